"""The filter's step and other renderers, measured in one process on the same poses of the same map.

Every repeat takes another frame of the recording: particles are drawn about its true pose as the filter would draw
them, one whole step of the filter is timed, with fewer triangles and exactly, and then every tool renders the poses
that the first of these steps rendered, of the whole map. So what changes from repeat to repeat, the view and the
machine's mood, changes for all alike, and ratios are taken repeat by repeat.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from other_tools import LOOPED_IMAGES, Tool, course_backend, open3d_embree, pyvista_loop

from course_lib.depth_mcl.localizer import MonteCarloLocalizer
from course_lib.depth_mcl.motion import Motion
from course_lib.depth_mcl.sequence import DepthSequence
from course_lib.geometry import optical_pose, state_from_optical_pose
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from course_lib.rendering.sensor import subsample_depth

N_PARTICLES = 200
IMAGE = (176, 144)  # pixels: the paper's camera

TOOLS: dict[str, tuple[str, Callable[[SceneMap, DepthCamera], Tool]]] = {
    "embree": ("Open3D RaycastingScene (Embree), casting alone", open3d_embree),
    "embreex": ("trimesh's embreex, a particle at a time", lambda m, c: course_backend("ray", m, c)),
    "vtk_tiles": ("OpenGL, tiles of one window (backend vtk)", lambda m, c: course_backend("vtk", m, c)),
    "vtk_loop": ("OpenGL, one VTK render per particle", lambda m, c: course_backend("vtk", m, c, one_by_one=True)),
    "pyvista": ("PyVista get_image_depth per particle", pyvista_loop),
}


class Scene(NamedTuple):
    """What is measured on."""

    name: str
    scene_map: SceneMap
    sequence: DepthSequence
    sigma: np.ndarray
    motion: Motion

    def camera(self) -> DepthCamera:
        """The recording's camera at the paper's image size."""
        return self.sequence.camera().resized(*IMAGE)


class Measured(NamedTuple):
    """Seconds of every repeat."""

    steps_s: dict[str, np.ndarray]
    """Whole steps of the filter `(R,)`: "default" and "exact"."""
    tools_s: dict[str, np.ndarray]
    """The same images `(R,)`, by tool; tools that are not here are left out."""
    missing: dict[str, str]
    """What each tool that is not here said."""
    disagreement: dict[str, float]
    """Share of pixels by which a tool's images and our exact ones differ by more than a centimetre."""

    def ratio(self, tool: str, step: str = "default") -> dict[str, float] | None:
        """How many times the step's time a tool takes: median, least and greatest of the repeats."""
        return told(self.tools_s[tool] / self.steps_s[step]) if tool in self.tools_s else None


def told(values: np.ndarray) -> dict[str, float]:
    """Median, least and greatest."""
    return {"median": float(np.median(values)), "least": float(np.min(values)), "greatest": float(np.max(values))}


def measure(scene: Scene, tools: Sequence[str], repeats: int, n_particles: int = N_PARTICLES) -> Measured:
    """Times steps and tools; a first, untimed round compiles, opens windows and uploads maps."""
    camera, made, missing = scene.camera(), {}, {}
    for key in tools:
        try:
            made[key] = TOOLS[key][1](scene.scene_map, camera)
        except Exception as error:  # a tool that is not here is a row that says so
            missing[key] = f"{type(error).__name__}: {error}"
    frames = np.linspace(1, len(scene.sequence) - 1, repeats).astype(int)
    steps_s = {"default": np.empty(repeats), "exact": np.empty(repeats)}
    tools_s, disagreement = {key: np.empty(repeats) for key in made}, {}
    with DepthRenderer(scene.scene_map, camera) as default, DepthRenderer(scene.scene_map, camera, exact=True) as exact:
        for repeat, frame in enumerate([frames[0], *frames], start=-1):
            seconds, particles = timed_step(scene, default, int(frame), n_particles)
            exact_seconds, _ = timed_step(scene, exact, int(frame), n_particles)
            poses = optical_pose(particles)
            results = {key: tool(poses) for key, tool in made.items()}
            if repeat < 0:
                ours = exact.render(particles[:LOOPED_IMAGES])
                disagreement = {key: share_apart(ours, result.images, camera.far) for key, result in results.items()}
                continue
            steps_s["default"][repeat], steps_s["exact"][repeat] = seconds, exact_seconds
            for key, result in results.items():
                tools_s[key][repeat] = result.seconds
    return Measured(steps_s, tools_s, missing, disagreement)


def timed_step(scene: Scene, renderer: DepthRenderer, frame: int, n_particles: int) -> tuple[float, np.ndarray]:
    """Seconds of one whole step, all particles at the true pose before it; and the particles that it rendered."""
    depth = subsample_depth(scene.sequence.depth(frame), scene.sequence.camera(), renderer.camera)
    localizer = MonteCarloLocalizer(renderer, n_particles, scene.sigma, seed=frame, motion=scene.motion)
    localizer.initialize(state_from_optical_pose(scene.sequence.camera_to_world[frame]))
    begun = time.perf_counter()
    estimate = localizer.step(depth)
    return time.perf_counter() - begun, estimate.particles


def share_apart(ours: np.ndarray, theirs: np.ndarray, far: float) -> float:
    """Share of pixels by which two sets of images are more than a centimetre apart; beyond far nothing is hit."""
    count = min(len(ours), len(theirs))
    a, b = (np.where(images[:count] <= far, images[:count], np.inf).astype(np.float64) for images in (ours, theirs))
    with np.errstate(invalid="ignore"):
        return float(np.mean(~((a == b) | (np.abs(a - b) <= 0.01))))
