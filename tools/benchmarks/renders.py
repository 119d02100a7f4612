"""Is memory flat over many renders, and does the same pose give the same image to the last bit, every time?"""

import json
import sys
from collections.abc import Callable

import numpy as np

from course_lib.geometry import state_from_optical_pose
from course_lib.rendering.errors import OpenGLError
from course_lib.rendering.renderer import DepthRenderer
from tools.benchmarks.measure import corridor
from tools.benchmarks.waiting import held_mb

CLOUDS, VIEWS = 10, 4
SPREAD = np.array([0.1, 0.1, 0.05, 0.05, 0.05, 0.2])  # metres and radians: standard deviation about the true pose
SEED = 1
# Share and number of calls (half of them at most) in which caches may grow; past its tenth window OpenGL took 8 MB.
SETTLING, SETTLING_CALLS = 0.1, 20
QUARTER = 4  # growth: from the least of the first of so many parts to the least of the last


def measure(backend: str, n_renders: int, n_renderers: int) -> dict[str, object]:
    """What `bench --renders` tells of a backend, or why it is not here: n renders of one renderer, then n renderers."""
    scene = corridor()
    frames = np.linspace(0, len(scene.sequence) - 1, CLOUDS).astype(int)
    true = state_from_optical_pose(scene.sequence.camera_to_world[frames])
    clouds = true[:, None] + SPREAD * np.random.default_rng(SEED).normal(size=(CLOUDS, VIEWS, 6))

    def opened() -> DepthRenderer:
        return DepthRenderer(scene.scene_map, scene.camera(), backend)

    def render_once(k: int) -> np.ndarray:
        with opened() as renderer:
            return renderer.render(clouds[k])

    try:
        with opened() as renderer:
            renders = over(n_renders, lambda k: renderer.render(clouds[k]))
        return {"views": VIEWS, "renders": renders, "renderers": over(n_renderers, render_once)}
    except OpenGLError as error:
        return {"missing": str(error)}


def over(n: int, render: Callable[[int], np.ndarray]) -> dict[str, float]:
    """What n calls of `render` do to memory (MB), and how many of them differ from the first of their cloud."""
    start = held_mb()
    first = [render(k) for k in range(CLOUDS)]
    held, differ = [], 0
    for i in range(n):
        differ += not np.array_equal(render(i % CLOUDS), first[i % CLOUDS])
        held.append(held_mb())
    settled = held[max(int(SETTLING * n), min(SETTLING_CALLS, n // 2)) :]
    part = -(-len(settled) // QUARTER)
    return {
        "before_the_first_mb": start,
        "calls": n,
        "settled_mb": settled[0],
        "greatest_mb": max(settled),
        "end_mb": held[-1],
        "grew_mb": min(settled[-part:]) - min(settled[:part]),
        "other_images": differ,
    }


if __name__ == "__main__":
    print(json.dumps(measure(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))))
