"""All pages: their links, commands and minutes are right, they name one version and what there is."""

import ast
import json
import re
from fnmatch import fnmatch
from importlib import import_module
from pathlib import Path

import pytest
import yaml

from course_lib import __version__
from courseware.cli import COMMANDS, CommandParser, find_command, version
from courseware.paths import numbered_paths
from tests.notebooks.conftest import read

ROOT = Path(__file__).parents[1]
PAGES = sorted(
    path.relative_to(ROOT).as_posix()
    for pattern in (
        "*.md",
        ".github/**/*.md",
        "results-in-detail/*.md",
        "notebooks/**/*.md",
        "data/**/*.md",
        "tools/*.md",
    )
    for path in ROOT.glob(pattern)
)


def text(name):
    return (ROOT / name).read_text(encoding="utf-8")


def test_the_citation_and_the_changes_tell_the_version():
    assert yaml.safe_load(text("CITATION.cff"))["version"] == __version__
    assert re.search(r"^## (.*)$", text("CHANGELOG.md"), re.M)[1] == version()


def test_the_citation_names_both_papers_as_the_readme_does():
    papers = yaml.safe_load(text("CITATION.cff"))["references"]
    assert len(papers) == 2
    readme = " ".join(text("README.md").split())
    for paper in papers:
        assert paper["title"] in readme
        assert [one["family-names"] for one in paper["authors"] if one["family-names"] not in readme] == []


def test_the_architecture_names_every_package():
    page = text("ARCHITECTURE.md")
    packages = {path.parent.name for path in ROOT.glob("course*/*/__init__.py")}
    picture = page.partition("    tools ")[2].partition("`course.py` uses")[0]
    assert {name for name in packages if not re.search(rf"\b{name}\b", picture)} == set()


@pytest.mark.parametrize("package", ["depth_mcl", "spherical_stereo", "rendering", "beyond", "beyond/six_dof"])
def test_a_methods_init_lists_its_modules_as_the_architecture_says(package):
    folder = ROOT / "course_lib" / package
    listed = re.findall(r"\w+\*?", ast.get_docstring(ast.parse((folder / "__init__.py").read_text(encoding="utf-8"))))
    modules = {path.stem for path in folder.glob("*.py")} | {path.parent.name for path in folder.glob("*/__init__.py")}
    missing = {name for name in modules - {"__init__"} if not any(fnmatch(name, one) for one in listed)}
    assert missing == set(), f"course_lib/{package}/__init__.py lists its parts; add these"


def anchors(page):
    """The addresses of a page's headings, as GitHub makes them."""
    headings = (re.sub(r"\]\([^)]*\)", "", one) for one in re.findall(r"^#+ (.*)$", page, re.M))
    return {re.sub(r"[^\w -]", "", one).strip().lower().replace(" ", "-") for one in headings}


@pytest.mark.parametrize("name", PAGES)
def test_links_of_a_page_lead_to_files_and_headings_that_are_there(name):
    for target, anchor in re.findall(r"\]\((?!https?://|mailto:)([^)#]*)#?([^)]*)\)", text(name)):
        found = (ROOT / name).parent / target if target else ROOT / name
        assert found.exists(), target
        if anchor and found.suffix == ".md":
            assert anchor in anchors(found.read_text(encoding="utf-8")), f"{target}#{anchor}"


def options(program, module):
    """The options of a command, with those of its parts (`make_data room`)."""
    parsers = [CommandParser(prog=program)]
    module.add_arguments(parsers[0])
    for action in parsers[0]._actions:
        parsers += action.choices.values() if isinstance(action.choices, dict) else []
    return {
        "--debug",
        *(option for parser in parsers for action in parser._actions for option in action.option_strings),
    }


@pytest.mark.parametrize("name", PAGES)
def test_commands_of_a_page_are_commands_with_these_options(name):
    page = re.sub(r"^    git worktree add (?:.+\n)+", "", text(name), flags=re.M)  # what follows runs at another commit
    calls = re.findall(r"(?:`|python3 )course\.py ([a-z][^`#\n]*)", page)
    calls += re.findall(r"python -m courseware ([a-z][^`#\n]*)", page)
    asked = [(f"course.py {call}", find_command(call.split())) for call in calls]
    assert [call for call, found in asked if found is None] == []
    used = [(call, f"courseware.commands.{COMMANDS[found[0]][0]}", *found) for call, found in asked]
    for module, words in re.findall(r"python -m (tools\.(?!NAME|site)\w+)([^`#\n]*)", page):
        used.append((module, module, module, words.split()))
    for call, path, program, words in used:
        module = import_module(path)
        given = {word.partition("=")[0] for word in words if word.startswith("--") and word != "-->"}
        if given and not getattr(module, "PASSES_ARGUMENTS_ON", False):
            assert given <= options(program, module), call


LESSON_MINUTES = (
    r"[Ll]esson ([0-9F]\d) \((\d+) min",  # lesson 07 (50 min)
    r"^\| \[([0-9F]\d) .*\((\d+) min\)",  # a row of a table that begins with the lesson
    r"\[[Ll]esson ([0-9F]\d)\]\([^)]*\)[^.]*\.\s+It takes (\d+) minutes",
)


@pytest.mark.parametrize("name", PAGES)
def test_minutes_of_a_lesson_are_those_of_its_own_first_cell(name):
    found = [pair for pattern in LESSON_MINUTES for pair in re.findall(pattern, text(name), re.M)]
    assert [(number, int(told)) for number, told in found if read(numbered_paths()[number]).minutes != int(told)] == []


def test_one_list_names_the_systems_packages_and_the_dev_container_is_the_graders():
    grader = "courseware/classroom/Containerfile"
    for name in (".github/workflows/test.yml", grader):
        assert "binder/apt.txt" in text(name), name
        assert not set(text("binder/apt.txt").split()) & set(text(name).split()), name
    settings = json.loads(text(".devcontainer/devcontainer.json"))
    assert (ROOT / ".devcontainer" / settings["build"]["dockerfile"]).samefile(ROOT / grader)
    assert settings["workspaceFolder"] == re.search(r"^WORKDIR (.*)$", text(grader), re.MULTILINE)[1]


def test_the_workflow_calls_the_two_commands_on_three_systems_and_two_pythons():
    job = yaml.safe_load(text(".github/workflows/test.yml"))["jobs"]["test"]
    commands = [step["run"] for step in job["steps"] if step.get("run", "").startswith("python3")]
    assert commands == ["python3 course.py check", "python3 course.py test"]
    matrix = job["strategy"]["matrix"]
    assert {system.split("-")[0] for system in matrix["os"]} == {"ubuntu", "macos", "windows"}
    assert matrix["python"] == ["3.11", "3.13"]


VERBS = set(
    "Check Compare Compile Draw Fill Fit Free Go Join Keep Localize Match Pair Put Raise Read Return Sample Say "
    "Silence Start Take Turn Write Yield".split()
)


def test_docstrings_of_public_functions_of_course_lib_begin_with_a_verb_as_contributing_says():
    """A verb that is not among VERBS is added there."""
    found = {}
    for path in sorted((ROOT / "course_lib").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef) and not node.name.startswith("_") and ast.get_docstring(node):
                found[f"{path.relative_to(ROOT)}: {node.name}"] = ast.get_docstring(node).split()[0]
    assert {name: word for name, word in found.items() if word not in VERBS} == {}
