"""From registered scans to a triangle mesh: truncated signed distances on a voxel grid, iso-surface, decimation.

A voxel that no station saw stays empty, so what was hidden on the survey day remains a hole.
Source: Curless and Levoy, "A volumetric method for building complex models from range images", SIGGRAPH 1996.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from courseware.simulation.corridor.mesh_building import to_polydata
from courseware.simulation.sensors.laser_survey import RegisteredScan

_BLOCK = 8  # voxels along the edge of a block; only blocks near measured points are worked on

Pair = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class FusionModel:
    """How the surface is fused."""

    voxel: float = 0.025  # m; chosen
    truncation: float = 0.075  # m: signed distances are cut here, three voxels; chosen
    greatest_range: float = 9.0  # m: farther points of a station are too sparse for the voxel; chosen
    slab: float = 2.0  # m along x; chosen
    least_component: int = 150  # triangles: smaller loose pieces (mixed pixels) are removed; chosen
    triangles: int = 120_000  # after decimation; chosen


def fuse(scans: list[RegisteredScan], model: FusionModel, progress=lambda slabs: slabs) -> Pair:
    """Surface of the scans at their registered poses: vertices `(V, 3)` metres, faces `(F, 3)`, before decimation."""
    block = _BLOCK * model.voxel
    clouds = [(scan.points(), scan.registered_pose[:3, 3]) for scan in scans]
    near = [points[np.linalg.norm(points - eye, axis=1) < model.greatest_range] for points, eye in clouds]
    if not sum(map(len, near)):
        raise ValueError("the scans hold no surface")
    occupied = np.unique(np.floor(np.concatenate(near) / block).astype(np.int32), axis=0)
    blocks = np.unique((occupied[:, None] + _grid([-1, 0, 1])).reshape(-1, 3), axis=0)
    low, high = blocks.min(axis=0), blocks.max(axis=0) + 1
    images = [_range_image(scan) for scan in scans]
    per_slab = max(1, round(model.slab / block))
    vertices, faces, n_vertices = [], [], 0
    for start in progress(range(low[0], high[0], per_slab)):
        # One more layer of voxels than the slab is long: neighbouring slabs share it and their vertices there.
        mine = blocks[(blocks[:, 0] >= start) & (blocks[:, 0] <= start + per_slab)]
        if len(mine) == 0:
            continue
        size = np.array([per_slab * _BLOCK + 1, *((high - low)[1:] * _BLOCK)])
        origin = np.array([start, low[1], low[2]]) * _BLOCK
        distance, weight = _integrate(scans, images, mine, origin, size, model)
        slab_vertices, slab_faces = _iso_surface(distance, weight > 0)
        if len(slab_faces):
            vertices.append(slab_vertices + origin)
            faces.append(slab_faces + n_vertices)
            n_vertices += len(slab_vertices)
    return _weld(np.concatenate(vertices) * model.voxel, np.concatenate(faces))


def _grid(steps: Sequence[int]) -> np.ndarray:
    """All points `(n^3, 3)` with these steps along each axis."""
    return np.stack(np.meshgrid(*[steps] * 3, indexing="ij"), axis=-1).reshape(-1, 3)


def simplify(vertices: np.ndarray, faces: np.ndarray, model: FusionModel) -> Pair:
    """Removes loose pieces and decimates by quadric errors to `model.triangles`; vertices come back as float32."""
    mesh = to_polydata(vertices, faces)
    labels = mesh.connectivity("all").cell_data["RegionId"]
    keep = np.bincount(labels)[labels] >= model.least_component
    mesh = to_polydata(*_weld(vertices, faces[keep]))
    if model.triangles < mesh.n_cells:
        mesh = mesh.decimate(1.0 - model.triangles / mesh.n_cells)
    return _weld(np.asarray(mesh.points, np.float32), np.asarray(mesh.regular_faces))


def _range_image(scan: RegisteredScan) -> Pair:
    """Ranges and cosines of incidence `(E, A)` of a scan; the slopes are one-sided where the other side jumps."""
    ranges = scan.ranges.astype(np.float64)
    reach = 3  # pixels: a slope over one pixel would be mostly noise
    step = scan.azimuths[1] - scan.azimuths[0]
    slope_azimuth = _smaller(ranges - np.roll(ranges, reach, axis=1), np.roll(ranges, -reach, axis=1) - ranges)
    before, after = np.full_like(ranges, np.nan), np.full_like(ranges, np.nan)
    before[reach:], after[:-reach] = ranges[reach:] - ranges[:-reach], ranges[reach:] - ranges[:-reach]
    slope_elevation = _smaller(before, after)
    with np.errstate(invalid="ignore"):
        across = slope_azimuth / (reach * step * ranges * np.maximum(np.cos(scan.elevations), 0.02)[:, None])
        up = slope_elevation / (reach * step * ranges)
        cosine = 1.0 / np.sqrt(1.0 + across**2 + up**2)
    return scan.ranges, np.where(np.isfinite(cosine), cosine, 1.0).astype(np.float32)


def _smaller(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The difference that is smaller in size; the other one where one is missing; 0 where both are."""
    size_a, size_b = np.where(np.isnan(a), np.inf, np.abs(a)), np.where(np.isnan(b), np.inf, np.abs(b))
    return np.nan_to_num(np.where(size_a < size_b, a, b))


