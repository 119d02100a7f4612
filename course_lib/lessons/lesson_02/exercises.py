"""Exercises of lesson 02: where a scanner must look, a chain of stations, the share of holes, how a chain bends."""

import numpy as np

from course_lib.geometry import pose_matrix
from course_lib.lessons.kit.exercises import Exercise
from course_lib.lessons.kit.values import as_numbers

# 02.1: from points back to range, azimuth and elevation


def aim(points):
    """Ranges [m], azimuths and elevations [rad], each (n,), of points (n, 3) in the scanner's frame."""
    # The length, the angle seen from above, and the angle over the distance on the floor.
    x, y, z = points.T
    return np.linalg.norm(points, axis=1), np.arctan2(y, x), np.arctan2(z, np.hypot(x, y))


def points_all_around(rng: np.random.Generator) -> tuple:
    n = int(rng.integers(6, 10))
    return (rng.uniform(0.4, [6, 4, 2], (n, 3)) * rng.choice([-1, 1], (n, 3)),)


def across_the_seam(rng: np.random.Generator) -> tuple:
    """Straight behind the scanner, a hair to its left and to its right; and straight ahead, level."""
    return (np.array([[-3.0, 0.01, 0.5], [-3.0, -0.01, -0.5], [2.0, 0.0, 0.0]]),)


def one_steep_point(rng: np.random.Generator) -> tuple:
    return (np.array([[-0.02, 0.03, 2.0]]),)


# 02.2: a chain of stations


def station_places(steps):
    """Places (K + 1, 3) [m] of all stations in the first one's frame; steps (K, 4, 4) are poses in the one before."""
    # Carry the pose along; every new step acts first, so it stands on the right.
    pose, places = np.eye(4), [np.zeros(3)]
    for step in steps:
        pose = pose @ step
        places.append(pose[:3, 3])
    return np.array(places)


def some_steps(rng: np.random.Generator) -> tuple:
    n = int(rng.integers(3, 6))
    turns = np.column_stack([rng.uniform(-0.1, 0.1, (n, 2)), rng.uniform(0.3, 2.5, n) * rng.choice([-1, 1], n)])
    return (pose_matrix(np.column_stack([rng.uniform([2, -1, -0.2], [6, 1, 0.2], (n, 3)), turns])),)


def round_a_square(rng: np.random.Generator) -> tuple:
    return (pose_matrix(np.tile([3.0, 0, 0, 0, 0, np.pi / 2], (4, 1))),)


def one_step(rng: np.random.Generator) -> tuple:
    return (some_steps(rng)[0][:1],)


def one_station(rng: np.random.Generator) -> tuple:
    return (np.empty((0, 4, 4)),)


def turn_and_place(turn, place):
    """For mistakes: the pose with the turn of one pose and the place of another."""
    pose = np.array(place)
    pose[:3, :3] = turn[:3, :3]
    return pose


def heading_alone(step):
    """A mistake: the step without its tilt."""
    angle = np.arctan2(step[1, 0], step[0, 0])
    return turn_and_place(pose_matrix(np.array([0, 0, 0, 0, 0, angle])), step)


# 02.3: the share of holes


def share_of_holes(seen, mapped, limit):
    """Share (0 to 1) of places (n, 3) with no map point (m, 3) within `limit` metres."""
    # The nearest map point decides; count the places where even that one is too far.
    nearest = np.array([np.linalg.norm(mapped - p, axis=1).min() for p in seen])
    return np.mean(nearest > limit)


def places_and_map(rng: np.random.Generator) -> tuple:
    """A map with a gap, whose points lie nearer and farther than the limit, and a few points in mid-air."""
    n, limit = int(rng.integers(30, 50)), rng.uniform(0.06, 0.25)
    seen = np.column_stack([rng.uniform(0, 4, n), rng.uniform(0, 2, n), np.zeros(n)])
    kept = seen[(seen[:, 0] < 2.6) | (seen[:, 0] > 3.4)]
    # Neither along an axis nor at 45 degrees: a distance that is not the root of a sum of squares comes out otherwise.
    aslant = np.pi / 2 * rng.integers(4, size=len(kept)) + np.deg2rad(rng.uniform(25, 65, len(kept)))
    away = rng.uniform(0, 1.6, len(kept)) * limit
    mapped = kept + np.column_stack([away * np.cos(aslant), away * np.sin(aslant), 0 * away])
    stray = np.column_stack([rng.uniform(0, 4, (9, 2)), rng.uniform(1, 2, 9)])
    return seen, np.concatenate([mapped, stray]), limit


