"""Exercises of lesson 04: range and depth, two frequencies, a pole in a pixel, and the nearest of n noisy points."""

import numpy as np
from scipy.stats import norm

from course_lib.lessons.kit.exercises import Exercise, Mistake
from course_lib.rendering.camera import DepthCamera

SPEED_OF_LIGHT = 299_792_458.0  # m/s

# 04.1: from the range along the ray to the depth along the optical axis


def range_to_depth(ranges: np.ndarray, rays: np.ndarray) -> np.ndarray:
    """Depth (H, W) [m] of ranges (H, W) along rays (H, W, 3) whose forward component is one."""
    return ranges / np.linalg.norm(rays, axis=-1)


def _range_image(rng: np.random.Generator) -> tuple:
    width, height = int(rng.integers(4, 9)), int(rng.integers(4, 9))
    fov_deg = rng.uniform(40, 90, 2)
    ranges = rng.uniform(0.5, 9.5, (height, width))
    ranges.flat[rng.integers(ranges.size)] = np.nan
    return ranges, DepthCamera.from_fov(width, height, *fov_deg).rays()


def _task_ray(rng: np.random.Generator) -> tuple:
    return np.array([[5.0]]), np.array([[[0.75, 0.0, 1.0]]])


def _nothing_measured(rng: np.random.Generator) -> tuple:
    return np.full((3, 4), np.nan), DepthCamera.from_fov(4, 3, 60, 45).rays()


def _paper_camera(rng: np.random.Generator) -> tuple:
    camera = DepthCamera.sr4000().resized(11, 9)
    return rng.uniform(0.3, 9.9, camera.shape), camera.rays()


def _forward_left_out(ranges: np.ndarray, rays: np.ndarray) -> np.ndarray:
    with np.errstate(divide="ignore"):
        return ranges / np.linalg.norm(rays[..., :2], axis=-1)


def _rays_as_metres(ranges: np.ndarray, rays: np.ndarray) -> np.ndarray:
    with np.errstate(invalid="ignore"):
        return np.sqrt(ranges**2 - rays[..., 0] ** 2 - rays[..., 1] ** 2)


# 04.2: one range of two readings


def range_from_two(read_a: np.ndarray, f_a: float, read_b: np.ndarray, f_b: float, farthest: float) -> np.ndarray:
    """Range (n,) [m] of readings (n,) at two frequencies [Hz]: of read_a + k c / 2f_a up to `farthest`, the best."""
    candidates, misses = _candidates(read_a, f_a, read_b, f_b, farthest)
    return _best(candidates, np.abs(misses))


def _turn(f: float) -> float:
    return SPEED_OF_LIGHT / (2 * f)


def _candidates(read_a, f_a, read_b, f_b, farthest) -> tuple[np.ndarray, np.ndarray]:
    """Ranges (n, k) that are read as read_a, inf beyond `farthest`, and how far each misses read_b on its circle."""
    candidates = read_a[:, None] + np.arange(int(farthest / _turn(f_a)) + 1) * _turn(f_a)
    candidates = np.where(candidates <= farthest, candidates, np.inf)
    with np.errstate(invalid="ignore"):
        misses = (candidates - read_b[:, None] + _turn(f_b) / 2) % _turn(f_b) - _turn(f_b) / 2
    return candidates, np.where(np.isfinite(candidates), misses, np.inf)


def _best(candidates: np.ndarray, costs: np.ndarray) -> np.ndarray:
    return candidates[np.arange(len(candidates)), np.argmin(costs, axis=1)]


def _readings(rng: np.random.Generator) -> tuple:
    f_a = rng.uniform(14e6, 16e6)
    return _two_readings(rng, f_a, f_a * rng.uniform(1.25, 1.4))


def _two_readings(rng: np.random.Generator, f_a: float, f_b: float, farthest: float = 25.0) -> tuple:
    """Readings of ranges near and far: the last reading at f_b has slipped over its seam by noise."""
    r = rng.permutation(np.concatenate([rng.uniform(0.5, 7, 2), rng.uniform(10.5, 19, 2), rng.uniform(20.5, 24, 2)]))
    r = np.append(r, 2 * _turn(f_b) - 0.005)
    noise_a, noise_b = rng.uniform(-0.02, 0.02, (2, len(r)))
    noise_b[-1] = 0.015
    near_seam = np.abs((r + _turn(f_a) / 2) % _turn(f_a) - _turn(f_a) / 2) < 0.05
    return np.where(near_seam, r, r + noise_a) % _turn(f_a), f_a, (r + noise_b) % _turn(f_b), f_b, farthest


