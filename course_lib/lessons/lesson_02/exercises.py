"""Exercises of lesson 02: where a scanner must look, a chain of stations, the share of holes, how a chain bends."""

from itertools import accumulate

import numpy as np

from course_lib.geometry import pose_matrix
from course_lib.lessons.kit.exercises import Exercise, Mistake

# 02.1: from points back to range, azimuth and elevation


def aim(points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Ranges [m], azimuths and elevations [rad], each (n,), of points (n, 3) in the scanner's frame."""
    x, y, z = points.T
    return np.linalg.norm(points, axis=1), np.arctan2(y, x), np.arctan2(z, np.hypot(x, y))


def _points(rng: np.random.Generator) -> tuple:
    """Points in front, behind, above and below, on every side."""
    n = int(rng.integers(6, 10))
    return (rng.uniform(0.4, [6, 4, 2], (n, 3)) * rng.choice([-1, 1], (n, 3)),)


def _across_the_seam(rng: np.random.Generator) -> tuple:
    """Straight behind the scanner, a hair to its left and to its right; and straight ahead, level."""
    return (np.array([[-3.0, 0.01, 0.5], [-3.0, -0.01, -0.5], [2.0, 0.0, 0.0]]),)


def _one_steep_point(rng: np.random.Generator) -> tuple:
    return (np.array([[-0.02, 0.03, 2.0]]),)


def _with_elevation(points: np.ndarray, elevation: np.ndarray) -> tuple:
    return (*aim(points)[:2], elevation)


def _with_azimuth(points: np.ndarray, azimuth: np.ndarray) -> tuple:
    ranges, _, elevations = aim(points)
    return ranges, azimuth, elevations


# 02.2: a chain of stations


def station_places(steps: np.ndarray) -> np.ndarray:
    """Places (K + 1, 3) [m] of K + 1 stations in the first one's frame; steps (K, 4, 4): each in the one before's."""
    poses = accumulate(steps, np.matmul, initial=np.eye(4))
    return np.array([pose[:3, 3] for pose in poses])


def _steps(rng: np.random.Generator) -> tuple:
    n = int(rng.integers(3, 6))
    turns = np.column_stack([rng.uniform(-0.1, 0.1, (n, 2)), rng.uniform(0.3, 2.5, n) * rng.choice([-1, 1], n)])
    return (pose_matrix(np.column_stack([rng.uniform([2, -1, -0.2], [6, 1, 0.2], (n, 3)), turns])),)


def _round_a_square(rng: np.random.Generator) -> tuple:
    return (pose_matrix(np.tile([3.0, 0, 0, 0, 0, np.pi / 2], (4, 1))),)


def _one_step(rng: np.random.Generator) -> tuple:
    return (_steps(rng)[0][:1],)


def _one_station(rng: np.random.Generator) -> tuple:
    return (np.empty((0, 4, 4)),)


def _places_by(steps: np.ndarray, product) -> np.ndarray:
    return np.array([pose[:3, 3] for pose in accumulate(steps, product, initial=np.eye(4))])


def _added_up(steps: np.ndarray) -> np.ndarray:
    return np.vstack([np.zeros(3), np.cumsum(steps[:, :3, 3], axis=0)])


def _turned_by_the_last_step_alone(steps: np.ndarray) -> np.ndarray:
    places, turn = [np.zeros(3)], np.eye(3)
    for step in steps:
        places.append(places[-1] + turn @ step[:3, 3])
        turn = step[:3, :3]
    return np.array(places)


def _turned_backwards(steps: np.ndarray) -> np.ndarray:
    places, turn = [np.zeros(3)], np.eye(3)
    for step in steps:
        places.append(places[-1] + turn.T @ step[:3, 3])
        turn = turn @ step[:3, :3]
    return np.array(places)


def _turns_in_the_other_order(steps: np.ndarray) -> np.ndarray:
    turn, places = np.eye(3), [np.zeros(3)]
    for step in steps:
        places.append(places[-1] + turn @ step[:3, 3])
        turn = step[:3, :3] @ turn
    return np.array(places)


def _by_heading_alone(steps: np.ndarray) -> np.ndarray:
    heading, places = 0.0, [np.zeros(3)]
    for step in steps:
        level = pose_matrix(np.array([0, 0, 0, 0, 0, heading]))[:3, :3]
        places.append(places[-1] + level @ step[:3, 3])
        heading += np.arctan2(step[1, 0], step[0, 0])
    return np.array(places)


def _last_row(steps: np.ndarray) -> np.ndarray:
    return np.array([pose[3, :3] for pose in accumulate(steps, np.matmul, initial=np.eye(4))])


def _turned_too_early(steps: np.ndarray) -> np.ndarray:
    places, turn = [np.zeros(3)], np.eye(3)
    for step in steps:
        turn = turn @ step[:3, :3]
        places.append(places[-1] + turn @ step[:3, 3])
    return np.array(places)


# 02.3: the share of holes


def hole_share(seen: np.ndarray, mapped: np.ndarray, limit: float) -> float:
    """Share (0 to 1) of places (n, 3) with no point of the map (m, 3) within `limit` metres."""
    return float(np.mean(_nearest(seen, mapped) > limit))


def _nearest(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return _distances(a, b).min(axis=1)


def _distances(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.linalg.norm(a[:, None] - b[None], axis=2)


def _places_and_map(rng: np.random.Generator) -> tuple:
    """A map with a gap, whose points lie aslant beside the places, nearer and farther than the limit, and some points
    in mid-air that no place is near (mixed pixels)."""
    n, limit = int(rng.integers(30, 50)), rng.uniform(0.06, 0.25)
    seen = np.column_stack([rng.uniform(0, 4, n), rng.uniform(0, 2, n), np.zeros(n)])
    kept = seen[(seen[:, 0] < 2.6) | (seen[:, 0] > 3.4)]
    # Neither along an axis nor at 45 degrees: a distance that is not the root of a sum of squares comes out otherwise.
    aslant = np.pi / 2 * rng.integers(4, size=len(kept)) + np.deg2rad(rng.uniform(25, 65, len(kept)))
    away = rng.uniform(0, 1.6, len(kept)) * limit
    mapped = kept + np.column_stack([away * np.cos(aslant), away * np.sin(aslant), 0 * away])
    stray = np.column_stack([rng.uniform(0, 4, (9, 2)), rng.uniform(1, 2, 9)])
    return seen, np.concatenate([mapped, stray]), limit


def _no_holes(rng: np.random.Generator) -> tuple:
    """Every place has several map points within the limit, some places are map points themselves."""
    seen = np.column_stack([rng.uniform(0, 4, (20, 2)), np.zeros(20)])
    beside, above = np.array([0.03, 0.04, 0]), np.array([-0.02, 0, 0.05])
    return seen, np.concatenate([seen, seen + beside, seen[:7] + above]), 0.1


def _nothing_but_holes(rng: np.random.Generator) -> tuple:
    return rng.uniform(0, 1, (12, 3)), rng.uniform(3, 4, (5, 3)), 0.1


# 02.4, the challenge: how far to the side the last of a row of stations may be


def lateral_sigma(n_steps: int, spacing: float, sigma_place: float, sigma_heading: float) -> float:
    """One sigma [m] of the last station's place across the row, to first order in the errors of heading [rad].

    A heading error at step j swings all later steps, n - j of them, to the side: sum of squares 0 to n - 1.
    """
    swings = (n_steps - 1) * n_steps * (2 * n_steps - 1) / 6
    return float(np.sqrt(n_steps * sigma_place**2 + swings * (spacing * sigma_heading) ** 2))


SHARE_ALLOWED = 0.05
"""By how much a predicted sigma may be off: a simulation of 10,000 rows is good to 1 %."""


def _row_of_stations(rng: np.random.Generator) -> tuple:
    return (
        int(rng.integers(2, 20)),
        rng.uniform(3, 8),
        rng.uniform(0.003, 0.02),
        np.deg2rad(rng.uniform(0.05, 0.3)),
    )


def _perfect_headings(rng: np.random.Generator) -> tuple:
    return 9, 5.0, 0.010, 0.0


def _single_step(rng: np.random.Generator) -> tuple:
    return 1, 6.0, 0.008, np.deg2rad(0.2)


def _perfect_places(rng: np.random.Generator) -> tuple:
    return 12, 5.0, 0.0, np.deg2rad(0.1)


def off_the_sigma(arguments: tuple, answer: object) -> str | None:
    """What is wrong with a predicted sigma, or None where it is near enough."""
    n_steps, _, sigma_place, sigma_heading = arguments
    try:
        found = np.asarray(answer, dtype=np.float64)
    except (TypeError, ValueError):
        return "Return one number, in metres."
    if found.size != 1 or not np.isfinite(found).all():
        return "Return one finite number, in metres."
    ratio = float(found.reshape(())) / lateral_sigma(*arguments)
    if abs(ratio - 1) <= SHARE_ALLOWED:
        return None
    size = "large" if ratio > 1 else "small"
    if n_steps == 1:
        return f"With a single step yours is too {size}: its heading error has nothing left to swing. What remains?"
    if sigma_heading == 0:
        return f"With perfect headings yours is too {size}: how do the errors of the places alone add up?"
    if sigma_place == 0:
        return f"With perfect places yours is too {size}: how many later steps does each heading error swing?"
    return f"Yours is too {size} by more than 5 % for {n_steps} steps. Try one kind of error at a time."


def _by(swings, places=lambda n: n):
    """A prediction by other counts of the two errors, summed as squares."""

    def sigma(n_steps: int, spacing: float, sigma_place: float, sigma_heading: float) -> float:
        variance = places(n_steps) * sigma_place**2 + swings(n_steps) * (spacing * sigma_heading) ** 2
        return float(np.sqrt(variance))

    return sigma


def _added_linearly(n_steps: int, spacing: float, sigma_place: float, sigma_heading: float) -> float:
    return n_steps * sigma_place + spacing * sigma_heading * n_steps * (n_steps - 1) / 2


EXERCISES = [
    Exercise(
        number="02.1",
        level="warm-up",
        solution=aim,
        inputs=_points,
        cases=(_across_the_seam, _one_steep_point),
        mistakes=(
            Mistake(
                lambda points: _with_azimuth(points, np.arctan(points[:, 1] / points[:, 0])),
                "Your azimuth stays within 90 degrees: what is behind the scanner comes out in front. Use arctan2.",
            ),
            Mistake(
                lambda points: _with_azimuth(points, np.arctan2(points[:, 0], points[:, 1])),
                "Your azimuth counts from y. It is 0 straight ahead, along x; np.arctan2 takes the sine part first.",
            ),
            Mistake(
                lambda points: _with_azimuth(points, -np.arctan2(points[:, 1], points[:, 0])),
                "Your azimuth grows to the right; it must grow to the left, from x to y.",
            ),
            Mistake(
                lambda points: _with_azimuth(points, aim(points)[1] % (2 * np.pi)),
                "Your azimuths run from 0 to 2 pi; the task asks for -pi to pi.",
            ),
            Mistake(
                lambda points: _with_elevation(points, -aim(points)[2]),
                "Your elevation has the wrong sign: what is above the scanner has a positive one.",
            ),
            Mistake(
                lambda points: _with_elevation(points, np.pi / 2 - aim(points)[2]),
                "Your elevation counts from straight up. Here 0 is level.",
            ),
            Mistake(
                lambda points: _with_elevation(points, np.arctan2(points[:, 2], aim(points)[0])),
                "z over the range is a sine. arctan2 wants z and the distance on the floor.",
            ),
            Mistake(
                lambda points: _with_elevation(points, np.arctan2(points[:, 2], points[:, 0])),
                "Your elevation is measured against x alone. How far away on the floor is the point?",
            ),
            Mistake(
                lambda points: (np.hypot(points[:, 0], points[:, 1]), *aim(points)[1:]),
                "Your range is the distance on the floor. The ray goes up or down as well.",
            ),
            Mistake(
                lambda points: (aim(points)[0] ** 2, *aim(points)[1:]),
                "Your range is squared: take the root.",
            ),
            Mistake(
                lambda points: (aim(points)[0], *np.rad2deg(aim(points)[1:])),
                "Your angles are in degrees; the task asks for radians.",
            ),
        ),
    ),
    Exercise(
        number="02.2",
        solution=station_places,
        inputs=_steps,
        cases=(_round_a_square, _one_step, _one_station),
        mistakes=(
            Mistake(
                _added_up,
                "You add the steps up as if no station were turned. Each step counts along the axes of the one before.",
            ),
            Mistake(
                lambda steps: _places_by(steps, lambda pose, step: step @ pose),
                "Your products grow on the wrong side: the newest step is the first that acts on a point.",
            ),
            Mistake(
                lambda steps: _places_by(steps, lambda pose, step: pose @ np.linalg.inv(step)),
                "You walk every step backwards: a step is already the pose of the next station.",
            ),
            Mistake(
                lambda steps: station_places(steps)[1:],
                "The first station is missing: it stands at (0, 0, 0) of its own frame.",
            ),
            Mistake(
                lambda steps: station_places(steps)[:-1],
                "The last station is missing: K steps lead to K + 1 stations.",
            ),
            Mistake(
                _turned_by_the_last_step_alone,
                "You turn each step by the turn before it alone. All turns so far have turned it.",
            ),
            Mistake(
                _turned_too_early,
                "You turn before you step: the turn of a step changes the next steps, not this one.",
            ),
            Mistake(
                _turned_backwards,
                "You turn each step the wrong way: R leads from the station's axes to the world's as it is.",
            ),
            Mistake(
                _turns_in_the_other_order,
                "Your turns multiply in the wrong order: the newest one stands on the right of those before.",
            ),
            Mistake(
                _by_heading_alone,
                "Right on a level floor: you turn by the heading alone. A step may tilt and roll as well.",
            ),
            Mistake(
                _last_row,
                "Your poses are right, but you read their last *row*. The place is in the last column.",
            ),
            Mistake(
                lambda steps: np.vstack([np.zeros(3), steps[:, :3, 3]]),
                "These are the steps themselves, each counted from the station before. Carry them on to station 0.",
            ),
            Mistake(
                lambda steps: station_places(steps) * [1, 1, 0],
                "Your stations all stand at height 0. A step may go up or down as well.",
            ),
        ),
    ),
    Exercise(
        number="02.3",
        solution=hole_share,
        inputs=_places_and_map,
        cases=(_no_holes, _nothing_but_holes),
        mistakes=(
            Mistake(
                lambda seen, mapped, limit: hole_share(mapped, seen, limit),
                "You ask which map points lie off the room. A hole is the other way: a place with no map near it.",
            ),
            Mistake(
                lambda seen, mapped, limit: 1 - hole_share(seen, mapped, limit),
                "That is the share that is mapped; the holes are the rest.",
            ),
            Mistake(
                lambda seen, mapped, limit: 1 - float((_distances(seen, mapped) <= limit).sum() / len(seen)),
                "You count pairs: several map points may lie near one place, and it still counts once.",
            ),
            Mistake(
                lambda seen, mapped, limit: 1 - float((_nearest(mapped, seen) <= limit).sum() / len(seen)),
                "You count the map points that lie near the room. Count the *places* that have none near.",
            ),
            Mistake(
                lambda seen, mapped, limit: 100 * hole_share(seen, mapped, limit),
                "Yours is in percent. The task asks for a share from 0 to 1.",
            ),
            Mistake(
                lambda seen, mapped, limit: float((_nearest(seen, mapped) > limit).sum()),
                "That is how many places; divide by the number of all places.",
            ),
            Mistake(
                lambda seen, mapped, limit: float((_nearest(seen, mapped) > limit).sum() / len(mapped)),
                "You divide by the number of map points. The share is of the places that are seen.",
            ),
            Mistake(
                lambda seen, mapped, limit: float(_nearest(seen, mapped).mean()),
                "That is a mean distance in metres. Count the places that are farther than the limit.",
            ),
            Mistake(
                lambda seen, mapped, limit: float(np.mean(_distances(seen, mapped).mean(axis=1) > limit)),
                "You let far map points count: one near a place is enough. Only the nearest one decides.",
            ),
            Mistake(
                lambda seen, mapped, limit: float(np.mean(_distances(seen, mapped) > limit)),
                "You take the share of all pairs. First find the nearest map point of each place, then count places.",
            ),
            Mistake(
                lambda seen, mapped, limit: hole_share(seen[:, :2], mapped[:, :2], limit),
                "You measure on the floor: a map point high above a place is not near it. Take x, y *and* z.",
            ),
            Mistake(
                lambda seen, mapped, limit: float(np.mean(_nearest(seen, mapped) ** 2 > limit)),
                "You compare a squared distance with the limit: take the root.",
            ),
            Mistake(
                lambda seen, mapped, limit: hole_share(seen, mapped, 0.1),
                "Your limit is always 0.1 m: use the argument.",
            ),
            Mistake(
                lambda seen, mapped, limit: float(
                    np.mean(np.abs(seen[:, None] - mapped[None]).max(axis=2).min(axis=1) > limit)
                ),
                "You test x, y and z one by one: that is a cube about the place. The distance is a root of squares.",
            ),
            Mistake(
                lambda seen, mapped, limit: float(
                    np.mean(np.abs(seen[:, None] - mapped[None]).sum(axis=2).min(axis=1) > limit)
                ),
                "You add the ways along x, y and z. The distance is the root of the sum of their squares.",
            ),
        ),
    ),
    Exercise(
        number="02.4",
        level="challenge",
        solution=lateral_sigma,
        inputs=_row_of_stations,
        cases=(_single_step, _perfect_headings, _perfect_places),
        verify=off_the_sigma,
        mistakes=(
            Mistake(
                _by(lambda n: 0),
                "You leave the headings out. A tenth of a degree swings what stands 50 m farther by 9 cm.",
            ),
            Mistake(
                _by(lambda n: n),
                "Each of your heading errors swings one step. It swings *all* later steps.",
                others=(_by(lambda n: n - 1),),
            ),
            Mistake(
                _by(lambda n: n * (n + 1) * (2 * n + 1) / 6),
                "Close: you count one step too many. The turn of a step swings only the steps after it.",
            ),
            Mistake(
                _by(lambda n: n**2),
                "You let the first heading swing the whole row, and forget the others.",
                others=(_by(lambda n: (n - 1) ** 2),),
            ),
            Mistake(
                _by(lambda n: n**3),
                "All of your heading errors swing the whole row. The later ones have fewer steps left to swing.",
            ),
            Mistake(
                _by(lambda n: (n - 1) * n * (2 * n - 1) / 6, places=lambda n: 1),
                "The headings are right. But every step has a place error of its own: how do n of them add up?",
            ),
            Mistake(
                _by(lambda n: (n - 1) * n * (2 * n - 1) / 6, places=lambda n: n**2),
                "The headings are right. Independent place errors add up as squares: not n times one of them.",
            ),
            Mistake(
                _by(lambda n: (n * (n - 1) / 2) ** 2),
                "You add up how far the errors swing. They are independent: add up the squares.",
            ),
            Mistake(
                _added_linearly,
                "You add up sigmas. Independent errors partly cancel: their *variances* add up.",
            ),
            Mistake(
                lambda *arguments: lateral_sigma(*arguments) ** 2,
                "That is the variance, in square metres. The task asks for sigma.",
            ),
            Mistake(
                lambda n, spacing, place, heading: lateral_sigma(n, 1.0, place, heading),
                "You have not used the spacing: the longer a step, the farther it swings.",
            ),
            Mistake(
                _by(lambda n: (n - 1) * n * (2 * n - 1) / 6, places=lambda n: 0),
                "The headings are right. But the places are wrong by themselves, too: you left these errors out.",
            ),
            Mistake(
                _by(lambda n: (n - 1) * n * (2 * n - 1) / 6, places=lambda n: 2 * n),
                "You count the place error along the row as well. To the side only one of its two parts counts.",
            ),
            Mistake(
                lambda n, spacing, place, heading: lateral_sigma(n, spacing, place, np.deg2rad(heading)),
                "sigma_heading is in radians already: convert nothing.",
            ),
        ),
    ),
]
