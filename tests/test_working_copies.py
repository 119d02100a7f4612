"""`work/`: copies that follow the course until a student changes them; `git pull` where a student has worked."""

import datetime
import json
import shutil
import subprocess

import nbformat
import pytest

from courseware.paths import REPOSITORY
from courseware.working_copies import copy_of, lessons, make_copies

DAY = datetime.date(2026, 11, 23)
LESSON_06 = "06_likelihood_and_weights.ipynb"
BEGUN = "Your copies of the lessons are in work/, which git leaves alone."


def git(folder, *words):
    author = ("-c", "user.name=Test", "-c", "user.email=test@example.org", "-c", "commit.gpgsign=false")
    done = subprocess.run(["git", *author, *words], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr + done.stdout
    return done.stdout


@pytest.fixture(scope="module")
def course(tmp_path_factory):
    """The lessons as they are here, and .gitignore, as the only commit of a repository of their own."""
    folder = tmp_path_factory.mktemp("course")
    others = shutil.ignore_patterns(".ipynb_checkpoints", "yours", "__pycache__")
    shutil.copytree(REPOSITORY / "notebooks", folder / "notebooks", ignore=others)
    shutil.copy(REPOSITORY / ".gitignore", folder)
    git(folder, "init", "--quiet", "--initial-branch=main")
    git(folder, "add", ".")
    git(folder, "commit", "--quiet", "-m", "the course")
    return folder


@pytest.fixture
def clone(course, tmp_path):
    git(tmp_path, "clone", "--quiet", "--local", str(course), "clone")
    return tmp_path / "clone"


@pytest.fixture
def small(tmp_path):
    """Three notebooks of one cell, without git, so that a test takes no time."""
    folder = tmp_path / "small"
    for name in ("00_start_here.ipynb", LESSON_06, "projects/P1_the_whole_filter.ipynb"):
        write_lesson(folder / "notebooks" / name, f"the text of {name}")
    for name in ("GLOSSARY.md", "scenes/06_weights.html"):
        path = folder / "notebooks" / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(name)
    return folder


def test_a_fresh_copy_shows_the_idea_and_not_what_was_measured(clone):
    make_copies(clone)
    mine = nbformat.read(clone / "work" / LESSON_06, as_version=4)
    ours = nbformat.read(clone / "notebooks" / LESSON_06, as_version=4)
    section, kept = "", set()
    for copied, cell in zip(mine.cells, ours.cells, strict=True):
        assert copied.source == cell.source
        section = cell.source.partition("\n")[0] if cell.source.startswith("## ") else section
        if cell.get("outputs"):
            assert (copied.outputs == []) == (section in ("## Measure", "## Break it", "## Recap")), section
            kept |= {section} if copied.outputs else set()
    assert {"## The idea", "## Exercises"} <= kept


def write_lesson(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    nbformat.write(nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(text, id="cell")]), path)


def contents(folder):
    """Every file below a folder, hidden ones as well."""
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def begin(path):
    """A student types an answer; the notebook is saved as nbformat saves it."""
    notebook = nbformat.read(path, as_version=4)
    notebook.cells[-1].source += "\n# my answer: 42"
    nbformat.write(notebook, path)


def test_every_file_that_lessons_lean_on_is_copied_as_it_is_but_for_the_solutions(clone):
    assert make_copies(clone) == [BEGUN]
    tracked = git(clone, "ls-files", "notebooks").splitlines()
    wanted = {name.removeprefix("notebooks/") for name in tracked if "/solutions/" not in name}
    made, of_the_course = contents(clone / "work"), contents(clone / "notebooks")
    assert set(made) == wanted | {".copies.json"}
    assert all(made[name] == of_the_course[name] for name in wanted if not name.endswith(".ipynb"))
    assert git(clone, "status", "--porcelain") == ""
    assert make_copies(clone) == []


