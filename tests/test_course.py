"""course.py sets up, repairs, explains, and hands over; tried in small copies of the course that install offline."""

import ast
import importlib.util
import os
import re
import subprocess
import sys
import time
import tomllib
from pathlib import Path

import pytest

from course_lib import __version__
from courseware.cli import usage

ROOT = Path(__file__).resolve().parents[1]
COURSE = ROOT / "course.py"
# A build backend of its own, so that the copy's package installs without a network and without setuptools.
PYPROJECT = '[build-system]\nrequires = []\nbuild-backend = "backend"\nbackend-path = ["."]\n'
BACKEND = """
import pathlib, zipfile
def build_editable(folder, config_settings=None, metadata_directory=None):
    name = "NAME-1-py3-none-any.whl"
    with zipfile.ZipFile(pathlib.Path(folder) / name, "w") as wheel:
        wheel.writestr("NAME.pth", "ROOT")
        info = "NAME-1.dist-info"
        wheel.writestr(info + "/METADATA", "Metadata-Version: 2.1\\nName: NAME\\nVersion: 1\\n")
        wheel.writestr(info + "/WHEEL", "Wheel-Version: 1.0\\nRoot-Is-Purelib: true\\nTag: py3-none-any\\n")
        wheel.writestr(info + "/RECORD", "")
    return name
"""
HANDED_OVER = """
import os, sys
kept = sorted(name for name in os.environ if name.startswith(("PYTHON", "COURSE_")))
print("handed over", sys.argv[1:], sys.prefix, os.getcwd(), kept, sys.flags.safe_path)
"""
HANGS_S = 1200  # no call takes so long, however busy the machine is


@pytest.fixture
def copy(tmp_path):
    """A folder with course.py, an environment of no package, and a package that says that it was called."""
    folder = tmp_path / "course"
    for name in ("course_lib", "courseware"):
        (folder / name).mkdir(parents=True)
    (folder / "course.py").write_bytes(COURSE.read_bytes())
    for name in ("environment.txt", "environment-test.txt"):
        (folder / name).write_text("# nothing\n")
    for project, name in ((folder, "course_lib"), (folder / "courseware", "courseware")):
        (project / "pyproject.toml").write_text(PYPROJECT)
        (project / "backend.py").write_text(BACKEND.replace("NAME", name).replace("ROOT", str(folder)))
    for name in ("course_lib/__init__.py", "courseware/__init__.py", "courseware/cli.py"):
        (folder / name).write_bytes((ROOT / name).read_bytes())
    (folder / "courseware" / "__main__.py").write_text(HANDED_OVER)
    return folder


def environment(**more):
    """The user's environment without pip's settings: an address that nobody answers stands for every index."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("PIP_", "PYTHON", "COURSE_"))}
    pip = {"PIP_CONFIG_FILE": os.devnull, "PIP_INDEX_URL": "http://127.0.0.1:9/simple", "PIP_RETRIES": "0"}
    return {**kept, **pip, "PIP_NO_CACHE_DIR": "1", **more}


def call(folder, *arguments, prelude="", cwd=None, **more):
    """Run the copy's course.py, after `prelude` has changed the Python that it finds; no traceback is ever shown."""
    runner = f"import sys, os, runpy\n{prelude}\nsys.argv = ['course.py', *sys.argv[1:]]\n"
    runner += f"runpy.run_path({str(folder / 'course.py')!r}, run_name='__main__')"
    command = [sys.executable, "-c", runner] if prelude else [sys.executable, str(folder / "course.py")]
    done = subprocess.run(
        [*command, *arguments], capture_output=True, text=True, env=environment(**more), cwd=cwd, timeout=HANGS_S
    )
    assert "Traceback" not in done.stdout + done.stderr
    return done


