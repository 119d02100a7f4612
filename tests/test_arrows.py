"""Arrows between the rooms of the library point one way: import-linter's contracts in pyproject.toml."""

import subprocess
import sys
from pathlib import Path


def test_every_room_imports_only_rooms_below_it():
    command = [str(Path(sys.executable).with_name("lint-imports")), "--no-cache"]
    done = subprocess.run(command, cwd=Path(__file__).parents[1], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout
