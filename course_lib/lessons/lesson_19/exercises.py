"""Exercises of lesson 19: the camera on the robot, what a start is worth, how many places prove 95 %, a lever arm."""

import math

import numpy as np
from scipy.stats import beta

from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.exercises import Exercise, Mistake

# 19.1: from the panoramas' axis to the depth camera


def camera_on_map(
    x: float, y: float, theta: float, forward: float, left: float, turned: float
) -> tuple[float, float, float]:
    """x, y [m] and heading [rad, -pi to pi] of a camera that sits forward and left [m] of a robot at x, y, theta."""
    return _camera(x, y, theta, forward, left, theta + turned)


def _camera(x, y, along, forward, left, heading) -> tuple[float, float, float]:
    c, s = math.cos(along), math.sin(along)
    return x + c * forward - s * left, y + s * forward + c * left, float(wrap_angle(heading))


def _clockwise(x, y, theta, forward, left, turned):
    found = _camera(x, y, -theta, forward, left, theta + turned)
    return found


def _unwrapped(x, y, theta, forward, left, turned):
    return *camera_on_map(x, y, theta, forward, left, turned)[:2], theta + turned


def _mounted(rng: np.random.Generator) -> tuple:
    """A robot anywhere and a camera anywhere on it; the two headings together pass the half turn in most cases."""
    x, y = rng.uniform(0, 6, 2)
    theta, turned = rng.uniform(1.7, 3.1, 2) * rng.choice([-1, 1])
    forward, left = rng.uniform(0.1, 0.5, 2) * rng.choice([-1, 1], 2)
    return float(x), float(y), float(theta), float(forward), float(left), float(turned)


# 19.2: what is known of the start


def start_knowledge(covariance: np.ndarray, sigma_z: float, sigma_tilt_deg: float) -> np.ndarray:
    """Covariance (6, 6) of [x, y, z, roll, pitch, yaw] from that of [x, y, theta] (3, 3), a height and a tilt."""
    return _known(covariance, sigma_z**2, math.radians(sigma_tilt_deg) ** 2)


def _known(covariance, height, tilt, order=(0, 1, 5), rest=(2, 3, 4)) -> np.ndarray:
    result = np.zeros((6, 6))
    result[np.ix_(order, order)] = covariance
    for index, variance in zip(rest, (height, tilt, tilt), strict=True):
        result[index, index] = variance
    return result


def _one_sided(covariance, sigma_z, sigma_tilt_deg):
    result = start_knowledge(covariance, sigma_z, sigma_tilt_deg)
    result[5, :2] = 0.0
    return result


def _semantic_covariance(rng: np.random.Generator) -> np.ndarray:
    """Of a pose on the floor: place and heading lean on each other."""
    mixing = rng.standard_normal((3, 3)) * np.array([[0.05], [0.05], [0.02]])
    return mixing @ mixing.T + np.diag([0.02, 0.02, 0.01]) ** 2


def _knowledge(rng: np.random.Generator) -> tuple:
    return _semantic_covariance(rng), float(rng.uniform(0.003, 0.03)), float(rng.uniform(0.2, 2.0))


# 19.3: how many places prove a share

Z = 1.96


def places_needed(share: float, misses: int) -> int:
    """Least number of places, with so many misses among them, whose Wilson 95 % interval lies at `share` or above."""
    return _min_n(lambda n: wilson_low(n - misses, n) >= share, misses)


def wilson_low(hits: int, n: int, z: float = Z) -> float:
    """Lower end of Wilson's interval, 0 to 1."""
    p = hits / n
    spread = z * math.sqrt(p * (1 - p) / n + z**2 / (4 * n**2))
    return (p + z**2 / (2 * n) - spread) / (1 + z**2 / n)


def _wilson_high(hits: int, n: int) -> float:
    return 1 - wilson_low(n - hits, n)


def _normal_low(hits: int, n: int) -> float:
    p = hits / n
    return p - Z * math.sqrt(p * (1 - p) / n)


def _exact_low(hits: int, n: int) -> float:
    """Lower end of Clopper and Pearson's interval."""
    return float(beta.ppf(0.025, hits, n - hits + 1))


def _agresti_low(hits: int, n: int) -> float:
    more = n + Z**2
    p = (hits + Z**2 / 2) / more
    return p - Z * math.sqrt(p * (1 - p) / more)


def _min_n(enough, misses: int) -> int:
    n = misses + 1
    while not enough(n):
        n += 1
    return n


