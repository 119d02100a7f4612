"""What a user waits for besides the filter: imports, `--help`, lesson 00, a pose of paper 2, a picture; and memory."""

import subprocess
import sys
import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import nbformat
import numpy as np
from nbclient import NotebookClient

from course_lib.depth_mcl.localizer import MonteCarloLocalizer
from course_lib.geometry import state_from_optical_pose
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.sensor import subsample_depth
from courseware.paths import REPOSITORY, data_path, notebook_paths
from tools.benchmarks.side_by_side import Scene

SMALL_IMAGE, FEW_PARTICLES = (44, 36), 30


def seconds_of(command: list[str], repeats: int) -> float:
    """Median seconds of a command, after a first that fills caches."""
    found = []
    for _ in range(repeats + 1):
        begun = time.perf_counter()
        subprocess.run([sys.executable, *command], check=True, capture_output=True, cwd=REPOSITORY)
        found.append(time.perf_counter() - begun)
    return float(np.median(found[1:]))


def start_up(repeats: int) -> dict[str, float]:
    """Seconds of `import course_lib`, of `course.py --help`, of lesson 00 from its kernel's start to its last cell."""
    lesson = notebook_paths()[0]
    notebook = nbformat.read(lesson, as_version=4)
    client = NotebookClient(notebook, timeout=None, resources={"metadata": {"path": lesson.parent}})
    begun = time.perf_counter()
    client.execute()
    lesson_s = time.perf_counter() - begun
    import_s, help_s = (seconds_of(words, repeats) for words in (["-c", "import course_lib"], ["course.py", "--help"]))
    return {"import_s": import_s, "help_s": help_s, "lesson_00_s": lesson_s}


def room_seconds(poses: int) -> dict[str, float]:
    """Seconds a pose of paper 2 takes from its two images, and those of loading models, which are not in it."""
    begun = time.perf_counter()
    from course_lib.spherical_stereo.detection.detector import YoloDetector
    from course_lib.spherical_stereo.localizer import SemanticLocalizer
    from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap
    from courseware.experiments.room import localize_pair
    from courseware.simulation.room.stereo_recording import read_stereo_recording

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


def picture_ms(lessons: Sequence[str], presses: int) -> dict[str, float]:
    """Median milliseconds from a key on the first panel of each lesson (number "00") to its new picture.

    In JupyterLab in the system's Chromium, over so many presses, right and left in turn. Raises `RuntimeError` where
    there is no browser.
    """
    from tempfile import TemporaryDirectory

    from playwright.sync_api import sync_playwright

    from tests.notebooks.driven_lab import chromium, first_panel, open_lesson, run_cells, served_lab, wait_for_a_picture

    path, found = chromium(), {}
    if path is None:
        raise RuntimeError("no Chromium or Chrome found")
    with TemporaryDirectory() as folder, served_lab(Path(folder)) as address, sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=path, args=["--no-sandbox"])
        for lesson in [path for path in notebook_paths() if path.name[:2] in lessons]:
            page = browser.new_page(viewport={"width": 1400, "height": 1000})
            open_lesson(page, address, lesson.name)
            run_cells(page, False)
            panel = first_panel(page)
            acts = [partial(page.keyboard.press, ("ArrowRight", "ArrowLeft")[k % 2]) for k in range(presses + 2)]
            milliseconds = [wait_for_a_picture(page, panel, "keydown", act) for act in acts]
            found[lesson.stem] = float(np.median(milliseconds[2:]))
            page.close()
        browser.close()
    return found


def memory(scene: Scene, steps: int, renderers: int) -> dict[str, float]:
    """MB by which this process grew: over the second half of many small steps, and over many renderers."""
    camera = scene.camera().resized(*SMALL_IMAGE)
    depths = [subsample_depth(scene.sequence.depth(i), scene.sequence.camera(), camera) for i in range(20)]
    start, held = state_from_optical_pose(scene.sequence.camera_to_world[0]), []
    with DepthRenderer(scene.scene_map, camera) as renderer:
        localizer = MonteCarloLocalizer(renderer, FEW_PARTICLES, scene.sigma, seed=0, motion=scene.motion)
        for step in range(steps):
            if step % len(depths) == 0:
                localizer.initialize(start)
            held.append(held_mb())
            localizer.step(depths[step % len(depths)])
    steps_grew, held = held_mb() - held[steps // 2], []
    for _ in range(renderers):
        with DepthRenderer(scene.scene_map, camera) as renderer:
            renderer.render(start[None])
        held.append(held_mb())
    grew = {"steps_grew_mb": steps_grew, "renderers_grew_mb": held[-1] - held[renderers // 2]}
    return {"steps": steps, "renderers": renderers} | grew


def held_mb() -> float:
    """Memory that this process holds now (Linux), in MB; NaN elsewhere."""
    try:
        pages = int(Path("/proc/self/statm").read_text().split()[1])
    except OSError:
        return float("nan")
    return pages * 4096 / 2**20
