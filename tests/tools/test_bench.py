"""`bench`: its tools are installed once, into their own folder; its table says what was measured and what is missing.

How fast anything is, is no test: the numbers here are made up, and what is measured is measured by the command alone.
"""

import copy
import json
import mmap
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from course_lib.cli import main
from course_lib.depth_mcl import DepthRenderer, SceneMap
from course_lib.depth_mcl.localizer import SIGMA_XY_YAW
from course_lib.depth_mcl.motion import BODY_AXES
from course_lib.depth_mcl.sequence import read_sequence
from tools import bench, bench_renders
from tools.bench_table import table

ROOT = Path(__file__).parents[2]
SPREAD = {"median": 100.0, "least": 90.0, "greatest": 130.0}
RESULT = {
    "step_ms": 100.0,
    "scenes": [
        {
            "name": "corridor",
            "triangles": 120_000,
            "rows": {
                "step, default": {"ms": SPREAD},
                "Embree": {
                    "ms": {"median": 700.0, "least": 650.0, "greatest": 750.0},
                    "times_default": {"median": 7.0, "least": 6.5, "greatest": 7.5},
                    "times_exact": {"median": 3.5, "least": 3.0, "greatest": 4.0},
                    "pixels_apart": 0.00001,
                },
                "PyVista": {"missing": "ModuleNotFoundError: No module named 'pyvista'"},
            },
        }
    ],
    "particles": {"particles": [200, 2000], "growth": 0.9, "peak_memory_grew_mb": 60.0},
    "maps": {"triangles": [120_000, 1_080_000], "drawn": [31_385, 33_000], "growth": 1.1, "preprocessing_s": 17.0},
    "against_the_true_world": {"exact": {"median_mm": 12.7, "percentile_99_mm": 2837.0}},
    "waiting": {"import_s": 0.03, "help_s": 0.06, "lesson_00_s": 11.0, "pose_s": 0.45, "loading_s": 0.7},
    "picture_ms": {"00_start_here": 73.0, "07_estimate_and_resample": 57.0},
    "memory": {"steps": 200, "steps_grew_mb": 0.1, "renderers": 20, "renderers_grew_mb": 0.0},
    "machine": {"processor": "a processor", "processors": 2, "load_at_the_end": 1.1, "opengl": "llvmpipe"},
}


def test_the_table_tells_times_ratios_and_what_is_missing():
    text = table(RESULT)
    assert "a processor, 2 processors, load 1.1 at the end; OpenGL: llvmpipe" in text
    assert "700 (650 to 750)" in text
    assert "7.0 (6.5 to 7.5)" in text
    assert "3.5 (3.0 to 4.0)" in text
    assert "not here: ModuleNotFoundError" in text
    assert (
        "a map of 1,080,000 triangles costs 1.10 of one of 120,000 (33,000 and 31,385 drawn), after 17 s once" in text
    )
    assert "57 to 73 ms, the medians of 2 lessons' first panels" in text
    without = copy.deepcopy(RESULT) | {"picture_ms": {"missing": "no Chromium or Chrome found"}}
    assert "not measured (no Chromium or Chrome found)" in table(without)


@pytest.fixture
def fake(tmp_path, monkeypatch):
    """A place for tools, and a measurement that prints the result above and what it was asked."""
    monkeypatch.setattr(bench, "TOOLS", tmp_path / "tools")
    monkeypatch.setattr(bench, "LOCK", tmp_path / "lock.txt")
    (tmp_path / "lock.txt").write_text("a-tool==1\n")
    calls = []
    real = subprocess.run

    def run(command, **options):
        calls.append(command)
        if "pip" in command:
            return subprocess.CompletedProcess(command, 0, "", "")
        return real([sys.executable, "-c", f"print('noise')\nprint({json.dumps(json.dumps(RESULT))})"], **options)

    monkeypatch.setattr(subprocess, "run", run)
    return calls