def _at_15_and_20(rng: np.random.Generator) -> tuple:
    return _two_readings(rng, 15e6, 20e6)


def _at_20_and_15(rng: np.random.Generator) -> tuple:
    return _two_readings(rng, 20e6, 15e6)


def _nearly_in_step(rng: np.random.Generator) -> tuple:
    """Three turns of one clock are nearly four of the other: the first range that fits roughly is the wrong one, and
    what fits best of all lies beyond `farthest`."""
    f_a, f_b, r = 15e6, 1.336 * 15e6, np.array([31.0, 4.0, 12.0, 32.0, 2.0])
    noise_a, noise_b = np.array([[0, -0.02, 0.01, 0, -0.025], [0, 0.035, -0.01, 0.01, 0.03]])
    return (r + noise_a) % _turn(f_a), f_a, (r + noise_b) % _turn(f_b), f_b, 32.5


def _first_that_fits(within: float):
    def mistaken(read_a, f_a, read_b, f_b, farthest):
        candidates, misses = _candidates(read_a, f_a, read_b, f_b, farthest)
        return _best(candidates, np.abs(misses) >= within)

    return mistaken


def _beyond_farthest(more: int):
    """A mistake: all ranges of so many more turns than fit, also those beyond `farthest`."""

    def mistaken(read_a, f_a, read_b, f_b, farthest):
        candidates = read_a[:, None] + np.arange(int(farthest / _turn(f_a)) + 1 + more) * _turn(f_a)
        misses = (candidates - read_b[:, None] + _turn(f_b) / 2) % _turn(f_b) - _turn(f_b) / 2
        return _best(candidates, np.abs(misses))

    return mistaken


def _along_a_line(read_a, f_a, read_b, f_b, farthest):
    candidates, _ = _candidates(read_a, f_a, read_b, f_b, farthest)
    with np.errstate(invalid="ignore"):
        misses = np.abs(candidates % _turn(f_b) - read_b[:, None])
    return _best(candidates, np.where(np.isfinite(candidates), misses, np.inf))


def _not_read_at_b(read_a, f_a, read_b, f_b, farthest):
    candidates, _ = _candidates(read_a, f_a, read_b, f_b, farthest)
    return _best(candidates, np.abs(candidates - read_b[:, None]))


def _one_turn_at_most(read_a, f_a, read_b, f_b, farthest):
    candidates, misses = _candidates(read_a, f_a, read_b, f_b, farthest)
    return _best(candidates[:, :2], np.abs(misses[:, :2]))


def _without_absolute_value(read_a, f_a, read_b, f_b, farthest):
    return _best(*_candidates(read_a, f_a, read_b, f_b, farthest))


def _turns_of_a(read_a, f_a, read_b, f_b, farthest):
    return np.round((range_from_two(read_a, f_a, read_b, f_b, farthest) - read_a) / _turn(f_a))


def _from_b(read_a, f_a, read_b, f_b, farthest):
    return range_from_two(read_b, f_b, read_a, f_a, farthest)


def _mean_of_both(read_a, f_a, read_b, f_b, farthest):
    from_a, turn = range_from_two(read_a, f_a, read_b, f_b, farthest), _turn(f_b)
    return from_a - ((from_a - read_b + turn / 2) % turn - turn / 2) / 2


# 04.3: how much of a pixel is on the pole


def pole_share(r: np.ndarray, r1: np.ndarray, rho1: np.ndarray, r2: np.ndarray, rho2: np.ndarray, f: float):
    """Share (n,) of a pixel on the nearer surface at r1 for which it reads r, the rest being on that at r2 [m]."""
    return _share(r, r1, rho1 / r1**2, r2, rho2 / r2**2, f)


def _share(r, r1, a1, r2, a2, f):
    """The share for which the parts of both phasors across the hand of r cancel; a1, a2: amplitudes at full cover."""
    k = 4 * np.pi * f / SPEED_OF_LIGHT
    nearer, farther = a1 * np.sin(k * (r - r1)), a2 * np.sin(k * (r2 - r))
    return farther / (nearer + farther)


def _pole_and_wall(rng: np.random.Generator) -> tuple:
    f, n = rng.uniform(10e6, 30e6), int(rng.integers(6, 10))
    r1 = rng.uniform(0.05, 0.45, n) * _turn(f)
    r2 = r1 + rng.uniform(0.1, 0.45, n) * _turn(f)
    between = rng.uniform(0.1, 0.9, n)
    between[:2] = 0, 1
    rho1, rho2 = rng.uniform(0.1, 0.9, (2, n))
    return r1 + between * (r2 - r1), r1, rho1, r2, rho2, f


