"""Exercises of lesson 04: range and depth, two frequencies, a pole in a pixel, and the nearest of n noisy points."""

import numpy as np

from course_lib.rendering.camera import DepthCamera
from courseware.lessons.kit.exercise import Exercise


def range_to_depth(ranges, rays):
    """Depth (H, W) [m] along the optical axis of ranges (H, W) [m] along rays (H, W, 3)."""
    # The point is depth times the ray, so the range is depth times the ray's length.
    return ranges / np.linalg.norm(rays, axis=-1)


def range_image(rng: np.random.Generator) -> tuple:
    width, height = int(rng.integers(4, 9)), int(rng.integers(4, 9))
    ranges = rng.uniform(0.5, 9.5, (height, width))
    ranges.flat[rng.integers(ranges.size)] = np.nan
    return ranges, DepthCamera.from_fov(width, height, *rng.uniform(40, 90, 2)).rays()


def range_from_two(read_a, f_a, read_b, f_b, farthest):
    """Ranges (n,) [m], at most farthest, of readings (n,) [m] at the frequencies f_a and f_b [1/s]."""
    turn_a, turn_b = 299_792_458.0 / (2 * f_a), 299_792_458.0 / (2 * f_b)
    candidates = read_a[:, None] + np.arange(farthest // turn_a + 1) * turn_a
    miss = np.abs((candidates - read_b[:, None] + turn_b / 2) % turn_b - turn_b / 2)  # on the circle of f_b
    best = np.argmin(np.where(candidates <= farthest, miss, np.inf), axis=1)
    return candidates[np.arange(len(read_a)), best]


def turn(f: float) -> float:
    """Return the range [m] after which readings at this frequency [Hz] repeat."""
    return 299_792_458.0 / (2 * f)


def two_readings(rng: np.random.Generator, f_a: float, f_b: float) -> tuple:
    """Make readings of ranges near and far. Noise has moved the last reading at f_b over its seam."""
    r = rng.permutation(np.concatenate([rng.uniform(0.5, 7, 2), rng.uniform(10.5, 19, 2), rng.uniform(20.5, 24, 2)]))
    r = np.append(r, 2 * turn(f_b) - 0.005)
    noise_a, noise_b = rng.uniform(-0.02, 0.02, (2, len(r)))
    noise_b[-1] = 0.015
    noise_a[np.abs((r + turn(f_a) / 2) % turn(f_a) - turn(f_a) / 2) < 0.05] = 0  # near the seam of f_a
    return (r + noise_a) % turn(f_a), f_a, (r + noise_b) % turn(f_b), f_b, 25.0


def clocks_nearly_in_step(rng: np.random.Generator) -> tuple:
    """Make three turns of one clock nearly four of the other: the first rough fit is wrong, the best of all too far."""
    f_a, f_b, r = 15e6, 1.336 * 15e6, np.array([31.0, 4.0, 12.0, 32.0, 2.0])
    noise_a, noise_b = np.array([[0, -0.02, 0.01, 0, -0.025], [0, 0.035, -0.01, 0.01, 0.03]])
    return (r + noise_a) % turn(f_a), f_a, (r + noise_b) % turn(f_b), f_b, 32.5


def pole_share(r, r1, rho1, r2, rho2, f):
    """Share (n,) of a pixel on the surface at r1 [m] for which it reads r [m], the rest being on that at r2 [m]."""
    # Across the direction of the sum the two hands cancel: share * pole = (1 - share) * wall.
    k = 4 * np.pi * f / 299_792_458.0
    pole, wall = rho1 / r1**2 * np.sin(k * (r - r1)), rho2 / r2**2 * np.sin(k * (r2 - r))
    return wall / (pole + wall)


def pole_and_wall(rng: np.random.Generator) -> tuple:
    f, n = rng.uniform(10e6, 30e6), int(rng.integers(6, 10))
    r1 = rng.uniform(0.05, 0.45, n) * turn(f)
    r2 = r1 + rng.uniform(0.1, 0.45, n) * turn(f)
    between = rng.uniform(0.1, 0.9, n)
    between[:2] = 0, 1
    rho1, rho2 = rng.uniform(0.1, 0.9, (2, n))
    return r1 + between * (r2 - r1), r1, rho1, r2, rho2, f


def nearest_of(n):
    """Mean and standard deviation of the least of n independent standard normal numbers."""
    # P(least > x) = sf(x)^n; the density is n pdf(x) sf(x)^(n - 1). At 6 m: -1.766 * 20.8 + 3 = -34 mm.
    from scipy.stats import norm

    x = np.linspace(-9, 9, 3001)
    density = n * norm.pdf(x) * norm.sf(x) ** (n - 1) * (x[1] - x[0])
    mean = np.sum(x * density)
    return mean, np.sqrt(np.sum((x - mean) ** 2 * density))


# fmt: off
EXERCISES = [
    Exercise("04.1", range_to_depth, range_image, "warm-up", cases={
        "the task's ray": lambda rng: (np.array([[5.0]]), np.array([[[0.75, 0.0, 1.0]]])),
        "nothing measured": lambda rng: (np.full((3, 4), np.nan), DepthCamera.from_fov(4, 3, 60, 45).rays()),
    }, example=(([[5]], [[[0.75, 0, 1]]]), [[4]])),
    Exercise("04.2", range_from_two, lambda rng: two_readings(
        rng, f := rng.uniform(14e6, 16e6), f * rng.uniform(1.25, 1.4),
    ), cases={
        "the task's pixel": lambda rng: (np.array([2.007]), 15e6, np.array([4.505]), 20e6, 25.0),
        "at 15 and 20 megahertz": lambda rng: two_readings(rng, 15e6, 20e6),
        "at 20 and 15 megahertz": lambda rng: two_readings(rng, 20e6, 15e6),
        "clocks nearly in step": clocks_nearly_in_step,
    }),
    Exercise("04.3", pole_share, pole_and_wall, tolerance=1e-3, cases={
        "one paint": lambda rng: (*np.array([[3.0], [2.0], [0.5], [4.0], [0.5]]), 15e6),
    }),
    # The tolerance of 04.4 lets a simulation with a hundred thousand draws pass, that of 04.3 a search on a fine grid.
    Exercise("04.4", nearest_of, lambda rng: (int(rng.integers(3, 41)),), "challenge", tolerance=0.004, cases={
        "one point": lambda rng: (1,), "two points": lambda rng: (2,), "sixteen points": lambda rng: (16,),
    }, example=((2,), (-0.564, 0.826))),
]
