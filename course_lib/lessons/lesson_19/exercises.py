"""Exercises of lesson 19: the camera on the robot, what a start is worth, how many places prove 95 %, a lever arm."""

import numpy as np
from scipy.stats import beta

from course_lib.lessons.kit.exercises import Exercise

# 19.1: from the panoramas' axis to the depth camera


def camera_on_map(x, y, theta, forward, left, turned):
    """x [m], y [m] and heading [rad] of a camera mounted forward and left [m] of the robot's axis, turned [rad]."""
    c, s = np.cos(theta), np.sin(theta)
    heading = (theta + turned + np.pi) % (2 * np.pi) - np.pi
    return x + c * forward - s * left, y + s * forward + c * left, heading


def mounted(rng: np.random.Generator) -> tuple:
    """A robot anywhere and a camera anywhere on it; the two headings together pass the half turn in most cases."""
    x, y = rng.uniform(0, 6, 2)
    theta, turned = rng.uniform(1.7, 3.1, 2) * rng.choice([-1, 1])
    forward, left = rng.uniform(0.1, 0.5, 2) * rng.choice([-1, 1], 2)
    return float(x), float(y), float(theta), float(forward), float(left), float(turned)


# 19.2: what is known of the start


def start_knowledge(covariance, sigma_z, sigma_tilt_deg):
    """Covariance (6, 6) of the start [x, y, z, roll, pitch, yaw], metres and radians, squared."""
    tilt = np.deg2rad(sigma_tilt_deg)
    result = np.diag([0.0, 0.0, sigma_z**2, tilt**2, tilt**2, 0.0])
    result[np.ix_([0, 1, 5], [0, 1, 5])] = covariance
    return result


def semantic_covariance(rng: np.random.Generator) -> np.ndarray:
    """Of a pose on the floor: place and heading lean on each other."""
    mixing = rng.standard_normal((3, 3)) * np.array([[0.05], [0.05], [0.02]])
    return mixing @ mixing.T + np.diag([0.02, 0.02, 0.01]) ** 2


def knowledge(rng: np.random.Generator) -> tuple:
    return semantic_covariance(rng), float(rng.uniform(0.003, 0.03)), float(rng.uniform(0.2, 2.0))


# 19.3: how many places prove a share


def places_needed(share, misses):
    """Least number of places, misses among them, whose Wilson interval (z = 1.96) lies at share (0 to 1) or above."""
    z, n = 1.96, misses + 1
    while True:
        p = (n - misses) / n
        half = z * np.sqrt(p * (1 - p) / n + z**2 / (4 * n**2))
        if (p + z**2 / (2 * n) - half) / (1 + z**2 / n) >= share:
            return n
        n += 1


def wilson_low(hits, n, z=1.96):
    p = hits / n
    return (p + z**2 / (2 * n) - z * np.sqrt(p * (1 - p) / n + z**2 / (4 * n**2))) / (1 + z**2 / n)


def exact_low(hits, n):
    """Lower end of Clopper and Pearson's interval."""
    return beta.ppf(0.025, hits, n - hits + 1)


def agresti_low(hits, n):
    more = n + 1.96**2
    p = (hits + 1.96**2 / 2) / more
    return p - 1.96 * np.sqrt(p * (1 - p) / more)


def least(share, misses, low):
    """A mistake: the least n for which `low(hits, n)` is at least the share."""
    n = misses + 1
    while low(n - misses, n) < share - 1e-12:
        n += 1
    return n


def wanted(rng: np.random.Generator) -> tuple:
    """A share and some misses; not a case that 1.96 and 1.959964 answer differently."""
    while True:
        share, misses = float(np.round(rng.uniform(0.7, 0.97), 2)), int(rng.integers(0, 5))
        n = places_needed(share, misses)
        if all(abs(wilson_low(k - misses, k) - share) > 1e-4 for k in (n, n - 1) if k > misses):
            return share, misses


# 19.4: a covariance on a lever


