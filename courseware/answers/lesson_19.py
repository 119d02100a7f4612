"""Exercises of lesson 19: the camera on the robot, what a start is worth, how many places prove 95 %, a lever arm."""

import numpy as np
from scipy.stats import beta  # noqa: F401, a mistake uses it

from courseware.lessons.kit.exercises import Exercise


def camera_on_map(x, y, theta, forward, left, turned):
    """x [m], y [m] and heading [rad] of a camera mounted forward and left [m] of the robot's axis, turned [rad]."""
    c, s = np.cos(theta), np.sin(theta)
    heading = (theta + turned + np.pi) % (2 * np.pi) - np.pi
    return x + c * forward - s * left, y + s * forward + c * left, heading


def mounted(rng: np.random.Generator) -> tuple:
    """Draw a robot and a camera on it. The two headings together pass the half turn in most cases."""
    x, y = rng.uniform(0, 6, 2)
    theta, turned = rng.uniform(1.7, 3.1, 2) * rng.choice([-1, 1])
    forward, left = rng.uniform(0.1, 0.5, 2) * rng.choice([-1, 1], 2)
    return float(x), float(y), float(theta), float(forward), float(left), float(turned)


def start_knowledge(covariance, sigma_z, sigma_tilt_deg):
    """Covariance (6, 6) of the start [x, y, z, roll, pitch, yaw], metres and radians, squared."""
    tilt = np.deg2rad(sigma_tilt_deg)
    result = np.diag([0.0, 0.0, sigma_z**2, tilt**2, tilt**2, 0.0])
    result[np.ix_([0, 1, 5], [0, 1, 5])] = covariance
    return result


def semantic_covariance(rng: np.random.Generator) -> np.ndarray:
    """Draw the covariance of a pose on the floor. Its place and heading are correlated."""
    mixing = rng.standard_normal((3, 3)) * np.array([[0.05], [0.05], [0.02]])
    return mixing @ mixing.T + np.diag([0.02, 0.02, 0.01]) ** 2


def places_needed(share, misses):
    """Least number of places, misses among them, whose Wilson interval (z = 1.96) lies at share (0 to 1) or above."""
    z, n = 1.96, misses + 1
    while True:
        p = (n - misses) / n
        half = z * np.sqrt(p * (1 - p) / n + z**2 / (4 * n**2))
        if (p + z**2 / (2 * n) - half) / (1 + z**2 / n) >= share:
            return n
        n += 1


def wanted(rng: np.random.Generator) -> tuple:
    """Draw a share and some misses for which z = 1.96 and z = 1.959964 give the same answer."""
    while True:
        share, misses = float(np.round(rng.uniform(0.7, 0.97), 2)), int(rng.integers(0, 5))
        if places_needed(share - 1e-4, misses) == places_needed(share + 1e-4, misses):
            return share, misses


def carried(covariance, theta, forward, left):
    """Covariance (3, 3) of the camera's [x, y, heading]; theta of the robot [rad], forward and left [m]."""
    c, s = np.cos(theta), np.sin(theta)
    lever = np.eye(3)
    lever[:2, 2] = -s * forward - c * left, c * forward - s * left
    return lever @ covariance @ lever.T


def on_a_lever(rng: np.random.Generator) -> tuple:
    forward, left = rng.uniform(0.3, 1.5, 2) * rng.choice([-1, 1], 2)
    return semantic_covariance(rng), float(rng.uniform(-np.pi, np.pi)), float(forward), float(left)


