"""`work/`: copies made once, never written over, told of changes; `git pull` over a tree that a student worked in."""

from __future__ import annotations

import datetime
import hashlib
import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import nbformat
import pytest

from course_lib.commands import lesson_versions, working_copies
from course_lib.commands.lesson_versions import lessons, text_version, whole_version
from course_lib.commands.working_copies import WorkingCopiesError, copy_of, make_copies
from course_lib.paths import REPOSITORY

DAY = datetime.date(2026, 11, 23)
LESSON_06 = "06_likelihood_and_weights.ipynb"
NOTHING_OF_IT = shutil.ignore_patterns(".ipynb_checkpoints", "yours", "__pycache__")


def git(folder, *words):
    author = ("-c", "user.name=Test", "-c", "user.email=test@example.org", "-c", "commit.gpgsign=false")
    done = subprocess.run(["git", *author, *words], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr + done.stdout
    return done.stdout


@pytest.fixture(scope="module")
def course(tmp_path_factory):
    """The lessons as they are here, and .gitignore, as the only commit of a repository of their own."""
    folder = tmp_path_factory.mktemp("course")
    shutil.copytree(REPOSITORY / "notebooks", folder / "notebooks", ignore=NOTHING_OF_IT)
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
    for name in ("00_start_here", "06_likelihood_and_weights", "projects/P1_the_whole_filter"):
        write_lesson(folder / "notebooks" / f"{name}.ipynb", f"the text of {name}")
    for name in ("GLOSSARY.md", "README.md", "pictures/00.png", "scenes/06_weights.html", "projects/README.md"):
        path = folder / "notebooks" / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(name)
    return folder


def write_lesson(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    nbformat.write(nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(text, id="cell")]), path)


def checksums(folder):
    """Of every file below a folder, hidden ones as well."""
    return {
        path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and not path.is_symlink()
    }


def begin(path):
    """A student types an answer and runs the cell; the notebook is saved as nbformat saves it."""
    notebook = nbformat.read(path, as_version=4)
    cell = next(cell for cell in notebook.cells if cell.cell_type == "code")
    cell.source += "\n# my answer: 42"
    cell.outputs = [nbformat.v4.new_output("stream", text="what I saw\n")]
    nbformat.write(notebook, path)


def test_every_file_that_lessons_lean_on_is_copied_as_it_is_but_for_the_solutions(clone):
    told = make_copies(clone, today=DAY)
    assert told == ["Your copies of the lessons are in work/, which git leaves alone."]
    tracked = git(clone, "ls-files", "notebooks").splitlines()
    wanted = {name.removeprefix("notebooks/") for name in tracked if "/solutions/" not in name}
    made = checksums(clone / "work")
    assert set(made) == wanted | {".copies.json"}
    of_the_course = checksums(clone / "notebooks")
    assert all(made[name] == of_the_course[name] for name in wanted)
    assert not [path for path in (clone / "work").rglob("*") if path.is_symlink()]
    assert git(clone, "status", "--porcelain") == ""


def test_every_link_picture_and_scene_of_a_copy_leads_to_a_file_in_work(clone):
    make_copies(clone, today=DAY)
    work, found = clone / "work", []
    for path in [*work.rglob("*.ipynb"), *work.rglob("*.md")]:
        texts = [path.read_text(encoding="utf-8")]
        if path.suffix == ".ipynb":
            cells = nbformat.read(path, as_version=4).cells
            texts = [cell.source for cell in cells if cell.cell_type == "markdown"]
            outputs = [output for cell in cells for output in cell.get("outputs", []) if "data" in output]
            texts += [output.data.get("text/html", "") for output in outputs]
        for target in re.findall(r"""\]\(([^)#\s]+)|(?:src|href)="([^"#]+)""", "\n".join(texts)):
            target = "".join(target)
            if not re.match(r"(https?|data|attachment):", target) and "solutions/" not in target:
                found.append((path.parent / target).resolve())
                assert found[-1].is_file(), (path.name, target)
                assert found[-1].is_relative_to(work.resolve()), (path.name, target)
    assert {"GLOSSARY.md", "06_weights.html", LESSON_06, "00.png"} <= {path.name for path in found}


def test_a_folder_of_that_name_with_other_things_in_it_serves(small):
    earlier = small / "work" / "earlier" / "06.ipynb"
    write_lesson(earlier, "what I did before")
    kept = earlier.read_bytes()
    assert make_copies(small, today=DAY) == ["Your copies of the lessons are in work/, which git leaves alone."]
    assert earlier.read_bytes() == kept


