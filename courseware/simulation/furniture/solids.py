"""The solids of furniture and rooms, as textured triangles; a piece is built with x forward, y left, floor at z = 0."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import trimesh

from course_lib.geometry import pose_matrix
from courseware.simulation.room.scene import RoomObject
from courseware.simulation.textures import Meshes, Surface, TexturedMesh

CELL = 0.4  # metres: longest edge of a flat cell, because straight edges bulge in a panorama

Triple = Sequence[float]

# The six sides of a box: normal axis, its sign, axis along, its sign, axis up, its sign; along x up = outward normal.
SIDES = (
    (0, 1, 1, 1, 2, 1),
    (0, -1, 1, -1, 2, 1),
    (1, 1, 0, -1, 2, 1),
    (1, -1, 0, 1, 2, 1),
    (2, 1, 1, 1, 0, -1),
    (2, -1, 1, 1, 0, 1),
)


@dataclass(frozen=True)
class Piece:
    """label: class name. meshes: one for each texture, in the piece's frame; the origin is the footprint's centre."""

    label: str
    meshes: tuple[TexturedMesh, ...]

    @classmethod
    def of(cls, label: str, meshes: Sequence[TexturedMesh]) -> Piece:
        """A piece from its parts, shifted so that the footprint's centre is the origin."""
        vertices = np.concatenate([mesh.vertices for mesh in meshes])
        x, y = -(vertices[:, :2].min(axis=0) + vertices[:, :2].max(axis=0)) / 2
        return cls(label, tuple(turn(joined(meshes), x, y)))

    @property
    def size(self) -> np.ndarray:
        """`(3,)` depth, width, height in metres."""
        vertices = np.concatenate([mesh.vertices for mesh in self.meshes])
        return np.append(np.ptp(vertices[:, :2], axis=0), vertices[:, 2].max())

    def at(self, x: float, y: float, heading: float, z: float = 0.0) -> RoomObject:
        """The piece standing in the room, its front towards heading (radians); z: metres above the floor."""
        meshes = tuple(turn(self.meshes, x, y, z, heading))
        return RoomObject(self.label, float(x), float(y), float(heading), meshes)


def grid_faces(rows: int, columns: int) -> np.ndarray:
    """Triangles `(2 (rows - 1) (columns - 1), 3)` of a grid of points in row order, normal = along the row x up."""
    first = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)[None, :]).reshape(-1)
    lower = np.stack([first, first + 1, first + 1 + columns], 1)
    upper = np.stack([first, first + 1 + columns, first + columns], 1)
    return np.concatenate([lower, upper])


def textured(vertices: np.ndarray, faces: np.ndarray, metres: np.ndarray, surface: Surface) -> TexturedMesh:
    """A mesh whose texture coordinates are metres `(n, 2)` on the surface."""
    return TexturedMesh(vertices, faces, metres / np.asarray(surface.size), surface.image, surface.emission)


def panel(corner: Triple, along: Triple, up: Triple, surface: Surface, fit=False, cell: float = CELL) -> TexturedMesh:
    """A flat rectangle from its lower left corner as seen from outside; fit: the picture covers it exactly once."""
    corner, along, up = (np.asarray(vector, float) for vector in (corner, along, up))
    length = np.array([np.linalg.norm(along), np.linalg.norm(up)])
    columns, rows = np.maximum(1, np.ceil(length / cell - 1e-9)).astype(int)
    s, t = np.meshgrid(np.linspace(0.0, 1.0, columns + 1), np.linspace(0.0, 1.0, rows + 1))
    s, t = s.reshape(-1, 1), t.reshape(-1, 1)
    metres = np.concatenate([s, t], 1) * (surface.size if fit else length)
    if not fit:
        metres = metres + np.array([corner @ along, corner @ up]) / length
    return textured(corner + s * along + t * up, grid_faces(rows + 1, columns + 1), metres, surface)


