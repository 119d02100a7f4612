"""Compiled loops are kept where they can be, and run where they cannot: read-only installations, damaged files."""

import importlib
import logging

import pytest
from numba.core import event

from course_lib.rendering.compiled import _Announcement, compiled

TWICE = "def twice(x):\n    return 2 * x\n"


def run_twice(path):
    names = {"__name__": "twice"}
    exec(compile(TWICE, str(path), "exec"), names)
    return compiled()(names["twice"])(21)


def test_without_a_place_for_compiled_code_each_process_compiles_for_itself(tmp_path, monkeypatch):
    file = tmp_path / "a file, no folder"
    file.write_text("")
    for variable in ("XDG_CACHE_HOME", "HOME", "LOCALAPPDATA", "USERPROFILE"):
        monkeypatch.setenv(variable, str(file / "cache"))
    assert run_twice(file / "twice.py") == 42


@pytest.mark.parametrize("damage", [b"", b"no pickle"])
def test_kept_code_that_is_damaged_is_compiled_again(tmp_path, monkeypatch, damage):
    """As a disk that lost its power leaves a file: with its name, and without what was in it."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    path = tmp_path / "twice.py"
    path.write_text(TWICE)
    for _ in range(2):
        assert run_twice(path) == 42
        kept = [*tmp_path.rglob("*.nbc"), *tmp_path.rglob("*.nbi")]
        assert kept
        for file in kept:
            file.write_bytes(damage)


@pytest.mark.parametrize(("terminal", "level"), [(True, "WARNING"), (False, "INFO")])
def test_compiling_is_announced_once_and_loading_is_not(tmp_path, monkeypatch, caplog, terminal, level):
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr("sys.stderr.isatty", lambda: terminal, raising=False)
    caplog.set_level(logging.INFO, "course_lib")
    head = "from course_lib.rendering.compiled import compiled\n\n\n@compiled()\n"
    for name in (f"first_{level}", f"second_{level}"):
        (tmp_path / f"{name}.py").write_text(head + TWICE)
    made = [importlib.import_module(path.stem) for path in sorted(tmp_path.glob("*.py"))]
    monkeypatch.setitem(event._registered, "numba:compile", [_Announcement()])  # none is made yet
    assert [one.twice(21) for one in made] == [42, 42]
    assert [record.levelname for record in caplog.records] == [level]
    monkeypatch.setitem(event._registered, "numba:compile", [_Announcement()])
    assert importlib.reload(made[0]).twice(21) == 42
    assert len(caplog.records) == 1
