"""Compiled loops where there is no place to keep compiled code: read-only installations, users without a home."""

import numba
import pytest

from course_lib.depth_mcl.compiled import compiled

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
