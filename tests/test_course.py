"""course.py sets up, repairs, explains, and hands over; tried in small copies of the course that install offline."""

import ast
import os
import runpy
import signal
import socket
import subprocess
import sys
import sysconfig
import time
from pathlib import Path

import pytest

from course_lib.cli import COMMANDS, usage

ROOT = Path(__file__).resolve().parents[1]
COURSE = ROOT / "course.py"
PYPROJECT = """
[build-system]
requires = []
build-backend = "backend"
backend-path = ["."]
[project]
name = "course-lib"
version = "1"
"""
# A build backend of its own, so that the copy's package installs without a network and without setuptools.
BACKEND = """
import pathlib, zipfile
def build_editable(folder, config_settings=None, metadata_directory=None):
    name = "course_lib-1-py3-none-any.whl"
    with zipfile.ZipFile(pathlib.Path(folder) / name, "w") as wheel:
        wheel.writestr("course_lib.pth", str(pathlib.Path.cwd()))
        info = "course_lib-1.dist-info"
        wheel.writestr(info + "/METADATA", "Metadata-Version: 2.1\\nName: course-lib\\nVersion: 1\\n")
        wheel.writestr(info + "/WHEEL", "Wheel-Version: 1.0\\nRoot-Is-Purelib: true\\nTag: py3-none-any\\n")
        wheel.writestr(info + "/RECORD", "")
    return name
build_wheel = build_editable
"""
HANGS_S = 1200  # no call takes so long, however busy the machine is
# Stands for the Python that makes environments, whose pip is unpacked and compiled for seconds: links a ready one.
QUICK_VENV = """#!{} -P
import os, pathlib, sys, venv
venv.main(["--without-pip", sys.argv[-1]])
for entry in map(pathlib.Path, {!r}):
    for library in pathlib.Path(sys.argv[-1]).glob("lib/*/site-packages"):
        os.symlink(entry, library / entry.name)
"""
QUICK = []  # the Python that makes environments while a copy is tried
HANDED_OVER = 'import os, sys\nprint("handed over", sys.argv[1:], sys.prefix, os.getcwd())\n'


@pytest.fixture(scope="module")
def quick_pip(tmp_path_factory):
    """A program that makes environments which get their pip at once, called as Python is."""
    program = tmp_path_factory.mktemp("quick") / "python"
    pip = [str(path) for path in Path(sysconfig.get_path("purelib")).glob("pip*") if path.is_dir()]
    assert pip
    program.write_text(QUICK_VENV.format(getattr(sys, "_base_executable", sys.executable), pip))
    program.chmod(0o755)
    return str(program)


@pytest.fixture
def copy(tmp_path, quick_pip, monkeypatch):
    """A folder with course.py, an environment of no package, and a package that says that it was called."""
    monkeypatch.setattr(f"{__name__}.QUICK", [quick_pip])
    folder = tmp_path / "course"
    (folder / "course_lib").mkdir(parents=True)
    (folder / "course.py").write_bytes(COURSE.read_bytes())
    (folder / "environment.txt").write_text("# nothing\n")
    (folder / "pyproject.toml").write_text(PYPROJECT)
    (folder / "backend.py").write_text(BACKEND)
    (folder / "course_lib" / "__init__.py").touch()
    (folder / "course_lib" / "cli.py").write_bytes((ROOT / "course_lib" / "cli.py").read_bytes())
    (folder / "course_lib" / "__main__.py").write_text(HANDED_OVER)
    return folder


def environment(**more):
    """The user's environment without pip's settings: an address that nobody answers stands for every index."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("PIP_", "UV_", "PYTHON"))}
    pip = {"PIP_CONFIG_FILE": os.devnull, "PIP_INDEX_URL": "http://127.0.0.1:9/simple", "PIP_RETRIES": "0"}
    return {**kept, **pip, "PIP_NO_CACHE_DIR": "1", **more}


def course_command(folder, prelude=""):
    """The copy's course.py, run after `prelude` has changed the Python that it finds."""
    quick = f"sys._base_executable = {QUICK[0]!r}\n" if QUICK else ""
    runner = f"import sys, os, runpy\n{quick}{prelude}\nsys.argv = ['course.py', *sys.argv[1:]]\n"
    runner += f"runpy.run_path({str(folder / 'course.py')!r}, run_name='__main__')"
    return [sys.executable, "-c", runner] if quick or prelude else [sys.executable, str(folder / "course.py")]


