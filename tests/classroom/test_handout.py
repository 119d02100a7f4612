"""A class's folder: made at once or not at all, only in a place of its own, the same for the same seed."""

import json
import re
import subprocess
import sys
import zipfile

import pytest

from courseware import PACKED
from courseware.classroom import handout
from courseware.classroom.assignment_cells import read_assignments
from courseware.classroom.handout import MARKER, HandoutError, canary_of, make_handout
from courseware.classroom.leaks import LeakError, find_leaks, solutions, teachers_words
from courseware.lessons.kit.exercises import find_exercise

SEED = 31_415_926_535
TWO = read_assignments(["06", "P2"])


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A whole handout of a lesson and a project."""
    return make_handout(tmp_path_factory.mktemp("class") / "handout", TWO, SEED, solved=True, package=True)


def contents(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def test_every_folder_says_what_it_is(made):
    folders = [made, made / "student", made / "teacher", made / "teacher" / "nbgrader"]
    assert [folder.name for folder in folders if not (folder / "README.md").is_file()] == []
    assert {path.name for path in made.iterdir()} == {"student", "teacher", "course.zip", "README.md", MARKER}
    parts = {"solutions", "rubric", "grading", "nbgrader", "solved", "README.md"}
    assert {path.name for path in (made / "teacher").iterdir()} == parts
    assert (made / "teacher").stat().st_mode & 0o077 == 0, "closed to others"
    assert (made / "student").stat().st_mode & 0o055 == 0o055


def test_everything_of_the_teachers_holds_the_canary_and_nothing_of_the_students_does(made):
    canary = canary_of(SEED)
    assert find_leaks(made / "student", teachers_words(SEED, canary)) == []
    holding = [leak.split(" holds ")[0] for leak in find_leaks(made / "teacher", {"the canary": canary})]
    own = {"solutions/06.py", "solutions/P2.py", "rubric/06.md", "rubric/P2.md", "grading/seed.json"}
    own |= {"nbgrader/source/06/06.ipynb", "nbgrader/source/P2/P2.ipynb", "solved/06_likelihood_and_weights.ipynb"}
    assert own <= set(holding)
    assert find_leaks(made, {"the seed": str(SEED)}) == ["teacher/grading/seed.json holds the seed"]
    assert "the secret seed" in teachers_words(SEED, canary)
    assert "the secret seed" not in teachers_words(7, canary), "a small number is everywhere"


def test_the_same_seed_makes_the_same_folder_and_another_one_other_tests(made, tmp_path):
    again, other = (contents(make_handout(tmp_path / str(seed), TWO, seed, True, True)) for seed in (SEED, SEED + 1))
    assert again == contents(made)
    differing = {name for name in again if again[name] != other[name]}
    assert {"teacher/grading/seed.json", "teacher/rubric/06.md"} <= differing
    assert all(name.startswith("teacher/") for name in differing)


def test_the_model_answers_run(made, capsys):
    names: dict = {}
    exec((made / "teacher" / "solutions" / "06.py").read_text(encoding="utf-8"), names)
    assert {"raw_score_solution", "importance_mean_solution"} <= set(names)


def test_the_rubric_has_every_exercise_with_its_points_and_mistakes(made):
    page = (made / "teacher" / "rubric" / "06.md").read_text(encoding="utf-8")
    assert page.startswith("# Rubric · 06 · Likelihood and weights")
    assert "**16 points.**" in page
    assert re.findall(r"^## (\S+ ).* · (.*) points$", page, re.M) == [
        ("06.1 ", "warm-up, 2"), ("06.2 ", "core, 4"), ("06.3 ", "core, 4"), ("06.4 ", "challenge, 6"),
    ]  # fmt: skip
    assert f"* {find_exercise('06.1').known[0].hint}\n" in page
    assert page.count("**To talk about.** ") == 4
    project = (made / "teacher" / "rubric" / "P2.md").read_text(encoding="utf-8")
    assert "## P2, the score · 12 points" in project
    assert "better than the paper's method (0.309 m on the hidden seeds)" in project


@pytest.fixture(scope="module")
def course(made, tmp_path_factory):
    """The course for students, unpacked."""
    folder = tmp_path_factory.mktemp("unpacked")
    with zipfile.ZipFile(made / "course.zip") as archive:
        archive.extractall(folder)
    return folder / "course"


def test_the_package_for_students_holds_nothing_of_the_teachers_and_no_solution_that_can_be_read(course):
    names = {str(path.relative_to(course)) for path in course.rglob("*")}
    assert {"course.py", f"courseware/{PACKED}", "notebooks/06_likelihood_and_weights.ipynb"} <= names
    gone = {"tests", "tools", ".git", ".ci", "courseware/classroom", "notebooks/projects/solutions", "TEACHING.md"}
    assert not (gone | {"courseware/answers"}) & names
    assert find_leaks(course / "courseware", solutions(read_assignments())) == []
    assert not list(course.rglob("rooms_hidden*"))


ONLY_THIS_COPY = """
import sys
sys.path[:0] = "."
sys.meta_path[:] = [one for one in sys.meta_path if not getattr(one, "__module__", "").startswith("__editable__")]
"""
CHECKED = """
from courseware.lessons import check
from courseware.lessons.kit.projects import find_project, project_names, stored_rivals
def raw_score(hidden, alpha):
    return (1 - hidden) * alpha / (alpha + 0.02) + hidden * alpha / (alpha + 2)
