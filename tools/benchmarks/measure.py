"""Everything that `.venv/bin/python -m tools.bench` tells, measured in this process: prints one JSON object.

The command runs it with the tools of environment-bench.txt on its path (tools/bench.py).
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

import curves
import growth
import numpy as np
import panels
import side_by_side
import start_up
from side_by_side import Measured, Scene

from course_lib.depth_mcl.localizer import SIGMA_XY_YAW
from course_lib.depth_mcl.motion import BODY_AXES
from course_lib.depth_mcl.sequence import read_sequence
from course_lib.experiments.recordings import system_noise
from course_lib.experiments.results import versions
from course_lib.paths import data_path, notebook_paths
from course_lib.processors import processors
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap

QUICK_LESSONS = ("00", "07", "15")


def corridor() -> Scene:
    """The shipped corridor, in x, y and yaw."""
    folder = data_path("corridor")
    sequence = read_sequence(folder / "wagon")
    return Scene("corridor", SceneMap.load(folder / "map.ply"), sequence, np.array(SIGMA_XY_YAW), BODY_AXES)


def six_degrees(map_path: Path, folder: Path) -> Scene:
    """A recording in six degrees of freedom, with the noise of `localize --dof 6`."""
    noise = system_noise("6", 0.05, float(np.deg2rad(2.0)))
    return Scene(folder.name, SceneMap.load(map_path), read_sequence(folder), np.array(noise["sigma"]), noise["motion"])


def rows_of(scene: Scene, measured: Measured) -> dict[str, object]:
    """What is told of a scene: milliseconds, and how many times the step's time each tool takes."""
    rows = {f"step, {name}": {"ms": side_by_side.told(1000 * seconds)} for name, seconds in measured.steps_s.items()}
    for tool, seconds in measured.tools_s.items():
        rows[side_by_side.TOOLS[tool][0]] = {
            "ms": side_by_side.told(1000 * seconds),
            "times_default": measured.ratio(tool),
            "times_exact": measured.ratio(tool, "exact"),
            "pixels_apart": measured.disagreement[tool],
        }
    for tool, why in measured.missing.items():
        rows[side_by_side.TOOLS[tool][0]] = {"missing": why}
    return {"name": scene.name, "triangles": len(scene.scene_map), "rows": rows}


def measure_all(
    quick: bool, recording: Path | None, figure: Path | None, note: Callable[[str], None]
) -> dict[str, object]:
    """Every number of the table; figure: where that of time against particles, pixels and triangles goes."""
    repeats, scene = (3 if quick else 9), corridor()
    note("particles")  # before tools that would hold more memory than many particles do
    particles = growth.particle_growth(scene, 2 if quick else 5)
    note("corridor, side by side")
    measured = side_by_side.measure(scene, list(side_by_side.TOOLS), repeats)
    scenes = [rows_of(scene, measured)]
    if recording is not None:
        note("a recording in six degrees of freedom, side by side")
        other = six_degrees(recording / "map.ply", recording)
        scenes.append(rows_of(other, side_by_side.measure(other, ["embree", "embreex", "pyvista"], repeats)))
    note("triangles")
    maps = growth.map_growth(scene, repeats)
    note("against the true world")
    true = growth.truth(scene, SceneMap.load(data_path("corridor/true_world.ply")), 8 if quick else 40)
    note("start-up, lesson 00, a room's poses")
    waiting = start_up.start_up(2 if quick else 7) | start_up.room_seconds(5 if quick else 15)
    note("keys and pictures, in a browser")
    lessons = QUICK_LESSONS if quick else tuple(path.name[:2] for path in notebook_paths())
    try:
        pictures = panels.picture_ms(lessons, 8 if quick else 20)
    except (ImportError, RuntimeError) as error:
        pictures = {"missing": str(error)}
    curve = None
    if figure is not None:
        curve = curves.curves(scene, 3, note)
        curves.draw(curve, figure)
    note("memory")
    memory = start_up.memory(scene, 200 if quick else 10_000, 20 if quick else 100)
    ratios = {tool: measured.ratio(tool) for tool in ("embree", "pyvista")}
    exact = measured.ratio("embree", "exact")
    return {
        "step_ms": 1000 * float(np.median(measured.steps_s["default"])),
        "step_exact_ms": 1000 * float(np.median(measured.steps_s["exact"])),
        **{f"{tool}_ratio": ratio and ratio["median"] for tool, ratio in ratios.items()},
        "embree_ratio_exact": exact and exact["median"],
        "per_particle_growth": particles["growth"],
        "map_growth": maps["growth"],
        "median_depth_error_mm": true["default"]["median_mm"],
        "scenes": scenes,
        "particles": particles,
        "maps": maps,
        "against_the_true_world": true,
        "waiting": waiting,
        "picture_ms": pictures,
        "curves": curve,
        "memory": memory,
        "quick": quick,
        "machine": machine(scene),
    }


def machine(scene: Scene) -> dict[str, object]:
    """What it was measured on."""
    names = [line.split(":")[1].strip() for line in _cpuinfo() if line.startswith("model name")]
    try:
        with DepthRenderer(scene.scene_map, scene.camera(), "vtk", exact=True) as renderer:
            opengl = renderer.describe()
    except RuntimeError as error:
        opengl = f"none ({error})"
    return {
        "processor": names[0] if names else platform.processor(),
        "processors": processors(),
        "load_at_the_end": os.getloadavg()[0] if hasattr(os, "getloadavg") else None,
        "opengl": opengl,
        "versions": versions(),
    }


def _cpuinfo() -> list[str]:
    path = Path("/proc/cpuinfo")
    return path.read_text().splitlines() if path.exists() else []


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--recording", type=Path)
    parser.add_argument("--figure", type=Path)
    given = parser.parse_args()
    note = partial(print, "measuring:", file=sys.stderr, flush=True)
    print(json.dumps(measure_all(given.quick, given.recording, given.figure, note)))
