"""Objects of a scene, `pyvista.PolyData` in the world (metres, z up) for `plotter.add_mesh`: map, frustum, axes, paths.

What a page's viewer (vtk.js) does not draw is not used: labels on the screen, scalar bars, lines whose width zooms.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from course_lib.geometry import as_states, optical_pose, pose_matrix

if TYPE_CHECKING:
    import pyvista

    from course_lib.rendering.camera import DepthCamera
    from course_lib.rendering.scene_map import SceneMap

AXIS_COLOURS = np.array([[213, 40, 0], [0, 158, 60], [0, 80, 200]], dtype=np.uint8)
"""Red x, green y, blue z, as robotics draws them; each axis also carries its letter."""
MAP_FACES = 20_000  # triangles of a map that a page shows: it stays below 1.3 MB, of which the viewer is 1.07

# The strokes of the letters x, y and z in a unit square, each stroke a pair of points.
_LETTERS = (
    [((0, 0), (1, 1)), ((0, 1), (1, 0))],
    [((0, 1), (0.5, 0.5)), ((1, 1), (0.5, 0.5)), ((0.5, 0.5), (0.5, -0.2))],
    [((0, 1), (1, 1)), ((1, 1), (0, 0)), ((0, 0), (1, 0))],
)


class SceneError(ValueError):
    """Something that cannot be drawn in a scene: a wrong shape, or values that are not finite."""


def new_plotter(
    viewpoint: np.ndarray | None = None, focus: np.ndarray | None = None, size: tuple[int, int] = (800, 500)
) -> pyvista.Plotter:
    """An empty scene: white, z up, off the screen. Without OpenGL it can become a page, and no picture (`draws`).

    viewpoint: from where it is seen, focus: the point in its middle, `(3,)` metres; without them the whole scene is
    seen from a corner above. size: pixels (width, height) of its picture.
    """
    from course_lib.rendering import vtk_backend

    pyvista = _pyvista()
    theme = pyvista.themes.DocumentTheme()  # white, whatever the reader's own theme is
    theme.cmap, theme.show_scalar_bar = "cividis", False  # safe colours; a page cannot show the bar
    theme.lighting_params.ambient, theme.lighting_params.diffuse = 0.35, 0.65  # no wall is black, no floor white
    with vtk_backend.quiet():
        plotter = pyvista.Plotter(off_screen=True, window_size=list(size), theme=theme)
    if viewpoint is not None:
        plotter.camera_position = [tuple(viewpoint), tuple(focus), (0.0, 0.0, 1.0)]
    return plotter


def draws(plotter: pyvista.Plotter) -> bool:
    """Return whether OpenGL can draw this scene. Without OpenGL, VTK makes a window in which drawing would crash."""
    return plotter.render_window.GetClassName() != "vtkOSOpenGLRenderWindow"


def map_mesh(scene_map: SceneMap, faces: int = MAP_FACES, below: float | None = None) -> pyvista.PolyData:
    """The map's triangles, at most `faces` of them, cut off at the height `below` (metres) so that one looks inside.

    Where the map has more, surfaces are merged (quadric decimation): fit to be looked at, not to be measured in.
    """
    from course_lib.rendering.simplification import simplified

    fewer = simplified(scene_map)
    mesh = polydata(fewer.vertices, fewer.faces)
    if below is not None:
        mesh = mesh.clip(normal="z", origin=(0.0, 0.0, float(below))).triangulate()
        if mesh.n_cells == 0:
            low, high = scene_map.bounds[:, 2]
            raise SceneError(f"nothing of the map lies below {below:g} m: heights go from {low:.2f} to {high:.2f} m")
    if mesh.n_cells > faces:
        mesh = mesh.clean().decimate(1 - faces / mesh.n_cells)
    mesh.clear_data()
    return mesh


def frustum(camera: DepthCamera, state: np.ndarray, far: float | None = None) -> pyvista.PolyData:
    """What a depth camera sees, as lines: from its centre to the corners of its image, and the planes near and far.

    state: `(6,)` of the camera's body, metres and radians. far: where it is cut off, metres (None: the camera's own).
    Edges are those of the image, half a pixel outside the outermost pixel centres.
    """
    far = camera.far if far is None else float(far)
    u = np.array([-0.5, camera.width - 0.5, camera.width - 0.5, -0.5])
    v = np.array([-0.5, -0.5, camera.height - 0.5, camera.height - 0.5])
    corners = np.stack([(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, np.ones(4)], axis=-1)
    points = np.vstack([np.zeros(3), camera.near * corners, far * corners])
    edges = [(0, 5 + k) for k in range(4)]
    edges += [(first + k, first + (k + 1) % 4) for first in (1, 5) for k in range(4)]
    return _lines(to_world(points, optical_pose(state)), edges)


def body_axes(state: np.ndarray, length: float = 0.5) -> pyvista.PolyData:
    """The axes of a pose: x red (forward), y green (left), z blue (up), each with its letter at the end.

    state: `(6,)`, metres and radians; length: metres. Colours are point data: draw with `add_mesh(axes, rgb=True)`.
    """
    matrix = pose_matrix(as_states(state))
    points, edges, colours = [], [], []
    for k, axis in enumerate(np.eye(3)):
        # The letter stands upright at the axis' end, for one who looks along x, to whose right -y lies.
        across, up = (np.eye(3)[0] if k == 0 else -np.eye(3)[1]), np.eye(3)[2]
        strokes = [(0.16 * (a - 0.5) * across + 0.16 * b * up for a, b in stroke) for stroke in _LETTERS[k]]
        letter = [[1.1 * axis + point for point in stroke] for stroke in strokes]
        for start, end in [(np.zeros(3), axis), *letter]:
            edges.append((len(points), len(points) + 1))
            points += [length * start, length * end]
            colours += [AXIS_COLOURS[k]] * 2
    mesh = _tubes(to_world(np.array(points), matrix), edges, 0.02 * length)
    mesh.point_data["colour"] = np.repeat(np.array(colours), mesh.n_points // len(colours), axis=0)
    mesh.set_active_scalars("colour")
    return mesh


def ellipsoid(mean: np.ndarray, covariance: np.ndarray, sigmas: float = 3.0) -> pyvista.PolyData:
    """The surface (p - mean)' C^-1 (p - mean) = sigmas^2 of a covariance: half axes of sigmas standard deviations.

    mean: `(..., 3)` metres. covariance: `(..., 3, 3)` square metres; of rank two (nothing said of height) it is a disc.
    """
    covariance = finite(covariance, "covariance")
    if covariance.shape[-2:] != (3, 3):
        raise SceneError(f"covariance must have shape (..., 3, 3); got {covariance.shape}. Of a state's: [:3, :3]")
    covariance = covariance.reshape(-1, 3, 3)
    mean = finite(mean, "mean").reshape(-1, 3)
    variances, axes = np.linalg.eigh(covariance)
    if (variances < -1e-6 * np.abs(variances).max(axis=-1, keepdims=True)).any():
        raise SceneError(f"a covariance has no negative variance; got {variances.min():.3g} m^2 along one of its axes")
    # An eigenvector's sign is anybody's choice; the ellipsoid is the same, and so, this way, are its points.
    largest_entry = np.take_along_axis(axes, np.abs(axes).argmax(axis=-2, keepdims=True), axis=-2)
    axes = axes * np.where(largest_entry < 0, -1.0, 1.0)
    ball = _pyvista().Icosphere(radius=1.0, nsub=2)
    half_axes = sigmas * axes * np.sqrt(np.maximum(variances, 0))[:, None, :]
    points = np.einsum("nij,kj->nki", half_axes, np.asarray(ball.points)) + mean[:, None]
    faces = ball.regular_faces + ball.n_points * np.arange(len(mean))[:, None, None]
    return polydata(points.reshape(-1, 3), faces.reshape(-1, 3))


def path(points: np.ndarray, dashed: bool = False) -> pyvista.PolyData:
    """A trajectory as a line through positions `(N, 3)`, metres; dashed: every other piece of it is left out."""
    points = finite(points, "points")
    if points.ndim != 2 or points.shape[1] != 3 or len(points) < 2:
        raise SceneError(f"points must have shape (N, 3), N at least 2; got {points.shape}. Of states: states[:, :3]")
    return _lines(points, [(k, k + 1) for k in range(0, len(points) - 1, 2 if dashed else 1)])


def post(foot: np.ndarray, height: float, radius: float = 0.03) -> pyvista.PolyData:
    """A thin upright post on a point `(3,)`: something of which the place is known, but not the shape. Metres."""
    return _tubes(np.stack([foot, foot + np.array([0.0, 0.0, height])]), [(0, 1)], radius)


def text(words: str, at: np.ndarray, height: float = 0.2) -> pyvista.PolyData:
    """Words in ASCII as letters that lie flat, their foot towards -y, from the point `(3,)` on; capital height [m]."""
    pyvista = _pyvista()
    from vtkmodules.vtkRenderingFreeType import vtkVectorText

    source = vtkVectorText()
    source.SetText(words)
    source.Update()
    letters = pyvista.PolyData(source.GetOutput())
    points = np.asarray(letters.points, float) - [letters.bounds[0], 0.0, 0.0]
    letters.points = (points * height + np.asarray(at)).astype(np.float32)
    letters.clear_data()
    return letters


def to_world(points: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """Points `(N, 3)` of a frame in the world, by that frame's pose `(4, 4)`."""
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def _lines(points: np.ndarray, edges: list[tuple[int, int]]) -> pyvista.PolyData:
    """A PolyData of points `(N, 3)` with a line for each pair of them."""
    cells = np.column_stack([np.full(len(edges), 2), np.asarray(edges)])
    return _pyvista().PolyData(np.asarray(points, dtype=np.float32), lines=cells.ravel())


