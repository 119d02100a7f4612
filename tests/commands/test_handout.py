"""`course.py handout`: what it says, and the seed that it draws."""

import json

from courseware.cli import main
from courseware.commands import handout


def test_it_makes_the_folder_and_says_which_part_is_whose_and_draws_a_seed(tmp_path, capsys, monkeypatch):
    assert main(["handout", "06", "--out", str(tmp_path / "class"), "--seed", "5"]) == 0
    out = capsys.readouterr().out
    assert out.startswith("1 notebook in ")
    assert f"{tmp_path / 'class' / 'student'}   for the students" in out
    assert f"{tmp_path / 'class' / 'teacher'}   for you alone" in out
    assert json.loads((tmp_path / "class" / "teacher" / "grading" / "seed.json").read_text())["seed"] == 5
    assert not (tmp_path / "class" / "teacher" / "solved").exists()
    monkeypatch.setattr(handout.secrets, "randbits", lambda bits: 4_000_000_007 if bits >= 60 else 0)
    assert main(["handout", "00", "--out", str(tmp_path / "drawn")]) == 0
    assert json.loads((tmp_path / "drawn" / "teacher" / "grading" / "seed.json").read_text())["seed"] == 4_000_000_007
