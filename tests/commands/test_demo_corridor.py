"""`demo corridor`: table 1, its figures and its JSON, on a few frames."""

import csv
import json
import os
import subprocess
import sys

import pytest

from course_lib.cli import main

KEYS = {
    "seed", "n_particles", "frames", "median_m", "sigma_m", "within_3sigma_percent", "median_timed_m", "ms_per_frame",
    "fallon_median_m",
}  # fmt: skip


@pytest.fixture(scope="module")
def demo(tmp_path_factory, request):
    """The demo on the first eight frames with sixty particles: its folder."""
    folder = tmp_path_factory.mktemp("demo")
    words = ["demo", "corridor", "--seed", "11", "--frames", "8", "--particles", "60", "--out", str(folder)]
    assert main(words) == 0
    return folder


def test_json_is_one_object_with_the_promised_keys(tmp_path, capsys):
    words = ["demo", "corridor", "--frames", "3", "--particles", "20", "--out", str(tmp_path), "--json"]
    assert main(words) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary.keys() >= KEYS
    assert (summary["frames"], summary["n_particles"], summary["seed"]) == (3, 20, 0)
    assert 0 <= summary["within_3sigma_percent"] <= 100
    assert set(summary["methods"]) >= {"proposed", "fallon", "fallon_full", "fallon_disparity", "fallon_disparity_full"}


def test_the_table_holds_the_papers_rows_beside_ours(tmp_path, capsys):
    assert main(["demo", "corridor", "--frames", "2", "--particles", "10", "--out", str(tmp_path)]) == 0
    table = capsys.readouterr().out
    for row in ("paper: proposed method", "paper: Fallon", "proposed method, ours", "Fallon-style, depth, 20 x 15"):
        assert row in table
    assert "0.07" in table
    assert "n/a" in table


def test_figures_and_results_are_written(demo):
    for name in ("figure_5.png", "figure_6.png"):
        assert (demo / name).read_bytes().startswith(b"\x89PNG")
    rows = list(csv.DictReader((demo / "corridor.csv").open()))
    stored = json.loads((demo / "corridor.json").read_text())
    errors = sorted(float(row["proposed_nearest_m"]) for row in rows)
    assert len(rows) == 8
    assert stored["median_m"] == pytest.approx((errors[3] + errors[4]) / 2, abs=1e-5)
    assert not list(demo.glob("*.partial"))


def test_the_filter_keeps_to_the_path(demo):
    assert json.loads((demo / "corridor.json").read_text())["median_timed_m"] < 0.15


def test_a_folder_without_the_data_is_named(tmp_path, capsys):
    assert main(["demo", "corridor", "--data", str(tmp_path)]) == 2
    assert "no sequence" in capsys.readouterr().err


@pytest.mark.slow
def test_another_process_with_the_same_seed_writes_the_same_bytes(tmp_path):
    words = ["demo", "corridor", "--seed", "6", "--frames", "3", "--particles", "15", "--out"]
    for name in ("a", "b"):
        code = f"from course_lib.cli import main; raise SystemExit(main({[*words, str(tmp_path / name)]!r}))"
        subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
    for name in ("corridor.csv", "trajectory.txt"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


@pytest.mark.slow
def test_without_opengl_ray_casting_runs_it_to_the_last_figure(tmp_path):
    words = [
        "demo",
        "corridor",
        "--frames",
        "2",
        "--particles",
        "8",
        "--backend",
        "ray",
        "--out",
        str(tmp_path / "out"),
    ]
    environment = os.environ | {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent", "DISPLAY": ""}
    code = f"from course_lib.cli import main; raise SystemExit(main({words!r}))"
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out" / "overview.png").exists()
