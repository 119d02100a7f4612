"""`demo`: each experiment's table, its JSON and its files; finished seeds are used again."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest

from course_lib.depth_mcl.sequence import read_sequence
from course_lib.depth_mcl.sequence_files import read_tum
from courseware.cli import main
from courseware.experiments import corridor, walk
from courseware.simulation.corridor.seeded_recording import HARDSHIPS
from tests.commands.conftest import rows_of

THREE_FRAMES = ["--seed", "6", "--frames", "3", "--particles", "15"]
TWO_SEEDS = ["--seeds", "10040-10041", "--frames", "2", "--particles", "6", "--methods", "proposed,fallon"]


@pytest.mark.slow
def test_the_corridor_has_table_1_figures_and_a_scene_and_another_process_without_opengl_the_same_bytes(tmp_path, told):
    summary = told("demo", "corridor", *THREE_FRAMES, "--out", tmp_path)
    assert (summary["frames"], summary["n_particles"], summary["seed"]) == (3, 15, 6)
    assert list(summary["methods"]) == list(corridor.METHODS)
    assert list(summary["methods_by_hand"]) == ["proposed", "fallon"]
    assert summary["fallon_median_m"] == summary["methods"]["fallon"]["median_m"]
    assert corridor.BY_HAND_TITLE in corridor.table_1(summary)
    stored = json.loads((tmp_path / "corridor.json").read_text())
    assert {key: stored[key] for key in summary} == summary
    errors = [float(row["proposed_nearest_m"]) for row in rows_of(tmp_path / "corridor.csv")]
    assert np.median(errors) == pytest.approx(summary["median_m"], abs=1e-5)
    for name in ("figure_5.png", "figure_6.png", "overview.png"):
        assert (tmp_path / name).read_bytes().startswith(b"\x89PNG")
    assert len((tmp_path / "corridor.html").read_text()) < 1_300_000
    assert len(read_tum(tmp_path / "trajectory.txt")[1]) == 3
    assert set(json.loads((tmp_path / "run.json").read_text())["files"]) >= {"corridor.json", "figure_5.png"}
    words = ["demo", "corridor", *THREE_FRAMES, "--out", str(tmp_path / "again")]
    code = f"from courseware.cli import main; raise SystemExit(main({words!r}))"
    hidden = os.environ | {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent", "DISPLAY": ""}
    subprocess.run([sys.executable, "-c", code], env=hidden, stdout=subprocess.DEVNULL, check=True)
    for name in ("corridor.csv", "trajectory.txt", "overview.png", "corridor.html"):
        assert (tmp_path / name).read_bytes() == (tmp_path / "again" / name).read_bytes()


@pytest.mark.slow
def test_the_shipped_recordings_table_holds_the_papers_rows_beside_ours(tmp_path, corridor_folder, printed):
    words = ["demo", "corridor", "--recording", "shipped", "--frames", "3", "--particles", "20", "--out", tmp_path]
    table = printed(*words)
    for row in ("paper: proposed method", "paper: Fallon", "proposed method, ours", "Fallon-style, depth, 20 x 15"):
        assert row in table
    assert corridor.BY_HAND_TITLE not in table
    assert "Written: corridor.json, corridor.csv, figure_5.png" in table
    x, y = (float(rows_of(tmp_path / "corridor.csv")[0][f"proposed_{axis}_m"]) for axis in "xy")
    start = read_sequence(corridor_folder / "wagon").camera_to_world[0, :2, 3]
    assert np.hypot(x - start[0], y - start[1]) < 0.2


@pytest.mark.slow
def test_several_seeds_give_a_table_over_recordings_and_are_not_run_again(tmp_path, told):
    result = told("demo", "corridor", *TWO_SEEDS, "--out", tmp_path)
    assert [one["seed"] for one in result["recordings"]] == result["seeds"] == [10040, 10041]
    medians = [one["median_timed_m"] for one in result["recordings"]]
    shown = result["over_recordings"]["methods"]["proposed"]["median_timed_m"]
    assert shown == {"median": pytest.approx(sum(medians) / 2), "least": min(medians), "greatest": max(medians)}
    assert f"({min(medians):.3f} to {max(medians):.3f})" in corridor.table_over_recordings(result)
    assert {"recordings.json", "seed_10040.json", "seed_10041.csv"} <= {path.name for path in tmp_path.iterdir()}
    kept = (tmp_path / "corridor.jsonl").read_text()
    assert told("demo", "corridor", *TWO_SEEDS, "--out", tmp_path) == result
    assert (tmp_path / "corridor.jsonl").read_text() == kept


@pytest.mark.slow
def test_the_idealizations_are_measured_one_by_one(tmp_path, told):
    words = ["--seeds", "10042", "--frames", "3", "--particles", "30", "--backend", "ray", "--out", tmp_path]
    result = told("demo", "corridor", "--idealizations", *words)
    assert list(result["hardships"]) == ["none", *HARDSHIPS, "all"]
    assert len({row["median_timed_m"]["median"] for row in result["hardships"].values()}) > 4
    table = corridor.table_of_idealizations(result)
    assert all(name in table for name in result["hardships"])


@pytest.mark.slow
def test_a_seeds_recording_by_hand_and_the_one_with_calibration_errors(tmp_path, told):
    words = ["demo", "corridor", "--dof", "6", "--seed", "10001", "--frames", "3", "--out", tmp_path]
    rows = told(*words)["rows"]
    assert len(rows) == 6
    assert all(row["frames"] == 3 for row in rows.values())
    assert max(row["median_position_m"] for name, row in rows.items() if not name.startswith("the paper's")) < 0.05
    less, kind = (rows[f"annealed and refined{part}"]["median_rotation_deg"] for part in (", with errors", ""))
    assert less > kind, "a mount that is off by 0.3 degrees an axis"
    assert (tmp_path / "covariance.png").exists()


def test_without_out_a_run_has_a_folder_of_its_own_beside_the_kept_rows(monkeypatch, tmp_path, capsys):
    def walked(seed, methods, everies):
        run = {"position_m": [0.01], "rotation_deg": [0.1], "status": ["tracked"], "renders": [5], "score": [0.9]}
        return [{"method": method, "every": 1, "run": run} for method in methods]

    monkeypatch.setattr(walk, "room_walk", walked)
    for module in ("courseware.run_folder", "courseware.commands.demo"):
        monkeypatch.setattr(f"{module}.REPOSITORY", tmp_path)
    assert main(["demo", "walk", "--methods", "floor"]) == 0
    kept = tmp_path / "results" / "demo_walk"
    (folder,) = (path for path in kept.iterdir() if path.is_dir())
    assert {path.name for path in folder.iterdir()} == {"walk.json", "covariance.png", "run.json"}
    assert len((kept / "walk.jsonl").read_text().splitlines()) == 1
    assert f"results: {folder}" in capsys.readouterr().err
