"""Measure what `.venv/bin/python -m tools.bench` prints, in this process, and print one JSON object.

The command runs it with the tools of environment-bench.txt on its path (tools/bench.py).
"""

import argparse
import json
import os
import platform
import sys
from pathlib import Path

import numpy as np
from joblib import cpu_count

from course_lib.depth_mcl.localizer import SIGMA_XY_YAW
from course_lib.depth_mcl.motion import BODY_AXES
from course_lib.depth_mcl.sequence import read_sequence
from course_lib.recordings import system_noise
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from courseware.experiments.results import versions
from courseware.paths import data_path
from tools.benchmarks import side_by_side
from tools.benchmarks.side_by_side import TOOLS, Scene


def corridor() -> Scene:
    """The shipped corridor, in x, y and yaw."""
    folder = data_path("corridor")
    sequence = read_sequence(folder / "wagon")
    return Scene("corridor", SceneMap.load(folder / "map.ply"), sequence, np.array(SIGMA_XY_YAW), BODY_AXES)


def six_degrees(folder: Path) -> Scene:
    """A recording in six degrees of freedom with its map, and the noise of `localize --dof 6`."""
    noise = system_noise("6", 0.05, float(np.deg2rad(2.0)))
    scene_map = SceneMap.load(folder / "map.ply")
    return Scene(folder.name, scene_map, read_sequence(folder), np.array(noise["sigma"]), noise["motion"])


def note(text: str) -> None:
    """Say what is measured now."""
    print("measuring:", text, file=sys.stderr, flush=True)


def measure_all(quick: bool, recording: Path | None) -> dict[str, object]:
    """Return every number of the table."""
    repeats, scene = (3 if quick else 9), corridor()
    note("corridor, side by side")
    rows = side_by_side.measure(scene, list(TOOLS), repeats)
    scenes = [{"name": scene.name, "triangles": len(scene.scene_map), "rows": rows}]
    if recording is not None:
        note("a recording in six degrees of freedom, side by side")
        other = six_degrees(recording)
        other_rows = side_by_side.measure(other, ["embree", "embreex", "pyvista"], repeats)
        scenes.append({"name": other.name, "triangles": len(other.scene_map), "rows": other_rows})
    embree = rows[TOOLS["embree"][0]]
    return {
        "quick": quick,
        "scenes": scenes,
        "step_ms": rows["step, default"]["ms"]["median"],
        "embree_ratio": embree["times_default"]["median"] if "missing" not in embree else None,
        "machine": machine(scene),
    }


def machine(scene: Scene) -> dict[str, object]:
    """What it was measured on."""
    cpuinfo = Path("/proc/cpuinfo")
    lines = cpuinfo.read_text().splitlines() if cpuinfo.exists() else []
    names = [line.split(":")[1].strip() for line in lines if line.startswith("model name")]
    try:
        with DepthRenderer(scene.scene_map, scene.camera(), "vtk", exact=True) as renderer:
            opengl = renderer.describe()
    except RuntimeError as error:
        opengl = f"none ({error})"
    return {
        "processor": names[0] if names else platform.processor(),
        "processors": cpu_count(),
        "load_at_the_end": os.getloadavg()[0] if hasattr(os, "getloadavg") else None,
        "opengl": opengl,
        "versions": versions(),
    }


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--recording", type=Path)
    given = parser.parse_args()
    print(json.dumps(measure_all(given.quick, given.recording)))
