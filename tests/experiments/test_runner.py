"""Rows of an experiment: each point once, with its seed, and kept although a run is killed on the way."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from courseware.experiments.results import versions, write_results
from courseware.experiments.runner import kept_rows

ROOT = Path(__file__).parents[2]
POINTS = [{"seed": seed, "scale": scale} for seed in range(1, 4) for scale in (1.0, 10.0)]


@pytest.fixture(autouse=True)
def found_by_other_processes(monkeypatch):
    """Lets processes of any kind import this file's functions."""
    monkeypatch.syspath_prepend(str(ROOT))
    monkeypatch.setenv("PYTHONPATH", str(ROOT))


def draw(seed, scale=1.0):
    return {"drawn": scale * float(np.random.default_rng(seed).normal())}


def note_call(seed, folder):
    """A call leaves its mark, and waits until it may go on."""
    with open(Path(folder) / f"calls_{seed}", "a") as file:
        file.write("x")
    while seed > 1 and not (Path(folder) / "go").exists():
        time.sleep(0.02)
    return {"squared": seed**2}


def fail_for_two(seed, folder):
    if seed == 2 and not (Path(folder) / "mended").exists():
        raise ZeroDivisionError("two is not to be had")
    return {"seed": seed}


def points_in(path):
    return [json.loads(line)["point"] for line in path.read_text().splitlines()]


@pytest.mark.parametrize("processes", [1, 2])
def test_results_come_in_the_order_of_the_points(processes, tmp_path):
    assert kept_rows(draw, POINTS, tmp_path / "rows.jsonl", processes) == [draw(**point) for point in POINTS]
    assert sorted(map(str, points_in(tmp_path / "rows.jsonl"))) == sorted(map(str, POINTS))


def test_only_missing_points_are_run_and_counted(tmp_path):
    counted = []
    for seeds, more in ((range(3), {}), (range(5), {}), ([1], {"scale": 2.0})):
        points = [{"seed": seed, **more} for seed in seeds]
        kept_rows(draw, points, tmp_path / "rows.jsonl", 1, lambda missing: counted.append(len(missing)) or missing)
    assert counted == [3, 2, 1]


@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
def test_a_run_that_is_killed_goes_on_with_no_row_lost_or_doubled(tmp_path):
    results = tmp_path / "rows.jsonl"
    points = [{"seed": seed, "folder": str(tmp_path)} for seed in range(4)]
    code = (
        "from pathlib import Path\nfrom tests.experiments.test_runner import note_call, kept_rows\n"
        f"kept_rows(note_call, {points!r}, Path({str(results)!r}), 1)"
    )
    process = subprocess.Popen([sys.executable, "-c", code], cwd=ROOT)
    while not (tmp_path / "calls_2").exists():  # it waits for "go"; rows 0 and 1 are written
        assert process.poll() is None
        time.sleep(0.02)
    with pytest.raises(RuntimeError, match="is being written by another run"):
        kept_rows(note_call, points[:1], results)
    process.send_signal(signal.SIGKILL)
    process.wait()
    with results.open("a") as file:
        file.write('{"point": {"seed": 2, "fol')  # as a process leaves it that is killed while it writes
    (tmp_path / "go").touch()
    assert [row["squared"] for row in kept_rows(note_call, points, results, 1)] == [0, 1, 4, 9]
    assert points_in(results) == points
    assert [(tmp_path / f"calls_{seed}").read_text() for seed in range(4)] == ["x", "x", "xx", "x"]


def test_a_point_that_fails_is_named_and_what_was_finished_is_kept(tmp_path):
    points = [{"seed": seed, "folder": str(tmp_path)} for seed in range(1, 4)]
    rows = tmp_path / "rows.jsonl"
    with pytest.raises(RuntimeError, match="seed 2: two is not to be had"):
        kept_rows(fail_for_two, points, rows, 1)
    assert points_in(rows) == points[:1]
    (tmp_path / "mended").touch()
    assert [row["seed"] for row in kept_rows(fail_for_two, points, rows, 1)] == [1, 2, 3]


def test_results_hold_their_versions_and_rows(tmp_path):
    write_results(tmp_path / "new" / "run.json", {"seed": 3}, [{"frame": 1, "error_m": 0.5}])
    assert json.loads((tmp_path / "new" / "run.json").read_text()) == {"seed": 3, "versions": versions()}
    assert (tmp_path / "new" / "run.csv").read_text().split() == ["frame,error_m", "1,0.5"]