def test_a_second_start_writes_nothing_and_says_nothing(small):
    make_copies(small, today=DAY)
    before = {path: path.stat().st_mtime_ns for path in (small / "work").rglob("*")}
    assert make_copies(small, today=DAY + datetime.timedelta(1)) == []
    assert {path: path.stat().st_mtime_ns for path in (small / "work").rglob("*")} == before


def test_a_copy_is_never_written_over_and_a_missing_one_is_made(small):
    make_copies(small, today=DAY)
    mine = small / "work" / LESSON_06
    begin(mine)
    kept = mine.read_bytes()
    (small / "work" / "projects" / "P1_the_whole_filter.ipynb").unlink()
    write_lesson(small / "notebooks" / "07_new.ipynb", "a lesson that a pull brought")
    assert make_copies(small, today=DAY) == [
        "Lesson 07 is new in your folder: work/07_new.ipynb.",
        "Lesson P1 is new in your folder: work/projects/P1_the_whole_filter.ipynb.",
    ]
    assert mine.read_bytes() == kept
    assert (small / "work" / "07_new.ipynb").exists()


def test_a_fresh_one_takes_the_name_and_the_old_one_stays_beside_it(small):
    make_copies(small, today=DAY)
    mine, project = small / "work" / LESSON_06, small / "work" / "projects" / "P1_the_whole_filter.ipynb"
    kept = []
    for _ in range(3):
        begin(mine)
        kept.append(mine.read_bytes())
        told = make_copies(small, ["6", "p1"], today=DAY)
    stem = "06_likelihood_and_weights.before-2026-11-23"
    assert told[0] == f"Lesson 06 begins anew; your earlier copy is now work/{stem}-3.ipynb."
    assert [(small / "work" / f"{stem}{n}.ipynb").read_bytes() for n in ("", "-2", "-3")] == kept
    assert mine.read_bytes() == (small / "notebooks" / LESSON_06).read_bytes()
    assert len(list(project.parent.glob("P1*.ipynb"))) == 4


def test_a_number_without_a_lesson_changes_nothing(small):
    make_copies(small, today=DAY)
    before = checksums(small)
    with pytest.raises(ValueError, match="no lesson 07, X9; there are: 00, 06, P1"):
        make_copies(small, ["06", "x9", "7"], today=DAY)
    assert checksums(small) == before


def test_a_changed_lesson_is_told_once_each_and_the_unbegun_ones_together(small):
    make_copies(small, today=DAY)
    begin(small / "work" / LESSON_06)
    untouched = small / "work" / "00_start_here.ipynb"
    untouched.write_text(json.dumps(json.loads(untouched.read_text()), indent=4))  # saved anew, nothing changed
    for name in lessons(small).values():
        write_lesson(small / "notebooks" / name, "another text")
    expected = [
        "Lesson 06 has changed since you began your copy: `python3 course.py lab --fresh 06` starts the new one "
        "beside yours.",
        "Changed by the course before you began: 00, P1. `python3 course.py lab --fresh 00 P1` takes the new ones.",
    ]
    assert make_copies(small, today=DAY) == expected
    assert make_copies(small, today=DAY) == expected, "it is said until the student acts"
    make_copies(small, ["00", "06"], today=DAY)
    assert make_copies(small, today=DAY) == [
        "Changed by the course before you began: P1. `python3 course.py lab --fresh P1` takes the new ones."
    ]


def test_a_lesson_whose_outputs_alone_were_made_anew_has_not_changed(small):
    make_copies(small, today=DAY)
    path = small / "notebooks" / LESSON_06
    notebook = nbformat.read(path, as_version=4)
    notebook.cells[0].outputs = [nbformat.v4.new_output("stream", text="drawn anew")]
    nbformat.write(notebook, path)
    assert make_copies(small, today=DAY) == []


def test_what_lessons_lean_on_follows_the_course_until_the_student_changes_it(small):
    make_copies(small, today=DAY)
    (small / "work" / "GLOSSARY.md").write_text("with my notes")
    for name in ("GLOSSARY.md", "scenes/06_weights.html"):
        (small / "notebooks" / name).write_text("the course's next")
    (small / "notebooks" / "scenes" / "06_new.html").write_text("a new one")
    told = make_copies(small, today=DAY)
    assert told == ["work/GLOSSARY.md is changed by you and stays; the course's new one: notebooks/GLOSSARY.md."]
    assert (small / "work" / "GLOSSARY.md").read_text() == "with my notes"
    assert (small / "work" / "scenes" / "06_weights.html").read_text() == "the course's next"
    assert (small / "work" / "scenes" / "06_new.html").read_text() == "a new one"


