"""`compare`: filters in six degrees of freedom side by side."""

import json
from subprocess import CompletedProcess

import pytest

from courseware.cli import main
from courseware.commands import compare


@pytest.fixture
def words(corridor_folder, recorded, tmp_path):
    """The command on six frames of the shipped recording."""
    short = recorded("hand", range(6), "short")
    files = ["--map", str(corridor_folder / "map.ply"), "--sequence", str(short), "--out", str(tmp_path / "out")]
    return ["compare", *files]


@pytest.mark.slow
def test_the_table_has_a_row_for_each_method_and_thinning(words, tmp_path, told, printed):
    words += ["--every", "1,3", "--seeds", "10001"]
    table = printed(*words)
    for name, frames in (("annealed and refined, every 1", 6), ("the paper's filter, every 3", 6)):
        row = next(line for line in table.splitlines() if line.startswith(name))
        assert row.split(name)[1].split()[0] == str(frames)
    assert "floor: refined from the truth" in table
    rows = told(*words)["rows"]
    assert rows["annealed and refined, every 3"]["median_position_m"] < 0.04
    assert rows["floor: refined from the truth"]["most_renders"] == 5
    assert len((tmp_path / "out" / "compare.jsonl").read_text().splitlines()) == 2 * 4 + 1, "each run once"


def test_icp_stands_beside_them_pooled_as_they_are(words, tmp_path, told, capsys, monkeypatch):
    """Open3D lives in an environment of its own: here its errors are given."""
    errors = {"ICP 0.15, 0.05 m": {"1": {"position_m": [0.01, 0.02, 0.5], "rotation_deg": [1.0, 1.0, 1.0]}}}
    monkeypatch.setattr(compare, "REPOSITORY", tmp_path)
    monkeypatch.setattr("subprocess.run", lambda *words, **_: CompletedProcess(words, 0, stdout=json.dumps(errors)))
    (tmp_path / ".bench").mkdir()
    words += ["--methods", "floor", "--icp"]
    row = told(*words)["rows"]["ICP 0.15, 0.05 m"]
    assert (row["frames"], row["wrong"], row["wrong_called_lost"]) == (3, 1, 0)
    assert row["within_5cm_5deg_percent"] == pytest.approx(200 / 3)
    (tmp_path / ".bench").rmdir()
    assert main(words) == 2
    assert "tools.bench --quick installs it" in capsys.readouterr().err
