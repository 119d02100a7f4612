"""environment.txt is a full lock of pyproject.toml's ranges: one version a package, for every platform, no address."""

import re
import sys
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).resolve().parents[1]
LOCK = ROOT / "environment.txt"


def locked(text):
    """Requirements of a lock's lines, comments left out."""
    return [Requirement(line.split(" #")[0]) for line in text.splitlines() if line.strip() and line.strip()[0] != "#"]


@pytest.fixture(scope="module")
def versions():
    """Locked version by package name."""
    return {canonicalize_name(r.name): next(iter(r.specifier)).version for r in locked(LOCK.read_text("utf-8"))}


@pytest.fixture(scope="module")
def project():
    return tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]


def test_every_line_pins_one_exact_version():
    requirements = locked(LOCK.read_text("utf-8"))
    for requirement in requirements:
        assert re.fullmatch(r"==[^*,]+", str(requirement.specifier)), f"{requirement} is not pinned"
        assert requirement.url is None
    names = [canonicalize_name(requirement.name) for requirement in requirements]
    assert sorted(names) == sorted(set(names))


def test_every_range_of_pyproject_is_met_and_the_test_tools_are_there(versions, project):
    extras = project["optional-dependencies"]
    for requirement in map(Requirement, [*project["dependencies"], *extras["lessons"], *extras["test"]]):
        if requirement.name != project["name"]:  # an extra that names another one
            assert versions[canonicalize_name(requirement.name)] in requirement.specifier, requirement
    assert {"pytest", "pytest-xdist", "nbval", "hypothesis", "ruff"} <= set(versions)


def test_the_environment_that_runs_is_the_locked_one(versions):
    import importlib.metadata

    if not (Path(sys.prefix) / "course-ready.json").exists():
        pytest.skip("these tests do not run in a .venv that course.py made")
    for requirement in locked(LOCK.read_text("utf-8")):
        if requirement.marker is None or requirement.marker.evaluate():
            name = canonicalize_name(requirement.name)
            assert importlib.metadata.version(name) == versions[name], f"{name} is another version than locked"
