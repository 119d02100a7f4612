"""Small scenes of lesson 03: a corridor and its end, a pole, a wall with a hole, two surfaces from the side."""

import numpy as np

from course_lib.lessons.kit.box_world import box_map
from course_lib.rendering.scene_map import SceneMap

# The side view of the idea: two surfaces (ends as depth, height in metres) and the slopes of seven rays.
SURFACES = (((3.0, -0.75), (3.4, 0.35)), ((5.2, -1.5), (5.2, 1.6)))
SLOPES = np.linspace(-0.24, 0.24, 7)


def corridor_end() -> SceneMap:
    """What stands ahead at the end of a corridor: the end wall (8 m), a pillar (5 m) and a crate (4 m)."""
    return box_map(
        ((8.0, -1.5, 0.0), (8.2, 1.5, 2.6)),
        ((5.0, 0.5, 0.0), (5.3, 0.8, 2.6)),
        ((4.0, -0.8, 0.0), (4.5, -0.3, 0.7)),
    )


def corridor() -> SceneMap:
    """The same with floor, ceiling and side walls: 3 m wide, 2.6 m high, 8 m long."""
    ahead = corridor_end()
    shell = box_map(
        ((0.0, -1.5, -0.1), (8.2, 1.5, 0.0)),
        ((0.0, -1.5, 2.6), (8.2, 1.5, 2.7)),
        ((0.0, 1.5, 0.0), (8.2, 1.6, 2.6)),
        ((0.0, -1.6, 0.0), (8.2, -1.5, 2.6)),
    )
    faces = np.concatenate([ahead.faces, shell.faces + len(ahead.vertices)])
    return SceneMap(np.concatenate([ahead.vertices, shell.vertices]), faces)


def side_view() -> dict[str, list[tuple[float, float]]]:
    """Rays of seven pixels against two surfaces, from the side: depth and height [m] of the kept and hidden hits."""
    hits = {"kept": [], "hidden": []}
    for slope in SLOPES:
        depths = sorted(z for z in (_crossing(slope, start, end) for start, end in SURFACES) if z is not None)
        hits["kept"].append((depths[0], depths[0] * slope))
        hits["hidden"] += [(z, z * slope) for z in depths[1:]]
    return hits


def pole_ahead(distance: float, width: float) -> SceneMap:
    """A pole of square section, `width` metres thick, `distance` metres ahead of the origin."""
    half = width / 2
    return box_map(((distance, -half, -1.0), (distance + width, half, 1.0)))


def wall_with_hole(radius: float) -> SceneMap:
    """A wall of small triangles 4 m ahead, 6 m by 6 m, with a hole: none within `radius` metres of its middle."""
    n = 121
    y, z = np.meshgrid(np.linspace(-3, 3, n), np.linspace(-3, 3, n))
    vertices = np.stack([np.full(n * n, 4.0), y.ravel(), z.ravel()], axis=1)
    first = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    faces = np.concatenate([first[:, None] + [0, 1, n], first[:, None] + [1, n + 1, n]])
    centres = vertices[faces].mean(axis=1)
    return SceneMap(vertices, faces[np.hypot(centres[:, 1], centres[:, 2]) > radius])


def _crossing(slope: float, start: tuple, end: tuple) -> float | None:
    """Depth at which the ray height = slope * depth meets the segment; None where it passes by."""
    (z0, h0), (z1, h1) = start, end
    share = (slope * z0 - h0) / ((h1 - h0) - slope * (z1 - z0))
    return z0 + share * (z1 - z0) if 0 <= share <= 1 else None
