"""Exercises of lesson 04: range and depth, ranges that repeat, and a pixel that sees two surfaces."""

from __future__ import annotations

import numpy as np

from course_lib.depth_mcl.camera import DepthCamera
from course_lib.lessons.kit.exercises import Exercise, Mistake

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


def _forward_left_out(ranges: np.ndarray, rays: np.ndarray) -> np.ndarray:
    with np.errstate(divide="ignore"):
        return ranges / np.linalg.norm(rays[..., :2], axis=-1)


def _rays_as_metres(ranges: np.ndarray, rays: np.ndarray) -> np.ndarray:
    with np.errstate(invalid="ignore"):
        return np.sqrt(ranges**2 - rays[..., 0] ** 2 - rays[..., 1] ** 2)


# 04.2: ranges that repeat


def range_read(r: np.ndarray, f: float) -> np.ndarray:
    """Range [m] that a camera modulated at f [Hz] reads of true ranges r [m]: r modulo c / 2f."""
    return r % (SPEED_OF_LIGHT / (2 * f))


def _true_ranges(rng: np.random.Generator) -> tuple:
    f = rng.uniform(10e6, 40e6)
    repeats = SPEED_OF_LIGHT / (2 * f)
    turns = np.concatenate([rng.uniform(0.1, 0.9, 2), rng.uniform(1.1, 1.9, 2), rng.uniform(2.1, 3.9, 2)])
    return repeats * rng.permutation(turns), f


def _once(r: np.ndarray, f: float) -> np.ndarray:
    repeats = SPEED_OF_LIGHT / (2 * f)
    return np.where(r >= repeats, r - repeats, r)


def _half_turns(r: np.ndarray, f: float) -> np.ndarray:
    repeats = SPEED_OF_LIGHT / (2 * f)
    return (r + repeats / 2) % repeats - repeats / 2


# 04.3: one pixel, two surfaces


def mixed_range(r1: np.ndarray, a1: np.ndarray, r2: np.ndarray, a2: np.ndarray, f: float) -> np.ndarray:
    """Range [m], 0 to c / 2f, of the sum of two phasors with amplitudes a1, a2 from ranges r1, r2 [m]."""
    turns = 2 * f / SPEED_OF_LIGHT
    total = a1 * np.exp(2j * np.pi * turns * r1) + a2 * np.exp(2j * np.pi * turns * r2)
    return np.angle(total) / (2 * np.pi) % 1 / turns


def _two_returns(rng: np.random.Generator) -> tuple:
    f, n = rng.uniform(10e6, 40e6), int(rng.integers(5, 9))
    repeats = SPEED_OF_LIGHT / (2 * f)
    near, apart = rng.uniform(0.05, 0.55, n), rng.uniform(0.1, 0.4, n)
    near[0], apart[0] = 0.6, 0.3  # both in the second half of the circle: their angle is negative
    near[1], apart[1] = 0.1, 0.65  # more than half a turn apart: the sum is not between the two
    a1, a2 = rng.uniform(0.1, 1.0, (2, n))
    return near * repeats, a1, (near + apart) * repeats, a2, f


def _half_phase(r1: np.ndarray, a1: np.ndarray, r2: np.ndarray, a2: np.ndarray, f: float) -> np.ndarray:
    return mixed_range(r1, a1, r2, a2, f / 2)


def _not_wrapped(r1: np.ndarray, a1: np.ndarray, r2: np.ndarray, a2: np.ndarray, f: float) -> np.ndarray:
    repeats = SPEED_OF_LIGHT / (2 * f)
    reading = mixed_range(r1, a1, r2, a2, f)
    return np.where(reading > repeats / 2, reading - repeats, reading)


def _with_round_number(r1: np.ndarray, a1: np.ndarray, r2: np.ndarray, a2: np.ndarray, f: float) -> np.ndarray:
    share = 3e8 / SPEED_OF_LIGHT  # another speed of light acts like another frequency
    return mixed_range(r1, a1, r2, a2, f / share)


def _half_circle(r1: np.ndarray, a1: np.ndarray, r2: np.ndarray, a2: np.ndarray, f: float) -> np.ndarray:
    half = SPEED_OF_LIGHT / (4 * f)
    return ((mixed_range(r1, a1, r2, a2, f) + half / 2) % half - half / 2) % (2 * half)