def _wanted(rng: np.random.Generator) -> tuple:
    """A share and some misses; not a case that 1.96 and 1.959964 answer differently."""
    while True:
        share, misses = float(np.round(rng.uniform(0.7, 0.97), 2)), int(rng.integers(0, 5))
        n = places_needed(share, misses)
        clear = min(abs(wilson_low(k - misses, k) - share) for k in (n, n - 1) if k > misses)
        if clear > 1e-4:
            return share, misses


# 19.4: a covariance on a lever


def carried(covariance: np.ndarray, theta: float, forward: float, left: float) -> np.ndarray:
    """Covariance (3, 3) of the camera's [x, y, heading] from the robot's, for a camera forward and left of it [m]."""
    lever = _lever(theta, forward, left)
    return lever @ covariance @ lever.T


def _lever(theta: float, forward: float, left: float, sign: float = 1.0) -> np.ndarray:
    """How the camera's x, y, heading follow the robot's: the derivative of 19.1."""
    c, s = math.cos(theta), math.sin(theta)
    lever = np.eye(3)
    lever[0, 2] = sign * (-s * forward - c * left)
    lever[1, 2] = sign * (c * forward - s * left)
    return lever


def _transposed(covariance, theta, forward, left):
    lever = _lever(theta, forward, left)
    return lever.T @ covariance @ lever


def _on_top(covariance, theta, forward, left):
    """The lever's part added, as if place and heading did not lean on each other."""
    arm = _lever(theta, forward, left)[:2, 2]
    result = covariance.copy()
    result[:2, :2] += covariance[2, 2] * np.outer(arm, arm)
    return result


def _untouched_lever(covariance, theta, forward, left):
    lever = np.array([[1.0, 0.0, forward], [0.0, 1.0, left], [0.0, 0.0, 1.0]])
    return lever @ covariance @ lever.T


def _rotated(covariance, theta, forward, left):
    c, s = math.cos(theta), math.sin(theta)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return turn @ covariance @ turn.T


def _on_a_lever(rng: np.random.Generator) -> tuple:
    theta = float(rng.uniform(-np.pi, np.pi))
    forward, left = rng.uniform(0.3, 1.5, 2) * rng.choice([-1, 1], 2)
    return _semantic_covariance(rng), theta, float(forward), float(left)


def _not_transposed(p: np.ndarray, theta: float, forward: float, left: float) -> np.ndarray:
    lever = _lever(theta, forward, left)
    return lever @ p @ lever