def test_an_old_python_can_read_the_file_and_is_told_which_one_is_needed(copy):
    tree = ast.parse(COURSE.read_text(encoding="utf-8"), feature_version=(3, 6))
    named = {a.name for node in ast.walk(tree) if isinstance(node, ast.Import) for a in node.names}
    named |= {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    assert {name.split(".")[0] for name in named} <= set(sys.stdlib_module_names)
    done = call(copy, "check", prelude="sys.version_info = (3, 10, 99)")
    assert done.returncode == 1
    assert "needs Python 3.11 or newer; this is 3.10" in done.stderr
    assert not (copy / ".venv").exists()


@pytest.mark.parametrize(("arguments", "code"), [([], 2), (["--help"], 0), (["lab", "--help"], 0)])
def test_help_before_any_set_up_lists_the_commands_and_installs_nothing(copy, arguments, code):
    done = call(copy, *arguments)
    assert (done.returncode, done.stdout) == (code, usage())
    assert not (copy / ".venv").exists()


def test_the_version_is_told_before_any_set_up_and_the_packages_is_the_same(copy):
    done = call(copy, "--version")
    assert (done.returncode, done.stdout) == (0, "2.0\n")
    assert not (copy / ".venv").exists()
    assert __version__ == tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["version"]


@pytest.mark.slow
def test_the_first_call_sets_up_and_the_next_ones_repair_what_has_changed(copy, tmp_path):
    (copy / "json.py").write_text("raise SystemExit(3)\n")  # is not taken for Python's
    first = call(copy, "demo", "--json", cwd=tmp_path, PYTHONPATH="/x", PYTHONUTF8="1", COURSE_RECORD="/y")
    # Only the command writes to standard output, or --json would be spoilt. The folder one is in stays.
    kept = "['COURSE_RECORD', 'PYTHONUTF8'] True"
    assert first.stdout == f"handed over ['demo', '--json'] {copy / '.venv'} {tmp_path} {kept}\n"
    assert "setting it up" in first.stderr
    assert call(copy, "x").stderr == ""
    assert "The tests need more packages than the lessons" in call(copy, "test").stderr
    assert call(copy, "x").stderr == call(copy, "test").stderr == "", "what the tests need stays"

    (copy / "environment-test.txt").write_text("not-to-be-had==1\n")
    offline = call(copy, "x")
    assert offline.returncode == 1
    assert "bringing .venv up to date" in offline.stderr
    assert "Is there a network connection" in offline.stderr
    (copy / "environment-test.txt").write_text("# nothing\n")
    assert call(copy, "x").stderr == "", "what was installed before is still there"

    (copy / ".venv" / "course-ready.json").unlink()
    half_made = call(copy, "x")
    assert "half-made" in half_made.stderr
    assert half_made.stdout.startswith("handed over")

    moved = copy.parent / "moved"
    copy.rename(moved)
    assert "another folder" in call(moved, "x").stderr


@pytest.mark.parametrize("kind", ["link", "folder", "file"])
def test_what_course_py_did_not_make_is_refused_and_left_as_it_is(copy, kind):
    venv, precious = copy / ".venv", copy.parent / "precious"
    precious.mkdir()
    if kind == "link":
        (precious / "course-made").touch()
        venv.symlink_to(precious)
    elif kind == "folder":
        precious.rename(venv)
        (venv / "thesis.txt").write_text("mine")
    else:
        venv.write_text("mine")
    before = sorted((path, path.lstat().st_mtime_ns) for path in copy.parent.rglob("*"))
    done = call(copy, "check")
    assert done.returncode == 1
    assert done.stderr == f"error: {copy / '.venv'} was not made by course.py. Move it away and call course.py again.\n"
    assert sorted((path, path.lstat().st_mtime_ns) for path in copy.parent.rglob("*")) == before


@pytest.mark.release
def test_two_at_once_wait_for_each_other(copy):
    command = [sys.executable, str(copy / "course.py"), "x"]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True, "env": environment()}
    first = subprocess.Popen(command, **pipes)
    while not (copy / ".venv").exists():
        time.sleep(0.01)
    second = subprocess.Popen(command, **pipes)
    results = [process.communicate(timeout=HANGS_S) for process in (first, second)]
    assert all(output.startswith("handed over") for output, _ in results)
    assert "waiting for it to finish" in results[1][1]
    assert "Installing" not in results[1][1]


@pytest.fixture
def course(monkeypatch):
    """course.py as a module on a Debian without OpenGL and venv; `course.ran` are the commands that it runs."""
    spec = importlib.util.spec_from_file_location("course", COURSE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    module.ran = []
    monkeypatch.setattr(module, "run", lambda command: module.ran.append(" ".join(command)) or (0, ""))
    monkeypatch.setattr(module.ctypes, "CDLL", lambda name: (_ for _ in ()).throw(OSError(name)))
    monkeypatch.setattr(module.importlib.util, "find_spec", lambda name: None)
    monkeypatch.setattr(module.shutil, "which", lambda name: f"/usr/bin/{name}")
    return module


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="other systems bring OpenGL along")
@pytest.mark.parametrize("root", [True, False])
def test_what_the_system_lacks_is_installed_or_all_of_it_told_at_once(course, monkeypatch, capsys, root):
    monkeypatch.setattr(course.os, "geteuid", lambda: 0 if root else 1000)
    opengl = " ".join((ROOT / "binder" / "apt.txt").read_text().split())
    line = "apt-get install -y --no-install-recommends {}" + opengl
    venv = "python{}.{}-venv ".format(*sys.version_info)
    course.see_to_the_system(anew=False)
    assert course.ran == (["apt-get update", line.format("")] if root else [])
    assert (line.format("") in capsys.readouterr().err) == (not root)
    if root:
        course.see_to_the_system(anew=True)
        assert course.ran[-1] == line.format(venv)
    else:
        with pytest.raises(course.SetupError, match=re.escape(line.format(venv))):
            course.see_to_the_system(anew=True)


def test_what_stopped_pip_is_told_in_a_sentence(course):
    for output, told in (
        ("ERROR: [Errno 28] No space left on device", "the disk is full"),
        ("ERROR: No matching distribution found for x (from versions: none)", "Is there a network connection"),
        ("a\nERROR: hashes do not match", "could not install the environment. pip said: ERROR: hashes do not match"),
    ):
        assert told in course.why_not_installed(output)
