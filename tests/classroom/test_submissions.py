"""Whose a file is, in the folders that LMSs make; the class list; what is not read."""

import unicodedata
from pathlib import Path

import pytest

from courseware.classroom.submissions import Roster, SubmissionError, collect, read_roster, whose

LESSONS = {"06": "06_likelihood_and_weights", "20": "20_your_own_data", "P1": "P1_the_whole_filter"}


@pytest.mark.parametrize(("path", "student", "guess"), [
    ("alice/06_likelihood_and_weights.ipynb", "alice", "06"),
    ("alice/homework.ipynb", "alice", ""),
    ("alice/06/06.ipynb", "alice", "06"),
    ("alice_06.ipynb", "alice", "06"),
    ("alice_06_likelihood_and_weights (1).ipynb", "alice", "06"),
    ("alice_P1_v2.py", "alice", "P1"),
    ("nina_06_2026-11-20.ipynb", "nina", "06"),
    ("nina.ipynb", "nina", ""),
    ("Alice Doe_12345_assignsubmission_file_/homework.ipynb", "Alice Doe", ""),
    ("Alice Doe_12345_assignsubmission_file_/06_likelihood_and_weights.ipynb", "Alice Doe", "06"),
    ("doealice_12345_67890_homework.ipynb", "doealice", ""),
    ("doealice_LATE_12345_67890_06_likelihood_and_weights-1.ipynb", "doealice", "06"),
    ("bob-jones/week 3/06.ipynb", "bob-jones", "06"),
    ("eve/bob_1_1_06.py", "eve", "06"),
    ("eve/bob_777_assignsubmission_file_.py", "eve", ""),
    ("06_likelihood_and_weights_carol.ipynb", "carol", "06"),
])  # fmt: skip
def test_student_and_lesson_are_told_by_place_and_name(path, student, guess):
    assert whose(Path(path), LESSONS, Roster()) == (student, guess)


ROSTERS = {
    "Moodle": "First name,Last name,ID number,Email address\nAlice,Doe,77,alice@uni.edu\nJosé,Núñez,78,jose@uni.edu\n",
    "Canvas": '"Student","ID","SIS Login ID"\n"Doe, Alice",12345,adoe\n"Núñez, José",12346,jnunez\n',
    "semicolons": "name;username\nAlice Doe;adoe\nJosé Núñez;jnunez\n",
}


@pytest.mark.parametrize(("roster", "names"), [
    ("Moodle", ["Alice Doe_5_assignsubmission_file_/h.ipynb", "alice/06.ipynb", "doe_alice_06.ipynb"]),
    ("Canvas", ["doealice_12345_9_h.ipynb", "doealice_LATE_12345_9_h.ipynb", "adoe/06.ipynb", "Alice Doe/x.py"]),
    ("semicolons", ["adoe_06.ipynb", "alice doe/06.ipynb", "DOE Alice/06.ipynb"]),
])  # fmt: skip
def test_the_class_list_knows_a_student_under_every_name(tmp_path, roster, names):
    (tmp_path / "class.csv").write_text("\ufeff" + ROSTERS[roster], encoding="utf-8")
    found = read_roster(tmp_path / "class.csv")
    assert len(found.rows) == 2
    first = next(iter(found.rows))
    assert [whose(Path(name), LESSONS, found)[0] for name in names] == [first] * len(names)


def test_composed_and_decomposed_letters_are_one_name(tmp_path):
    (tmp_path / "class.csv").write_text(ROSTERS["semicolons"], encoding="utf-8")
    found = read_roster(tmp_path / "class.csv")
    for form in ("NFC", "NFD"):
        path = Path(unicodedata.normalize(form, "José Núñez") + "/06.ipynb")
        assert whose(path, LESSONS, found)[0] == "José Núñez"
        assert whose(path, LESSONS, Roster())[0] == "José Núñez"


@pytest.mark.parametrize("text", ["", "grade\n3\n", "\xff"])
def test_a_class_list_without_names_is_refused(tmp_path, text):
    (tmp_path / "class.csv").write_text(text, encoding="latin-1")
    with pytest.raises(SubmissionError, match=r"CSV file|no column"):
        read_roster(tmp_path / "class.csv")


def test_what_is_not_read_is_named_and_links_are_not_followed(tmp_path):
    (tmp_path / "alice").mkdir()
    for name in ("06.ipynb", "notes.txt", "all.zip", ".hidden.ipynb", "._06.ipynb", ".DS_Store"):
        (tmp_path / "alice" / name).write_text("{}")
    (tmp_path / "alice" / "07.ipynb").symlink_to("/etc/passwd")
    (tmp_path / "bob").symlink_to("/etc")
    for name in ("alice/__mine", "alice/__MACOSX", "alice/.git", ".carol"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "06.ipynb").write_text("{}")
    found, not_read = collect(tmp_path, LESSONS)
    assert [one.path.name for one in found] == ["06.ipynb"]
    why = {one.name: one.why for one in not_read}
    said = {
        "alice/notes.txt": "neither", "alice/all.zip": "unpack", "alice/07.ipynb": "link", "bob": "link",
        "alice/.hidden.ipynb": "hidden", "alice/__mine": "hidden", ".carol": "hidden",
    }  # fmt: skip
    assert set(why) == set(said)
    assert all(word in why[name] for name, word in said.items())
    for folder in (tmp_path / "none", tmp_path / "alice" / "06.ipynb"):
        with pytest.raises(SubmissionError, match="not a folder"):
            collect(folder, LESSONS)


def test_folders_without_end_are_read_to_a_bound(tmp_path):
    deep = tmp_path.joinpath(*"a" * 60)
    deep.mkdir(parents=True)
    (deep / "06.ipynb").write_text("{}")
    (tmp_path / "bob_06.ipynb").write_text("{}")
    found, not_read = collect(tmp_path, LESSONS)
    assert [one.student for one in found] == ["bob"]
    assert "folder within 20 others" in not_read[0].why


def test_a_student_with_very_many_files_stops_nobody(tmp_path):
    for student, files in (("alice", 2001), ("bob", 1)):
        (tmp_path / student).mkdir()
        for number in range(files):
            (tmp_path / student / f"{number}.py").touch()
    found, not_read = collect(tmp_path, LESSONS)
    assert [sum(one.student == student for one in found) for student in ("alice", "bob")] == [100, 1]
    assert [(one.name, one.why) for one in not_read] == [("1,901 more files", "only 100 files of a student are graded")]
