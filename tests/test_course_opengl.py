"""How course.py sees to OpenGL: what it looks for, what it installs, and what it says where it cannot."""

import importlib.util
import os
import sys
from pathlib import Path

import pytest

COURSE = Path(__file__).resolve().parents[1] / "course.py"
LINE = "apt-get install -y --no-install-recommends libegl1 libgl1-mesa-dri libgl1"

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="other systems bring OpenGL along")


@pytest.fixture
def course(monkeypatch, tmp_path):
    """course.py as a module, with its memory of a success in a scratch folder and no command really run."""
    spec = importlib.util.spec_from_file_location("course", COURSE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    monkeypatch.setattr(module, "OPENGL_READY", str(tmp_path / "ready"))
    monkeypatch.setattr(module.shutil, "which", lambda name: f"/usr/bin/{name}")
    monkeypatch.setattr(module.os, "geteuid", lambda: 0)
    return module


def pretend(course, monkeypatch, works, apt_code=0):
    """`works`: what each look at OpenGL finds, in turn. Returns the list that the commands are written to."""
    commands, answers = [], iter(works)
    monkeypatch.setattr(course, "opengl_works", lambda: next(answers))
    monkeypatch.setattr(
        course, "run", lambda command, lock: commands.append(" ".join(command)) or (apt_code, ["E: no"])
    )
    return commands


def test_what_works_is_not_installed_and_not_looked_at_again(course, monkeypatch):
    commands = pretend(course, monkeypatch, [True])
    course.see_to_opengl()
    course.see_to_opengl()
    assert commands == []


def test_root_on_debian_gets_it_installed(course, monkeypatch, capsys):
    commands = pretend(course, monkeypatch, [False, True])
    course.see_to_opengl()
    assert commands[0] == "apt-get update"
    assert commands[1].startswith(LINE)
    assert "installing libegl1" in capsys.readouterr().err
    assert os.path.exists(course.OPENGL_READY)


def test_an_installation_that_fails_leaves_the_line_to_run(course, monkeypatch, capsys):
    pretend(course, monkeypatch, [False, False], apt_code=100)
    course.see_to_opengl()
    assert LINE in capsys.readouterr().err
    assert not os.path.exists(course.OPENGL_READY)


def test_another_user_gets_the_line_to_run(course, monkeypatch, capsys):
    commands = pretend(course, monkeypatch, [False])
    monkeypatch.setattr(course.os, "geteuid", lambda: 1000)
    course.see_to_opengl()
    assert commands == []
    assert f"sudo {LINE}" in capsys.readouterr().err


def test_a_system_without_apt_is_told_what_to_install(course, monkeypatch, capsys):
    pretend(course, monkeypatch, [False])
    monkeypatch.setattr(course.shutil, "which", lambda name: None)
    course.see_to_opengl()
    assert "Mesa" in capsys.readouterr().err


def test_the_look_finds_opengl_here(course):
    assert course.opengl_works()


def test_the_look_notices_missing_libraries(course, monkeypatch):
    monkeypatch.setattr(course, "OPENGL_PROBE", course.OPENGL_PROBE.replace("libEGL.so.1", "libNowhere.so.1"))
    assert not course.opengl_works()


def test_the_look_notices_a_missing_driver(course, monkeypatch):
    # The library that dispatches is there, and the file that would name a driver is not.
    monkeypatch.setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere/mesa.json")
    assert not course.opengl_works()
