"""How course.py sees to what only the system can install, OpenGL and Python's module venv, and what it says."""

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
    """course.py as a module, with its memory of success and failure in a scratch folder and no command really run."""
    spec = importlib.util.spec_from_file_location("course", COURSE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    monkeypatch.setattr(module, "OPENGL_READY", str(tmp_path / "ready"))
    monkeypatch.setattr(module, "OPENGL_FAILED", str(tmp_path / "failed"))
    monkeypatch.setattr(module.shutil, "which", lambda name: f"/usr/bin/{name}")
    monkeypatch.setattr(module.os, "geteuid", lambda: 0)
    monkeypatch.setattr(module.sys, "base_prefix", "/usr")
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


VERSION = f"{sys.version_info[0]}.{sys.version_info[1]}"
VENV_LINE = f"apt-get install -y --no-install-recommends python{VERSION}-venv"


def take_venv_away(course, monkeypatch, apt_brings_it, module="ensurepip"):
    """A Python without `module`, until apt-get has run, where that brings it. Returns the commands that are run."""
    commands = []

    def run(command, lock):
        commands.append(" ".join(command))
        if apt_brings_it and "install" in command:
            monkeypatch.delitem(sys.modules, module)
        return 0 if apt_brings_it else 100, ["E: Unable to locate package"]

    monkeypatch.setitem(sys.modules, module, None)
    monkeypatch.setattr(course, "run", run)
    return commands


def test_a_complete_python_needs_no_package(course, monkeypatch):
    monkeypatch.setattr(course, "run", lambda *anything: pytest.fail("a command was run"))
    course.see_to_venv_module()


@pytest.mark.parametrize("module", ["venv", "ensurepip"])
def test_root_on_debian_gets_the_module_venv_installed_in_one_line(course, monkeypatch, capsys, module):
    commands = take_venv_away(course, monkeypatch, apt_brings_it=True, module=module)
    course.see_to_venv_module()
    assert commands[0] == "apt-get update"
    assert commands[1].startswith(VENV_LINE)
    announced = capsys.readouterr().err.splitlines()
    assert len(announced) == 1
    assert f"installing python{VERSION}-venv" in announced[0]


def test_a_module_venv_that_apt_cannot_bring_is_told_with_what_apt_said(course, monkeypatch):
    take_venv_away(course, monkeypatch, apt_brings_it=False)
    with pytest.raises(course.SetupError, match=rf"Unable to locate package.*{VENV_LINE}"):
        course.see_to_venv_module()


def test_without_a_network_apts_first_word_about_it_is_told(course, monkeypatch):
    # What a bare Debian 12 printed; its `apt-get update` ends with code 0.
    unreachable = "W: Failed to fetch http://mirror/InRelease  Could not connect to mirror:80 (127.0.0.1)."
    updated = [unreachable, unreachable.replace("InRelease", "updates"), "W: Some index files failed to download."]
    refused = ["This may mean that it is missing.", "E: Package 'python3.11-venv' has no installation candidate"]
    monkeypatch.setitem(sys.modules, "ensurepip", None)
    monkeypatch.setattr(course, "run", lambda command, lock: (0, updated) if "update" in command else (100, refused))
    with pytest.raises(course.SetupError) as error:
        course.see_to_venv_module()
    assert f"It could not be installed: {unreachable} / {refused[1]}." in str(error.value)


@pytest.mark.parametrize("who", ["another user", "a system without apt", "a Python that is not the system's"])
def test_where_apt_is_of_no_use_the_cure_for_a_missing_venv_is_told(course, monkeypatch, who):
    commands = take_venv_away(course, monkeypatch, apt_brings_it=True)
    if who == "another user":
        monkeypatch.setattr(course.os, "geteuid", lambda: 1000)
    elif who == "a system without apt":
        monkeypatch.setattr(course.shutil, "which", lambda name: None)
    else:
        monkeypatch.setattr(course.sys, "base_prefix", "/opt/python")
    with pytest.raises(course.SetupError, match=f"'ensurepip'.*{VENV_LINE}; then call course.py again"):
        course.see_to_venv_module()
    assert commands == []