def _integrate(
    scans: list[RegisteredScan],
    images: list,
    blocks: np.ndarray,
    origin: np.ndarray,
    size: np.ndarray,
    model: FusionModel,
) -> Pair:
    """Weighted mean of truncated signed distances on one slab, in metres, and the weights; both `size`."""
    index = (blocks[:, None] * _BLOCK + _grid(range(_BLOCK)) - origin).reshape(-1, 3)
    index = index[(index < size).all(axis=1)]
    world = (index + origin) * model.voxel
    total, weight = np.zeros(len(index)), np.zeros(len(index))
    middle = world.mean(axis=0)
    for scan, (ranges, cosines) in zip(scans, images, strict=True):
        if abs(middle[0] - scan.registered_pose[0, 3]) > model.greatest_range + model.slab:
            continue
        local = (world - scan.registered_pose[:3, 3]) @ scan.registered_pose[:3, :3]
        far = np.linalg.norm(local, axis=1)
        # The nearest row and column of the scan.
        step = scan.azimuths[1] - scan.azimuths[0]
        elevation = np.arcsin(np.clip(local[:, 2] / np.maximum(far, 1e-9), -1.0, 1.0))
        row = np.rint((elevation - scan.elevations[0]) / step).astype(np.int64)
        column = np.rint((np.arctan2(local[:, 1], local[:, 0]) - scan.azimuths[0]) / step).astype(np.int64)
        column %= len(scan.azimuths)
        seen = (row >= 0) & (row < len(scan.elevations)) & (far < model.greatest_range) & (far > 0.1)
        row, column, far = row[seen], column[seen], far[seen]
        measured, cosine = ranges[row, column], cosines[row, column]
        # Along the ray the gap is longer than across to the surface: times the cosine of incidence. Behind a grazing
        # surface that would reach metres deep, so the gap along the ray is bounded too.
        gap = measured - far
        distance = gap * np.maximum(cosine, 0.05)
        with np.errstate(invalid="ignore"):
            good = (distance > -model.truncation) & (gap > -2 * model.truncation)
            behind = np.clip((distance + model.truncation) / (model.truncation - model.voxel), 0.0, 1.0)
        w = np.where(good, cosine * behind * np.minimum(1.0, (3.0 / far) ** 2), 0.0)
        where = np.flatnonzero(seen)
        total[where] += w * np.where(good, np.minimum(distance, model.truncation), 0.0)
        weight[where] += w
    distances, weights = np.full(size, model.truncation, np.float32), np.zeros(size, np.float32)
    place = tuple(index.T)
    distances[place] = np.where(weight > 0, total / np.where(weight > 0, weight, 1.0), model.truncation)
    weights[place] = np.where(weight > 0.02, weight, 0.0)
    return distances, weights


def _iso_surface(distance: np.ndarray, observed: np.ndarray) -> Pair:
    """Zero surface in voxel units, without the triangles of cells that have an unobserved corner."""
    import pyvista

    grid = pyvista.ImageData(dimensions=distance.shape)
    grid.point_data["distance"] = distance.ravel(order="F")
    surface = grid.contour([0.0], scalars="distance", method="flying_edges", compute_normals=False)
    if surface.n_cells == 0:
        return np.empty((0, 3)), np.empty((0, 3), int)
    points, faces = np.asarray(surface.points, np.float64), surface.regular_faces
    whole = np.lib.stride_tricks.sliding_window_view(observed, (2, 2, 2)).all(axis=(3, 4, 5))
    cell = np.clip(np.floor(points[faces].mean(axis=1)).astype(int), 0, np.array(whole.shape) - 1)
    return points, faces[whole[tuple(cell.T)]]


def _weld(vertices: np.ndarray, faces: np.ndarray) -> Pair:
    """One vertex per place; unused vertices and triangles without three corners are dropped."""
    used, inverse = np.unique(vertices[faces].reshape(-1, 3), axis=0, return_inverse=True)
    faces = inverse.reshape(-1, 3)
    proper = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    return used, faces[proper]
