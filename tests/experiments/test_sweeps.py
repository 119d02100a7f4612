"""Sweeps over any executor: every row once, with its seed, whoever is killed on the way."""

import json
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from course_lib.experiments.sweeps import SweepError
from course_lib.writing import WriteError

from course_lib.experiments import sweep

ROOT = Path(__file__).parents[2]
HANGS_S = 1200
GRID = {"seed": range(1, 5), "scale": (1.0, 10.0)}


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
    while seed > 2 and not (Path(folder) / "go").exists():
        time.sleep(0.02)
    return {"squared": seed**2}


def fail_for_two(seed, folder):
    if seed == 2 and not (Path(folder) / "mended").exists():
        raise ZeroDivisionError("two is not to be had")
    return {"seed": seed}


def die(seed):
    os._exit(3)


def give_nan(seed):
    return {"value": float("nan")}


def lines_of(path):
    return [json.loads(line) for line in path.read_text().splitlines()][1:]


def expected_rows():
    points = [{"seed": seed, "scale": scale} for seed in range(1, 5) for scale in (1.0, 10.0)]
    return [{"point": point, "result": draw(**point)} for point in points]


@pytest.mark.parametrize("make", [lambda: None, lambda: ThreadPoolExecutor(3)], ids=["processes", "threads"])
def test_rows_come_in_the_order_of_the_grid_each_with_its_seed(make, tmp_path):
    rows = sweep(draw, GRID, make(), results=tmp_path / "rows.jsonl")
    assert rows == expected_rows()
    assert sorted(map(str, lines_of(tmp_path / "rows.jsonl"))) == sorted(map(str, rows))


def test_dasks_workers_give_the_same_rows(tmp_path):
    distributed = pytest.importorskip("dask.distributed")
    options = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
    with distributed.LocalCluster(**options) as cluster, distributed.Client(cluster) as client:
        with client.get_executor() as executor:
            assert sweep(draw, GRID, executor, results=tmp_path / "rows.jsonl") == expected_rows()
    assert len(lines_of(tmp_path / "rows.jsonl")) == 8


def test_progress_counts_what_is_still_to_be_run(tmp_path):
    lengths = []

    def bar(futures):
        lengths.append(len(futures))
        return iter(futures)

    for seeds in (range(3), range(5)):
        with ThreadPoolExecutor(1) as pool:
            sweep(draw, {"seed": seeds}, pool, results=tmp_path / "rows.jsonl", progress=bar)
    assert lengths == [3, 2]


@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
def test_a_sweep_that_is_killed_goes_on_with_no_row_lost_or_doubled(tmp_path):
    results = tmp_path / "rows.jsonl"
    code = (
        "from concurrent.futures import ThreadPoolExecutor\n"
        "from tests.experiments.test_sweeps import note_call, sweep\n"
        f"sweep(note_call, {{'seed': range(6), 'folder': [{str(tmp_path)!r}]}}, ThreadPoolExecutor(1), "
        f"results={str(results)!r})"
    )
    process = subprocess.Popen([sys.executable, "-c", code], cwd=ROOT)
    begun = time.monotonic()
    # Point 3 waits for "go" in the worker; head and rows before it are written by the main thread, perhaps later.
    while not ((tmp_path / "calls_3").exists() and results.exists() and results.read_text().count("\n") == 1 + 3):
        assert process.poll() is None
        assert time.monotonic() - begun < HANGS_S
        time.sleep(0.02)
    with pytest.raises(SweepError, match="is being written by another sweep"):
        sweep(note_call, {"seed": [0], "folder": [str(tmp_path)]}, results=results)
    process.send_signal(signal.SIGKILL)
    process.wait()
    with results.open("a") as file:
        file.write('{"point": {"seed": 3, "fol')  # as a process leaves it that is killed while it writes
    (tmp_path / "go").touch()
    with ThreadPoolExecutor(2) as pool:
        rows = sweep(note_call, {"seed": range(6), "folder": [str(tmp_path)]}, pool, results=results)
    assert [row["result"]["squared"] for row in rows] == [0, 1, 4, 9, 16, 25]
    assert sorted(row["point"]["seed"] for row in lines_of(results)) == list(range(6))
    calls = [(tmp_path / f"calls_{seed}").read_text() for seed in range(6)]
    assert calls == ["x", "x", "x", "xx", "x", "x"]


