"""What a user waits for besides the filter: imports, `--help`, lesson 00, a pose of paper 2; and memory."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

import numpy as np
from side_by_side import Scene

from course_lib.depth_mcl.localizer import MonteCarloLocalizer
from course_lib.geometry import state_from_optical_pose
from course_lib.paths import REPOSITORY, data_path, notebook_paths
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.sensor import subsample_depth

SMALL_IMAGE, FEW_PARTICLES = (44, 36), 30


def seconds_of(command: list[str], repeats: int) -> float:
    """Median seconds of a command, after a first that fills caches."""
    found = []
    for _ in range(repeats + 1):
        begun = time.perf_counter()
        subprocess.run(command, check=True, capture_output=True, cwd=REPOSITORY)
        found.append(time.perf_counter() - begun)
    return float(np.median(found[1:]))


def start_up(repeats: int) -> dict[str, float]:
    """Seconds of `import course_lib`, of `course.py --help`, of lesson 00 from its kernel's start to its last cell."""
    return {
        "import_s": seconds_of([sys.executable, "-c", "import course_lib"], repeats),
        "help_s": seconds_of([sys.executable, "course.py", "--help"], repeats),
        "lesson_00_s": lesson_seconds(notebook_paths()[0]),
    }


def lesson_seconds(path: Path) -> float:
    """Seconds in which a lesson runs, its kernel's start included."""
    import nbformat
    from nbclient import NotebookClient

    client = NotebookClient(
        nbformat.read(path, as_version=4), timeout=None, resources={"metadata": {"path": path.parent}}
    )
    begun = time.perf_counter()
    client.execute()
    return time.perf_counter() - begun


def room_seconds(poses: int) -> dict[str, float]:
    """Seconds a pose of paper 2 takes from its two images, and those of loading models, which are not in it."""
    begun = time.perf_counter()
    from course_lib.experiments.room import localize_pair
    from course_lib.spherical_stereo.detection.detector import YoloDetector
    from course_lib.spherical_stereo.localizer import SemanticLocalizer
    from course_lib.spherical_stereo.recording import read_stereo_recording
    from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

    recording = read_stereo_recording(data_path("room/experiment_1"))
    semantic_map = SemanticMap.load(data_path("room/semantic_map.json"))
    # The paper's method, as `demo room` runs it.
    detector = YoloDetector.load(data_path("detector"))
    localizer = SemanticLocalizer(recording.rig, semantic_map, detector, reject_implausible=False)
    localize_pair(recording.pairs[0], localizer)
    loading, seconds = time.perf_counter() - begun, []
    for pair in recording.pairs[1 : poses + 1]:
        begun = time.perf_counter()
        localize_pair(pair, localizer)
        seconds.append(time.perf_counter() - begun)
    return {"pose_s": float(np.median(seconds)), "loading_s": loading}


def memory(scene: Scene, steps: int, renderers: int) -> dict[str, float]:
    """MB by which this process grew: over the second half of many small steps, and over many renderers."""
    camera = scene.camera().resized(*SMALL_IMAGE)
    depths = [subsample_depth(scene.sequence.depth(i), scene.sequence.camera(), camera) for i in range(20)]
    with DepthRenderer(scene.scene_map, camera) as renderer:
        localizer = MonteCarloLocalizer(renderer, FEW_PARTICLES, scene.sigma, seed=0, motion=scene.motion)
        at_half = 0.0
        for step in range(steps):
            if step % len(depths) == 0:
                localizer.initialize(state_from_optical_pose(scene.sequence.camera_to_world[0]))
            if step == steps // 2:
                at_half = held_mb()
            localizer.step(depths[step % len(depths)])
        steps_grew = held_mb() - at_half
    pose, grew = state_from_optical_pose(scene.sequence.camera_to_world[:1]), []
    for _ in range(renderers):
        with DepthRenderer(scene.scene_map, camera) as renderer:
            renderer.render(pose)
        grew.append(held_mb())
    return {
        "steps": steps,
        "steps_grew_mb": steps_grew,
        "renderers": renderers,
        "renderers_grew_mb": grew[-1] - grew[len(grew) // 2],
    }


def held_mb() -> float:
    """Memory that this process holds now (Linux), in MB; NaN elsewhere."""
    try:
        pages = int(Path("/proc/self/statm").read_text().split()[1])
    except OSError:
        return float("nan")
    return pages * 4096 / 2**20
