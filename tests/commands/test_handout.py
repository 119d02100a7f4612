"""`course.py handout`: what it says, and that a trial that is not as it must be fails."""

import pytest

from course_lib.classroom.nbgrader_trial import HEADER, Trial
from course_lib.cli import main
from course_lib.commands import handout


def test_it_makes_the_folder_and_says_which_part_is_whose_and_draws_a_seed(tmp_path, capsys, monkeypatch):
    assert main(["handout", "06", "--out", str(tmp_path / "class"), "--seed", "5"]) == 0
    out = capsys.readouterr().out
    assert out.startswith("1 notebook in ")
    assert f"{tmp_path / 'class' / 'student'}   for the students" in out
    assert f"{tmp_path / 'class' / 'teacher'}   for you alone" in out
    assert "SEED = 5" in (tmp_path / "class" / "teacher" / "grading" / "course_grading.py").read_text()
    assert not (tmp_path / "class" / "teacher" / "solved").exists()
    monkeypatch.setattr(handout.secrets, "randbits", lambda bits: 4_000_000_007 if bits >= 60 else 0)
    assert main(["handout", "00", "--out", str(tmp_path / "drawn")]) == 0
    assert "SEED = 4000000007" in (tmp_path / "drawn" / "teacher" / "grading" / "course_grading.py").read_text()


@pytest.mark.parametrize(
    ("trial", "code"),
    [
        (Trial("06", 16.0, 16.0, 0.0, 6.0, 6.0, (), 20.0), 0),
        (Trial("06", 16.0, 15.0, 0.0, 6.0, 6.0, (), 20.0), 1),
        (Trial("06", 16.0, 16.0, 0.0, 6.0, 6.0, ("release/06.ipynb holds the canary",), 20.0), 1),
    ],
)
def test_a_trial_that_is_not_as_it_must_be_fails(trial, code, capsys, monkeypatch):
    monkeypatch.setattr("course_lib.classroom.nbgrader_trial.try_assignment", lambda *a, **k: trial)
    assert main(["handout", "06", "--try"]) == code
    printed = capsys.readouterr().out
    assert printed.startswith(HEADER)
    assert ("WRONG" in printed) == (code == 1)