def test_tools_are_installed_once_into_their_own_folder_and_again_when_their_lock_changes(fake, tmp_path, capsys):
    words = ["bench", "--quick", "--out", str(tmp_path / "out")]
    assert main([*words, "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == RESULT
    assert json.loads((tmp_path / "out" / "bench.json").read_text()) == RESULT
    (pip,) = [call for call in fake if "pip" in call]
    assert pip[pip.index("--target") + 1] == str(tmp_path / "tools")
    assert main(words) == 0
    assert "step, default" in capsys.readouterr().out
    assert sum("pip" in call for call in fake) == 1
    (tmp_path / "lock.txt").write_text("a-tool==2\n")
    assert main(words) == 0
    assert sum("pip" in call for call in fake) == 2
    assert main([*words, "--no-tools"]) == 0
    assert "--quick" in fake[-1]


def test_without_a_network_the_rest_is_measured(fake, tmp_path, capsys, monkeypatch):
    ours = subprocess.run

    def fail(command, **options):
        if "pip" in command:
            return subprocess.CompletedProcess(command, 1, "", "noise\nERROR: no route to host")
        return ours(command, **options)

    monkeypatch.setattr(subprocess, "run", fail)
    assert main(["bench", "--quick", "--out", str(tmp_path / "out")]) == 0
    assert "are left out: ERROR: no route to host" in capsys.readouterr().err
    assert main(["bench", "--quick", "--out", str(tmp_path / "out")]) == 0
    assert "are left out" in capsys.readouterr().err, "an installation that failed is tried again"


def test_a_folder_that_is_not_ours_is_left_alone(fake, tmp_path, capsys):
    (tmp_path / "tools").mkdir()
    (tmp_path / "tools" / "thesis.txt").write_text("mine")
    assert main(["bench", "--quick", "--out", str(tmp_path / "out")]) == 0
    assert "was not made by this command" in capsys.readouterr().err
    assert (tmp_path / "tools" / "thesis.txt").read_text() == "mine"


def test_a_recording_without_its_map_is_named(tmp_path, capsys):
    assert main(["bench", "--recording", str(tmp_path)]) == 2
    assert "holds no map.ply" in capsys.readouterr().err


@pytest.fixture
def benchmarks(monkeypatch):
    """The tools/benchmarks' modules, importable."""
    monkeypatch.syspath_prepend(str(ROOT / "tools/benchmarks"))


def test_images_that_differ_are_counted_and_what_nobody_hits_is_alike(benchmarks):
    from side_by_side import share_apart

    ours = np.array([[[1.0, 2.0, np.inf, 5.0]]])
    theirs = np.array([[[1.005, 2.5, np.inf, 40.0]]])
    assert share_apart(ours, theirs, far=30.0) == 0.5
    assert share_apart(ours, ours, far=30.0) == 0.0


def test_a_finer_survey_is_the_same_building_in_nine_times_the_triangles(benchmarks):
    from growth import finer_survey

    cube = np.array([[x, y, z] for x in (0, 2.0) for y in (0, 3.0) for z in (0, 1.0)])
    faces = [
        [0, 1, 3],
        [0, 3, 2],
        [4, 6, 7],
        [4, 7, 5],
        [0, 4, 5],
        [0, 5, 1],
        [2, 3, 7],
        [2, 7, 6],
        [0, 2, 6],
        [0, 6, 4],
    ]
    scene_map = SceneMap(cube, np.array(faces))
    fine = finer_survey(scene_map)
    assert len(fine) == 9 * len(scene_map)
    assert np.abs(fine.bounds - scene_map.bounds).max() < 0.02
    edges = np.sort(fine.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    _, counts = np.unique(edges, axis=0, return_counts=True)
    assert set(counts) == {1, 2}
    assert (counts == 1).sum() == 12, "open where the box is open, and nowhere else"


def test_a_step_is_timed_from_the_pose_that_is_asked(benchmarks, corridor_folder):
    from side_by_side import Scene, timed_step

    sequence = read_sequence(corridor_folder / "wagon")
    planar = SceneMap.load(corridor_folder / "planar_map.ply")
    scene = Scene("corridor", planar, sequence, np.array(SIGMA_XY_YAW), BODY_AXES)
    with DepthRenderer(scene.scene_map, scene.sequence.camera().resized(16, 12)) as renderer:
        seconds, particles = timed_step(scene, renderer, 40, 7)
    assert seconds > 0
    assert particles.shape == (7, 6)
    assert np.linalg.norm(particles[:, :2].mean(axis=0) - scene.sequence.camera_to_world[40, :2, 3]) < 0.5


RENDERS = {
    "before_the_first_mb": 270.0,
    "calls": 10_000,
    "settled_mb": 360.0,
    "greatest_mb": 361.5,
    "end_mb": 361.0,
    "grew_mb": 1.0,
    "other_images": 3,
}


def test_the_table_of_renders_tells_memory_other_images_and_what_is_missing():
    told = {
        "raster": {"views": 4, "renders": RENDERS, "renderers": RENDERS | {"calls": 300, "grew_mb": -0.5}},
        "vtk": {"missing": "OpenGL could not start"},
    }
    rows = [line for backend, row in told.items() for line in bench_renders.rows(backend, row).splitlines()]
    renders, renderers, missing = rows
    heads = "memory held [MB] before settled greatest end grew [MB] other images"
    assert bench_renders.heading().split() == heads.split()
    assert renders.split() == "raster, 10,000 renders, one renderer 270.0 360.0 361.5 361.0 +1.0 3".split()
    assert renderers.split() == "raster, 300 renderers, a render each 270.0 360.0 361.5 361.0 -0.5 3".split()
    assert missing.split(maxsplit=1) == ["vtk", "not here: OpenGL could not start"]


@pytest.mark.parametrize("words", [["--renders", "19"], ["--renders", "300", "--renderers", "0"]])
def test_too_few_renders_are_refused_before_any_is_made(words, capsys):
    assert main(["bench", *words]) == 2
    assert "at least 20" in capsys.readouterr().err


def test_a_measurement_that_dies_is_named(tmp_path, capfd):
    script = tmp_path / "renders.py"
    script.write_text("raise SystemExit(7)")
    with pytest.raises(RuntimeError, match="of vtk ended with code 7"):
        list(bench_renders.measure(script, dict(os.environ), ["vtk"], 20, 20))


@pytest.mark.parametrize("backend", ["raster", "vtk", "ray"])
def test_memory_is_flat_and_images_stay_over_hundreds_of_renders(backend, capsys):
    """10,000 of them are for the command; if each of these kept its images, or one of them, that would be 20 MB.

    80 of the 100 renderers count: 24 MB from their first quarter to their last if each kept the images of its one
    render, far more if it kept its map.
    """
    assert main(["bench", "--renders", "300", "--renderers", "100", "--backends", backend, "--json"]) == 0
    (told,) = json.loads(capsys.readouterr().out).values()
    assert "missing" not in told
    for what, calls, most in (("renders", 300, 8.0), ("renderers", 100, 8.0)):
        assert told[what]["calls"] == calls
        assert told[what]["other_images"] == 0
        assert not told[what]["grew_mb"] > most, told[what]


@pytest.mark.parametrize("kept", ["nothing", "one image in twenty", "an image is another"])
def test_what_a_call_leaves_behind_or_changes_is_told(benchmarks, kept):
    from renders import CLOUDS, _over

    # Mapped afresh: an array of any size may come from what earlier tests of this process gave back.
    images, left, calls = np.zeros((CLOUDS, 4, 144, 176), dtype=np.float32), [], 0

    def render(k):
        nonlocal calls
        calls += 1
        if kept == "one image in twenty" and calls % 20 == 0:
            left.append(mmap.mmap(-1, 40 * 2**20))
            left[-1].write(b"1" * len(left[-1]))
        return images[k] + (kept == "an image is another" and calls == 70)

    told = _over(100, render, images)
    assert told["other_images"] == (kept == "an image is another")
    # Three of five come between the first and the last quarter of what counts: 120 MB.
    assert (told["grew_mb"] > 100) == (kept == "one image in twenty") or np.isnan(told["grew_mb"])
