"""Whether this machine's kernel builds the walls about strangers' code: tests that run such code need them."""

import os
import pickle
import sys
from pathlib import Path

import pytest

from course_lib.classroom.confinement import Limits
from course_lib.classroom.sandbox_process import Assignment


def require_walls(folder: Path) -> None:
    """Skip where the kernel builds no wall (but fail where CI=true); whether the walls hold is what the tests find."""
    missing = ["it is not Linux"] if sys.platform != "linux" else missing_walls(folder)
    if missing and os.environ.get("CI") == "true":
        pytest.fail(f"this machine does not keep strangers' code in: {missing}")
    if missing:
        pytest.skip(f"this machine does not keep strangers' code in: {missing}")


def missing_walls(folder: Path) -> list[str]:
    from course_lib.classroom.sandbox import Sandbox

    cells = (("cell 1", "def nothing(): pass", (0,)),)
    with Sandbox(folder, trusted=True) as sandbox:
        return sandbox.run(Assignment(cells, "nothing", pickle.dumps([]), Limits())).missing_walls
