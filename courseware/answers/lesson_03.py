"""Exercises of lesson 03: the depth buffer's scale, depth along an edge, what a pixel keeps, a triangle cut."""

import numpy as np

from courseware.lessons.kit.exercise import Exercise
from courseware.lessons.kit.values import as_numbers


def linearize(b, near, far):
    """Depth in metres of z-buffer values b in [0, 1]; inf where b is 1."""
    # Solve the equation of b for Z; the clear value 1 means that nothing was hit.
    depth = near * far / (far - b * (far - near))
    return np.where(b < 1, depth, np.inf)


def depth_on_edge(z_start, z_end, s):
    """Depth in metres at the share s of an edge's length on the screen."""
    # An edge is a triangle's side, so 1/Z changes evenly along it.
    return 1 / ((1 - s) / z_start + s / z_end)


def nearest_surface(layers, near, far):
    """Depth image (H, W) that is left of surfaces (K, H, W)."""
    # First drop what the planes cut away, then keep the least.
    seen = (layers >= near) & (layers <= far)
    return np.where(seen, layers, np.inf).min(axis=0)


def cut_at_near(corners, near):
    """Corners (n, 3) [m], n = 0, 3 or 4, of the part of a triangle (3, 3) that lies beyond the near plane."""
    # Round the edges; a corner beyond the plane is kept, an edge that crosses it gives a new corner.
    kept = []
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if a[2] >= near:
            kept.append(a)
        if (a[2] >= near) != (b[2] >= near):
            kept.append(a + (near - a[2]) / (b[2] - a[2]) * (b - a))
    return np.array(kept).reshape(-1, 3)


def triangles(rng: np.random.Generator) -> tuple:
    """Return a triangle with none to three corners before the near plane, some of them behind the camera."""
    before = rng.permutation(3) < rng.integers(0, 4)
    depths = np.where(before, rng.uniform(-3, 0.3, 3), rng.uniform(0.6, 6, 3))
    return triangle(rng, *depths), rng.uniform(0.35, 0.55)


def triangle(rng: np.random.Generator, *depths: float) -> np.ndarray:
    """Return a triangle that is no needle, with corners at these depths."""
    while True:
        corners = np.column_stack([rng.uniform(-2, 2, (3, 2)), depths])
        if np.linalg.norm(np.cross(corners[1] - corners[0], corners[2] - corners[0])) >= 0.5:
            return corners


def off_the_cut(arguments: tuple, answer: object) -> str | None:
    """Say what is wrong with a cut triangle, or None. The corners may begin anywhere and go round either way."""
    near, right, given = arguments[1], distinct(cut_at_near(*arguments)), as_numbers(answer)
    if given is None or (given.size and (given.ndim != 2 or given.shape[1] != 3)):
        return "Give the corners as rows of three numbers: an array (n, 3)."
    if not np.isfinite(given).all():
        return "One of your corners is nan or inf. Did you divide by a difference of depths that is zero?"
    given = distinct(given.reshape(-1, 3))
    if (given[:, 2] < near - 1e-6).any():
        return "Some of your corners lie before the near plane, but nothing of that part may be left."
    if len(given) != len(right):
        return f"One of your polygons has {len(given)} corners and should have {len(right)}. Draw that case on paper."
    ways = [np.roll(turned, k, axis=0) for turned in (given, given[::-1]) for k in range(4)]
    if any(np.allclose(way, right, atol=1e-6) for way in ways):
        return None
    if all(np.linalg.norm(right - corner, axis=1).min() < 1e-6 for corner in given):
        return "The corners are right, but not in order round the edge, so the polygon crosses itself."
    return "The number of corners is right, but not their places. Where exactly does an edge meet the plane Z = near?"


def distinct(corners: np.ndarray) -> np.ndarray:
    """Leave out corners that repeat the one before. Without an area, nothing is left."""
    kept = corners[np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1) > 1e-6]
    return kept if len(kept) >= 3 else np.empty((0, 3))


# fmt: off
EXERCISES = [
    Exercise("03.1", linearize, lambda rng: (
        # The near plane, never drawn, and two far surfaces that a careless comparison takes for never drawn. The planes
        # are binary fractions, so that the formula gives far itself where b is 1, and one may ask for Z >= far as well.
        rng.permutation([0.0, 1.0, 0.995, 0.999999, *rng.uniform(0.0, 0.99, 8)]).reshape(3, 4),
        rng.integers(4, 64) / 64, rng.integers(20, 160) / 4,
    ), "warm-up", cases={
        "nothing drawn": lambda rng: (np.ones((3, 4)), 0.125, 30.0),
        "a corridor's planes": lambda rng: (np.linspace(0.0, 0.9999, 9)[None], 0.125, 10.0),
    }, example=(([0, 0.5, 0.9, 1], 0.1, 30), [0.1, 0.199, 0.971, np.inf])),
    Exercise("03.2", depth_on_edge, lambda rng: (
        *rng.permutation(rng.uniform([0.5, 4.0], [3.0, 20.0])), np.array([0.0, 1.0, *rng.uniform(0.05, 0.95, 6)]),
    ), cases={"ends equally far": lambda rng: (3.0, 3.0, np.linspace(0, 1, 5))}),
    Exercise("03.3", nearest_surface, lambda rng: (
        np.where(rng.random((4, 5, 6)) < 0.3, np.inf, rng.uniform(0.1, 15, (4, 5, 6))), *rng.uniform([0.5, 8], [1, 12]),
    ), cases={
        "depths of near and far themselves":  # and a pixel that nothing covers
            lambda rng: (np.array([[[0.5, 8.0, np.inf]], [[2.0, 9.0, np.inf]], [[0.4, np.inf, 0.1]]]), 0.5, 8.0),
        "one surface": lambda rng: (np.array([[[0.5, 3.0, 12.0, np.inf]]]), 0.75, 10.0),
    }, example=(([[[0.3]], [[5]], [[2]]], 0.5, 10), [[2]])),
    Exercise("03.4", cut_at_near, triangles, "challenge", verify=off_the_cut, cases={
        "a corner on the plane": lambda rng: (triangle(rng, 0.1, -1.0, 3.0), 0.1),
    }),
]