def call(folder, *arguments, prelude="", cwd=None, **more):
    """Runs the copy's course.py, after `prelude` has changed the Python that it finds; no traceback is ever shown."""
    command = course_command(folder, prelude)
    done = subprocess.run(
        [*command, *arguments], capture_output=True, text=True, env=environment(**more), cwd=cwd, timeout=HANGS_S
    )
    assert "Traceback" not in done.stdout + done.stderr
    return done


def test_only_the_standard_library_is_imported():
    names = set()
    for node in ast.walk(ast.parse(COURSE.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names.add(node.module.split(".")[0])
    # course_lib.cli itself imports the standard library alone: tests/commands/test_cli.py.
    assert names <= set(sys.stdlib_module_names) | {"course_lib"}


def test_an_old_python_can_read_the_file():
    ast.parse(COURSE.read_text(encoding="utf-8"), feature_version=(3, 6))


@pytest.mark.parametrize("version", [(3, 6, 15), (3, 10, 99)])
def test_an_old_python_is_told_which_one_is_needed(copy, version):
    done = call(copy, "check", prelude=f"sys.version_info = {version}")
    assert done.returncode == 1
    assert "needs Python 3.11 or newer" in done.stderr
    assert f"{version[0]}.{version[1]}" in done.stderr
    assert not (copy / ".venv").exists()


def test_usage_lists_every_command_as_the_command_line_does(copy):
    printed = call(copy, "--help").stdout
    assert printed.startswith(usage())
    assert all(name in printed for name in COMMANDS)
    assert "python3 course.py COMMAND --help" in printed


@pytest.mark.parametrize("arguments", [["--help"], ["-h"], ["lab", "--help"]])
def test_help_before_any_set_up_installs_nothing(copy, arguments):
    done = call(copy, *arguments)
    assert done.returncode == 0
    assert "usage: python3 course.py" in done.stdout
    assert not (copy / ".venv").exists()


def test_no_command_shows_the_usage_and_fails(copy):
    done = call(copy)
    assert done.returncode == 2
    assert "usage:" in done.stdout


@pytest.mark.slow
def test_first_call_sets_up_and_hands_over_and_the_second_is_quiet(copy, tmp_path):
    QUICK.clear()  # with Python's own ensurepip
    first = call(copy, "demo", "corridor", "--json", cwd=tmp_path)
    # Only the command writes to standard output, or --json would be spoilt; the folder one is in stays.
    assert first.stdout == f"handed over ['demo', 'corridor', '--json'] {copy / '.venv'} {tmp_path}\n"
    assert "setting it up" in first.stderr
    assert first.returncode == 0
    again = call(copy, "x")
    assert again.stderr == ""
    assert again.stdout.startswith("handed over ['x']")


def make_nothing(venv):
    venv.mkdir()


def make_an_interrupted_one(venv):
    (venv / "bin").mkdir(parents=True)
    (venv / "course-incomplete").touch()  # all that earlier versions of course.py left


def make_a_dangling_python(venv):
    (venv / "bin").mkdir(parents=True)
    (venv / "bin" / "python").symlink_to("/nowhere/python3.11")
    (venv / "course-made").touch()


def make_one_without_pip(venv):
    subprocess.run([sys.executable, "-P", "-m", "venv", "--without-pip", str(venv)], check=True)
    (venv / "course-ready.json").write_text("{}")  # all that earlier versions of course.py left


@pytest.mark.slow
@pytest.mark.parametrize("make", [make_nothing, make_an_interrupted_one, make_a_dangling_python, make_one_without_pip])
def test_a_half_made_environment_is_made_anew(copy, make):
    make(copy / ".venv")
    done = call(copy, "x")
    assert "half-made" in done.stderr
    assert done.stdout.startswith("handed over")
    assert not (copy / ".venv" / "course-incomplete").exists()
    assert (copy / ".venv" / "course-made").exists()


def put_a_link_to_a_folder(venv):
    precious = venv.parent.parent / "precious"
    precious.mkdir()
    (precious / "thesis.txt").write_text("mine")
    venv.symlink_to(precious)
    return precious / "thesis.txt"


def put_a_link_to_an_environment_of_ours(venv):
    kept = put_a_link_to_a_folder(venv)
    for mark in ("course-made", "course-incomplete"):
        (kept.parent / mark).touch()
    return kept


def put_a_foreign_folder(venv):
    venv.mkdir()
    (venv / "thesis.txt").write_text("mine")
    return venv / "thesis.txt"


def put_a_foreign_environment(venv):
    subprocess.run([sys.executable, "-P", "-m", "venv", "--without-pip", str(venv)], check=True)
    (venv / "thesis.txt").write_text("mine")
    return venv / "thesis.txt"


def put_a_mark_that_is_a_link(venv):
    kept = put_a_link_to_a_folder(venv.parent / "a_link")
    venv.mkdir()
    (venv / "course-made").symlink_to(kept)
    return kept


def put_a_forged_mark(venv):
    kept = put_a_foreign_folder(venv)
    (venv / "a").mkdir()
    (venv / "course-made").touch()
    return kept


def put_a_mark_of_an_earlier_version(venv):
    kept = put_a_foreign_folder(venv)
    (venv / "course-incomplete").touch()
    return kept


def put_a_file(venv):
    venv.write_text("mine")
    return venv


@pytest.mark.parametrize(
    ("put", "said"),
    [
        (put_a_link_to_a_folder, "is a link to"),
        (put_a_link_to_an_environment_of_ours, "is a link to"),
        (put_a_foreign_folder, "was not made by course.py"),
        (put_a_foreign_environment, "was not made by course.py"),
        (put_a_mark_that_is_a_link, "was not made by course.py"),
        (put_a_forged_mark, "holds what course.py did not put there: a, thesis.txt"),
        (put_a_mark_of_an_earlier_version, "holds what course.py did not put there: thesis.txt"),
        (put_a_file, "is not a folder"),
    ],
)
def test_what_course_py_did_not_make_is_refused_and_left_as_it_is(copy, put, said):
    kept = put(copy / ".venv")
    before = sorted((path, path.lstat().st_mtime_ns) for path in copy.parent.rglob("*"))
    done = call(copy, "check")
    assert done.returncode == 1
    assert said in done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert "course.py again" in done.stderr
    assert kept.read_text() == "mine"
    assert sorted((path, path.lstat().st_mtime_ns) for path in copy.parent.rglob("*")) == before


@pytest.mark.slow
def test_a_link_with_the_name_of_our_files_is_replaced_and_not_written_through(copy):
    kept = put_a_link_to_a_folder(copy / "a_link")
    (copy / ".venv").mkdir()
    (copy / ".venv" / "course-made").touch()
    for name in ("course-incomplete", "course-ready.json", "course-ready.json.part", "course-opengl-ready"):
        (copy / ".venv" / name).symlink_to(kept)
    assert call(copy, "x").stdout.startswith("handed over")
    assert kept.read_text() == "mine"


@pytest.mark.slow
def test_a_link_inside_an_environment_is_removed_and_not_what_it_leads_to(copy):
    precious = put_a_link_to_a_folder(copy / "a_link")
    (copy / ".venv").mkdir()
    (copy / ".venv" / "course-incomplete").touch()
    (copy / ".venv" / "share").symlink_to(precious.parent)
    assert call(copy, "x").stdout.startswith("handed over")
    assert precious.read_text() == "mine"


@pytest.mark.slow
def test_a_module_of_the_callers_folder_neither_breaks_the_set_up_nor_runs(copy, tmp_path):
    for name in ("random", "ctypes", "venv", "pip", "shutil", "json"):
        for folder in (tmp_path, copy):  # the folder that one stands in, and the course's own
            (folder / f"{name}.py").write_text(f"open({str(tmp_path / 'ran')!r}, 'w')\nraise SystemExit(3)\n")
    for python_path in ("", "x:", f".:{tmp_path}"):  # an empty part is the folder that one stands in
        more = {"PYTHONPATH": python_path, "PYTHONSTARTUP": str(tmp_path / "random.py"), "PYTHONSAFEPATH": ""}
        command = [sys.executable, str(copy / "course.py"), "x"]
        done = subprocess.run(command, capture_output=True, text=True, env=environment(**more), cwd=tmp_path)
        assert done.stdout.startswith("handed over"), done.stderr
        assert call(copy, "--help", cwd=copy, **more).stdout.startswith("usage")
    assert not (tmp_path / "ran").exists()


def test_the_command_gets_no_variable_that_says_what_code_python_runs(copy):
    (copy / "course_lib" / "__main__.py").write_text("import os, sys\nprint(sorted(os.environ), sys.flags.safe_path)\n")
    given = {
        "PYTHONPATH": "/x",
        "PYTHONSTARTUP": "/x",
        "PYTHONUSERBASE": "/x",
        "PYTHONUTF8": "1",
        "COURSE_RECORD": "/x",
    }
    names, safe = call(copy, "x", **given).stdout.rsplit(maxsplit=1)
    assert safe == "True"
    assert given.keys() & set(ast.literal_eval(names)) == {"PYTHONUTF8", "COURSE_RECORD"}


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="symbolic links of POSIX")
def test_called_through_a_link_it_finds_the_course(copy, tmp_path):
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "course").symlink_to(copy / "course.py")
    module = runpy.run_path(str(tmp_path / "bin" / "course"), run_name="imported")
    assert module["ROOT"] == str(copy.resolve())