def _same_paint(rng: np.random.Generator) -> tuple:
    r1, rho = rng.uniform(1, 3, 4), rng.uniform(0.1, 0.9, 4)
    r2 = r1 + rng.uniform(0.5, 4.5, 4)
    return (r1 + r2) / 2, r1, rho, r2, rho, 15e6


def _by_weighted_ranges(r, r1, rho1, r2, rho2, f):
    a1, a2 = rho1 / r1**2, rho2 / r2**2
    return a2 * (r2 - r) / (a2 * (r2 - r) + a1 * (r - r1))


# 04.4: the nearest of n points


def nearest_of(n: int) -> tuple[float, float]:
    """Mean and standard deviation of the least of n independent standard normal numbers.

    The least is above x where all n are: P = (1 - Phi(x))^n, whose slope gives the density n phi (1 - Phi)^(n - 1).
    """
    x = np.linspace(-9, 9, 3001)
    density = n * norm.pdf(x) * norm.sf(x) ** (n - 1)
    step = x[1] - x[0]
    mean = np.sum(x * density) * step
    return float(mean), float(np.sqrt(np.sum((x - mean) ** 2 * density) * step))


def _how_many(rng: np.random.Generator) -> tuple:
    return (int(rng.integers(3, 41)),)


def _one_point(rng: np.random.Generator) -> tuple:
    return (1,)


def _two_points(rng: np.random.Generator) -> tuple:
    return (2,)


def _sixteen_points(rng: np.random.Generator) -> tuple:
    return (16,)


def _density_without_n(n: int) -> tuple[float, float]:
    mean, deviation = nearest_of(n)
    return mean / n, float(np.sqrt((deviation**2 + mean**2) / n - (mean / n) ** 2 * (2 - 1 / n)))