def no_holes(rng: np.random.Generator) -> tuple:
    """Every place has several map points within the limit, some places are map points themselves."""
    seen = np.column_stack([rng.uniform(0, 4, (20, 2)), np.zeros(20)])
    beside, above = seen + np.array([0.03, 0.04, 0]), seen[:7] + np.array([-0.02, 0, 0.05])
    return seen, np.concatenate([seen, beside, above]), 0.1


def nothing_but_holes(rng: np.random.Generator) -> tuple:
    return rng.uniform(0, 1, (12, 3)), rng.uniform(3, 4, (5, 3)), 0.1


# 02.4: how far to the side the last of a row of stations may be


def lateral_sigma(n_steps, spacing, sigma_place, sigma_heading):
    """One sigma [m] of the last station's place across the row."""
    # Variances add up; the heading of step j swings the n - j steps behind it.
    behind = spacing * np.arange(n_steps)
    return np.sqrt(n_steps * sigma_place**2 + np.sum((behind * sigma_heading) ** 2))


def row_of_stations(rng: np.random.Generator) -> tuple:
    sigma_heading = np.deg2rad(rng.uniform(0.05, 0.3))
    return int(rng.integers(2, 20)), rng.uniform(3, 8), rng.uniform(0.003, 0.02), sigma_heading


def single_step(rng: np.random.Generator) -> tuple:
    return 1, 6.0, 0.008, np.deg2rad(0.2)


def perfect_headings(rng: np.random.Generator) -> tuple:
    return 9, 5.0, 0.010, 0.0


def perfect_places(rng: np.random.Generator) -> tuple:
    return 12, 5.0, 0.0, np.deg2rad(0.1)


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
        return f"With a single step yours is too {size}: its heading error has nothing left to swing. What remains?"
    if sigma_heading == 0:
        return f"With perfect headings yours is too {size}: how do the errors of the places alone add up?"
    if sigma_place == 0:
        return f"With perfect places yours is too {size}: how many later steps does each heading error swing?"
    return f"Yours is too {size} by more than 5 % for {n_steps} steps. Try one kind of error at a time."