EXERCISES = [
    Exercise(
        number="19.1",
        solution=camera_on_map,
        inputs=_mounted,
        mistakes=(
            Mistake(
                lambda x, y, theta, forward, left, turned: (x + forward, y + left, float(wrap_angle(theta + turned))),
                "Forward and left are the robot's directions. Turn them by theta before you add them to x and y.",
            ),
            Mistake(
                lambda x, y, theta, forward, left, turned: _camera(x, y, theta + turned, forward, left, theta + turned),
                "The camera sits forward of the *robot*: its place turns with theta alone, not with its own turn.",
            ),
            Mistake(_clockwise, "You turn the offset the wrong way round: check with theta = 90 degrees, forward 1 m."),
            Mistake(
                lambda x, y, theta, forward, left, turned: camera_on_map(x, y, theta, forward, -left, turned),
                "Your camera sits on the robot's right. At theta = 0, left is +y.",
            ),
            Mistake(
                lambda x, y, theta, forward, left, turned: _camera(x, y, theta, forward, left, theta),
                "The place is right; the camera's own turn is missing from the heading.",
            ),
            Mistake(
                lambda x, y, theta, forward, left, turned: _camera(x, y, theta, forward, left, theta - turned),
                "The place is right; the camera's own turn is counter-clockwise as theta is: add it.",
            ),
            Mistake(
                lambda x, y, theta, forward, left, turned: (
                    *camera_on_map(x, y, theta, forward, left, turned)[:2],
                    (theta + turned) % (2 * math.pi),
                ),
                "The place is right; your heading runs from 0 to 2 pi, and the task asks for -pi to pi.",
            ),
            Mistake(_unwrapped, "The place is right; bring the heading back to -pi to pi (`wrap_angle`)."),
            Mistake(
                lambda x, y, theta, forward, left, turned: (
                    *camera_on_map(x, y, theta, forward, left, turned)[:2],
                    math.degrees(camera_on_map(x, y, theta, forward, left, turned)[2]),
                ),
                "The heading comes out in degrees: the course keeps radians.",
            ),
            Mistake(
                lambda x, y, theta, forward, left, turned: _camera(x, y, theta, -forward, -left, theta + turned),
                "You subtract the offset: that leads from the camera to the robot. Here it goes the other way.",
            ),
            Mistake(
                lambda x, y, theta, forward, left, turned: camera_on_map(x, y, theta, left, forward, turned),
                "Forward and left are exchanged: at theta = 0, forward is +x and left is +y.",
            ),
            Mistake(
                lambda x, y, theta, forward, left, turned: _camera(x, y, theta, forward, left, turned),
                "The place is right; the camera looks where the robot looks, and then by `turned` further: add theta.",
            ),
        ),
        level="warm-up",
    ),
    Exercise(
        number="19.2",
        solution=start_knowledge,
        inputs=_knowledge,
        tolerance=1e-9,  # the variances are some 1e-5
        mistakes=(
            Mistake(
                lambda p, z, tilt: _known(p, z, math.radians(tilt)),
                "A covariance holds squares: sigma_z and sigma_tilt go in squared.",
            ),
            Mistake(
                lambda p, z, tilt: _known(p, z**2, tilt**2),
                "The tilt is given in degrees; the state's angles are radians.",
            ),
            Mistake(
                lambda p, z, tilt: _known(p, z**2, math.radians(tilt**2)),
                "First to radians, then the square: the square of degrees is not turned into that of radians so.",
            ),
            Mistake(
                lambda p, z, tilt: _known(p, z**2, math.radians(tilt) ** 2, (0, 1, 2), (3, 4, 5)),
                "You put the three of [x, y, theta] first. In the state, yaw is the last: which places have x, y, yaw?",
            ),
            Mistake(
                lambda p, z, tilt: _known(p, z**2, math.radians(tilt) ** 2, (0, 1, 3), (2, 4, 5)),
                "Theta is the yaw, the last of the six; you gave it roll's place.",
            ),
            Mistake(
                lambda p, z, tilt: _known(np.diag(np.diag(p)), z**2, math.radians(tilt) ** 2),
                "Place and heading lean on each other: carry the numbers beside the diagonal, too.",
            ),
            Mistake(
                lambda p, z, tilt: _known(p, z**2, 0.0),
                "Roll and pitch are not exactly zero: the robot stands level to sigma_tilt.",
            ),
            Mistake(
                lambda p, z, tilt: _known(p, 0.0, math.radians(tilt) ** 2),
                "The height is missing: it is known to sigma_z, not exactly.",
            ),
            Mistake(
                lambda p, z, tilt: np.where(
                    np.outer(np.isin(np.arange(6), (0, 1)), np.arange(6) == 5)
                    | np.outer(np.arange(6) == 5, np.isin(np.arange(6), (0, 1))),
                    0.0,
                    start_knowledge(p, z, tilt),
                ),
                "x and y are joined with yaw as well: four numbers in the last row and column are missing.",
            ),
            Mistake(
                _one_sided,
                "A covariance is the same on both sides of its diagonal: what stands right of it stands below it, too.",
            ),
            Mistake(
                lambda p, z, tilt: _known(p, z, math.radians(tilt) ** 2),
                "sigma_z is a standard deviation; the covariance's diagonal holds squares.",
            ),
            Mistake(
                lambda p, z, tilt: start_knowledge(p, z, tilt) * (np.arange(6) != 4),
                "The pitch is missing: it is known as well as the roll, sigma_tilt.",
            ),
        ),
    ),
    Exercise(
        number="19.3",
        solution=places_needed,
        inputs=_wanted,
        mistakes=(
            Mistake(
                lambda share, misses: _min_n(lambda n: _exact_low(n - misses, n) >= share, misses),
                "That is the exact (Clopper-Pearson) interval, which is wider. The task asks for Wilson's.",
            ),
            Mistake(
                lambda share, misses: _min_n(lambda n: (n - misses) / n >= share - 1e-12, misses),
                "You ask the share itself. It is the *lower end* of the interval that must reach the wanted share.",
            ),
            Mistake(
                lambda share, misses: _min_n(lambda n: _normal_low(n - misses, n) >= share, misses),
                "p - 1.96 sqrt(p (1 - p) / n) says that one place without a miss proves everything. Take Wilson's.",
            ),
            Mistake(
                lambda share, misses: _min_n(lambda n: _wilson_high(n - misses, n) >= share, misses),
                "That is the upper end: it says what is not excluded. What is shown is the lower end.",
            ),
            Mistake(
                lambda share, misses: places_needed(share, misses) - 1,
                "One place too few: with that number the lower end is still below the share.",
            ),
            Mistake(
                lambda share, misses: places_needed(share, misses) + 1,
                "One place too many: with one fewer the lower end reaches the share already.",
            ),
            Mistake(
                lambda share, misses: places_needed(share, misses) - misses,
                "Yours are the places that went well; asked is how many there are in all, misses included.",
            ),
            Mistake(
                lambda share, misses: _min_n(lambda n: wilson_low(n - misses, n, 1.0) >= share, misses),
                "z = 1 is the 68 % interval. For 95 % z is 1.96.",
            ),
            Mistake(
                lambda share, misses: _min_n(lambda n: wilson_low(n - misses, n, 1.645) >= share, misses),
                "z = 1.645 is the 90 % interval (or one side of 95 %). Take 1.96.",
            ),
            Mistake(
                lambda share, misses: _min_n(lambda n: wilson_low(n, n) >= share, misses),
                "You count no miss: hits are n less the misses.",
            ),
            Mistake(
                lambda share, misses: _min_n(lambda n: _agresti_low(n - misses, n) >= share, misses),
                "That is the interval of Agresti and Coull: Wilson's middle, another width. Take Wilson's.",
            ),
            Mistake(
                lambda share, misses: _min_n(lambda n: wilson_low(n - misses, n) * (1 + Z**2 / n) >= share, misses),
                "Wilson's lower end is divided by 1 + z^2 / n: that is missing.",
            ),
            Mistake(
                lambda share, misses: _min_n(lambda n: wilson_low(n - misses, n, 2.576) >= share, misses),
                "z = 2.576 is the 99 % interval. Take 1.96.",
            ),
            Mistake(
                lambda share, misses: _min_n(lambda n: wilson_low(n - misses, n, 2.0) >= share, misses),
                "z = 2 is 1.96 rounded, and a place or more beside it. Take 1.96.",
            ),
        ),
        tolerance=1e-9,
    ),
    Exercise(
        number="19.4",
        solution=carried,
        inputs=_on_a_lever,
        mistakes=(
            Mistake(
                lambda p, theta, forward, left: p.copy(),
                "Yours is the robot's own. A heading that is off by a degree moves a camera 1 m ahead by 17 mm.",
            ),
            Mistake(_transposed, "The order is J P J', with the derivative first: yours has it transposed."),
            Mistake(_on_top, "Place and heading lean on each other: J P J' has cross terms that you left out."),
            Mistake(_rotated, "You turn the covariance. It is on the map's axes already; what acts is the lever arm."),
            Mistake(
                _untouched_lever,
                "Your lever is (forward, left) itself, the robot's way *to* the camera. What counts is how it moves.",
            ),
            Mistake(
                lambda p, theta, forward, left: carried(p, 0.0, forward, left),
                "Forward and left are the robot's: the derivative contains cos theta and sin theta.",
            ),
            Mistake(
                lambda p, theta, forward, left: (
                    _lever(theta, forward, left, -1.0) @ p @ _lever(theta, forward, left, -1.0).T
                ),
                "Your lever acts the wrong way: d(cos theta) is -sin theta, d(sin theta) is +cos theta.",
            ),
            Mistake(
                lambda p, theta, forward, left: carried(p, theta, forward, -left),
                "The sign of left: at theta = 0 a camera on the left moves to -x when the robot turns to the left.",
            ),
            Mistake(
                lambda p, theta, forward, left: carried(p, theta, left, forward),
                "Forward and left are exchanged.",
            ),
            Mistake(
                lambda p, theta, forward, left: _lever(theta, forward, left) @ p,
                "A covariance is carried from both sides: J P is only half of it.",
            ),
            Mistake(
                _not_transposed,
                "The second J is transposed: J P J'. Without it x and y do not feel the lever from both sides.",
            ),
            Mistake(
                lambda p, theta, forward, left: np.diag(np.diag(carried(p, theta, forward, left))),
                "The diagonal is right; what stands beside it is not 0: place and heading lean on each other.",
            ),
            Mistake(
                lambda p, theta, forward, left: carried(p, theta, forward, 0.0),
                "Left does not act in yours: a camera to the left moves, too, when the robot turns.",
            ),
        ),
        level="challenge",
    ),
]
