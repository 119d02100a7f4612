"""How the time of a step grows with particles and triangles; what the simplified map costs and how true it is."""

import resource
import time
from collections.abc import Iterable

import numpy as np

from course_lib.geometry import state_from_optical_pose
from course_lib.rendering import simplification
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from tools.benchmarks.side_by_side import N_PARTICLES, Scene, timed_step

NOISE_OF_FINER_SURVEY = 0.002  # metres, across the surface: what a scanner leaves after fusion


def step_seconds(
    scene: Scene, renderers: dict[str, DepthRenderer], repeats: int, particles: Iterable[int] = (N_PARTICLES,)
) -> dict[tuple[str, int], np.ndarray]:
    """Seconds `(R,)` of steps for each renderer and number of particles, taking turns; a first round is not told."""
    frames = np.linspace(1, len(scene.sequence) - 1, repeats).astype(int)
    seconds = {(name, n): [] for name in renderers for n in particles}
    for frame in [frames[0], *frames]:
        for (name, n), found in seconds.items():
            found.append(timed_step(scene, renderers[name], int(frame), n)[0])
    return {key: np.array(found[1:]) for key, found in seconds.items()}


def particle_growth(scene: Scene, repeats: int, counts: tuple[int, int] = (N_PARTICLES, 2000)) -> dict[str, object]:
    """Cost of one of many particles in units of one of few, and the memory that many need."""
    with DepthRenderer(scene.scene_map, scene.camera()) as renderer:
        before = peak_memory_mb()
        seconds = step_seconds(scene, {"": renderer}, repeats, counts)
        more = peak_memory_mb() - before
    few, many = (seconds["", n] / n for n in counts)
    return {"particles": counts, "growth": float(np.median(many / few)), "peak_memory_grew_mb": more}


def map_growth(scene: Scene, repeats: int) -> dict[str, object]:
    """Time of a step on a map of the same building with nine times the triangles, in units of that on the map."""
    maps = {"usual": scene.scene_map, "fine": finer_survey(scene.scene_map)}
    begun = time.perf_counter()
    limits = simplification.TOLERANCE, simplification.WITHIN_PERCENT, simplification._QUADRIC_ERRORS
    simplification._simplify(maps["fine"], *limits, "")  # not what the cache may hold
    preprocessing = time.perf_counter() - begun
    renderers = {name: DepthRenderer(scene_map, scene.camera()) for name, scene_map in maps.items()}
    seconds = step_seconds(scene, renderers, repeats)
    return {
        "triangles": [len(scene_map) for scene_map in maps.values()],
        "drawn": [len(renderer.map_to_draw()) for renderer in renderers.values()],
        "growth": float(np.median(seconds["fine", N_PARTICLES] / seconds["usual", N_PARTICLES])),
        "preprocessing_s": preprocessing,
    }


def finer_survey(scene_map: SceneMap) -> SceneMap:
    """The map with each triangle cut into nine and noise on every corner, as a finer survey of the building gives."""
    thirds = [(i, j, 3 - i - j) for i in range(4) for j in range(4 - i)]
    at = {point: k for k, point in enumerate(thirds)}
    up = [(at[i + 1, j, k - 1], at[i, j + 1, k - 1], at[i, j, k]) for i, j, k in thirds if k >= 1]
    down = [(at[i, j + 1, k - 1], at[i + 1, j, k - 1], at[i + 1, j + 1, k - 2]) for i, j, k in thirds if k >= 2]
    corners = scene_map.vertices[scene_map.faces]
    points = np.einsum("pw,fwx->fpx", np.array(thirds) / 3, corners).reshape(-1, 3)
    faces = (np.array(up + down)[None] + len(thirds) * np.arange(len(corners))[:, None, None]).reshape(-1, 3)
    # Both triangles of an edge make its points, which rounding may tell apart: a micrometre does not.
    _, first, inverse = np.unique(np.round(points, 6), axis=0, return_index=True, return_inverse=True)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    shift = np.random.default_rng(1).normal(scale=NOISE_OF_FINER_SURVEY, size=len(first))
    vertices = points[first] + shift[:, None] * normals[first // len(thirds)]
    return SceneMap(vertices, inverse.ravel()[faces].astype(np.int32))


def truth(scene: Scene, true_world: SceneMap, frames: int) -> dict[str, dict[str, float]]:
    """Depth errors in millimetres against the true world, of the map and of the simplified map: median and 99 %."""
    chosen = np.linspace(0, len(scene.sequence) - 1, frames).astype(int)
    states = state_from_optical_pose(scene.sequence.camera_to_world[chosen])

    def images(scene_map: SceneMap, exact: bool) -> np.ndarray:
        with DepthRenderer(scene_map, scene.camera(), exact=exact) as renderer:
            return renderer.render(states).astype(np.float64)

    true = images(true_world, True)
    found = {"exact": images(scene.scene_map, True), "default": images(scene.scene_map, False)}
    both = np.isfinite(true) & np.isfinite(found["exact"]) & np.isfinite(found["default"])
    errors = {name: 1000 * np.abs(image[both] - true[both]) for name, image in found.items()}
    return {
        name: {"median_mm": float(np.median(e)), "percentile_99_mm": float(np.percentile(e, 99))}
        for name, e in errors.items()
    }


def peak_memory_mb() -> float:
    """The most memory this process has held so far."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
