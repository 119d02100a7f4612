"""Exercises of lesson 19: the camera on the robot, what a start is worth, how many places prove 95 %, a lever arm."""

import numpy as np
from scipy.stats import beta  # noqa: F401, a mistake uses it

from courseware.lessons.kit.exercise import Exercise


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
    Exercise("19.1", camera_on_map, mounted, "warm-up"),
    Exercise("19.2", start_knowledge, tolerance=1e-9, inputs=lambda rng: (
        semantic_covariance(rng), float(rng.uniform(0.003, 0.03)), float(rng.uniform(0.2, 2.0)),
    )),
    Exercise("19.3", places_needed, wanted, tolerance=1e-9, example=((0.95, 0), 73)),
    Exercise("19.4", carried, on_a_lever, "challenge"),
]