# fmt: off
EXERCISES = [
    Exercise("02.1", aim, points_all_around, "warm-up", cases=[across_the_seam, one_steep_point], mistakes="""
        np.arctan2(y, x) => -np.arctan2(y, x)
        Your azimuth grows to the right; it must grow to the left, from x to y.
        np.arctan2(y, x) => np.arctan2(y, x) % (2 * np.pi)
        Your azimuths run from 0 to 2 pi; the task asks for -pi to pi.
        np.arctan2(z, => -np.arctan2(z,
        Your elevation has the wrong sign: what is above the scanner has a positive one.
        np.arctan2(z, np.hypot(x, y)) => np.arctan2(np.hypot(x, y), z)
        Your elevation counts from straight up. Here 0 is level.
        np.hypot(x, y) => np.linalg.norm(points, axis=1)
        z over the range is a sine. arctan2 wants z and the distance on the floor.
        np.hypot(x, y) => x
        np.hypot(x, y) => y
        np.hypot(x, y) => np.abs(x)
        Your elevation is measured against x or y alone. How far away on the floor is the point?
        np.linalg.norm(points, axis=1) => np.hypot(x, y)
        Your range is the distance on the floor. The ray goes up or down as well.
        ... => ranges, *angles = aim(points); return ranges, *np.rad2deg(angles)
        Your angles are in degrees; the task asks for radians.
    """),
    Exercise("02.2", station_places, some_steps, cases=[round_a_square, one_step, one_station], mistakes="""
        ... => return np.vstack([np.zeros(3), np.cumsum(steps[:, :3, 3], axis=0)])
        You add the steps up as if no station were turned. Each step counts along the axes of the one before.
        pose @ step => step @ pose
        Your products grow on the wrong side: the newest step is the first that acts on a point.
        pose @ step => pose @ np.linalg.inv(step)
        You walk every step backwards: a step is already the pose of the next station.
        np.array(places) => np.array(places)[1:]
        np.array(places) => np.array(places)[:-1]
        K steps lead to K + 1 stations: the first station is missing, at (0, 0, 0) of its own frame, or the last.
        pose @ step => turn_and_place(step, pose @ step)
        You turn each step by the turn before it alone. All turns so far have turned it.
        pose @ step => pose @ turn_and_place(step, np.eye(4)) @ turn_and_place(np.eye(4), step)
        You turn before you step: the turn of a step changes the next steps, not this one.
        pose @ step => turn_and_place(pose @ step, turn_and_place(pose.T, pose) @ step)
        You turn each step the wrong way: R leads from the station's axes to the world's as it is.
        pose @ step => turn_and_place(step @ pose, pose @ step)
        Your turns multiply in the wrong order: the newest one stands on the right of those before.
        @ step => @ heading_alone(step)
        pose[:3, 3] => pose[:3, 3] * [1, 1, 0]
        Right on a level floor: you turn by the heading alone, or stay at height 0. A step may tilt, roll and climb.
        pose[:3, 3] => pose[3, :3]
        Your poses are right, but you read their last *row*. The place is in the last column.
        ... => return np.vstack([np.zeros(3), steps[:, :3, 3]])
        These are the steps themselves, each counted from the station before. Carry them on to station 0.
    """),
    Exercise("02.3", share_of_holes, places_and_map, cases=[no_holes, nothing_but_holes], mistakes="""
        ... => return share_of_holes(mapped, seen, limit)
        You ask which map points lie off the room. A hole is the other way: a place with no map near it.
        nearest > limit => nearest <= limit
        That is the share that is mapped; the holes are the rest.
        ... => return 1 - np.sum([np.linalg.norm(mapped - p, axis=1) <= limit for p in seen]) / len(seen)
        You count pairs: several map points may lie near one place, and it still counts once.
        ... => return 1 - np.sum([np.linalg.norm(seen - p, axis=1).min() <= limit for p in mapped]) / len(seen)
        You count the map points that lie near the room. Count the *places* that have none near.
        np.mean(nearest > limit) => np.sum(nearest > limit)
        np.mean(nearest > limit) => np.sum(nearest > limit) / len(mapped)
        A share of the places: divide the number of holes by the number of all *places*.
        nearest > limit => nearest
        That is a mean distance in metres. Count the places that are farther than the limit.
        .min() => .mean()
        .min() => .max()
        You let far map points count: one near a place is enough. Only the nearest one decides.
        .min() =>
        You take the share of all pairs. First find the nearest map point of each place, then count places.
        ... => return share_of_holes(seen[:, :2], mapped[:, :2], limit)
        You measure on the floor: a map point high above a place is not near it. Take x, y *and* z.
        nearest > limit => nearest**2 > limit
        You compare a squared distance with the limit: take the root.
        > limit => > 0.1
        Your limit is always 0.1 m: use the argument.
        np.linalg.norm(mapped - p, axis=1) => np.abs(mapped - p).max(axis=1)
        np.linalg.norm(mapped - p, axis=1) => np.abs(mapped - p).sum(axis=1)
        You test a cube about the place, or add up the ways along x, y and z. A distance is a root of squares.
    """),
    Exercise("02.4", lateral_sigma, row_of_stations, "challenge", cases=[
        single_step, perfect_headings, perfect_places,
    ], verify=off_the_sigma, mistakes="""
        + np.sum((behind * sigma_heading) ** 2) =>
        You leave the headings out. A tenth of a degree swings what stands 50 m farther by 9 cm.
        np.arange(n_steps) => np.ones(n_steps)
        np.arange(n_steps) => np.ones(n_steps - 1)
        Each of your heading errors swings one step. It swings *all* later steps.
        np.arange(n_steps) => np.arange(1, n_steps + 1)
        Close: you count one step too many. The turn of a step swings only the steps after it.
        np.arange(n_steps) => n_steps
        np.arange(n_steps) => (n_steps - 1)
        You let the first heading swing the whole row, and forget the others.
        np.arange(n_steps) => np.full(n_steps, n_steps)
        All of your heading errors swing the whole row. The later ones have fewer steps left to swing.
        n_steps * sigma_place**2 => sigma_place**2
        n_steps * sigma_place**2 => (n_steps * sigma_place) ** 2
        The headings are right. Every step has a place error of its own: add up n variances.
        np.sum((behind * sigma_heading) ** 2) => np.sum(behind * sigma_heading) ** 2
        ... => return n_steps * sigma_place + sigma_heading * spacing * n_steps * (n_steps - 1) / 2
        sigma_place**2 + np.sum( => sigma_place**2) + np.sqrt(np.sum(
        You add up errors or sigmas. Independent errors partly cancel: add up their squares, the variances.
        np.sqrt( => (
        That is the variance, in square metres. The task asks for sigma.
        spacing * np.arange(n_steps) => np.arange(n_steps)
        You have not used the spacing: the longer a step, the farther it swings.
        n_steps * sigma_place**2 + =>
        The headings are right. But the places are wrong by themselves, too: you left these errors out.
        n_steps * sigma_place**2 => 2 * n_steps * sigma_place**2
        You count the place error along the row as well. To the side only one of its two parts counts.
        behind * sigma_heading => behind * np.deg2rad(sigma_heading)
        sigma_heading is in radians already: convert nothing.
    """),
]