def box(size: Triple, centre: Triple, surface: Surface, front: Surface | None = None) -> Meshes:
    """A box; front: a picture that covers the side towards +x exactly once."""
    dx, dy, dz = np.asarray(size, float)
    x0, y0, z0 = np.asarray(centre, float) - (dx / 2, dy / 2, dz / 2)
    x1, y1, z1 = x0 + dx, y0 + dy, z0 + dz
    return [
        panel((x1, y0, z0), (0, dy, 0), (0, 0, dz), front or surface, fit=front is not None),
        panel((x0, y1, z0), (0, -dy, 0), (0, 0, dz), surface),
        panel((x1, y1, z0), (-dx, 0, 0), (0, 0, dz), surface),
        panel((x0, y0, z0), (dx, 0, 0), (0, 0, dz), surface),
        panel((x1, y0, z1), (0, dy, 0), (-dx, 0, 0), surface),
        panel((x0, y0, z0), (0, dy, 0), (dx, 0, 0), surface),
    ]


def rounded_box(size: Triple, centre: Triple, surface: Surface, radius: float = 0.04, bulge: float = 0.0) -> Meshes:
    """A box with rounded edges; radius: metres; bulge: metres by which its upper side rises in the middle."""
    half = np.asarray(size, float) / 2
    radius = min(radius, 0.98 * float(half.min()))
    steps = []
    for extent in half:
        count = max(1, int(np.ceil(2 * (extent - radius) / CELL)), 4 if bulge else 1)
        inner = np.linspace(-(extent - radius), extent - radius, count + 1)
        bend = radius * np.tan(np.radians([22.5, 45.0]))
        steps.append(np.concatenate([inner[0] - bend[::-1], inner, inner[-1] + bend]))
    meshes = []
    for normal, sign, along, s_sign, up, t_sign in SIDES:
        s, t = np.meshgrid(steps[along][::s_sign], steps[up][::t_sign])
        points = np.empty((s.size, 3))
        points[:, normal], points[:, along], points[:, up] = sign * half[normal], s.reshape(-1), t.reshape(-1)
        core = np.clip(points, -(half - radius), half - radius)
        offset = points - core
        vertices = core + radius * offset / np.linalg.norm(offset, axis=1, keepdims=True)
        if bulge:
            dome = np.prod(1.0 - (vertices[:, :2] / half[:2]) ** 2, axis=1)
            vertices[:, 2] += bulge * np.clip(dome, 0.0, 1.0) * (vertices[:, 2] > 0)
        metres = np.stack([s_sign * points[:, along], t_sign * points[:, up]], 1) + np.array([centre[1], centre[2]])
        faces = grid_faces(len(steps[up]), len(steps[along]))
        meshes.append(textured(vertices + np.asarray(centre, float), faces, metres, surface))
    return meshes


def lathe(profile: Sequence, centre: Triple, surface: Surface, n: int = 18, stretch: tuple = (1.0, 1.0)) -> Meshes:
    """A solid of revolution about the vertical axis through centre; profile: (radius, height) from below to above."""
    profile = np.asarray(profile, float)
    angle = np.linspace(0.0, 2 * np.pi, n + 1)
    ring = np.stack([np.cos(angle) * stretch[0], np.sin(angle) * stretch[1], np.zeros(n + 1)], 1)
    widest = profile[:, 0].max()
    meshes, height = [], 0.0
    for (r0, z0), (r1, z1) in itertools.pairwise(profile):
        rings = [ring * radius + np.asarray(centre, float) + (0, 0, z) for radius, z in ((r0, z0), (r1, z1))]
        vertices = np.concatenate(rings)
        slope = float(np.hypot(r1 - r0, z1 - z0))
        if abs(r1 - r0) > 2.0 * abs(z1 - z0):
            metres = vertices[:, :2] * (1.0, 1.0 if r1 < r0 else -1.0)
        else:
            metres = np.stack([np.tile(angle * widest, 2), np.repeat([height, height + slope], n + 1)], 1)
        height += slope
        keep = np.repeat([r0 > 0, r1 > 0], n)  # a ring without radius is a point: no triangles along it
        meshes.append(textured(vertices, grid_faces(2, n + 1)[keep], metres, surface))
    return meshes


