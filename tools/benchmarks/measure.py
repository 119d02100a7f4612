"""Everything that `.venv/bin/python -m tools.bench` tells, measured in this process: prints one JSON object.

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
from courseware.paths import data_path, notebook_paths
from tools.benchmarks import growth, side_by_side, waiting
from tools.benchmarks.side_by_side import TOOLS, Scene

QUICK_LESSONS = ("00", "07", "15")


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
    """Every number of the table."""
    repeats, scene = (3 if quick else 9), corridor()
    note("particles")  # before tools that would hold more memory than many particles do
    found: dict[str, object] = {"quick": quick, "particles": growth.particle_growth(scene, 2 if quick else 5)}
    note("corridor, side by side")
    rows = side_by_side.measure(scene, list(TOOLS), repeats)
    found["scenes"] = [{"name": scene.name, "triangles": len(scene.scene_map), "rows": rows}]
    if recording is not None:
        note("a recording in six degrees of freedom, side by side")
        other = six_degrees(recording)
        other_rows = side_by_side.measure(other, ["embree", "embreex", "pyvista"], repeats)
        found["scenes"].append({"name": other.name, "triangles": len(other.scene_map), "rows": other_rows})
    note("triangles")
    found["maps"] = growth.map_growth(scene, repeats)
    note("against the true world")
    true_world = SceneMap.load(data_path("corridor/true_world.ply"))
    found["against_the_true_world"] = growth.truth(scene, true_world, 8 if quick else 40)
    note("start-up, lesson 00, a room's poses")
    found["waiting"] = waiting.start_up(2 if quick else 7) | waiting.room_seconds(5 if quick else 15)
    note("keys and pictures, in a browser")
    lessons = QUICK_LESSONS if quick else tuple(path.name[:2] for path in notebook_paths())
    try:
        found["picture_ms"] = waiting.picture_ms(lessons, 8 if quick else 20)
    except (ImportError, RuntimeError) as error:
        found["picture_ms"] = {"missing": str(error)}
    note("memory")
    found["memory"] = waiting.memory(scene, 200 if quick else 10_000, 20 if quick else 100)
    found["step_ms"] = rows["step, default"]["ms"]["median"]
    embree = rows[TOOLS["embree"][0]]
    found["embree_ratio"] = embree["times_default"]["median"] if "missing" not in embree else None
    return found | {"machine": machine(scene)}


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
