"""`bench`: its tools are installed once, into their own folder; its table says what was measured and what is missing.

How fast anything is, is no test: the numbers here are made up, and what is measured is measured by the command alone.
That the table of stored numbers stands in RESULTS.md is tested in tests/test_readme.py.
"""

import json
import mmap
import subprocess
from pathlib import Path

import numpy as np
import pytest

from course_lib.depth_mcl import SceneMap
from tools import bench
from tools.benchmarks import growth, renders, side_by_side

STORED = Path(__file__).parents[2] / "data" / "corridor" / "results" / "bench.json"


@pytest.fixture
def fake(tmp_path, monkeypatch):
    """A place for tools, and measurements that print stored results; what was called."""
    monkeypatch.setattr(bench, "TOOLS", tmp_path / "tools")
    monkeypatch.setattr(bench, "LOCK", tmp_path / "lock.txt")
    (tmp_path / "lock.txt").write_text("a-tool==1\n")
    calls = []

    def run(command, **options):
        calls.append(command)
        if "pip" not in command:
            return subprocess.CompletedProcess(command, 0, f"noise\n{json.dumps(json.loads(STORED.read_text()))}\n")
        network = "a-tool==3" not in (tmp_path / "lock.txt").read_text()
        return subprocess.CompletedProcess(command, 1 - network, "", "noise\nERROR: no route to host")

    monkeypatch.setattr(subprocess, "run", run)
    return calls


def test_tools_are_installed_once_into_their_own_folder_and_again_when_their_lock_changes(
    fake, tmp_path, run_tool, capsys
):
    words = ["bench", "--quick", "--out", tmp_path / "out"]
    assert run_tool(*words, "--json") == 0
    assert json.loads(capsys.readouterr().out) == json.loads(STORED.read_text())
    assert json.loads((tmp_path / "out" / "bench.json").read_text()) == json.loads(STORED.read_text())
    (pip,) = [call for call in fake if "pip" in call]
    assert pip[pip.index("--target") + 1] == str(tmp_path / "tools")
    assert run_tool(*words) == 0
    assert "step, default" in capsys.readouterr().out
    assert sum("pip" in call for call in fake) == 1
    (tmp_path / "lock.txt").write_text("a-tool==2\n")
    assert run_tool(*words) == 0
    assert sum("pip" in call for call in fake) == 2
    (tmp_path / "lock.txt").write_text("a-tool==3\n")
    for _ in range(2):  # an installation that failed is tried again
        assert run_tool(*words) == 0
        assert "are left out: ERROR: no route to host" in capsys.readouterr().err


def test_a_folder_that_is_not_ours_is_left_alone_and_a_recording_without_its_map_is_named(
    fake, tmp_path, run_tool, capsys
):
    (tmp_path / "tools").mkdir()
    (tmp_path / "tools" / "thesis.txt").write_text("mine")
    assert run_tool("bench", "--quick", "--out", tmp_path / "out") == 0
    assert "was not made by this command" in capsys.readouterr().err
    assert (tmp_path / "tools" / "thesis.txt").read_text() == "mine"
    assert run_tool("bench", "--recording", tmp_path) == 2
    assert "holds no map.ply" in capsys.readouterr().err


def test_images_that_differ_are_counted_and_what_nobody_hits_is_alike():
    ours = np.array([[[1.0, 2.0, np.inf, 5.0]]])
    theirs = np.array([[[1.005, 2.5, np.inf, 40.0]]])
    assert side_by_side.share_apart(ours, theirs, far=30.0) == 0.5
    assert side_by_side.share_apart(ours, ours, far=30.0) == 0.0


def test_a_finer_survey_is_the_same_building_in_nine_times_the_triangles():
    corners = np.array([[x, y, 0.0] for x in (0, 2.0) for y in (0, 3.0)])
    scene_map = SceneMap(corners, np.array([[0, 1, 3], [0, 3, 2]]))
    fine = growth.finer_survey(scene_map)
    assert len(fine) == 9 * len(scene_map)
    assert np.abs(fine.bounds - scene_map.bounds).max() < 0.02
    edges = np.sort(fine.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    _, counts = np.unique(edges, axis=0, return_counts=True)
    assert set(counts) == {1, 2}
    assert (counts == 1).sum() == 12, "open where the sheet is open, and nowhere else"


@pytest.mark.parametrize("words", [["--renders", "19"], ["--renders", "300", "--renderers", "0"]])
def test_too_few_renders_are_refused_before_any_is_made(words, run_tool, capsys):
    assert run_tool("bench", *words) == 2
    assert "at least 20" in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.parametrize("backend", ["raster", "vtk", "ray"])
def test_memory_is_flat_and_images_stay_over_hundreds_of_renders(backend, run_tool, capsys):
    """10,000 of them are for the command; if each of these kept its images, or one of them, that would be 20 MB.

    80 of the 100 renderers count: 24 MB from their first quarter to their last if each kept the images of its one
    render, far more if it kept its map.
    """
    assert run_tool("bench", "--renders", "300", "--renderers", "100", "--backends", backend, "--json") == 0
    (told,) = json.loads(capsys.readouterr().out).values()
    assert "missing" not in told
    for what, calls in (("renders", 300), ("renderers", 100)):
        assert told[what]["calls"] == calls
        assert told[what]["other_images"] == 0
        assert not told[what]["grew_mb"] > 8.0, told[what]


@pytest.mark.parametrize("kept", ["nothing", "one image in twenty", "an image is another"])
def test_what_a_call_leaves_behind_or_changes_is_told(kept):
    # Mapped afresh: an array of any size may come from what earlier tests of this process gave back.
    images, left, calls = np.zeros((renders.CLOUDS, 4, 144, 176), dtype=np.float32), [], -renders.CLOUDS

    def render(k):
        nonlocal calls
        calls += 1
        if kept == "one image in twenty" and calls > 0 and calls % 20 == 0:
            left.append(mmap.mmap(-1, 40 * 2**20))
            left[-1].write(b"1" * len(left[-1]))
        return images[k] + (kept == "an image is another" and calls == 70)

    told = renders.over(100, render)
    assert told["other_images"] == (kept == "an image is another")
    # Three of five come between the first and the last quarter of what counts: 120 MB.
    assert (told["grew_mb"] > 100) == (kept == "one image in twenty") or np.isnan(told["grew_mb"])
