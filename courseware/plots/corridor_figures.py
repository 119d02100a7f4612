"""Figures of the corridor: like the paper's 5 and 6, the whole idea in one picture, and cuts through the map."""

import numpy as np
import trimesh
from matplotlib.figure import Figure

from course_lib.depth_mcl.evaluation import PAPER_SIGMA
from course_lib.depth_mcl.likelihood import likelihood, valid_pixels
from course_lib.depth_mcl.sequence import DepthSequence
from course_lib.recordings import Run
from course_lib.rendering.renderer import Backend, DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from courseware.plots.figures import depth_images, line_style, new_figure

BESIDE = np.array([-0.5, 0.0, 0.0, 0.0, 0.0, np.deg2rad(4.0)])  # from the estimate: half a metre back, four degrees


def figure_5(path: np.ndarray, estimates: dict[str, np.ndarray], walls: np.ndarray | None = None) -> Figure:
    """Ground truth and estimated positions from above; y is drawn enlarged.

    path: `(P, 2 or 3)` metres. estimates: name -> `(T, 2 or 3)`. walls: `(M, 2)` map points at one height.
    """
    figure, axes = new_figure(size=(8.0, 3.4))
    if walls is not None:
        axes.plot(walls[:, 0], walls[:, 1], ".", color="#B8B8B8", markersize=0.6, label="map, cut at camera height")
    line = {"color": "black", "linewidth": 1.1, "zorder": 4}  # on top of the markers, or 300 of them would hide it
    axes.plot(path[:, 0], path[:, 1], label="ground truth: line on the floor", **line)
    for index, (name, positions) in enumerate(estimates.items()):
        style = line_style(index) | {"linestyle": "none", "markersize": 3.2}
        axes.plot(positions[:, 0], positions[:, 1], label=name, **style)
    low, high = path[:, 0].min() - 1.5, path[:, 0].max() + 3.0
    axes.set_title("Ground truth and estimated positions (like the paper's figure 5)")
    axes.set(xlim=(low, high), ylim=(-2.2, 2.9), xlabel="x along the corridor [m]", ylabel="y [m] (enlarged)")
    axes.legend(loc="upper center", ncols=3, fontsize=8, framealpha=0.95, markerscale=1.5)
    return figure


def figure_6(frames: np.ndarray, errors: dict[str, np.ndarray], title: str | None = None) -> Figure:
    """Error of every frame, name -> `(T,)` metres, on a logarithmic axis, with the paper's three sigma."""
    figure, axes = new_figure(size=(8.0, 3.4))
    for index, (name, values) in enumerate(errors.items()):
        style = line_style(index) | {"marker": "", "linewidth": 1.2}
        axes.semilogy(frames, np.maximum(values, 1e-3), label=name, **style)
    limit = 3 * PAPER_SIGMA
    style = {"color": "black", "linewidth": 0.9, "linestyle": (0, (6, 3))}
    axes.axhline(limit, label=f"3 sigma of the paper, {limit:.2f} m", **style)
    axes.set(title=title or "Error of every frame (like the paper's figure 6)", xlabel="frame [-]", ylabel="error [m]")
    axes.legend(loc="upper center", ncols=2, fontsize=8, framealpha=0.95)
    axes.set_ylim(1e-3, max(2.0, *(6 * float(np.max(values)) for values in errors.values())))
    return figure


def overview_figure(scene_map: SceneMap, sequence: DepthSequence, run: Run, backend: Backend = "raster") -> Figure:
    """The middle frame of a run in x, y, yaw: the measured image, the map from the estimate, the map from beside it.

    Agreement is eq. (8) divided by the number of measured pixels, 0 to 1.
    """
    index = len(run.frames) // 2
    camera = sequence.camera()
    with DepthRenderer(scene_map, camera, backend) as renderer:
        measured = renderer.render_points(camera.points(sequence.depth(index)))
        simulated = renderer.render(np.stack([run.states[index], run.states[index] + BESIDE]))
    agreement = likelihood(measured, simulated) / max(1, valid_pixels(measured).sum())
    titles = (
        "Measured by the depth camera",
        f"Map from the estimate: agreement {agreement[0]:.2f}",
        f"Map from 0.5 m, 4 degrees beside it: {agreement[1]:.2f}",
    )
    return depth_images((measured, *simulated), titles, (0.0, 10.0), size=(10.5, 3.2))


def floor_plan(vertices: np.ndarray, height: float, thickness: float = 0.05) -> np.ndarray:
    """Map vertices `(M, 2)` within `thickness` metres of a height: what a horizontal cut would show."""
    return vertices[np.abs(vertices[:, 2] - height) < thickness][:, :2]


def plane_cut(vertices: np.ndarray, faces: np.ndarray, axis: int, position: float) -> np.ndarray:
    """Segments `(M, 2, 2)` [m] where the plane "coordinate `axis` = position" cuts the triangles of a mesh.

    axis: 0, 1 or 2 for x, y or z. The other two coordinates are kept, in their order.
    """
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    origin, normal = np.zeros(3), np.zeros(3)
    origin[axis], normal[axis] = position, 1.0
    return np.delete(trimesh.intersections.mesh_plane(mesh, normal, origin), axis, axis=2)