check("06.1", raw_score)
check("06.1", lambda hidden, alpha: raw_score(hidden, alpha) - hidden * alpha / (alpha + 2))
for project in map(find_project, project_names()):
    print(project.name, *stored_rivals(project), len(project.prepare(project.seeds[0]).truth))
"""


def in_the_copy(course, code: str) -> subprocess.CompletedProcess:
    """Run code with the packages of the unpacked course alone, not those that are installed."""
    command = [sys.executable, "-c", ONLY_THIS_COPY + code]
    return subprocess.run(command, cwd=course, capture_output=True, text=True, check=False)


def test_checks_and_projects_of_the_package_work_and_know_the_mistakes(course):
    done = in_the_copy(course, CHECKED)
    hint = "You leave the hidden pixels out. They were measured, so each of them counts its small term."
    projects = ["P1 paper ours 2", "P2 paper ours 8", "P3 paper other ours 24", "P4 none paper ours 2"]
    assert done.stdout.splitlines() == ["06.1: right.", f"06.1: not yet. {hint}", *projects], done.stderr


def test_the_package_says_that_it_does_not_grade(course):
    helped, graded = (in_the_copy(course, f"from courseware.cli import main; sys.exit(main({words}))")
                      for words in (["--help"], ["grade", "."]))  # fmt: skip
    told = "handout and grade do not work in this copy of the course: it was made for students, without the grader"
    assert (helped.returncode, graded.returncode) == (0, 2)
    assert told in helped.stdout
    assert told in graded.stderr


def test_a_place_that_holds_something_else_is_refused_and_left_alone(tmp_path):
    other = tmp_path / "mine"
    other.mkdir()
    (other / "thesis.txt").write_text("years")
    for place, why in ((other, "no handout of ours"), (other / "thesis.txt", "no folder")):
        with pytest.raises(HandoutError, match=why):
            make_handout(place, TWO, SEED)
    (other / MARKER).write_text('{"made_by": "somebody else"}')
    with pytest.raises(HandoutError, match="no handout of ours"):
        make_handout(other, TWO, SEED)
    assert (other / "thesis.txt").read_text() == "years"
    assert [path.name for path in tmp_path.iterdir()] == ["mine"]


def test_an_empty_folder_is_taken_and_a_handout_of_ours_is_replaced_as_a_whole(tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    make_handout(out, TWO[:1], SEED)
    (out / "student" / "stray.txt").write_text("left over")
    make_handout(out, TWO[1:], SEED)
    assert not (out / "student" / "stray.txt").exists()
    assert json.loads((out / MARKER).read_text())["lessons"] == ["P2"]
    assert not list((out / "student").glob("06*"))
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_submissions_and_grades_are_never_replaced(tmp_path):
    out = make_handout(tmp_path / "out", TWO[:1], SEED)
    (out / "teacher" / "nbgrader" / "gradebook.db").write_text("grades")
    with pytest.raises(HandoutError, match=r"gradebook\.db, which would be lost"):
        make_handout(out, TWO[:1], SEED)
    assert (out / "teacher" / "nbgrader" / "gradebook.db").read_text() == "grades"


def test_a_leak_stops_it_and_the_old_folder_stays(tmp_path, monkeypatch):
    out = make_handout(tmp_path / "out", TWO[:1], SEED)
    before = contents(out)
    monkeypatch.setitem(handout.READMES, "student", "teacher.md")
    with pytest.raises(LeakError, match=r"HANDOUT\.md holds the canary"):
        make_handout(out, TWO, SEED)
    assert contents(out) == before
    assert [path.name for path in tmp_path.iterdir()] == ["out"]
