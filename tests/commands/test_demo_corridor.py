"""`demo corridor`: table 1, its figures and its JSON, on a few frames."""

import contextlib
import csv
import io
import json
import os
import shutil
import subprocess
import sys

import numpy as np
import pytest
from course_lib.commands.corridor_tables import table_1, table_over_recordings

from course_lib.cli import main
from course_lib.commands import demo_corridor
from course_lib.depth_mcl.sequence import read_sequence
from course_lib.simulation.corridor.seeded_recording import HARDSHIPS

KEYS = {
    "seed", "n_particles", "frames", "median_m", "sigma_m", "within_3sigma_percent", "median_timed_m", "ms_per_frame",
    "fallon_median_m",
}  # fmt: skip
THREE_FRAMES = ["--seed", "6", "--frames", "3", "--particles", "15"]


@pytest.fixture(scope="module")
def demo(tmp_path_factory, request):
    """The demo on the first six frames with forty particles: its folder."""
    folder = tmp_path_factory.mktemp("demo")
    words = ["demo", "corridor", "--seed", "11", "--frames", "6", "--particles", "40", "--out", str(folder)]
    assert main(words) == 0
    return folder


@pytest.fixture(scope="module")
def printed(tmp_path_factory):
    """What a run of three frames with --json printed, and its folder."""
    folder, output = tmp_path_factory.mktemp("printed"), io.StringIO()
    with contextlib.redirect_stdout(output):
        assert main(["demo", "corridor", *THREE_FRAMES, "--json", "--out", str(folder)]) == 0
    return output.getvalue(), folder


def test_json_is_one_object_with_the_promised_keys(printed):
    summary = json.loads(printed[0])
    assert summary.keys() >= KEYS
    assert (summary["frames"], summary["n_particles"], summary["seed"]) == (3, 15, 6)
    assert 0 <= summary["within_3sigma_percent"] <= 100
    assert set(summary["methods"]) >= {"proposed", "fallon", "fallon_full", "fallon_disparity", "fallon_disparity_full"}


