"""`sweep corridor`: table 1 with intervals, from a results file that the command goes on with."""

import json

import pytest

from tools import sweep

SMALL = ["--frames", "2", "--particles", "6"]


@pytest.mark.slow
def test_what_is_missing_is_run_and_the_table_tells_medians_and_intervals(tmp_path, capsys, run_tool):
    words = ["sweep", "corridor", *SMALL, "--out", tmp_path]
    assert run_tool(*words, "--seeds", "10040-10041") == 0
    table = capsys.readouterr().out
    assert "Table 1 over 2 recordings, seeds 10040 to 10041, 2 frames, 6 particles" in table
    assert "(? to ?)" in table, "two recordings tell no interval"
    kept = (tmp_path / "corridor.jsonl").read_text()
    rows = {row["point"]["seed"]: row["result"] for row in map(json.loads, kept.splitlines())}
    assert sorted(rows) == [10040, 10041]
    assert run_tool(*words, "--seeds", "10041", "--json") == 2, "a number alone is how many, and that is too many here"
    assert run_tool(*words, "--seeds", "10041-10041", "--json") == 0
    result = json.loads(capsys.readouterr().out)
    assert (tmp_path / "corridor.jsonl").read_text() == kept, "it was there"
    told = result["over_recordings"]["methods"]["proposed"]["median_m"]["median"]
    assert told == rows[10041]["methods"]["proposed"]["median_m"]
    assert set(result["over_recordings"]["methods_by_hand"]) == {"proposed", "fallon"}


@pytest.mark.parametrize(
    ("words", "said"),
    [(["--seeds", "0"], "--seeds"), (["--dask", "127.0.0.1:9", "--seeds", "1"], "no scheduler answers there")],
)
def test_options_that_do_not_fit_are_told(words, said, tmp_path, capsys, monkeypatch, run_tool):
    monkeypatch.setattr(sweep, "CONNECT_S", 1)
    assert run_tool("sweep", "corridor", "--out", tmp_path / "out", *words) == 2
    assert said in capsys.readouterr().err
    assert not list(tmp_path.rglob("*.jsonl"))