EXERCISES = [
    Exercise(
        number="04.1",
        solution=range_to_depth,
        inputs=_range_image,
        cases=(_task_ray, _nothing_measured, _paper_camera),
        level="warm-up",
        mistakes=(
            Mistake(
                lambda ranges, rays: ranges * np.linalg.norm(rays, axis=-1),
                "Your depth exceeds the range. Depth is the shorter of the two, save in the middle: divide.",
            ),
            Mistake(
                lambda ranges, rays: ranges,
                "That is still the range along the ray. How long is a ray whose forward component is one?",
            ),
            Mistake(
                lambda ranges, rays: ranges / (rays**2).sum(axis=-1),
                "You divide by the square of the ray's length: take the root.",
            ),
            Mistake(
                lambda ranges, rays: ranges / np.linalg.norm(rays),
                "You divide by one number for the whole image. Each ray has a length of its own: which axis?",
            ),
            Mistake(
                lambda ranges, rays: ranges / np.abs(rays).sum(axis=-1),
                "You add the components of the ray. Its length is the root of the sum of their squares.",
                others=(lambda ranges, rays: ranges / rays.sum(axis=-1),),
            ),
            Mistake(
                lambda ranges, rays: np.nan_to_num(ranges / np.linalg.norm(rays, axis=-1)),
                "A pixel without a measurement stays NaN; yours makes it 0 m, right at the lens.",
            ),
            Mistake(
                lambda ranges, rays: np.nan_to_num(ranges / np.linalg.norm(rays, axis=-1), nan=np.inf),
                "A pixel without a measurement stays NaN; inf would say that the camera looked and nothing was there.",
            ),
            Mistake(
                _forward_left_out,
                "Your ray has no forward component: the length of (x, y, 1) is not that of (x, y).",
            ),
            Mistake(
                _rays_as_metres,
                "x and y of a ray are no metres: they are per metre of depth. Range = depth times the ray's length.",
            ),
            Mistake(
                lambda ranges, rays: ranges / (np.hypot(rays[..., 0], 1) * np.hypot(rays[..., 1], 1)),
                "You multiply two tilts. The length of a ray is one root: of x^2 + y^2 + 1.",
            ),
            Mistake(
                lambda ranges, rays: ranges / np.hypot(rays[..., 0], 1),
                "Your rays are tilted to the side only. They are tilted up and down as well: y counts, too.",
            ),
            Mistake(
                lambda ranges, rays: ranges / np.hypot(rays[..., 1], 1),
                "Your rays are tilted up and down only. They are tilted to the side as well: x counts, too.",
            ),
        ),
    ),
    Exercise(
        number="04.2",
        solution=range_from_two,
        inputs=_readings,
        cases=(_at_15_and_20, _at_20_and_15, _nearly_in_step),
        mistakes=(
            Mistake(
                lambda read_a, f_a, read_b, f_b, farthest: read_a,
                "That is the reading at f_a. The surface may be one or more turns of c / 2f_a farther away.",
            ),
            Mistake(
                _along_a_line,
                "Mind the seam at f_b: 0.1 m and 7.4 m are neighbours on a circle of 7.5 m. Measure on the circle.",
            ),
            Mistake(
                _not_read_at_b,
                "You compare a range with a reading. What would the camera *read* at f_b of each candidate?",
            ),
            Mistake(
                _one_turn_at_most,
                "You try no or one turn. A surface can be two or three turns away: how many fit below `farthest`?",
            ),
            Mistake(
                _without_absolute_value,
                "The miss has a sign, and you take the most negative one. The best candidate has the *smallest* miss.",
            ),
            Mistake(_turns_of_a, "That is the number of turns. Return the range: read_a plus these turns, in metres."),
            Mistake(
                _from_b,
                "You add turns to read_b. The two differ by the noise: the task starts from read_a.",
            ),
            Mistake(
                _mean_of_both,
                "You average the two readings' ranges. A fine idea, but the task asks for read_a plus whole turns.",
            ),
            Mistake(
                lambda read_a, f_a, read_b, f_b, farthest: range_from_two(read_a, f_a / 2, read_b, f_b / 2, farthest),
                "Your turns are c / f long. The light goes out and back: a turn is c / 2f.",
            ),
            Mistake(
                lambda read_a, f_a, read_b, f_b, farthest: range_from_two(
                    read_a, f_a * SPEED_OF_LIGHT / 3e8, read_b, f_b * SPEED_OF_LIGHT / 3e8, farthest
                ),
                "Close, but 3e8 is rounded: take c = 299_792_458 m/s.",
            ),
            Mistake(
                lambda read_a, f_a, read_b, f_b, farthest: (
                    read_a + (_candidates(read_a, f_a, read_b, f_b, farthest)[0].shape[1] - 1) * _turn(f_a)
                ),
                "You take the farthest candidate always. Ask of each how well it fits the reading at f_b.",
            ),
            Mistake(
                _beyond_farthest(0),
                "One of your ranges lies beyond `farthest`: leave such candidates out before you take the best.",
                others=tuple(_beyond_farthest(more) for more in (1, 2, 3)),
            ),
            Mistake(
                _first_that_fits(0.1),
                "You stop at the first range that fits roughly. A later one may fit better: take the best of all.",
                others=tuple(_first_that_fits(within) for within in (0.15, 0.2, 0.25, 0.3, 0.5)),
            ),
            Mistake(
                lambda read_a, f_a, read_b, f_b, farthest: range_from_two(read_a, f_b, read_b, f_a, farthest),
                "The frequencies have changed places: read_a repeats every c / 2f_a.",
            ),
            Mistake(
                lambda read_a, f_a, read_b, f_b, farthest: (read_a + read_b) / 2,
                "Both readings may be turns short, each by turns of its own length. First find how many.",
            ),
        ),
    ),
    Exercise(
        number="04.3",
        solution=pole_share,
        inputs=_pole_and_wall,
        cases=(_same_paint,),
        tolerance=1e-3,  # so that a search on a fine grid passes as well
        mistakes=(
            Mistake(
                lambda r, r1, rho1, r2, rho2, f: (r2 - r) / (r2 - r1),
                "You mix ranges. The pixel adds phasors: the nearer surface sends more light and pulls harder.",
            ),
            Mistake(
                _by_weighted_ranges,
                "You weigh the ranges by the light. The pixel adds *phasors*; of their sum it reads the angle.",
            ),
            Mistake(
                lambda r, r1, rho1, r2, rho2, f: rho2 / r2**2 / (rho1 / r1**2 + rho2 / r2**2),
                "Your share makes both hands equally long, so the pixel reads the middle. Where is r?",
            ),
            Mistake(
                lambda r, r1, rho1, r2, rho2, f: _share(
                    r, r1, rho1 / r1**2, r2, rho2 / r2**2, SPEED_OF_LIGHT / 4 / np.pi
                ),
                "You take the sine of metres. The angle between two hands is 4 pi f / c times the difference in range.",
            ),
            Mistake(
                lambda r, r1, rho1, r2, rho2, f: 1 - pole_share(r, r1, rho1, r2, rho2, f),
                "That is the share on the farther surface.",
            ),
            Mistake(
                lambda r, r1, rho1, r2, rho2, f: pole_share(r, r1, 1.0, r2, 1.0, f),
                "Both surfaces have the same paint in yours: rho1 and rho2 are not used.",
            ),
            Mistake(
                lambda r, r1, rho1, r2, rho2, f: _share(r, r1, rho1, r2, rho2, f),
                "In yours a far surface is as bright as a near one: the amplitude falls with the range squared.",
            ),
            Mistake(
                lambda r, r1, rho1, r2, rho2, f: _share(r, r1, rho1 / r1, r2, rho2 / r2, f),
                "Your light falls with the range. It falls with its square.",
            ),
            Mistake(
                lambda r, r1, rho1, r2, rho2, f: _share(r, r1, rho1 / r1**4, r2, rho2 / r2**4, f),
                "Your light falls with the fourth power of the range. The lesson's phasor has the square.",
            ),
            Mistake(
                lambda r, r1, rho1, r2, rho2, f: pole_share(r, r1, rho1, r2, rho2, f / 2),
                "Your phase is 2 pi f r / c. The light travels 2 r: 4 pi f r / c.",
            ),
            Mistake(
                lambda r, r1, rho1, r2, rho2, f: pole_share(r, r1, rho1, r2, rho2, 15e6),
                "You use 15 MHz always: the frequency is an argument, f.",
            ),
            Mistake(
                lambda r, r1, rho1, r2, rho2, f: 100 * pole_share(r, r1, rho1, r2, rho2, f),
                "Yours is in percent; the task asks for a share from 0 to 1.",
            ),
            Mistake(
                lambda r, r1, rho1, r2, rho2, f: pole_share(r, r1, rho2, r2, rho1, f),
                "The paints have changed places: rho1 belongs to the surface at r1.",
            ),
            Mistake(
                lambda r, r1, rho1, r2, rho2, f: _share(r, r1, 1.0, r2, 1.0, f),
                "That is the pole's share of the *light*. Of the area? A share of it sends rho / r^2 as much light.",
            ),
            Mistake(
                lambda r, r1, rho1, r2, rho2, f: pole_share(r, r1, rho1, r2, rho2, 2 * f),
                "Your phase is 8 pi f r / c. Out and back is 2 r already: 4 pi f r / c.",
            ),
        ),
    ),
    Exercise(
        number="04.4",
        solution=nearest_of,
        inputs=_how_many,
        cases=(_one_point, _two_points, _sixteen_points),
        tolerance=0.004,
        level="challenge",
        mistakes=(
            Mistake(
                lambda n: (-np.sqrt(2 * np.log(n)), nearest_of(n)[1]),
                "sqrt(2 ln n) is the limit for very large n. For 16 it is a third too much: integrate.",
            ),
            Mistake(
                lambda n: (-nearest_of(n)[0], nearest_of(n)[1]),
                "That is the farthest of n points. The z-buffer keeps the nearest: its mean is negative.",
            ),
            Mistake(
                lambda n: (0.0, 1 / np.sqrt(n)),
                "That is the *mean* of n points. The z-buffer keeps the least of them.",
            ),
            Mistake(
                lambda n: (nearest_of(n)[0], nearest_of(n)[1] ** 2),
                "Your mean is right. The second value is the variance: take its root.",
            ),
            Mistake(
                lambda n: (nearest_of(n)[0], 1.0),
                "Your mean is right. But the least of n scatters less than one point does.",
            ),
            Mistake(
                lambda n: (nearest_of(n)[0], 1 / np.sqrt(n)),
                "Your mean is right. 1 / sqrt(n) is the scatter of a mean; the least of n has another.",
            ),
            Mistake(
                lambda n: (nearest_of(n)[0], float(np.hypot(*nearest_of(n)))),
                "Your mean is right. Your second value is the root of the mean square: take the mean away first.",
            ),
            Mistake(
                lambda n: (norm.ppf(1 - 0.5 ** (1 / n)), nearest_of(n)[1]),
                "That is the median of the least. Its distribution is lopsided: the mean lies farther out.",
            ),
            Mistake(
                lambda n: (norm.ppf(1 / (n + 1)), nearest_of(n)[1]),
                "The point with a share of 1 / (n + 1) below it is near the mean of the least, not equal to it.",
            ),
            Mistake(
                lambda n: nearest_of(n + 1),
                "That is the least of n + 1. In the density the power of 1 - Phi is n - 1.",
            ),
            Mistake(
                _density_without_n,
                "Your density does not integrate to 1: any of the n points may be the least, so it has a factor n.",
            ),
        ),
    ),
]