def carried(covariance, theta, forward, left):
    """Covariance (3, 3) of the camera's [x, y, heading]; theta of the robot [rad], forward and left [m]."""
    c, s = np.cos(theta), np.sin(theta)
    lever = np.eye(3)
    lever[:2, 2] = -s * forward - c * left, c * forward - s * left
    return lever @ covariance @ lever.T


def on_a_lever(rng: np.random.Generator) -> tuple:
    forward, left = rng.uniform(0.3, 1.5, 2) * rng.choice([-1, 1], 2)
    return semantic_covariance(rng), float(rng.uniform(-np.pi, np.pi)), float(forward), float(left)


def lever_on_top(covariance, theta, forward, left):
    """A mistake: the lever's part is added, as if place and heading did not lean on each other."""
    arm = np.array([-np.sin(theta) * forward - np.cos(theta) * left, np.cos(theta) * forward - np.sin(theta) * left])
    result = covariance.copy()
    result[:2, :2] += covariance[2, 2] * np.outer(arm, arm)
    return result


# fmt: off
EXERCISES = [
    Exercise("19.1", camera_on_map, mounted, "warm-up", mistakes="""
        x + c * forward - s * left, y + s * forward + c * left => x + forward, y + left
        Forward and left are the robot's directions. Turn them by theta before you add them to x and y.
        np.cos(theta), np.sin(theta) => np.cos(theta + turned), np.sin(theta + turned)
        The camera sits forward of the *robot*: its place turns with theta alone, not with its own turn.
        np.sin(theta) => np.sin(-theta)
        You turn the offset the wrong way round: check with theta = 90 degrees, forward 1 m.
        ... => return camera_on_map(x, y, theta, forward, -left, turned)
        Your camera sits on the robot's right. At theta = 0, left is +y.
        (theta + turned + np.pi) => (theta + np.pi)
        The place is right; the camera's own turn is missing from the heading.
        (theta + turned + np.pi) => (theta - turned + np.pi)
        The place is right; the camera's own turn is counter-clockwise as theta is: add it.
        (theta + turned + np.pi) => (turned + np.pi)
        The place is right; the camera looks where the robot looks, and then by `turned` further: add theta.
        (theta + turned + np.pi) % (2 * np.pi) - np.pi => (theta + turned) % (2 * np.pi)
        (theta + turned + np.pi) % (2 * np.pi) - np.pi => theta + turned
        The place is right; bring the heading back to the range from -pi to pi (`wrap_angle`).
        return x + => heading = np.rad2deg(heading); return x +
        The heading comes out in degrees: the course keeps radians.
        ... => return camera_on_map(x, y, theta, -forward, -left, turned)
        You subtract the offset: that leads from the camera to the robot. Here it goes the other way.
        ... => return camera_on_map(x, y, theta, left, forward, turned)
        Forward and left are exchanged: at theta = 0, forward is +x and left is +y.
    """),
    Exercise("19.2", start_knowledge, knowledge, tolerance=1e-9, mistakes="""
        sigma_z**2, tilt**2, tilt**2 => sigma_z**2, tilt, tilt
        sigma_z**2 => sigma_z
        A covariance holds squares: sigma_z and sigma_tilt go in squared.
        np.deg2rad(sigma_tilt_deg) => sigma_tilt_deg
        The tilt is given in degrees; the state's angles are radians.
        tilt**2 => np.deg2rad(sigma_tilt_deg**2)
        First to radians, then the square: the square of degrees is not turned into that of radians so.
        sigma_z**2, tilt**2, tilt**2, 0.0 => 0.0, sigma_z**2, tilt**2, tilt**2 and also [0, 1, 5] => [0, 1, 2]
        You put the three of [x, y, theta] first. In the state, yaw is the last: which places have x, y, yaw?
        sigma_z**2, tilt**2, tilt**2, 0.0 => sigma_z**2, 0.0, tilt**2, tilt**2 and also [0, 1, 5] => [0, 1, 3]
        Theta is the yaw, the last of the six; you gave it roll's place.
        = covariance => = np.diag(np.diag(covariance))
        Place and heading lean on each other: carry the numbers beside the diagonal, too.
        tilt**2, tilt**2 => 0.0, 0.0
        Roll and pitch are not exactly zero: the robot stands level to sigma_tilt.
        sigma_z**2 => 0.0
        The height is missing: it is known to sigma_z, not exactly.
        return result => result[5, :2] = result[:2, 5] = 0.0; return result
        return result => result[5, :2] = 0.0; return result
        x and y are joined with yaw as well, on both sides of the diagonal: some of these four numbers are missing.
        tilt**2, tilt**2 => tilt**2, 0.0
        The pitch is missing: it is known as well as the roll, sigma_tilt.
    """),
    Exercise("19.3", places_needed, wanted, tolerance=1e-9, mistakes="""
        ... => return least(share, misses, exact_low)
        That is the exact (Clopper-Pearson) interval, which is wider. The task asks for Wilson's.
        ... => return least(share, misses, lambda hits, n: hits / n)
        You ask the share itself. It is the *lower end* of the interval that must reach the wanted share.
        ... => return least(share, misses, lambda h, n: h / n - 1.96 * np.sqrt(h / n * (1 - h / n) / n))
        p - 1.96 sqrt(p (1 - p) / n) says that one place without a miss proves everything. Take Wilson's.
        - half => + half
        That is the upper end: it says what is not excluded. What is shown is the lower end.
        ... => return places_needed(share, misses) - 1
        One place too few: with that number the lower end is still below the share.
        ... => return places_needed(share, misses) + 1
        One place too many: with one fewer the lower end reaches the share already.
        ... => return places_needed(share, misses) - misses
        Yours are the places that went well; asked is how many there are in all, misses included.
        1.96 => 1.0
        1.96 => 1.645
        1.96 => 2.576
        1.96 => 2.0
        z = 1 is the 68 % interval, 1.645 the 90 % one, 2.576 the 99 % one, and 2 is rounded. Take 1.96.
        (n - misses) / n => 1.0
        You count no miss: hits are n less the misses.
        ... => return least(share, misses, agresti_low)
        That is the interval of Agresti and Coull: Wilson's middle, another width. Take Wilson's.
        / (1 + z**2 / n) >= => >=
        Wilson's lower end is divided by 1 + z^2 / n: that is missing.
    """),
    Exercise("19.4", carried, on_a_lever, "challenge", mistakes="""
        ... => return covariance.copy()
        Yours is the robot's own. A heading that is off by a degree moves a camera 1 m ahead by 17 mm.
        lever @ covariance @ lever.T => lever.T @ covariance @ lever
        The order is J P J', with the derivative first: yours has it transposed.
        ... => return lever_on_top(covariance, theta, forward, left)
        Place and heading lean on each other: J P J' has cross terms that you left out.
        lever[:2, 2] = -s * forward - c * left, c * forward - s * left => lever[:2, :2] = [[c, -s], [s, c]]
        You turn the covariance. It is on the map's axes already; what acts is the lever arm.
        -s * forward - c * left, c * forward - s * left => forward, left
        Your lever is (forward, left) itself, the robot's way *to* the camera. What counts is how it moves.
        ... => return carried(covariance, 0.0, forward, left)
        Forward and left are the robot's: the derivative contains cos theta and sin theta.
        -s * forward - c * left, c * forward - s * left => s * forward + c * left, s * left - c * forward
        Your lever acts the wrong way: d(cos theta) is -sin theta, d(sin theta) is +cos theta.
        ... => return carried(covariance, theta, forward, -left)
        The sign of left: at theta = 0 a camera on the left moves to -x when the robot turns to the left.
        ... => return carried(covariance, theta, left, forward)
        Forward and left are exchanged.
        lever @ covariance @ lever.T => lever @ covariance
        A covariance is carried from both sides: J P is only half of it.
        @ lever.T => @ lever
        The second J is transposed: J P J'. Without it x and y do not feel the lever from both sides.
        return lever @ covariance @ lever.T => return np.diag(np.diag(lever @ covariance @ lever.T))
        The diagonal is right; what stands beside it is not 0: place and heading lean on each other.
        ... => return carried(covariance, theta, forward, 0.0)
        Left does not act in yours: a camera to the left moves, too, when the robot turns.
    """),
]