@pytest.mark.slow
def test_another_process_without_opengl_writes_the_same_bytes_to_the_last_figure(printed, tmp_path):
    words = ["demo", "corridor", *THREE_FRAMES, "--out", str(tmp_path)]
    environment = os.environ | {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent", "DISPLAY": ""}
    code = f"from course_lib.cli import main; raise SystemExit(main({words!r}))"
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    for name in ("corridor.csv", "trajectory.txt"):
        assert (tmp_path / name).read_bytes() == (printed[1] / name).read_bytes()
    assert (tmp_path / "overview.png").exists()
    assert "no corridor.html (OpenGL cannot start" in done.stdout


@pytest.mark.slow
def test_figures_and_results_are_written(demo):
    for name in ("figure_5.png", "figure_6.png"):
        assert (demo / name).read_bytes().startswith(b"\x89PNG")
    assert len((demo / "corridor.html").read_text()) < 1_300_000
    rows = list(csv.DictReader((demo / "corridor.csv").open()))
    stored = json.loads((demo / "corridor.json").read_text())
    errors = sorted(float(row["proposed_nearest_m"]) for row in rows)
    assert len(rows) == 6
    assert stored["median_m"] == pytest.approx((errors[2] + errors[3]) / 2, abs=1e-5)
    assert not list(demo.glob("*.partial"))


@pytest.mark.slow
def test_the_filter_keeps_to_the_path(demo):
    assert json.loads((demo / "corridor.json").read_text())["median_timed_m"] < 0.15


@pytest.mark.slow
def test_a_seeds_own_recording_has_a_less_kind_one_beside_it(demo):
    stored = json.loads((demo / "corridor.json").read_text())
    assert list(stored["methods_by_hand"]) == ["proposed", "fallon"]
    assert stored["methods_by_hand"]["proposed"]["median_timed_m"] < 0.3
    assert "with calibration and mount errors, pushed by hand:" in table_1(stored)


def test_the_shipped_recordings_table_holds_the_papers_rows_beside_ours(tmp_path, corridor_folder, capsys):
    words = ["demo", "corridor", "--recording", "shipped", "--frames", "3", "--particles", "20", "--out", str(tmp_path)]
    assert main(words) == 0
    table = capsys.readouterr().out
    for row in ("paper: proposed method", "paper: Fallon", "proposed method, ours", "Fallon-style, depth, 20 x 15"):
        assert row in table
    assert "0.07" in table
    assert "n/a" in table
    stored = json.loads((tmp_path / "corridor.json").read_text())
    assert "methods_by_hand" not in stored
    x, y = (float(next(csv.DictReader((tmp_path / "corridor.csv").open()))[f"proposed_{axis}_m"]) for axis in "xy")
    start = read_sequence(corridor_folder / "wagon").camera_to_world[0, :2, 3]
    assert np.hypot(x - start[0], y - start[1]) < 0.2


@pytest.mark.parametrize(("recording", "missing"), [("own", "map.ply"), ("shipped", "map.ply")])
def test_a_folder_without_the_data_is_named(recording, missing, tmp_path, capsys):
    assert main(["demo", "corridor", "--data", str(tmp_path), "--recording", recording]) == 2
    assert missing in capsys.readouterr().err


def test_where_no_recording_can_be_made_the_shipped_one_is_named(monkeypatch, capsys):
    def fail(*_, **__):
        raise ImportError("the simulated world needs embreex")

    monkeypatch.setattr("course_lib.experiments.corridor_seeds.record_seed", fail)
    assert main(["demo", "corridor", "--frames", "2"]) == 1
    assert "needs embreex; --recording shipped makes none" in capsys.readouterr().err


SMALL = ["--frames", "2", "--particles", "6", "--methods", "proposed,fallon"]


@pytest.fixture(scope="module")
def two_seeds(tmp_path_factory):
    """Two seeds, finished: their folder."""
    out = tmp_path_factory.mktemp("seeds")
    assert main(["demo", "corridor", "--seeds", "10040-10041", *SMALL, "--out", str(out)]) == 0
    return out


@pytest.mark.slow
def test_several_seeds_give_a_table_over_recordings(two_seeds, capsys):
    assert main(["demo", "corridor", "--seeds", "10040-10041", *SMALL, "--out", str(two_seeds), "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["seeds"] == [summary["seed"] for summary in result["recordings"]] == [10040, 10041]
    medians = [summary["median_timed_m"] for summary in result["recordings"]]
    told = result["over_recordings"]["methods"]["proposed"]["median_timed_m"]
    assert told == {"median": pytest.approx(sum(medians) / 2), "least": min(medians), "greatest": max(medians)}
    assert medians[0] != medians[1]
    table = table_over_recordings(result)
    assert "Table 1 over 2 recordings, seeds 10040 to 10041" in table
    assert f"({min(medians):.3f} to {max(medians):.3f})" in table


@pytest.mark.slow
def test_finished_seeds_are_not_run_again_and_others_are(two_seeds, tmp_path, capsys, monkeypatch):
    ran = []
    real = demo_corridor._rows_of
    monkeypatch.setattr(demo_corridor, "_rows_of", lambda a, seed, t: ran.append(seed) or real(a, seed, t))
    out = tmp_path / "seeds"
    shutil.copytree(two_seeds, out)
    (out / "seed_10041.json").unlink()
    assert main(["demo", "corridor", "--seeds", "10040-10041", *SMALL, "--out", str(out)]) == 0
    assert ran == [10041]
    assert "seed 10040: finished before" in capsys.readouterr().err
    other = ["--frames", "2", "--particles", "5", "--methods", "proposed,fallon"]
    assert main(["demo", "corridor", "--seeds", "10040", *other, "--out", str(out)]) == 0
    assert ran == [10041, 10040]


def test_a_seed_is_written_when_it_is_done(tmp_path, monkeypatch):
    real = demo_corridor._rows_of

    def stopped(arguments, seed, temporary):
        if seed == 10041:
            raise KeyboardInterrupt
        return real(arguments, seed, temporary)

    monkeypatch.setattr(demo_corridor, "_rows_of", stopped)
    assert main(["demo", "corridor", "--seeds", "10040-10041", *SMALL, "--out", str(tmp_path)]) == 130
    assert json.loads((tmp_path / "seed_10040.json").read_text())["seed"] == 10040
    assert not (tmp_path / "seed_10041.json").exists()


@pytest.mark.slow
def test_the_kindnesses_are_measured_one_by_one(tmp_path, capsys):
    words = ["--seeds", "10042", "--frames", "3", "--particles", "30", "--backend", "ray", "--out", str(tmp_path)]
    assert main(["demo", "corridor", "--kindnesses", *words]) == 0
    table = capsys.readouterr().out
    result = json.loads((tmp_path / "kindnesses.json").read_text())
    assert list(result["hardships"]) == ["none", *HARDSHIPS, "all"]
    assert len({row["median_timed_m"]["median"] for row in result["hardships"].values()}) > 4
    assert all(name in table for name in result["hardships"])


@pytest.mark.parametrize(
    ("words", "named"),
    [
        (["--seeds", "5-1"], "--seeds must be"),
        (["--seeds", "1-"], "--seeds must be"),
        (["--frames", "0"], "--frames must be at least 1"),
        (["--particles", "0"], "--particles must be at least 1; got 0"),
        (["--particles", "1000000000"], "--particles must be at most 1,000,000; got 1,000,000,000"),
        (["--methods", "proposed"], "--methods goes with --seeds"),
        (["--seeds", "1", "--methods", "proposed,miracle"], "--methods must name proposed and fallon"),
    ],
)
def test_options_that_do_not_fit_are_told_before_the_work(words, named, capsys):
    assert main(["demo", "corridor", *words]) == 2
    assert named in capsys.readouterr().err