def cylinder(
    radius: float, height: float, centre: Triple, surface: Surface, top: float | None = None, n: int = 14
) -> Meshes:
    """An upright cylinder, or a cone's frustum with another radius at the top; centre: of its lower end."""
    upper = radius if top is None else top
    return lathe([(0.0, 0.0), (radius, 0.0), (upper, height), (0.0, height)], centre, surface, n)


def swept(
    path: np.ndarray, side: np.ndarray, widths: np.ndarray, thicknesses: np.ndarray, surface: Surface, n: int = 8
) -> Meshes:
    """A bar or a leaf along a path `(k, 3)`: elliptic sections of half-axes widths (along side) and thicknesses."""
    tangent = np.gradient(path, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    across = side - (tangent @ side)[:, None] * tangent
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    upward = np.cross(tangent, across)
    angle = np.linspace(0.0, 2 * np.pi, n + 1)
    section = np.cos(angle)[None, :, None] * (across * widths[:, None])[:, None]
    section = section + np.sin(angle)[None, :, None] * (upward * thicknesses[:, None])[:, None]
    k = len(path)
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    reach = float(np.max(widths))
    metres = np.stack([np.tile(reach * (1 - np.cos(angle)), k), np.repeat(along, n + 1)], 1)
    meshes = [textured((path[:, None] + section).reshape(-1, 3), grid_faces(k, n + 1), metres, surface)]
    for end, order in ((0, slice(None, None, -1)), (k - 1, slice(None))):
        rim = np.concatenate([path[end : end + 1], (path[end] + section[end])[order]])
        fan = np.stack([np.zeros(n, int), np.arange(1, n + 1), np.arange(2, n + 2)], 1)
        flat = np.stack([(rim - path[end]) @ across[end], (rim - path[end]) @ upward[end]], 1)
        meshes.append(textured(rim, fan, flat, surface))
    return meshes


def rod(points: Sequence[Triple], radius: float, surface: Surface, n: int = 8) -> Meshes:
    """A round bar through the points."""
    path = np.asarray(points, float)
    side = np.eye(3)[int(np.argmin(np.abs(path[-1] - path[0])))]
    radii = np.full(len(path), radius)
    return swept(path, side, radii, radii, surface, n)


def turn(
    meshes: Sequence[TexturedMesh], x: float = 0.0, y: float = 0.0, z: float = 0.0, yaw: float = 0.0, pitch: float = 0.0
) -> Meshes:
    """The meshes pitched about y (positive leans the top towards +x), turned by yaw about z, then shifted."""
    pose = pose_matrix(np.array([x, y, z, 0.0, pitch, yaw]))
    return [mesh.moved(pose) for mesh in meshes]


def joined(meshes: Sequence[TexturedMesh]) -> tuple[TexturedMesh, ...]:
    """One mesh per texture, because every mesh costs a draw call; in the order in which the textures first appear."""
    groups: dict[tuple[int, float], list[TexturedMesh]] = {}
    for mesh in meshes:
        groups.setdefault((id(mesh.texture), mesh.emission), []).append(mesh)
    result = []
    for group in groups.values():
        vertices, faces = merged(group)
        coordinates = np.concatenate([mesh.texture_coordinates for mesh in group])
        result.append(TexturedMesh(vertices, faces, coordinates, group[0].texture, group[0].emission))
    return tuple(result)


def merged(meshes: Sequence[TexturedMesh]) -> tuple[np.ndarray, np.ndarray]:
    """All triangles of the meshes: vertices `(V, 3)`, faces `(F, 3)`."""
    return trimesh.util.append_faces([mesh.vertices for mesh in meshes], [mesh.faces for mesh in meshes])
