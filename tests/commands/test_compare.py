"""`compare`: filters in six degrees of freedom side by side."""

import pytest


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