@pytest.mark.parametrize("content", ["", "[1]", '{"a": 3}', '{"a": {"whole": 3}}', '{"half', "\udcff"])
def test_a_damaged_memory_is_set_aside_and_no_copy_is_touched(small, content):
    make_copies(small, today=DAY)
    begin(small / "work" / LESSON_06)
    (small / "work" / ".copies.json").write_text(content, errors="surrogateescape")
    before = checksums(small / "work")
    (told,) = make_copies(small, today=DAY)
    assert "could not be read; it is kept as work/.copies.before-2026-11-23.json" in told
    after = checksums(small / "work")
    assert after.pop(".copies.before-2026-11-23.json") == before.pop(".copies.json")
    after.pop(".copies.json")
    assert after == before
    assert make_copies(small, today=DAY) == []


def test_a_full_disk_is_named_and_leaves_things_as_they_were(small, monkeypatch):
    def full(self, content, write=Path.write_bytes):
        if self.name == "2":
            raise OSError(28, "No space left on device")
        return write(self, content)

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(WorkingCopiesError, match=r"No space left on device.*nothing of yours was changed"):
        make_copies(small, today=DAY)
    assert not (small / "work").exists()
    monkeypatch.undo()
    make_copies(small, today=DAY)
    begin(small / "work" / LESSON_06)
    before = checksums(small)
    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(WorkingCopiesError, match="Make room"):
        make_copies(small, ["00", "06", "P1"], today=DAY)
    assert checksums(small) == before


def killed_after(puts, monkeypatch):
    """A run that ends after so many files were put in place, as kill -9 ends it: nothing clears up."""
    done = []

    def put(self, path, name, really=working_copies._Copies._put):
        if len(done) == puts:
            os._exit(9)
        done.append(name)
        really(self, path, name)

    monkeypatch.setattr(working_copies._Copies, "_put", put)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="a process of its own to be killed")
@pytest.mark.parametrize("puts", range(6))
def test_a_run_that_is_killed_between_two_files_is_gone_on_with(small, monkeypatch, puts):
    """What follows the course goes on following it; what the student changed is never taken for the course's."""
    make_copies(small, today=DAY)
    begin(small / "work" / LESSON_06)
    mine = (small / "work" / LESSON_06).read_bytes()
    (small / "work" / "GLOSSARY.md").write_text("with my notes")
    for name in ("scenes/06_weights.html", "GLOSSARY.md"):
        (small / "notebooks" / name).write_text("the course's next")
    write_lesson(small / "notebooks" / LESSON_06, "another text")
    child = os.fork()
    if not child:
        killed_after(puts, monkeypatch)
        make_copies(small, ["00"], today=DAY)
        os._exit(0)
    os.waitpid(child, 0)
    (small / "notebooks" / "scenes" / "06_weights.html").write_text("the course's second next")
    told = make_copies(small, today=DAY)
    assert (small / "work" / "scenes" / "06_weights.html").read_text() == "the course's second next"
    assert (small / "work" / "GLOSSARY.md").read_text() == "with my notes"
    assert (small / "work" / LESSON_06).read_bytes() == mine
    assert any(sentence.startswith("work/GLOSSARY.md is changed by you") for sentence in told)
    assert any(sentence.startswith("Lesson 06 has changed") for sentence in told)
    assert not any("scenes" in sentence for sentence in told)
    assert not list((small / "work").rglob("*.course-unfinished-*"))
    assert "earlier" not in (small / "work" / ".copies.json").read_text()
    assert make_copies(small, today=DAY) == told


def test_a_folder_that_may_not_be_written_is_named(small, monkeypatch):
    def refused(self, **_):
        raise PermissionError(13, "Permission denied", str(self))

    monkeypatch.setattr(Path, "mkdir", refused)  # not by the file's mode, which means nothing to root
    with pytest.raises(WorkingCopiesError, match=r"cannot be written to .*work .Permission denied"):
        make_copies(small, today=DAY)
    monkeypatch.undo()
    (small / "work").write_text("a file of this name")
    with pytest.raises(WorkingCopiesError, match=r"not a folder.*move it away"):
        make_copies(small, today=DAY)


def test_a_file_system_without_hard_links_serves_as_well(small, monkeypatch):
    def no_links(source, target):
        raise OSError(1, "Operation not permitted")

    monkeypatch.setattr(os, "link", no_links)
    make_copies(small, today=DAY)
    begin(small / "work" / LESSON_06)
    kept = (small / "work" / LESSON_06).read_bytes()
    make_copies(small, ["06"], today=DAY)
    assert (small / "work" / "06_likelihood_and_weights.before-2026-11-23.ipynb").read_bytes() == kept
    assert (small / "work" / LESSON_06).read_bytes() == (small / "notebooks" / LESSON_06).read_bytes()