def _tubes(points: np.ndarray, edges: list[tuple[int, int]], radius: float) -> pyvista.PolyData:
    """Lines as thin prisms of four sides: unlike a line they grow when one comes nearer. Eight points an edge."""
    start, end = (np.asarray(points)[[edge[k] for edge in edges]] for k in (0, 1))
    along = (end - start) / np.linalg.norm(end - start, axis=-1, keepdims=True)
    helper = np.eye(3)[np.abs(along).argmin(axis=-1)]
    side = np.cross(along, helper)
    side /= np.linalg.norm(side, axis=-1, keepdims=True)
    other = np.cross(along, side)
    ring = np.stack([side, other, -side, -other], axis=1) * radius
    corners = np.concatenate([start[:, None] + ring, end[:, None] + ring], axis=1)
    sides = [(k, (k + 1) % 4, 4 + (k + 1) % 4) for k in range(4)] + [(k, 4 + (k + 1) % 4, 4 + k) for k in range(4)]
    faces = np.array(sides) + 8 * np.arange(len(edges))[:, None, None]
    return polydata(corners.reshape(-1, 3), faces.reshape(-1, 3))


def polydata(vertices: np.ndarray, faces: np.ndarray) -> pyvista.PolyData:
    """A PolyData of vertices `(V, 3)` and triangles `(F, 3)`; single precision is a tenth of a millimetre at 1 km."""
    return _pyvista().PolyData.from_regular_faces(np.asarray(vertices, dtype=np.float32), np.asarray(faces, np.int64))


def finite(values: np.ndarray, name: str, shape: tuple[int, ...] | None = None) -> np.ndarray:
    array = np.asarray(values, dtype=np.float64)
    if shape is not None and array.shape != shape:
        raise SceneError(f"{name} must have shape {shape}; got {array.shape}")
    if array.size == 0 or not np.isfinite(array).all():
        raise SceneError(f"{name} must be numbers, all of them finite; got {'NaN or inf' if array.size else 'none'}")
    return array


def _pyvista():
    """PyVista, its windows off the screen; imported late, since it takes a second."""
    import course_lib.rendering.vtk_backend  # noqa: F401, I001 - before pyvista: no display is needed then
    import pyvista

    return pyvista
