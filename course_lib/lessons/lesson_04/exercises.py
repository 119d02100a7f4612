"""Exercises of lesson 04: range and depth, two frequencies, a pole in a pixel, and the nearest of n noisy points."""

import numpy as np

from course_lib.lessons.kit.exercises import Exercise
from course_lib.rendering.camera import DepthCamera

# 04.1: from the range along the ray to the depth along the optical axis


def range_to_depth(ranges, rays):
    """Depth (H, W) [m] along the optical axis of ranges (H, W) [m] along rays (H, W, 3)."""
    # The point is depth times the ray, so the range is depth times the ray's length.
    return ranges / np.linalg.norm(rays, axis=-1)


def range_image(rng: np.random.Generator) -> tuple:
    width, height = int(rng.integers(4, 9)), int(rng.integers(4, 9))
    ranges = rng.uniform(0.5, 9.5, (height, width))
    ranges.flat[rng.integers(ranges.size)] = np.nan
    return ranges, DepthCamera.from_fov(width, height, *rng.uniform(40, 90, 2)).rays()


def the_tasks_ray(rng: np.random.Generator) -> tuple:
    return np.array([[5.0]]), np.array([[[0.75, 0.0, 1.0]]])


def nothing_measured(rng: np.random.Generator) -> tuple:
    return np.full((3, 4), np.nan), DepthCamera.from_fov(4, 3, 60, 45).rays()


# 04.2: one range of two readings