def test_a_copy_that_another_lab_made_meanwhile_stays(small, monkeypatch):
    copies = working_copies._Copies(small, DAY)
    copies.decide(set())
    theirs = small / "work" / LESSON_06
    write_lesson(theirs, "theirs")
    kept = theirs.read_bytes()
    copies.write()
    assert theirs.read_bytes() == kept


@pytest.mark.parametrize(
    ("notebook", "opened"),
    [
        ("06", f"work/{LESSON_06}"),
        ("6", f"work/{LESSON_06}"),
        ("P1", "work/projects/P1_the_whole_filter.ipynb"),
        (f"notebooks/{LESSON_06}", f"work/{LESSON_06}"),
        (f"./work/../notebooks/{LESSON_06}", f"work/{LESSON_06}"),
        ("notebooks/projects/P1_the_whole_filter.ipynb", "work/projects/P1_the_whole_filter.ipynb"),
        ("{root}/notebooks/00_start_here.ipynb", "work/00_start_here.ipynb"),
        ("notebooks/mine.ipynb", "notebooks/mine.ipynb"),
    ],
)
def test_what_opens_for_a_lesson_is_its_copy(small, notebook, opened):
    write_lesson(small / "notebooks" / "mine.ipynb", "not a lesson")
    assert copy_of(notebook.format(root=small), small) == opened


@pytest.mark.parametrize(
    ("notebook", "said"),
    [
        ("/etc/hosts", "lies outside"),
        ("../x.ipynb", "lies outside"),
        ("notebooks/x.ipynb", "there is no notebook notebooks/x.ipynb"),
        ("notebooks", "there is no notebook"),
        ("21", "there is no notebook"),
    ],
)
def test_what_cannot_be_opened_is_told(small, notebook, said):
    with pytest.raises(ValueError, match=said):
        copy_of(notebook, small)


def test_versions_do_not_depend_on_the_layout_of_the_file():
    content = (REPOSITORY / "notebooks" / LESSON_06).read_bytes()
    laid_out = nbformat.writes(nbformat.reads(content.decode(), as_version=4)).encode()
    other = json.dumps(nbformat.reads(content.decode(), as_version=4)).encode()  # text in one piece, not in lines
    assert len({content, laid_out, other}) > 1
    assert text_version(content) == text_version(laid_out) == text_version(other)
    assert whole_version(content) == whole_version(laid_out) == whole_version(other)


def work_through(clone):
    """A student works in every lesson: types, runs, records, makes scenes, exports, annotates."""
    work = clone / "work"
    for number, name in lessons(clone).items():
        begin(work / name)
        (work / "record").mkdir(exist_ok=True)
        (work / "record" / f"{number}.json").write_text(json.dumps({"typed": number}))
        (work / name).with_suffix(".html").write_text(f"exported {number}")
        (work / name).parent.joinpath(".ipynb_checkpoints").mkdir(exist_ok=True)
        shutil.copy(work / name, (work / name).parent / ".ipynb_checkpoints")
    (work / "scenes" / "yours").mkdir()
    (work / "scenes" / "yours" / "06_weights.html").write_text("my scene")
    (work / "GLOSSARY.md").write_text((work / "GLOSSARY.md").read_text() + "\nmy note\n")
    (work / "Untitled.ipynb").write_text("{}")


def change_every_lesson(course):
    for path in [*(course / "notebooks").rglob("*.ipynb")]:
        notebook = nbformat.read(path, as_version=4)
        notebook.cells[0].source += "\n\nA sentence more."
        notebook.cells.append(nbformat.v4.new_code_cell("print('new')", id="new-cell"))
        nbformat.write(notebook, path)
    for path in [*(course / "notebooks").glob("*.md"), *(course / "notebooks" / "scenes").glob("*.html")]:
        path.write_text(path.read_text(encoding="utf-8") + "\n<!-- changed -->\n", encoding="utf-8")
    (course / "notebooks" / "21_new.ipynb").write_bytes((course / "notebooks" / LESSON_06).read_bytes())
    git(course, "add", ".")
    git(course, "commit", "--quiet", "-m", "every lesson changes")


