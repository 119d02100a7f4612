"""Every process that the product starts is clean of the caller's folder, PYTHONPATH and the user's start-up files."""

import ast
import os
import subprocess
import sys

import pytest

from course_lib import child
from course_lib.commands import lab
from course_lib.paths import REPOSITORY

HOSTILE = ("random", "numpy", "json", "sitecustomize", "usercustomize", "runpy", "conftest", "pkgutil", "tornado")
STARTS = (
    "subprocess",
    "multiprocessing",
    "torch.multiprocessing",
    "pty",
    "concurrent.futures.ProcessPoolExecutor",
    "nbclient",
    "jupyter_client",
)
STARTING_CALLS = (
    "os.system",
    "os.popen",
    "os.fork",
    "os.posix_spawn",
    "os.execv",
    "os.execve",
    "os.execvp",
    "os.spawnv",
)

# What starts processes, file -> why it may.
STARTERS = {
    "course.py": "the standard library only, with an environment of its own: tests/test_course.py",
    "course_lib/child.py": "the one way to start a program",
    "course_lib/worker_pool.py": "fresh processes by Python's spawn, which passes -P on",
    "course_lib/detector_training/workers.py": "fresh processes by PyTorch's spawn, which end with the first",
    "course_lib/commands/lab.py": "becomes the server, with the environment of child.py",
    "course_lib/commands/refresh.py": "the lessons' kernels, with the environment of child.py and this Python",
    "course_lib/commands/lesson_costs.py": "the type of a process; starts by child.py",
    "course_lib/commands/check.py": "constants of subprocess; starts by child.py",
    "course_lib/commands/bench.py": "constants of subprocess; starts by child.py",
    "course_lib/commands/bench_renders.py": "constants of subprocess; starts by child.py",
    "course_lib/commands/compare.py": "constants of subprocess; starts by child.py",
    "course_lib/commands/lesson_versions.py": "git, no Python",
    "course_lib/commands/test.py": "pytest in this checkout's folder: what it runs is the checkout",
    "course_lib/classroom/sandbox.py": "an answer behind walls, with an environment of its own",
    "course_lib/classroom/sandbox_process.py": "the child of the sandbox, behind its walls",
    "course_lib/classroom/grading.py": "fresh processes by Python's spawn, which pass -P on and end with the grader",
    "benchmarks/start_up.py": "measures what a user's own call costs",
}
ONLY_CONSTANTS = [file for file, why in STARTERS.items() if "starts by child.py" in why]


def product_files():
    files = [REPOSITORY / "course.py", *(REPOSITORY / "benchmarks").rglob("*.py")]
    return sorted([*files, *(REPOSITORY / "course_lib").rglob("*.py")])


