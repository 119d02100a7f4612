"""The pages beside README.md tell one version, name what there is, and ask for the same two commands."""

import json
import re
from pathlib import Path

import pytest
import yaml

from course_lib import __version__
from courseware.cli import find_command, version

ROOT = Path(__file__).parents[1]
PAGES = ("ARCHITECTURE.md", "CHANGELOG.md", "CODE_OF_CONDUCT.md", "CONTRIBUTING.md")
PAGES += (".github/ISSUE_TEMPLATE/bug.md", ".github/ISSUE_TEMPLATE/idea.md")


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


@pytest.mark.parametrize("name", PAGES)
def test_links_and_commands_of_a_page_are_right(name):
    for target in re.findall(r"\]\(([^)#]+)\)", text(name)):
        assert (ROOT / name).parent.joinpath(target).exists(), target
    calls = re.findall(r"python3 course\.py ([a-z][^`#\n]*)", text(name))
    assert [call for call in calls if find_command(call.split()) is None] == []


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
