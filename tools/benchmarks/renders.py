"""Is memory flat over many renders, and does the same pose give the same image to the last bit, every time?

`.venv/bin/python -m tools.bench --renders` runs this in a process of its own for each backend, so that one's memory
is not another's: prints one JSON object.
"""

from __future__ import annotations

import argparse
import json

import numpy as np
from measure import corridor
from side_by_side import Scene
from start_up import held_mb

from course_lib.geometry import state_from_optical_pose
from course_lib.rendering.renderer import Backend, DepthRenderer, OpenGLError

CLOUDS, VIEWS = 10, 4
SPREAD = np.array([0.1, 0.1, 0.05, 0.05, 0.05, 0.2])  # metres and radians: standard deviation about the true pose
SEED = 1
SETTLING, SETTLING_CALLS = 0.1, 20
"""Share and number of the calls (at most half of them) in which caches and the allocator may still grow: memory is
held flat from there on. 20 was chosen after a look: past its tenth window OpenGL once more took 8 MB."""
QUARTER = 4
"""Growth lies between the least memory of the first and of the last of so many parts: what OpenGL takes for a while
and gives back (8 MB often, once 18) is not growth, and what is kept with each call is in every later least."""


def clouds(scene: Scene) -> np.ndarray:
    """States `(CLOUDS, VIEWS, 6)` about true poses from all along the recording: what is rendered in turn."""
    frames = np.linspace(0, len(scene.sequence) - 1, CLOUDS).astype(int)
    true = state_from_optical_pose(scene.sequence.camera_to_world[frames])
    noise = np.random.default_rng(SEED).normal(size=(CLOUDS, VIEWS, 6))
    return true[:, None] + SPREAD * noise


def many_renders(scene: Scene, backend: Backend, n: int) -> dict[str, float]:
    """n calls of one renderer, the clouds in turn: memory (MB) on the way, and how many calls gave another image."""
    states = clouds(scene)
    with DepthRenderer(scene.scene_map, scene.camera(), backend) as renderer:
        start = held_mb()
        first = np.array([renderer.render(cloud) for cloud in states])
        return {"before_the_first_mb": start, **_over(n, lambda k: renderer.render(states[k]), first)}


def many_renderers(scene: Scene, backend: Backend, n: int) -> dict[str, float]:
    """The same for n renderers, each opened, asked for one cloud and closed."""
    states = clouds(scene)

    def render(k: int) -> np.ndarray:
        with DepthRenderer(scene.scene_map, scene.camera(), backend) as renderer:
            return renderer.render(states[k])

    start = held_mb()
    return {"before_the_first_mb": start, **_over(n, render, np.array([render(k) for k in range(CLOUDS)]))}


def _over(n, render, first: np.ndarray) -> dict[str, float]:
    """What n calls of `render` do to memory, and how many of them differ from the `first` of their cloud."""
    held, differ = [], 0
    for i in range(n):
        differ += not np.array_equal(render(i % CLOUDS), first[i % CLOUDS])
        held.append(held_mb())
    settled = held[max(int(SETTLING * n), min(SETTLING_CALLS, n // 2)) :]
    part = -(-len(settled) // QUARTER)
    return {
        "calls": n,
        "settled_mb": settled[0],
        "greatest_mb": max(settled),
        "end_mb": held[-1],
        "grew_mb": min(settled[-part:]) - min(settled[:part]),
        "other_images": differ,
    }


def measure(backend: Backend, n_renders: int, n_renderers: int) -> dict[str, object]:
    """What `bench --renders` tells of a backend; or why it is not here."""
    scene = corridor()
    try:
        return {
            "views": VIEWS,
            "renders": many_renders(scene, backend, n_renders),
            "renderers": many_renderers(scene, backend, n_renderers),
        }
    except OpenGLError as error:
        return {"missing": str(error)}


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("backend")
    parser.add_argument("renders", type=int)
    parser.add_argument("renderers", type=int)
    given = parser.parse_args()
    print(json.dumps(measure(given.backend, given.renders, given.renderers)))