def test_git_pull_over_a_tree_in_which_a_student_has_worked_in_every_lesson(course, tmp_path):
    upstream, clone = tmp_path / "upstream", tmp_path / "clone"
    git(tmp_path, "clone", "--quiet", "--local", str(course), "upstream")
    git(tmp_path, "clone", "--quiet", "--local", str(upstream), "clone")
    make_copies(clone, today=DAY)
    work_through(clone)
    assert git(clone, "status", "--porcelain") == ""
    of_the_student = checksums(clone / "work")
    change_every_lesson(upstream)

    git(clone, "pull", "--quiet", "--ff-only")

    assert git(clone, "status", "--porcelain") == ""
    assert git(clone, "rev-parse", "HEAD") == git(upstream, "rev-parse", "HEAD")
    assert checksums(clone / "work") == of_the_student
    told = make_copies(clone, today=DAY)
    numbers = [number for number in lessons(clone) if number != "21"]
    assert [line[:40] for line in told if "since you began" in line] == [
        f"Lesson {number} has changed since you began your copy"[:40] for number in numbers
    ]
    assert len(told) == len(numbers) + 2  # lesson 21 is new, and the glossary holds notes
    after = checksums(clone / "work")
    follows = {name for name in after if name.startswith("scenes/0") or name.startswith("scenes/1")}
    changed = {name for name in of_the_student if after[name] != of_the_student[name]}
    assert changed == follows | {"README.md", ".copies.json"}
    assert set(after) == set(of_the_student) | {"21_new.ipynb"}

    make_copies(clone, lessons(clone), today=DAY)
    fresh = set(checksums(clone / "work").values())
    assert {of_the_student[name] for name in of_the_student if name.endswith(".ipynb")} <= fresh
    assert git(clone, "status", "--porcelain") == ""


def test_who_worked_in_the_courses_own_notebook_is_told_and_the_copy_holds_it(clone):
    begin(clone / "notebooks" / LESSON_06)
    told = make_copies(clone, today=DAY)
    assert f"Changed in place, where git pull may stop at it: notebooks/{LESSON_06}. " in told[1]
    assert f"Your new copy holds that; then `git checkout HEAD -- notebooks/{LESSON_06}`" in told[1]
    assert "# my answer: 42" in (clone / "work" / LESSON_06).read_text()
    assert "Copy what you typed there into work/" in make_copies(clone, today=DAY)[0]
    git(clone, "checkout", "HEAD", "--", f"notebooks/{LESSON_06}")
    assert make_copies(clone, today=DAY) == [], "the copy was begun from this version"
    write_lesson(clone / "notebooks" / LESSON_06, "another")
    git(clone, "commit", "--quiet", "--all", "-m", "another")
    assert "since you began your copy" in make_copies(clone, today=DAY)[0], "what was typed is not called untouched"


def test_what_the_readme_tells_those_who_worked_in_notebooks_before_there_was_work(course, tmp_path):
    upstream, clone = tmp_path / "upstream", tmp_path / "clone"
    git(tmp_path, "clone", "--quiet", "--local", str(course), "upstream")
    git(tmp_path, "clone", "--quiet", "--local", str(upstream), "clone")
    for name in lessons(clone).values():
        begin(clone / "notebooks" / name)
    change_every_lesson(upstream)
    of_the_student = checksums(clone / "notebooks")
    refused = subprocess.run(["git", "pull", "--ff-only"], cwd=clone, capture_output=True, text=True)
    assert refused.returncode != 0
    told = (REPOSITORY / "notebooks" / "README.md").read_text(encoding="utf-8").partition("## Your copies")[2]
    for words in ("mkdir -p work", "cp -r notebooks work/earlier", "git checkout HEAD -- notebooks"):
        assert f"`{words}`" in told
        subprocess.run(words.split(), cwd=clone, check=True, capture_output=True)
    git(clone, "pull", "--quiet", "--ff-only")
    assert checksums(clone / "work" / "earlier") == of_the_student
    make_copies(clone, today=DAY)
    assert checksums(clone / "work" / "earlier") == of_the_student
    assert git(clone, "status", "--porcelain") == ""


def test_a_lesson_with_a_merges_marks_is_told_and_left_out(clone):
    (clone / "notebooks" / LESSON_06).write_text("<<<<<<< HEAD\n{}\n=======\n")
    told = make_copies(clone, today=DAY)
    assert any(f"notebooks/{LESSON_06} is no notebook" in line for line in told)
    assert not (clone / "work" / LESSON_06).exists()
    assert (clone / "work" / "07_estimate_and_resample.ipynb").exists()


def test_without_git_nothing_is_changed_in_place(small, monkeypatch):
    monkeypatch.setenv("PATH", "")
    assert lesson_versions.changed_in_place(small) == {}
