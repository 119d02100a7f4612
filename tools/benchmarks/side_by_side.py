"""The filter's step and other renderers, measured in one process on the same poses of the same map.

Every repeat takes another frame: one whole step of the filter is timed, with fewer triangles and exactly, and then
every tool renders the poses of the first of these steps, of the whole map. So view and the machine's mood are alike for
all. A tool is called with camera-to-world matrices `(N, 4, 4)`, optical convention; what it needs to be asked (rays, a
plotter) is made outside the seconds that count.
"""

import time
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

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


# A loop that takes seconds for 200 images is run for so many of them and reckoned up.
LOOPED_IMAGES = 20


class Timed(NamedTuple):
    """What one call gave."""

    seconds: float  # for all N images, reckoned up where only some were rendered
    images: np.ndarray  # `(n, H, W)`, the first n; `inf` where nothing was hit


Tool = Callable[[np.ndarray], Timed]


def open3d_embree(scene_map: SceneMap, camera: DepthCamera) -> Tool:
    """Open3D's `RaycastingScene`, Intel's Embree on all processors: the casting alone, of rays that are ready."""
    import open3d as o3d

    anchor = scene_map.origin
    scene = o3d.t.geometry.RaycastingScene()
    scene.add_triangles(
        o3d.core.Tensor((scene_map.vertices - anchor).astype(np.float32)),
        o3d.core.Tensor(scene_map.faces.astype(np.uint32)),
    )
    rays = camera.rays().reshape(-1, 3)

    def cast(poses: np.ndarray) -> Timed:
        directions = np.einsum("nij,pj->npi", poses[:, :3, :3], rays)
        origins = np.broadcast_to((poses[:, :3, 3] - anchor)[:, None], directions.shape)
        tensor = o3d.core.Tensor(np.concatenate([origins, directions], axis=-1).astype(np.float32))
        begun = time.perf_counter()
        hits = scene.cast_rays(tensor)["t_hit"]
        seconds = time.perf_counter() - begun
        return Timed(seconds, hits.numpy().reshape(-1, *camera.shape))

    return cast


def course_backend(backend: str, scene_map: SceneMap, camera: DepthCamera, one_by_one: bool = False) -> Tool:
    """One of the course's own backends; one_by_one: a render and a read-back for each particle, half of them timed."""
    pixels = camera.width * camera.height if one_by_one else 200 * camera.width * camera.height
    renderer = DepthRenderer(scene_map, camera, backend, exact=True, max_batch_pixels=pixels)

    def render(poses: np.ndarray) -> Timed:
        asked = poses[:LOOPED_IMAGES] if one_by_one else poses
        begun = time.perf_counter()
        images = renderer.render_poses(asked)
        return Timed((time.perf_counter() - begun) * len(poses) / len(asked), images)

    return render


def pyvista_loop(scene_map: SceneMap, camera: DepthCamera) -> Tool:
    """PyVista as its documentation shows it: a plotter, a camera a particle, `get_image_depth`."""
    import pyvista as pv

    anchor = scene_map.origin
    faces = np.column_stack([np.full(len(scene_map.faces), 3), scene_map.faces])
    plotter = pv.Plotter(off_screen=True, window_size=(camera.width, camera.height), lighting="none")
    plotter.add_mesh(pv.PolyData(scene_map.vertices - anchor, faces.ravel()), lighting=False)
    plotter.disable_anti_aliasing()
    projection = pv.vtkmatrix_from_array(camera.projection_matrix())  # its own view angle takes fx for fy
    plotter.camera.SetUseExplicitProjectionTransformMatrix(True)
    plotter.camera.SetExplicitProjectionTransformMatrix(projection)
    plotter.show(auto_close=False)

    def render(poses: np.ndarray) -> Timed:
        images = np.empty((min(LOOPED_IMAGES, len(poses)), *camera.shape), dtype=np.float32)
        begun = time.perf_counter()
        for pose, image in zip(poses, images, strict=False):
            position = pose[:3, 3] - anchor
            plotter.camera.position, plotter.camera.focal_point = position, position + pose[:3, 2]
            plotter.camera.up = -pose[:3, 1]
            plotter.render()
            plotter.camera.clipping_range = (camera.near, camera.far)  # by which depths are read
            image[:] = -plotter.get_image_depth(fill_value=-np.inf, reset_camera_clipping_range=False)
        return Timed((time.perf_counter() - begun) * len(poses) / len(images), images)

    return render


TOOLS: dict[str, tuple[str, Callable[[SceneMap, DepthCamera], Tool]]] = {
    "embree": ("Open3D RaycastingScene (Embree), casting alone", open3d_embree),
    "embreex": ("trimesh's embreex, a particle at a time", lambda m, c: course_backend("ray", m, c)),
    "vtk_tiles": ("OpenGL, tiles of one window (backend vtk)", lambda m, c: course_backend("vtk", m, c)),
    "vtk_loop": ("OpenGL, one VTK render per particle", lambda m, c: course_backend("vtk", m, c, one_by_one=True)),
    "pyvista": ("PyVista get_image_depth per particle", pyvista_loop),
}


def told(values: np.ndarray) -> dict[str, float]:
    """Median, least and greatest."""
    return {"median": float(np.median(values)), "least": float(np.min(values)), "greatest": float(np.max(values))}


def measure(scene: Scene, tools: Sequence[str], repeats: int, n_particles: int = N_PARTICLES) -> dict[str, dict]:
    """Rows of the table: milliseconds of the step and of every tool, and how many times the step's time a tool takes.

    A first, untimed round compiles, opens windows and uploads maps; in it, a tool's images are compared with our exact
    ones. A tool that is not here has a row that says why.
    """
    camera, made, missing, rows = scene.camera(), {}, {}, {}
    for key in tools:
        try:
            made[key] = TOOLS[key][1](scene.scene_map, camera)
        except Exception as error:
            missing[TOOLS[key][0]] = {"missing": f"{type(error).__name__}: {error}"}
    frames = np.linspace(1, len(scene.sequence) - 1, repeats).astype(int)
    seconds = {key: [] for key in ("default", "exact", *made)}
    with DepthRenderer(scene.scene_map, camera) as default, DepthRenderer(scene.scene_map, camera, exact=True) as exact:
        for repeat, frame in enumerate([frames[0], *frames], start=-1):
            took, particles = timed_step(scene, default, int(frame), n_particles)
            exact_took, _ = timed_step(scene, exact, int(frame), n_particles)
            results = {key: tool(optical_pose(particles)) for key, tool in made.items()}
            if repeat < 0:
                ours = exact.render(particles[:LOOPED_IMAGES])
                rows = {
                    key: {"pixels_apart": share_apart(ours, one.images, camera.far)} for key, one in results.items()
                }
                continue
            taken = {"default": took, "exact": exact_took} | {key: one.seconds for key, one in results.items()}
            for key, value in taken.items():
                seconds[key].append(value)
    found = {key: np.array(values) for key, values in seconds.items()}
    steps = {f"step, {name}": {"ms": told(1000 * found[name])} for name in ("default", "exact")}
    beside = {
        TOOLS[key][0]: {
            "ms": told(1000 * found[key]),
            "times_default": told(found[key] / found["default"]),
            "times_exact": told(found[key] / found["exact"]),
            **rows[key],
        }
        for key in made
    }
    return steps | beside | missing


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