def range_from_two(read_a, f_a, read_b, f_b, farthest):
    """Ranges (n,) [m], at most farthest, of readings (n,) [m] at the frequencies f_a and f_b [1/s]."""
    turn_a, turn_b = 299_792_458.0 / (2 * f_a), 299_792_458.0 / (2 * f_b)
    candidates = read_a[:, None] + np.arange(farthest // turn_a + 1) * turn_a
    miss = np.abs((candidates - read_b[:, None] + turn_b / 2) % turn_b - turn_b / 2)  # on the circle of f_b
    best = np.argmin(np.where(candidates <= farthest, miss, np.inf), axis=1)
    return candidates[np.arange(len(read_a)), best]


def turn(f: float) -> float:
    """The range [m] after which readings at this frequency [Hz] repeat."""
    return 299_792_458.0 / (2 * f)


def readings(rng: np.random.Generator) -> tuple:
    f_a = rng.uniform(14e6, 16e6)
    return two_readings(rng, f_a, f_a * rng.uniform(1.25, 1.4))


def two_readings(rng: np.random.Generator, f_a: float, f_b: float) -> tuple:
    """Readings of ranges near and far: the last reading at f_b has slipped over its seam by noise."""
    r = rng.permutation(np.concatenate([rng.uniform(0.5, 7, 2), rng.uniform(10.5, 19, 2), rng.uniform(20.5, 24, 2)]))
    r = np.append(r, 2 * turn(f_b) - 0.005)
    noise_a, noise_b = rng.uniform(-0.02, 0.02, (2, len(r)))
    noise_b[-1] = 0.015
    noise_a[np.abs((r + turn(f_a) / 2) % turn(f_a) - turn(f_a) / 2) < 0.05] = 0  # near the seam of f_a
    return (r + noise_a) % turn(f_a), f_a, (r + noise_b) % turn(f_b), f_b, 25.0


def the_tasks_pixel(rng: np.random.Generator) -> tuple:
    return np.array([2.007]), 15e6, np.array([4.505]), 20e6, 25.0


def at_15_and_20_megahertz(rng: np.random.Generator) -> tuple:
    return two_readings(rng, 15e6, 20e6)


def at_20_and_15_megahertz(rng: np.random.Generator) -> tuple:
    return two_readings(rng, 20e6, 15e6)


def clocks_nearly_in_step(rng: np.random.Generator) -> tuple:
    """Three turns of one clock are nearly four of the other: the first range that fits roughly is the wrong one, and
    what fits best of all lies beyond `farthest`."""
    f_a, f_b, r = 15e6, 1.336 * 15e6, np.array([31.0, 4.0, 12.0, 32.0, 2.0])
    noise_a, noise_b = np.array([[0, -0.02, 0.01, 0, -0.025], [0, 0.035, -0.01, 0.01, 0.03]])
    return (r + noise_a) % turn(f_a), f_a, (r + noise_b) % turn(f_b), f_b, 32.5


# 04.3: how much of a pixel is on the pole


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


def one_paint(rng: np.random.Generator) -> tuple:
    r1, rho = rng.uniform(1, 3, 4), rng.uniform(0.1, 0.9, 4)
    r2 = r1 + rng.uniform(0.5, 4.5, 4)
    return (r1 + r2) / 2, r1, rho, r2, rho, 15e6


# 04.4: the nearest of n points


def nearest_of(n):
    """Mean and standard deviation of the least of n independent standard normal numbers."""
    # P(least > x) = sf(x)^n; the density is n pdf(x) sf(x)^(n - 1). At 6 m: -1.766 * 20.8 + 3 = -34 mm.
    from scipy.stats import norm

    x = np.linspace(-9, 9, 3001)
    density = n * norm.pdf(x) * norm.sf(x) ** (n - 1) * (x[1] - x[0])
    mean = np.sum(x * density)
    return mean, np.sqrt(np.sum((x - mean) ** 2 * density))


def how_many(rng: np.random.Generator) -> tuple:
    return (int(rng.integers(3, 41)),)


def one_point(rng: np.random.Generator) -> tuple:
    return (1,)


def two_points(rng: np.random.Generator) -> tuple:
    return (2,)


def sixteen_points(rng: np.random.Generator) -> tuple:
    return (16,)


# fmt: off
EXERCISES = [
    Exercise("04.1", range_to_depth, range_image, "warm-up", cases=[the_tasks_ray, nothing_measured], mistakes="""
        ranges / => ranges *
        Your depth exceeds the range. Depth is the shorter of the two, save in the middle: divide.
        ... => return ranges
        That is still the range along the ray. How long is a ray whose forward component is one?
        np.linalg.norm(rays, axis=-1) => (rays**2).sum(axis=-1)
        You divide by the square of the ray's length: take the root.
        np.linalg.norm(rays, axis=-1) => np.linalg.norm(rays)
        You divide by one number for the whole image. Each ray has a length of its own: which axis?
        np.linalg.norm(rays, axis=-1) => np.abs(rays).sum(axis=-1)
        np.linalg.norm(rays, axis=-1) => rays.sum(axis=-1)
        You add the components of the ray. Its length is the root of the sum of their squares.
        ... => return np.nan_to_num(range_to_depth(ranges, rays))
        ... => return np.nan_to_num(range_to_depth(ranges, rays), nan=np.inf)
        A pixel without a measurement stays NaN. 0 m would be right at the lens, inf that nothing was there.
        ... => with np.errstate(all="ignore"): return ranges / np.linalg.norm(rays[..., :2], axis=-1)
        Your ray has no forward component: the length of (x, y, 1) is not that of (x, y).
        ... => with np.errstate(all="ignore"): return np.sqrt(ranges**2 - rays[..., 0] ** 2 - rays[..., 1] ** 2)
        x and y of a ray are no metres: they are per metre of depth. Range = depth times the ray's length.
        np.linalg.norm(rays, axis=-1) => (np.hypot(rays[..., 0], 1) * np.hypot(rays[..., 1], 1))
        You multiply two tilts. The length of a ray is one root: of x^2 + y^2 + 1.
        np.linalg.norm(rays, axis=-1) => np.hypot(rays[..., 0], 1)
        np.linalg.norm(rays, axis=-1) => np.hypot(rays[..., 1], 1)
        Rays are tilted to the side *and* up and down: x and y both count, and you use one of them.
    """),
    Exercise("04.2", range_from_two, readings, cases=[
        the_tasks_pixel, at_15_and_20_megahertz, at_20_and_15_megahertz, clocks_nearly_in_step,
    ], mistakes="""
        ... => return read_a
        That is the reading at f_a. The surface may be one or more turns of c / 2f_a farther away.
        (candidates - read_b[:, None] + turn_b / 2) % turn_b - turn_b / 2 => candidates % turn_b - read_b[:, None]
        Mind the seam at f_b: 0.1 m and 7.4 m are neighbours on a circle of 7.5 m. Measure on the circle.
        (candidates - read_b[:, None] + turn_b / 2) % turn_b - turn_b / 2 => candidates - read_b[:, None]
        You compare a range with a reading. What would the camera *read* at f_b of each candidate?
        np.arange(farthest // turn_a + 1) => np.arange(2)
        You try no or one turn. A surface can be two or three turns away: how many fit below `farthest`?
        miss = np.abs => miss =
        The miss has a sign, and you take the most negative one. The best candidate has the *smallest* miss.
        return candidates => return np.round((candidates - read_a[:, None]) / turn_a)
        That is the number of turns. The range is read_a plus these turns, in metres.
        ... => return range_from_two(read_b, f_b, read_a, f_a, farthest)
        You add turns to read_b. The two differ by the noise: the task starts from read_a.
        np.abs => and also miss, => abs(miss), and also return candidates => return (candidates - miss / 2)
        You average the two readings' ranges. A fine idea, but the task asks for read_a plus whole turns.
        2 * f_a => f_a and also 2 * f_b => f_b
        Your turns are c / f long. The light goes out and back: a turn is c / 2f.
        299_792_458.0 => 3e8
        Close, but 3e8 is rounded: take c = 299_792_458 m/s.
        np.where(candidates <= farthest, miss, np.inf) => miss
        np.where(candidates <= farthest, miss, np.inf) => miss and also turn_a + 1 => turn_a + 2
        np.where(candidates <= farthest, miss, np.inf) => miss and also turn_a + 1 => turn_a + 3
        np.where(candidates <= farthest, miss, np.inf) => miss and also turn_a + 1 => turn_a + 4
        One of your ranges lies beyond `farthest`: leave such candidates out before you take the best.
        miss, np.inf => miss >= 0.1, np.inf
        miss, np.inf => miss >= 0.2, np.inf
        miss, np.inf => miss >= 0.3, np.inf
        You stop at the first range that fits roughly. A later one may fit better: take the best of all.
        ... => return (read_a + read_b) / 2
        Both readings may be turns short, each by turns of its own length. First find how many.
    """),
    Exercise("04.3", pole_share, pole_and_wall, cases=[one_paint], tolerance=1e-3, mistakes="""
        ... => return (r2 - r) / (r2 - r1)
        ... => return (r - r1) / (r2 - r1)
        You mix ranges. The pixel adds phasors: the nearer surface sends more light and pulls harder.
        np.sin(k * (r - r1)) => (r - r1) and also np.sin(k * (r2 - r)) => (r2 - r)
        You weigh the ranges by the light. The pixel adds *phasors*; of their sum it reads the angle.
        * np.sin(k * (r - r1)) => and also * np.sin(k * (r2 - r)) =>
        * np.sin(k * (r - r1)) => and also * np.sin(k * (r2 - r)) => and also return wall => return pole
        Your share is the same whatever the pixel reads: where is r? It turns the sum of the two hands.
        k = 4 * np.pi * f / 299_792_458.0 => k = 1
        You take the sine of metres. The angle between two hands is 4 pi f / c times the difference in range.
        return wall => return pole
        That is the share on the farther surface.
        rho1 / => 1 / and also rho2 / => 1 /
        Both surfaces have the same paint in yours: rho1 and rho2 are not used.
        rho1 / r1**2 => rho1 and also rho2 / r2**2 => rho2
        r1**2 => r1 and also r2**2 => r2
        **2 => **4
        A far surface is too bright or too dark in yours: the amplitude falls with the range *squared*.
        4 * np.pi => 2 * np.pi
        4 * np.pi => 8 * np.pi
        Your phase is not 4 pi f r / c. A turn is 2 pi, and the light travels 2 r, out and back: count each once.
        * f / => * 15e6 /
        You use 15 MHz always: the frequency is an argument, f.
        rho1 / r1**2 * => and also rho2 / r2**2 * =>
        That is the pole's share of the *light*. Of the area? A share of it sends rho / r^2 as much light.
    """),
    # The tolerance of 04.4 lets a simulation with a hundred thousand draws pass, that of 04.3 a search on a fine grid.
    Exercise("04.4", nearest_of, how_many, "challenge", tolerance=0.004, cases=[
        one_point, two_points, sixteen_points,
    ], mistakes="""
        return mean => return -np.sqrt(2 * np.log(n))
        sqrt(2 ln n) is the limit for very large n. For 16 it is a third too much: integrate.
        return mean => return -mean
        That is the farthest of n points. The z-buffer keeps the nearest: its mean is negative.
        ... => return 0.0, n**-0.5
        That is the *mean* of n points. The z-buffer keeps the least of them.
        np.sqrt(np.sum((x - mean) ** 2 * density)) => 1.0
        np.sqrt(np.sum((x - mean) ** 2 * density)) => n**-0.5
        Your mean is right. But the least of n scatters less than one point, and more than a mean of n.
        (x - mean) => x
        Your mean is right. Your second value is the root of the mean square: take the mean away first.
        return mean => return norm.ppf(1 - 0.5 ** (1 / n))
        That is the median of the least. Its distribution is lopsided: the mean lies farther out.
        return mean => return norm.ppf(1 / (n + 1))
        The point with a share of 1 / (n + 1) below it is near the mean of the least, not equal to it.
        ** (n - 1) => ** n
        ... => return nearest_of(n + 1)
        In the density of the least of n the power of 1 - Phi is n - 1; in yours it is n.
        density = n * => density =
        Your density does not integrate to 1: any of the n points may be the least, so it has a factor n.
    """),
]