def test_what_has_changed_is_told_and_repaired(copy):
    call(copy, "x")
    ready = copy / ".venv" / "course-ready.json"

    ready.write_text(ready.read_text()[:20])
    assert "half-made" in call(copy, "x").stderr
    (copy / "environment.txt").write_text("# something else\n")
    assert "environment.txt or pyproject.toml has changed" in call(copy, "x").stderr
    library = next((copy / ".venv" / "lib").iterdir()) / "site-packages"
    for name in ("course_lib.pth", "course_lib-1.dist-info"):
        os.rename(library / name, copy / name)
    done = call(copy, "x")
    assert "Packages are missing" in done.stderr
    assert done.stdout.startswith("handed over")
    assert call(copy, "x").stderr == ""

    moved = copy.parent / "moved"
    copy.rename(moved)
    done = call(moved, "x")
    assert "another folder" in done.stderr
    assert str(moved) in done.stdout


@pytest.mark.slow
def test_no_network_is_told_and_the_next_call_goes_on(copy):
    (copy / "environment.txt").write_text("not-to-be-had==1\n")
    done = call(copy, "check")
    assert done.returncode == 1
    assert "is there a network connection" in done.stderr
    assert len(done.stderr) < 1500
    assert not (copy / ".venv" / "course-ready.json").exists()
    (copy / "environment.txt").write_text("# nothing\n")
    again = call(copy, "check")
    assert "completing it" in again.stderr
    assert again.stdout.startswith("handed over")


