"""Exercises of lesson 02: where a scanner must look, a chain of stations, the share of holes, how a chain bends."""

import numpy as np

from course_lib.geometry import pose_matrix
from courseware.lessons.kit.exercise import Exercise
from courseware.lessons.kit.values import as_numbers


def aim(points):
    """Ranges [m], azimuths and elevations [rad], each (n,), of points (n, 3) in the scanner's frame."""
    # The length, the angle seen from above, and the angle over the distance on the floor.
    x, y, z = points.T
    return np.linalg.norm(points, axis=1), np.arctan2(y, x), np.arctan2(z, np.hypot(x, y))


def station_places(steps):
    """Places (K + 1, 3) [m] of all stations in the first one's frame; steps (K, 4, 4) are poses in the one before."""
    # Carry the pose along; every new step acts first, so it stands on the right.
    pose, places = np.eye(4), [np.zeros(3)]
    for step in steps:
        pose = pose @ step
        places.append(pose[:3, 3])
    return np.array(places)


def some_steps(rng: np.random.Generator, n: int = 4) -> tuple:
    headings = rng.uniform(0.3, 2.5, (n, 1)) * rng.choice([-1, 1], (n, 1))
    return (pose_matrix(np.hstack([rng.uniform([2, -1, -0.2, -0.1, -0.1], [6, 1, 0.2, 0.1, 0.1], (n, 5)), headings])),)


def share_of_holes(seen, mapped, limit):
    """Share (0 to 1) of places (n, 3) with no map point (m, 3) within `limit` metres."""
    # The nearest map point decides; count the places where even that one is too far.
    nearest = np.array([np.linalg.norm(mapped - p, axis=1).min() for p in seen])
    return np.mean(nearest > limit)


def places_and_map(rng: np.random.Generator) -> tuple:
    """Return a map with a gap, whose points lie nearer and farther than the limit, and a few points in mid-air."""
    seen, limit = np.insert(rng.uniform(0, [4, 2], (40, 2)), 2, 0, axis=1), rng.uniform(0.06, 0.25)
    kept = seen[(seen[:, 0] < 2.6) | (seen[:, 0] > 3.4)]
    # Neither along an axis nor at 45 degrees, so that a sum or a maximum of differences is no distance.
    aslant = np.pi / 2 * rng.integers(4, size=len(kept)) + np.deg2rad(rng.uniform(25, 65, len(kept)))
    away = rng.uniform(0, 1.6, len(kept)) * limit
    mapped = kept + np.column_stack([away * np.cos(aslant), away * np.sin(aslant), 0 * away])
    return seen, np.concatenate([mapped, rng.uniform([0, 0, 1], [4, 4, 2], (9, 3))]), limit


def lateral_sigma(n_steps, spacing, sigma_place, sigma_heading):
    """One sigma [m] of the last station's place across the row."""
    # Variances add up; the heading of step j swings the n - j steps behind it.
    behind = spacing * np.arange(n_steps)
    return np.sqrt(n_steps * sigma_place**2 + np.sum((behind * sigma_heading) ** 2))


def off_the_sigma(arguments: tuple, answer: object) -> str | None:
    """Say what is wrong with a predicted sigma, or return None within 5 %: 10,000 simulated rows are good to 1 %."""
    (n_steps, _, sigma_place, sigma_heading), found = arguments, as_numbers(answer)
    if found is None or found.size != 1 or not np.isfinite(found).all():
        return "Return one finite number, in metres."
    ratio = float(found.reshape(())) / lateral_sigma(*arguments)
    if abs(ratio - 1) <= 0.05:
        return None
    size = "large" if ratio > 1 else "small"
    if n_steps == 1:
        return f"With a single step yours is too {size}. Its heading error has no later step to swing. What remains?"
    if sigma_heading == 0:
        return f"With perfect headings yours is too {size}. How do the errors of the places alone add up?"
    if sigma_place == 0:
        return f"With perfect places yours is too {size}. How many later steps does each heading error swing?"
    return f"Yours is too {size} by more than 5 % for {n_steps} steps. Try one kind of error at a time."


# fmt: off
EXERCISES = [
    Exercise("02.1", aim, lambda rng: (rng.uniform(0.4, 5, (8, 3)) * rng.choice([-1, 1], (8, 3)),), "warm-up", cases={
        "across the seam": lambda rng: (np.array([[-3.0, 0.01, 0.5], [-3.0, -0.01, -0.5], [2.0, 0.0, 0.0]]),),
        "one steep point": lambda rng: (np.array([[-0.02, 0.03, 2.0]]),),
    }),
    Exercise("02.2", station_places, some_steps, cases={
        "round a square": lambda rng: (pose_matrix(np.tile([3.0, 0, 0, 0, 0, np.pi / 2], (4, 1))),),
        "one step": lambda rng: some_steps(rng, 1),
        "one station": lambda rng: (np.empty((0, 4, 4)),),
    }),
    Exercise("02.3", share_of_holes, places_and_map, cases={
        "no holes": lambda rng: (np.eye(3), np.concatenate([np.eye(3), np.eye(3) + 0.04, np.eye(3)[:2] - 0.03]), 0.1),
        "nothing but holes": lambda rng: (rng.uniform(0, 1, (12, 3)), rng.uniform(3, 4, (5, 3)), 0.1),
    }),
    Exercise("02.4", lateral_sigma,
             lambda rng: (int(rng.integers(2, 20)), *rng.uniform([3, 0.003, 0.001], [8, 0.02, 0.005])),
             "challenge", verify=off_the_sigma, cases={
        "a single step": lambda rng: (1, 6.0, 0.008, 0.0035),
        "perfect headings": lambda rng: (9, 5.0, 0.010, 0.0),
        "perfect places": lambda rng: (12, 5.0, 0.0, 0.0017),
    }),
]
