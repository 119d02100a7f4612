"""`pip install .` gives course_lib alone; two files lock pyproject.toml's ranges in full; arrows."""

import ast
import importlib.metadata
import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).resolve().parents[1]
LOCK = ROOT / "environment-test.txt"
STUDENTS = ROOT / "environment.txt"
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
# What only the lessons, the commands and the tests have.
LESSONS_ONLY = ("courseware", "jupyterlab", "ipywidgets", "IPython", "matplotlib", "pyvista", "tqdm", "pytest", "nbval")

# Refuses the named packages, imports every module of the library, and runs README's two snippets.
USE_THE_LIBRARY = """
import importlib, pkgutil, re, sys
readme, *refused = sys.argv[1:]
class Refuse:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in refused:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
sys.meta_path.insert(0, Refuse())
import course_lib
print(course_lib.__file__)
for module in pkgutil.walk_packages(course_lib.__path__, "course_lib."):
    importlib.import_module(module.name)
for snippet in re.findall("```python\\n(.*?)```", open(readme, encoding="utf-8").read(), re.S):
    exec(snippet, {"__name__": "mine"})
print(sorted(set(refused) & {name.split(".")[0] for name in sys.modules}))
"""


def imported_packages(path):
    """The top-level names that a file imports, wherever in it."""
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name.split(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            yield node.module.split(".")[0]


def test_what_the_methods_import_is_what_is_installed_with_them():
    distributions = importlib.metadata.packages_distributions()
    installed = {canonicalize_name(Requirement(line).name) for line in PROJECT["dependencies"]}
    for path in sorted((ROOT / "course_lib").rglob("*.py")):
        for name in set(imported_packages(path)) - set(sys.stdlib_module_names) - {"course_lib"}:
            owners = {canonicalize_name(owner) for owner in distributions[name]}
            assert owners & installed, f"{path.relative_to(ROOT)} imports {name}, which `pip install .` does not bring"


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """A folder with what setuptools installs, from a build of a copy of both packages."""
    folder = tmp_path_factory.mktemp("build")
    for package in ("course_lib", "courseware"):
        shutil.copytree(ROOT / package, folder / package, ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, folder)
    command = [sys.executable, "-c", "from setuptools import setup; setup()", "-q", "build", "--build-lib", "built"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return folder / "built"


def test_every_file_of_the_library_is_installed_and_nothing_else(built):
    there = {
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / "course_lib").rglob("*")
        if path.is_file() and "__pycache__" not in path.parts and not re.search(r"\.pyc$|/\.", path.as_posix())
    }
    assert {path.relative_to(built).as_posix() for path in built.rglob("*") if path.is_file()} == there
    assert "course_lib/py.typed" in there


@pytest.mark.slow
def test_the_installed_library_runs_the_readmes_snippets_in_any_folder_without_what_lessons_need(built, tmp_path):
    command = [sys.executable, "-P", "-c", USE_THE_LIBRARY, str(ROOT / "README.md"), *LESSONS_ONLY]
    environment = os.environ | {"PYTHONPATH": str(built)}
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[0] == str(built / "course_lib" / "__init__.py")
    assert done.stdout.splitlines()[-1] == "[]"


def locked(text):
    """Requirements of a lock's lines, comments left out."""
    return [Requirement(line.split(" #")[0]) for line in text.splitlines() if line.strip() and line.strip()[0] != "#"]


@pytest.fixture(scope="module")
def versions():
    """Locked version by package name."""
    return {canonicalize_name(r.name): next(iter(r.specifier)).version for r in locked(LOCK.read_text("utf-8"))}


def test_every_line_pins_one_exact_version():
    requirements = locked(LOCK.read_text("utf-8"))
    for requirement in requirements:
        assert re.fullmatch(r"==[^*,]+", str(requirement.specifier)), f"{requirement} is not pinned"
        assert requirement.url is None
    names = [canonicalize_name(requirement.name) for requirement in requirements]
    assert sorted(names) == sorted(set(names))


def test_every_range_of_pyproject_is_met_and_the_test_tools_are_there(versions):
    extras = PROJECT["optional-dependencies"]
    ranges = [*PROJECT["dependencies"], *extras["lessons"], *extras["grading"], *extras["test"]]
    for requirement in map(Requirement, ranges):
        if requirement.name != PROJECT["name"]:  # an extra that names another one
            assert versions[canonicalize_name(requirement.name)] in requirement.specifier, requirement
    assert {"pytest", "pytest-xdist", "nbval", "hypothesis", "ruff"} <= set(versions)


def test_students_install_the_same_versions_of_what_lessons_need_and_no_test_tools(versions):
    pins = {str(requirement) for requirement in locked(STUDENTS.read_text("utf-8"))}
    assert pins < {str(requirement) for requirement in locked(LOCK.read_text("utf-8"))}
    names = {canonicalize_name(Requirement(pin).name) for pin in pins}
    extras = PROJECT["optional-dependencies"]
    ranges = [*PROJECT["dependencies"], *extras["lessons"], *extras["grading"]]
    assert {canonicalize_name(Requirement(text).name) for text in ranges} <= names
    tools = {canonicalize_name(Requirement(text).name) for text in extras["test"]} - {PROJECT["name"]}
    assert names & tools == set()


def test_the_environment_that_runs_is_the_locked_one(versions):
    if not (Path(sys.prefix) / "course-ready.json").exists():
        pytest.skip("these tests do not run in a .venv that course.py made")
    for requirement in locked(LOCK.read_text("utf-8")):  # `test` has added what students do without
        if requirement.marker is None or requirement.marker.evaluate():
            name = canonicalize_name(requirement.name)
            assert importlib.metadata.version(name) == versions[name], f"{name} is another version than locked"


def test_every_room_imports_only_rooms_below_it():
    """Arrows between the rooms point one way: import-linter's contracts in pyproject.toml."""
    command = [str(Path(sys.executable).with_name("lint-imports")), "--no-cache"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout
