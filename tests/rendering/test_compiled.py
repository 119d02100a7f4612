"""Compiled loops where there is no place to keep compiled code: read-only installations, users without a home, a full
disk; and where what was kept is damaged."""

import subprocess
import sys

import numba
import pytest

from course_lib.rendering.compiled import compiled

TWICE = "def twice(x):\n    return 2 * x\n"


@pytest.fixture
def nowhere(tmp_path, monkeypatch):
    """A function whose source and whose user's cache lie where no folder can be made, even by root."""
    file = tmp_path / "a file, no folder"
    file.write_text("")
    for variable in ("XDG_CACHE_HOME", "HOME", "LOCALAPPDATA", "USERPROFILE"):
        monkeypatch.setenv(variable, str(file / "cache"))
    names = {"__name__": "nowhere"}
    exec(compile(TWICE, str(file / "twice.py"), "exec"), names)
    return names["twice"]


def test_without_a_place_for_compiled_code_each_process_compiles_for_itself(nowhere):
    with pytest.raises(RuntimeError):
        numba.njit(cache=True)(nowhere)
    assert compiled()(nowhere)(21) == 42


def test_compiled_code_is_kept_where_it_can_be(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    path = tmp_path / "twice.py"
    path.write_text(TWICE)
    names = {"__name__": "twice"}
    exec(compile(TWICE, str(path), "exec"), names)
    assert compiled()(names["twice"])(21) == 42
    assert list(tmp_path.rglob("*.nbc"))


ON_A_DISK_THAT_TAKES_NOTHING = """
import resource, sys
from course_lib.rendering.compiled import compiled
resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))
names = {"__name__": "twice"}
exec(compile(open(sys.argv[1]).read(), sys.argv[1], "exec"), names)
print(compiled()(names["twice"])(21))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="a limit of POSIX")
def test_on_a_disk_that_takes_nothing_it_runs_all_the_same(tmp_path):
    path = tmp_path / "twice.py"
    path.write_text(TWICE)
    command = [sys.executable, "-c", ON_A_DISK_THAT_TAKES_NOTHING, str(path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.stdout == "42\n", done.stderr
    assert not [left for left in tmp_path.rglob("*.nb*") if left.stat().st_size]


@pytest.mark.parametrize("damage", [b"", b"no pickle"])
def test_kept_code_that_is_damaged_is_compiled_anew(tmp_path, monkeypatch, damage):
    """As a disk that lost its power leaves a file: with its name, and without what was in it."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    path = tmp_path / "twice.py"
    path.write_text(TWICE)
    for _ in range(2):
        names = {"__name__": "twice"}
        exec(compile(TWICE, str(path), "exec"), names)
        assert compiled()(names["twice"])(21) == 42
        kept = [*tmp_path.rglob("*.nbc"), *tmp_path.rglob("*.nbi")]
        assert kept
        for file in kept:
            file.write_bytes(damage)