EXERCISES = [
    Exercise(
        number="04.1",
        reference=range_to_depth,
        inputs=_range_image,
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
            ),
            Mistake(
                lambda ranges, rays: np.nan_to_num(ranges / np.linalg.norm(rays, axis=-1)),
                "A pixel without a measurement stays NaN; yours makes it 0 m, right at the lens.",
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
        ),
    ),
    Exercise(
        number="04.2",
        reference=range_read,
        inputs=_true_ranges,
        mistakes=(
            Mistake(
                lambda r, f: r % (SPEED_OF_LIGHT / f),
                "Yours repeats after c / f. The light goes out and back: it travels 2 r.",
            ),
            Mistake(
                lambda r, f: r % (SPEED_OF_LIGHT / (4 * f)),
                "Yours repeats after c / 4f, half of the right distance.",
            ),
            Mistake(_once, "You take away c / 2f once. A surface can be two or three times as far: see % (modulo)."),
            Mistake(
                lambda r, f: np.minimum(r, SPEED_OF_LIGHT / (2 * f)),
                "You stop at c / 2f. The camera does not know that the wall is far: it starts again from 0.",
            ),
            Mistake(
                lambda r, f: np.where(r < SPEED_OF_LIGHT / (2 * f), r, np.nan),
                "You drop what is too far. The camera cannot: it does not know. It starts again from 0.",
            ),
            Mistake(
                lambda r, f: r / (SPEED_OF_LIGHT / (2 * f)) % 1,
                "That is the share of a turn, without unit. The task asks for metres.",
            ),
            Mistake(lambda r, f: r % (3e8 / (2 * f)), "Close, but 3e8 is rounded: take c = 299_792_458 m/s."),
            Mistake(
                lambda r, f: range_read(r, 15e6),
                "You use 15 MHz always: the frequency is an argument, f.",
            ),
            Mistake(
                lambda r, f: r % (SPEED_OF_LIGHT / 2 * f),
                "Nothing is wrapped in yours. Mind the brackets: c / 2 * f is c times f, halved.",
            ),
            Mistake(
                lambda r, f: r // (SPEED_OF_LIGHT / (2 * f)),
                "That is how many whole turns the clock has made. The camera reads what is left: %, not //.",
            ),
            Mistake(
                lambda r, f: range_read(r, f) * (4 * np.pi * f / SPEED_OF_LIGHT),
                "That is the phase in radians. One whole turn, 2 pi, stands for c / 2f metres.",
            ),
            Mistake(
                _half_turns,
                "Some of your ranges are negative: np.angle runs from -pi to pi. The camera reads 0 to c / 2f.",
            ),
            Mistake(lambda r, f: range_read(r, 1e6 * f), "f is in 1/s already: 15 MHz comes as 15e6."),
            Mistake(lambda r, f: r % 10, "Ranges repeat every 10 m at 15 MHz only: the frequency decides."),
            Mistake(
                lambda r, f: range_read(r / 2, f),
                "Your phase is 2 pi f r / c. The light goes out *and* back: it travels 2 r.",
            ),
        ),
    ),
    Exercise(
        number="04.3",
        reference=mixed_range,
        inputs=_two_returns,
        mistakes=(
            Mistake(
                lambda r1, a1, r2, a2, f: (a1 * r1 + a2 * r2) / (a1 + a2),
                "You average the ranges. The pixel adds the phasors, complex numbers; only the sum has a range.",
            ),
            Mistake(
                lambda r1, a1, r2, a2, f: (r1 + r2) / 2,
                "You take the middle of the two ranges. Add the phasors, then read the range of the sum.",
            ),
            Mistake(
                lambda r1, a1, r2, a2, f: np.where(a1 > a2, r1, r2),
                "In yours the stronger surface wins. The camera sees their sum.",
            ),
            Mistake(
                lambda r1, a1, r2, a2, f: mixed_range(r1, 1, r2, 1, f),
                "Both surfaces count the same in yours: multiply each phasor by its amplitude.",
            ),
            Mistake(_half_phase, "Your phase is 2 pi f r / c. The light travels 2 r: 4 pi f r / c, out and back."),
            Mistake(
                _not_wrapped,
                "Some of your ranges are negative: np.angle runs from -pi to pi. Bring its share of a turn to 0 ... 1.",
            ),
            Mistake(
                lambda r1, a1, r2, a2, f: mixed_range(r1, a1, r2, a2, f) * 2 * f / SPEED_OF_LIGHT,
                "That is the share of a turn. Times c / 2f it becomes metres.",
            ),
            Mistake(
                lambda r1, a1, r2, a2, f: mixed_range(r1, a1, r2, a2, f) * 2,
                "Yours is twice too far: a whole turn is c / 2f, not c / f.",
            ),
            Mistake(
                lambda r1, a1, r2, a2, f: mixed_range(r1, a1 / r1**2, r2, a2 / r2**2, f),
                "a1 and a2 are amplitudes already: what is lost on the way, 1 / r^2, is in them.",
            ),
            Mistake(
                lambda r1, a1, r2, a2, f: mixed_range(r1, a1**2, r2, a2**2, f),
                "You square the amplitudes. A phasor is as long as its amplitude.",
            ),
            Mistake(
                lambda r1, a1, r2, a2, f: mixed_range(r1, a1, r2, a2, f) * (4 * np.pi * f / SPEED_OF_LIGHT),
                "That is the phase in radians. One whole turn, 2 pi, stands for c / 2f metres.",
            ),
            Mistake(
                lambda r1, a1, r2, a2, f: np.abs(_not_wrapped(r1, a1, r2, a2, f)),
                "You drop the sign of the angle. A hand at -90 degrees has made three quarters of a turn, not one.",
            ),
            Mistake(
                _half_circle,
                "arctan of a quotient knows half of the circle only: take np.angle, or arctan2.",
            ),
            Mistake(
                lambda r1, a1, r2, a2, f: mixed_range(r1, a1, r2, a2, 15e6),
                "You use 15 MHz always: the frequency is an argument, f.",
            ),
            Mistake(
                _with_round_number,
                "Close, but 3e8 is rounded: take c = 299_792_458 m/s.",
            ),
            Mistake(
                lambda r1, a1, r2, a2, f: _half_phase(r1, a1, r2, a2, f) / 2,
                "Your phase grows too slowly, 2 pi f r / c. Light goes out and back: it travels 2 r.",
            ),
            Mistake(
                lambda r1, a1, r2, a2, f: mixed_range(r1, a1, r2, a2, f) * f**2,
                "Far too far. Mind the brackets: c / 2 * f is c times f, halved.",
            ),
        ),
    ),
]