def test_a_changed_copy_is_never_written_over_and_an_unchanged_one_follows_the_course(small):
    make_copies(small)
    mine = small / "work" / LESSON_06
    begin(mine)
    notebook = nbformat.read(small / "notebooks" / LESSON_06, as_version=4)
    notebook.cells[0].outputs = [nbformat.v4.new_output("stream", text="drawn anew")]
    (small / "notebooks" / LESSON_06).write_text(json.dumps(notebook))  # and its text in one piece, not in lines
    assert make_copies(small) == [], "outputs alone are no change"
    (small / "work" / "GLOSSARY.md").write_text("with my notes")
    kept = mine.read_bytes()
    for name in [*lessons(small).values(), "07_new.ipynb"]:
        write_lesson(small / "notebooks" / name, "another text")
    for name in ("GLOSSARY.md", "scenes/06_weights.html", "scenes/06_new.html"):
        (small / "notebooks" / name).write_text("the course's next")
    changed, new, glossary = make_copies(small)
    assert changed.startswith("Lesson 06 has changed since you began your copy: `python3 course.py lab --fresh 06` ")
    assert new == "Lesson 07 is new in your folder: work/07_new.ipynb."
    assert glossary == "work/GLOSSARY.md is changed by you and stays; the course's new one: notebooks/GLOSSARY.md."
    assert make_copies(small) == [changed, glossary], "it is said until the student acts"
    assert mine.read_bytes() == kept
    assert (small / "work" / "GLOSSARY.md").read_text() == "with my notes"
    for name in ("00_start_here.ipynb", "07_new.ipynb", "scenes/06_weights.html", "scenes/06_new.html"):
        assert (small / "work" / name).read_bytes() == (small / "notebooks" / name).read_bytes()


def test_a_fresh_one_takes_the_name_and_the_old_one_stays_beside_it(small):
    make_copies(small)
    mine, project = small / "work" / LESSON_06, small / "work" / "projects" / "P1_the_whole_filter.ipynb"
    kept = []
    for _ in range(3):
        begin(mine)
        kept.append(mine.read_bytes())
        told = make_copies(small, ["6", "p1"], today=DAY)
    stem = "06_likelihood_and_weights.before-2026-11-23"
    assert told[0] == f"Lesson 06 starts again; your earlier copy is now work/{stem}-3.ipynb."
    assert [(small / "work" / f"{stem}{n}.ipynb").read_bytes() for n in ("", "-2", "-3")] == kept
    assert mine.read_bytes() == (small / "notebooks" / LESSON_06).read_bytes()
    assert len(list(project.parent.glob("P1*.ipynb"))) == 4


@pytest.mark.parametrize(
    ("notebook", "opened"),
    [
        ("06", f"work/{LESSON_06}"),
        ("P1", "work/projects/P1_the_whole_filter.ipynb"),
        ("{root}/notebooks/00_start_here.ipynb", "work/00_start_here.ipynb"),
        ("notebooks/mine.ipynb", "notebooks/mine.ipynb"),
    ],
)
def test_what_opens_for_a_lesson_is_its_copy_and_what_cannot_be_is_told(small, notebook, opened):
    write_lesson(small / "notebooks" / "mine.ipynb", "not a lesson")
    assert copy_of(notebook.format(root=small), small) == opened
    before = contents(small)
    for wrong, said in (("../x.ipynb", "lies outside"), ("notebooks/x.ipynb", "there is no notebook notebooks/x")):
        with pytest.raises(ValueError, match=said):
            copy_of(wrong, small)
    with pytest.raises(ValueError, match="no lesson 07, X9; there are: 00, 06, P1"):
        make_copies(small, ["06", "x9", "7"])
    assert contents(small) == before


def test_who_worked_in_the_courses_own_notebook_is_told_and_loses_nothing(clone):
    begin(clone / "notebooks" / LESSON_06)
    told = make_copies(clone)
    assert f"Changed in place, where git pull may stop at it: notebooks/{LESSON_06}. " in told[1]
    mine = clone / "work" / LESSON_06
    assert "# my answer: 42" in mine.read_text()
    git(clone, "checkout", "HEAD", "--", f"notebooks/{LESSON_06}")
    make_copies(clone)
    assert "# my answer: 42" in mine.read_text(), "what was typed does not count as the course's"