def test_a_folder_without_write_permission_is_told(copy):
    def_denied = "def denied(path, *a, **k): raise PermissionError(13, 'Permission denied', path)\nos.makedirs = denied"
    done = call(copy, "check", prelude=def_denied)
    assert done.returncode == 1
    assert "no permission to write" in done.stderr
    assert "folder of your own" in done.stderr


def test_a_missing_lock_file_is_told(copy):
    (copy / "environment.txt").unlink()
    done = call(copy, "check")
    assert done.returncode == 1
    assert "environment.txt is missing" in done.stderr


@pytest.fixture
def silent_index():
    """An index that accepts a connection and never answers: an installation that hangs."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        yield f"http://127.0.0.1:{server.getsockname()[1]}/simple", server


def start_hanging_installation(copy, silent_index):
    """course.py in a session of its own, in the middle of its pip."""
    address, server = silent_index
    (copy / "environment.txt").write_text("not-to-be-had==1\n")
    process = subprocess.Popen(
        [*course_command(copy), "x"],
        env=environment(PIP_INDEX_URL=address),
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        # A run started in the background has SIGINT ignored, and would hand that on.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    server.settimeout(HANGS_S)
    connection, _ = server.accept()  # pip asks: it runs
    return process, connection


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
def test_a_killed_installation_is_made_anew(copy, silent_index):
    process, connection = start_hanging_installation(copy, silent_index)
    with connection:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
    (copy / "environment.txt").write_text("# nothing\n")
    done = call(copy, "x")
    assert "interrupted and left .venv half-made" in done.stderr
    assert done.stdout.startswith("handed over")


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
def test_control_c_stops_with_a_sentence(copy, silent_index):
    process, connection = start_hanging_installation(copy, silent_index)
    with connection:
        os.killpg(process.pid, signal.SIGINT)
        errors = process.communicate(timeout=HANGS_S)[1]
    assert process.returncode == 130
    assert "Call course.py again to go on" in errors
    assert "Traceback" not in errors


@pytest.mark.slow
def test_two_at_once_wait_for_each_other(copy):
    command = [*course_command(copy), "x"]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True, "env": environment()}
    first = subprocess.Popen(command, **pipes)
    while not (copy / ".venv").exists():
        time.sleep(0.01)
    second = subprocess.Popen(command, **pipes)
    results = [process.communicate(timeout=HANGS_S) for process in (first, second)]
    assert [process.returncode for process in (first, second)] == [0, 0]
    assert all(output.startswith("handed over") for output, _ in results)
    assert "waiting for it to finish" in results[1][1]
    assert "Installing" not in results[1][1]