# fmt: off
EXERCISES = [
    Exercise("19.1", camera_on_map, mounted, "warm-up", mistakes="""
        x + c * forward - s * left, y + s * forward + c * left => x + forward, y + left
        Forward and left are the robot's directions. Turn them by theta before you add them to x and y.
        np.cos(theta), np.sin(theta) => np.cos(theta + turned), np.sin(theta + turned)
        The camera sits forward of the *robot*. Its place turns with theta alone, not with its own turn.
        np.sin(theta) => np.sin(-theta)
        You turn the offset the wrong way round. Check with theta = 90 degrees, forward 1 m.
        (theta + turned + np.pi) => (theta + np.pi)
        (theta + turned + np.pi) => (turned + np.pi)
        The place is right. The camera's heading is the sum of theta and its own turn, and yours lacks one of them.
        (theta + turned + np.pi) => (theta - turned + np.pi)
        The place is right. The camera's own turn is counter-clockwise, like theta, so add it.
        (theta + turned + np.pi) % (2 * np.pi) - np.pi => (theta + turned) % (2 * np.pi)
        (theta + turned + np.pi) % (2 * np.pi) - np.pi => theta + turned
        The place is right. Bring the heading back to the range from -pi to pi (`wrap_angle`).
        ... => return camera_on_map(x, y, theta, -forward, -left, turned)
        You subtract the offset, which leads from the camera to the robot. Here it goes the other way.
        (theta + turned + np.pi) % (2 * np.pi) - np.pi => theta + turned - 2 * np.pi * (theta + turned > np.pi)
        Your heading stays below -pi in some cases. The sum of two angles can leave the range at either end.
    """),
    Exercise("19.2", start_knowledge, tolerance=1e-9, inputs=lambda rng: (
        semantic_covariance(rng), float(rng.uniform(0.003, 0.03)), float(rng.uniform(0.2, 2.0)),
    ), mistakes="""
        sigma_z**2, tilt**2, tilt**2 => sigma_z**2, tilt, tilt
        A covariance holds squares, so sigma_z and sigma_tilt go in squared.
        sigma_z**2, tilt**2, tilt**2, 0.0 => 0.0, sigma_z**2, tilt**2, tilt**2 and also [0, 1, 5] => [0, 1, 2]
        sigma_z**2, tilt**2, tilt**2, 0.0 => sigma_z**2, 0.0, tilt**2, tilt**2 and also [0, 1, 5] => [0, 1, 3]
        Theta is the yaw, and yaw is the last of the six. At which places of the state are x, y and yaw?
        = covariance => = np.diag(np.diag(covariance))
        Place and heading are correlated, so copy the numbers beside the diagonal, too.
        tilt**2, tilt**2 => 0.0, 0.0
        tilt**2, tilt**2 => tilt**2, 0.0
        sigma_z**2 => 0.0
        Height, roll and pitch are not known exactly: the robot stands to sigma_z, and level to sigma_tilt in both.
        return result => result[5, :2] = result[:2, 5] = 0.0; return result
        return result => result[5, :2] = 0.0; return result
        x and y are correlated with yaw, on both sides of the diagonal. Some of these four numbers are missing.
    """),
    Exercise("19.3", places_needed, wanted, tolerance=1e-9, mistakes="""
        (p + z**2 / (2 * n) - half) / (1 + z**2 / n) => beta.ppf(0.025, n - misses, misses + 1)
        That is the exact (Clopper-Pearson) interval, which is wider. The task asks for Wilson's.
        (p + z**2 / (2 * n) - half) / (1 + z**2 / n) => p
        You compare the share itself. It is the *lower end* of the interval that must reach the wanted share.
        (p + z**2 / (2 * n) - half) / (1 + z**2 / n) => p - z * np.sqrt(p * (1 - p) / n)
        p - 1.96 sqrt(p (1 - p) / n) says that one place without a miss proves everything. Take Wilson's.
        - half => + half
        That is the upper end, which says what is not excluded. The lower end says what is shown.
        return n => return n - misses
        You count the places that went well. The task asks for all places, with the misses.
        / (1 + z**2 / n) >= => >=
        Wilson's lower end is divided by 1 + z^2 / n. This is missing.
        1.96 => 1.645
        1.96 => 2.0
        z = 1 is the 68 % interval, 1.645 the 90 % one, 2.576 the 99 % one, and 2 is rounded. Take 1.96.
    """),
    Exercise("19.4", carried, on_a_lever, "challenge", mistakes="""
        ... => return covariance.copy()
        Yours is the robot's own covariance. A heading that is off by a degree moves a camera 1 m ahead by 17 mm.
        lever @ covariance @ lever.T => lever.T @ covariance @ lever
        The order is J P J', with the derivative first. Yours has it transposed.
        lever @ covariance @ lever.T => covariance + covariance[2, 2] * (lever - np.eye(3)) @ (lever - np.eye(3)).T
        return lever @ covariance @ lever.T => return np.diag(np.diag(lever @ covariance @ lever.T))
        Place and heading are correlated, so J P J' has terms beside the diagonal. You left them out.
        lever[:2, 2] = -s * forward - c * left, c * forward - s * left => lever[:2, :2] = [[c, -s], [s, c]]
        You turn the covariance, but it is on the map's axes already. Only the lever arm acts.
        -s * forward - c * left, c * forward - s * left => forward, left
        ... => return carried(covariance, 0.0, forward, left)
        The lever says how the camera's place changes with theta, so it contains cos theta and sin theta.
        -s * forward - c * left, c * forward - s * left => s * forward + c * left, s * left - c * forward
        Your lever acts the wrong way. d(cos theta) is -sin theta, and d(sin theta) is +cos theta.
        lever @ covariance @ lever.T => lever @ covariance
        lever @ covariance @ lever.T => covariance @ lever.T
        A covariance is carried from both sides. J P or P J' is only half of it.
    """),
]