def test_a_point_that_fails_is_named_and_alone_is_run_again(tmp_path):
    grid = {"seed": range(1, 5), "folder": [str(tmp_path)]}
    with ThreadPoolExecutor(1) as pool:
        with pytest.raises(SweepError, match=r'1 of 4 points failed.*"seed": 2.*two is not') as caught:
            sweep(fail_for_two, grid, pool, results=tmp_path / "rows.jsonl")
        assert isinstance(caught.value.__cause__, ZeroDivisionError)
        assert [row["point"]["seed"] for row in lines_of(tmp_path / "rows.jsonl")] == [1, 3, 4]
        (tmp_path / "mended").touch()
        rows = sweep(fail_for_two, grid, pool, results=tmp_path / "rows.jsonl")
    assert [row["result"]["seed"] for row in rows] == [1, 2, 3, 4]
    assert [row["point"]["seed"] for row in lines_of(tmp_path / "rows.jsonl")] == [1, 3, 4, 2]


def test_a_process_that_dies_is_named(tmp_path):
    with pytest.raises(SweepError, match="ended without a word"):
        sweep(die, {"seed": [1, 2]}, results=tmp_path / "rows.jsonl")
    assert sweep(draw, {"seed": [1, 2]}, results=tmp_path / "others.jsonl"), "it was no process that found no function"


def test_what_json_cannot_hold_fails_and_leaves_no_half_line(tmp_path):
    with ThreadPoolExecutor(1) as pool, pytest.raises(SweepError, match="1 of 1 points failed"):
        sweep(give_nan, {"seed": [1]}, pool, results=tmp_path / "rows.jsonl")
    assert lines_of(tmp_path / "rows.jsonl") == []


def test_a_full_disk_is_named_keeps_the_rows_and_the_next_sweep_goes_on(tmp_path, monkeypatch):
    results, write = tmp_path / "rows.jsonl", os.write

    def full(handle, content):
        if b'"seed": 3' in content:
            write(handle, content[:9])  # what still went in
            raise OSError(28, "No space left on device")
        return write(handle, content)

    with ThreadPoolExecutor(1) as pool:
        with monkeypatch.context() as disk:
            disk.setattr(os, "write", full)
            with pytest.raises(WriteError, match=r"rows\.jsonl cannot be written.*disk is full"):
                sweep(draw, {"seed": [1, 2, 3, 4]}, pool, results=results)
        assert results.read_bytes().count(b"\n") == 3
        sweep(draw, {"seed": [1, 2, 3, 4]}, pool, results=results)
    assert [row["point"]["seed"] for row in lines_of(results)] == [1, 2, 3, 4]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("my thesis", "holds no rows of a sweep"),
        ("my thesis\n", "line 1 is no row"),
        ('{"sweep": "another.function", "version": 1}\n', "holds rows of another.function"),
        ('{"sweep": "NAME", "version": 1}\n{"point": {"seed": 1}}\n', "line 2 is no row"),
    ],
)
def test_a_file_that_is_not_this_sweeps_is_refused_and_left_as_it_is(text, said, tmp_path):
    text = text.replace("NAME", f"{draw.__module__}.draw")
    path = tmp_path / "rows.jsonl"
    path.write_text(text)
    with pytest.raises(SweepError, match=said):
        sweep(draw, {"seed": [1]}, results=path)
    assert path.read_text() == text


@pytest.mark.parametrize(
    ("grid", "said"),
    [
        ({"seed": []}, "got 0 points"),
        ({"scale": [1.0]}, "each point a seed"),
        ([{"seed": 1}, {"seed": np.int64(1)}], "stand there twice"),
    ],
)
def test_a_grid_without_points_or_seeds_or_with_a_point_twice_is_told(grid, said, tmp_path):
    with pytest.raises(ValueError, match=said):
        sweep(draw, grid, results=tmp_path / "rows.jsonl")
    assert not (tmp_path / "rows.jsonl").exists()