def starting_names(path):
    """What a file imports or calls that starts processes."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [f"{node.module}.{alias.name}" for alias in node.names]
        elif isinstance(node, ast.Call):
            names = [ast.unparse(node.func)]
            yield from (name for name in names if name in STARTING_CALLS)
            continue
        else:
            continue
        yield from (name for name in names if any(f"{name}.".startswith(f"{start}.") for start in STARTS))


def test_what_starts_processes_does_so_by_one_module_or_is_on_the_list():
    found = {path.relative_to(REPOSITORY).as_posix() for path in product_files() if set(starting_names(path))}
    assert found == set(STARTERS)


@pytest.mark.parametrize("file", ONLY_CONSTANTS)
def test_who_takes_only_constants_calls_nothing_of_subprocess(file):
    tree = ast.parse((REPOSITORY / file).read_text(encoding="utf-8"))
    called = [ast.unparse(node.func) for node in ast.walk(tree) if isinstance(node, ast.Call)]
    assert not [name for name in called if name.startswith("subprocess.")]


def test_course_py_keeps_the_same_variables():
    tree = ast.parse((REPOSITORY / "course.py").read_text(encoding="utf-8"))
    kept = next(node for node in tree.body if isinstance(node, ast.Assign) and node.targets[0].id == "KEPT")
    assert ast.literal_eval(kept.value) == child.KEPT


@pytest.fixture
def hostile(tmp_path, monkeypatch):
    """The folder one stands in, full of modules that note that they ran; PYTHONPATH and its like lead there."""
    for name in HOSTILE:
        (tmp_path / f"{name}.py").write_text(f"open({str(tmp_path / 'ran')!r}, 'w')\nraise SystemExit(3)\n")
    (tmp_path / "course_lib").mkdir()
    (tmp_path / "course_lib" / "__init__.py").write_text((tmp_path / "random.py").read_text())
    (tmp_path / "pytest.ini").write_text("[pytest]\naddopts = --hostile\n")
    (tmp_path / ".env").write_text(f"PYTHONPATH={tmp_path}\n")
    monkeypatch.chdir(tmp_path)
    for name in ("PYTHONPATH", "PYTHONSTARTUP", "PYTHONUSERBASE", "JUPYTER_PATH", "JUPYTER_CONFIG_PATH", "IPYTHONDIR"):
        monkeypatch.setenv(name, str(tmp_path))
    return tmp_path


def test_no_module_of_the_callers_folder_runs_in_a_child(hostile):
    code = "import json, random, numpy, course_lib, sys; print(course_lib.__file__, '' in sys.path)"
    done = child.run(child.course_module("course_lib.commands.depth_image_probe", "raster"), capture_output=True)
    assert done.returncode == 0, done.stderr
    done = child.run(child.python("-c", code), capture_output=True, text=True)
    assert done.stdout.endswith(" False\n"), done.stderr
    assert not (hostile / "ran").exists()


def test_the_hostile_folder_would_run_in_a_child_that_is_not_clean(hostile):
    assert subprocess.run([sys.executable, "-c", "import random"], check=False).returncode != 0
    assert (hostile / "ran").exists()


def test_a_course_module_is_of_this_course_and_its_folder_comes_last(hostile):
    code = "import runpy, sys\nprint(sys.path[-1], __name__, sys.argv[1:])\n"
    (hostile / "a_module_of_a_course.py").write_text(code)
    command = child.course_module("a_module_of_a_course", "x")
    assert command[4] == str(REPOSITORY)
    command[4] = str(hostile)
    said = child.run(command, capture_output=True, text=True).stdout
    assert said == f"{hostile} __main__ ['x']\n"
    assert not (hostile / "ran").exists()


def test_what_python_is_told_of_its_output_stays(monkeypatch):
    monkeypatch.setenv("PYTHONIOENCODING", "ascii")
    monkeypatch.setenv("PYTHONHOME", "/nowhere")
    environment = child.clean_environment({"PYTHONPATH": "/ours"})
    assert environment["PYTHONIOENCODING"] == "ascii"
    assert environment["PYTHONPATH"] == "/ours"
    assert "PYTHONHOME" not in environment
    assert environment["PATH"] == os.environ["PATH"]


def test_a_lesson_is_run_by_this_python_whatever_lies_beside_it(hostile):
    import nbformat

    from course_lib.commands.refresh import execute

    (hostile / "kernels" / "python3").mkdir(parents=True)
    (hostile / "kernels" / "python3" / "kernel.json").write_text('{"argv": ["false"], "display_name": "x"}')
    (hostile / "ipython_config.py").write_text((hostile / "random.py").read_text())
    (hostile / "mine.py").write_text("answer = 42\n")
    source = (
        "import sys, json, random, numpy, course_lib, mine\nprint(sys.executable, mine.answer, course_lib.__file__)"
    )
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(source)])
    execute(notebook, hostile, 600)
    assert notebook.cells[0].outputs[0].text.split() == [
        sys.executable,
        "42",
        str(child.ROOT / "course_lib/__init__.py"),
    ]
    assert not (hostile / "ran").exists()


def test_the_lab_has_a_clean_environment(hostile, tmp_path):
    command, environment = lab.lab_command(state_folder=tmp_path / "state")
    assert not [name for name, value in environment.items() if name.startswith("PYTHON") and str(tmp_path) in value]
    assert str(tmp_path / "state" / "config") == environment["JUPYTER_CONFIG_DIR"]
    assert "JUPYTER_PATH" not in environment
    assert command[:3] == [sys.executable, "-P", "-c"]
