"""Stages of project P4: from raw numbers of an unknown camera to depths, and how far to trust them."""

import itertools
from collections.abc import Callable

import numpy as np

from course_lib.lessons.kit.exercises import Exercise, Mistake

# P4.1: the code of "no measurement"


def invalid_code(raw: np.ndarray) -> int:
    """The number that stands for "no measurement" in raw frames (M, H, W) uint16."""
    numbers, counts = np.unique(raw, return_counts=True)
    return int(numbers[counts.argmax()])


def _raw_with(code: int, rng: np.random.Generator) -> tuple:
    """Frames whose measurements hardly repeat; a twentieth of the pixels hold the code."""
    low = rng.uniform(500, 5000)
    values = rng.permutation(np.arange(int(low), int(low) + 40_000, 7))[: 3 * 12 * 16].reshape(3, 12, 16)
    values = values.astype(np.uint16)
    values[rng.random(values.shape) < rng.uniform(0.04, 0.12)] = code
    values.flat[rng.permutation(values.size - 1)[:3] + 1] = code
    values.flat[0] = int(low) + 3  # the first pixel was measured: it is not the code
    return (values,)


def _raw(rng: np.random.Generator) -> tuple:
    return _raw_with(int(rng.choice([0, 1, 32_001, 65_000, 65_535])), rng)


# P4.2: unit and offset


def unit_and_offset(numbers: np.ndarray, distances: np.ndarray) -> tuple[float, float]:
    """Raw numbers a metre, and the offset [m] of the range, from mean raw numbers (K,) at taped distances (K,)."""
    slope, intercept = np.polyfit(distances, numbers, 1)
    return float(slope), float(intercept / slope)


def _on_a_line(rng: np.random.Generator) -> tuple:
    units = float(rng.choice([500, 1000, 2000, 4000, 5000, 6000]))
    distances = np.sort(rng.uniform(0.8, 8.5, int(rng.integers(3, 9))))
    return units * (distances + rng.choice([-1, 1]) * rng.uniform(0.01, 0.1)), distances


def _no_offset(rng: np.random.Generator) -> tuple:
    distances = np.array([1.0, 2.0, 4.0, 8.0])
    return 1000.0 * distances, distances


# P4.3: the focal length


def focal_length(ranges: np.ndarray, distance: float) -> float:
    """Focal length [pixels] of a camera that sees a wall squarely: ranges (H, W) along the rays, NaN = none."""
    height, width = ranges.shape
    v, u = np.indices(ranges.shape)
    square = (u - (width - 1) / 2) ** 2 + (v - (height - 1) / 2) ** 2
    used = np.isfinite(ranges) & (square > 0)
    return float(np.sqrt(np.median(square[used] / ((ranges[used] / distance) ** 2 - 1))))


def _wall(rng: np.random.Generator) -> tuple:
    height, width = int(rng.integers(6, 12)), int(rng.integers(6, 12))
    focal, distance = rng.uniform(8, 40), rng.uniform(0.8, 8.0)
    v, u = np.indices((height, width))
    ranges = distance * np.sqrt(1 + ((u - (width - 1) / 2) ** 2 + (v - (height - 1) / 2) ** 2) / focal**2)
    ranges[rng.random(ranges.shape) < 0.1] = np.nan
    ranges.flat[3] = np.nan
    ranges[-1, -1], ranges[0, 0] = (
        ranges[-1, -1],
        distance * np.sqrt(1 + ((width - 1) ** 2 + (height - 1) ** 2) / 4 / focal**2),
    )
    return ranges, float(distance)


def _no_corners(rng: np.random.Generator) -> tuple:
    """A wall whose four corners were not measured."""
    ranges, distance = _wall(rng)
    ranges[[0, 0, -1, -1], [0, -1, 0, -1]] = np.nan
    return ranges, distance


def _odd_image(rng: np.random.Generator) -> tuple:
    """A pixel on the axis, whose ray says nothing of the focal length."""
    v, u = np.indices((7, 9))
    return 2.0 * np.sqrt(1 + ((u - 4) ** 2 + (v - 3) ** 2) / 20.0**2), 2.0


def _by_corners(ranges: np.ndarray, distance: float, centre: float) -> float:
    """As the reference, the principal point at width / 2 + centre."""
    height, width = ranges.shape
    v, u = np.indices(ranges.shape)
    square = (u - width / 2 - centre) ** 2 + (v - height / 2 - centre) ** 2
    used = np.isfinite(ranges) & (square > 0)
    with np.errstate(divide="ignore"):
        return float(np.sqrt(np.median(square[used] / ((ranges[used] / distance) ** 2 - 1))))


def _by_a_line(ranges: np.ndarray, distance: float, off: float, power: int = 2) -> float:
    """A straight line through zero, least squares; off: of the middle, from width / 2."""
    v, u = np.indices(ranges.shape)
    square = (u - ranges.shape[1] / 2 + off) ** 2 + (v - ranges.shape[0] / 2 + off) ** 2
    more, used = (ranges / distance) ** power - 1, np.isfinite(ranges)
    return float(np.sqrt(np.sum(square[used] ** 2) / np.sum(square[used] * more[used])))


def _the_first_corner(ranges: np.ndarray, distance: float) -> float:
    square, _ = _pixels(ranges)
    return float(np.sqrt(square[0, 0] / ((ranges[0, 0] / distance) ** 2 - 1)))


def _pixels(ranges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    height, width = ranges.shape
    v, u = np.indices(ranges.shape)
    square = (u - (width - 1) / 2) ** 2 + (v - (height - 1) / 2) ** 2
    return square, np.isfinite(ranges) & (square > 0)


def _not_squared(ranges: np.ndarray, distance: float) -> float:
    square, used = _pixels(ranges)
    return float(np.sqrt(np.median(square[used] / (ranges[used] / distance - 1))))


def _root_forgotten(ranges: np.ndarray, distance: float) -> float:
    return focal_length(ranges, distance) ** 2


def _with_nan(ranges: np.ndarray, distance: float) -> float:
    square, _ = _pixels(ranges)
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(np.sqrt(np.median(square / ((ranges / distance) ** 2 - 1))))


def _one_not_subtracted(ranges: np.ndarray, distance: float) -> float:
    square, used = _pixels(ranges)
    return float(np.sqrt(np.median(square[used] / (ranges[used] / distance) ** 2)))


def _in_metres(ranges: np.ndarray, distance: float) -> float:
    square, used = _pixels(ranges)
    return float(np.sqrt(np.median(square[used] / (ranges[used] ** 2 - distance**2))))


# P4.4: the range error


def bias_coefficients(measured: np.ndarray, true: np.ndarray, repeat: float) -> np.ndarray:
    """Coefficients (a, b, c) of the error a + b sin(p) + c cos(p), p = 2 pi 4 measured / repeat, by least squares."""
    p = 2 * np.pi * 4 * measured / repeat
    columns = np.stack([np.ones_like(p), np.sin(p), np.cos(p)], axis=1)
    return np.linalg.lstsq(columns, measured - true, rcond=None)[0]


def _readings(rng: np.random.Generator) -> tuple:
    n, repeat = int(rng.integers(12, 40)), float(rng.uniform(5, 12))
    true = rng.uniform(0.1, 0.9, n) * repeat
    a, b, c = rng.choice((-1, 1), 3) * rng.uniform(0.01, 0.05, 3)
    p = 2 * np.pi * 4 * true / repeat
    return true + a + b * np.sin(p) + c * np.cos(p) + rng.normal(0, 0.003, n), true, repeat


def _sr4000(rng: np.random.Generator) -> tuple:
    measured, true, repeat = _readings(rng)
    return measured / repeat * 9.993, true / repeat * 9.993, 9.993


def _fitted(phase: np.ndarray, error: np.ndarray) -> np.ndarray:
    columns = np.stack([np.ones_like(phase), np.sin(phase), np.cos(phase)], axis=1)
    return np.linalg.lstsq(columns, error, rcond=None)[0]


def _without_offset(measured: np.ndarray, true: np.ndarray, repeat: float) -> np.ndarray:
    p = 2 * np.pi * 4 * measured / repeat
    b, c = np.linalg.lstsq(np.stack([np.sin(p), np.cos(p)], axis=1), measured - true, rcond=None)[0]
    return np.array([np.mean(measured - true), b, c])


# P4.5: flying pixels


def flying_pixels(depth: np.ndarray, tolerance: float) -> np.ndarray:
    """Mask (H, W) of the measured pixels that no two pixels in a row on any side support."""
    height, width = depth.shape
    padded = np.pad(1 / depth, 2, constant_values=np.nan)

    def neighbour(dv: int, du: int) -> np.ndarray:
        return padded[2 + dv : 2 + dv + height, 2 + du : 2 + du + width]

    supported = np.zeros(depth.shape, dtype=bool)
    for dv, du in ((0, 1), (0, -1), (1, 0), (-1, 0)):
        off = 2 * neighbour(dv, du) - neighbour(2 * dv, 2 * du) - 1 / depth
        with np.errstate(invalid="ignore"):
            supported |= np.abs(off) * depth**2 <= tolerance
    return np.isfinite(depth) & ~supported


def _two_surfaces(rng: np.random.Generator) -> tuple:
    """A slanted wall behind a nearer thing, pixels between them along one edge, and holes."""
    height, width = int(rng.integers(8, 13)), int(rng.integers(9, 14))
    v, u = np.indices((height, width))
    depth = 1 / (rng.uniform(0.12, 0.2) + rng.uniform(-0.01, 0.01) * u / width + rng.uniform(0.0, 0.02) * v / height)
    column = int(rng.integers(3, width - 3))
    depth[:, :column] = rng.uniform(1.2, 2.0) + 0.0 * depth[:, :column]
    depth[:, column] = rng.uniform(2.8, 3.6, height)
    depth[int(rng.integers(height)), int(rng.integers(width))] = rng.uniform(2.5, 3.0)
    depth[rng.random(depth.shape) < 0.03] = np.nan
    return depth, float(rng.uniform(0.03, 0.08))


def _steep_floor(rng: np.random.Generator) -> tuple:
    """A floor: neighbours differ by decimetres, and none of them flies."""
    v = np.arange(12)[:, None] * np.ones((1, 9))
    return 1.2 * 20 / (v + 3.0), 0.05


def _nothing_measured(rng: np.random.Generator) -> tuple:
    return np.full((6, 7), np.nan), 0.05


def _by_depth_itself(depth: np.ndarray, tolerance: float) -> np.ndarray:
    return _flying(depth, tolerance, depth, np.ones_like(depth))


def _flying(
    depth: np.ndarray,
    tolerance: float,
    q: np.ndarray,
    scale: np.ndarray,
    sides: tuple = ((0, 1), (0, -1), (1, 0), (-1, 0)),
    need: int = 1,
) -> np.ndarray:
    height, width = depth.shape
    padded = np.pad(q, 2, constant_values=np.nan)
    support = np.zeros(depth.shape, dtype=int)
    for dv, du in sides:
        one = padded[2 + dv : 2 + dv + height, 2 + du : 2 + du + width]
        two = padded[2 + 2 * dv : 2 + 2 * dv + height, 2 + 2 * du : 2 + 2 * du + width]
        with np.errstate(invalid="ignore"):
            support += np.abs(2 * one - two - q) * scale <= tolerance
    return np.isfinite(depth) & (support < need)


def _jumps(depth: np.ndarray, tolerance: float) -> np.ndarray:
    height, width = depth.shape
    padded = np.pad(depth, 1, constant_values=np.nan)
    found = np.zeros(depth.shape, dtype=bool)
    for dv, du in ((0, 1), (2, 1), (1, 0), (1, 2)):
        with np.errstate(invalid="ignore"):
            found |= np.abs(padded[dv : dv + height, du : du + width] - depth) > tolerance
    return found


def _between_its_neighbours(depth: np.ndarray, tolerance: float) -> np.ndarray:
    left, right = np.roll(depth, 1, axis=1), np.roll(depth, -1, axis=1)
    with np.errstate(invalid="ignore"):
        return (np.minimum(left, right) + tolerance < depth) & (depth < np.maximum(left, right) - tolerance)


def _round_the_edge(depth: np.ndarray, tolerance: float) -> np.ndarray:
    q, supported = 1 / depth, np.zeros(depth.shape, dtype=bool)
    for axis in (0, 1):
        for step in (1, -1):
            with np.errstate(invalid="ignore"):
                off = 2 * np.roll(q, step, axis) - np.roll(q, 2 * step, axis) - q
                supported |= np.abs(off) * depth**2 <= tolerance
    return np.isfinite(depth) & ~supported


# P4.6: noise by distance


def noise_by_distance(frames: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Standard deviation (B,) [m] over time of pixels with a mean between two edges (B + 1,); NaN = no pixel."""
    whole = np.isfinite(frames).all(axis=0)
    mean, variance = frames[:, whole].mean(axis=0), frames[:, whole].var(axis=0, ddof=1)
    found = np.full(len(edges) - 1, np.nan)
    for index in range(len(found)):
        inside = (mean >= edges[index]) & (mean < edges[index + 1])
        if inside.any():
            found[index] = np.sqrt(variance[inside].mean())
    return found


def _at_rest(rng: np.random.Generator) -> tuple:
    """Frames of a scene at rest; noise grows with distance; holes come and go; no pixel in the last bin."""
    frames, height, width = int(rng.integers(3, 7)), 6, 8
    scene = rng.uniform(1, 7, (height, width))
    values = scene + 0.004 * scene**2 * rng.standard_normal((frames, height, width))
    values[rng.random(values.shape) < 0.04] = np.nan
    values[0, 0, 0] = np.nan
    return values, np.array([0.5, 2.0, 4.0, 7.5, 9.0])


def _means_on_the_edges(rng: np.random.Generator) -> tuple:
    """Means that lie on an edge to the last digit: 1 m and 2 m belong to the bin that begins there, 4 m to none."""
    middle = np.array([[1.0, 1.5, 2.0], [2.0, 3.0, 4.0]])
    spread = np.array([[0.25, 0.125, 0.5], [0.25, 0.125, 1.0]])
    return np.stack([middle - spread, middle + spread]), np.array([1.0, 2.0, 4.0])


def _nothing_at_all(rng: np.random.Generator) -> tuple:
    return np.full((3, 4, 5), np.nan), np.array([1.0, 2.0, 3.0])


def _by_bins(frames: np.ndarray, edges: np.ndarray, tell) -> np.ndarray:
    """tell: of the series (M, n) of the pixels in a bin."""
    whole = np.isfinite(frames).all(axis=0)
    series = frames[:, whole]
    mean = series.mean(axis=0)
    bins = [series[:, (mean >= low) & (mean < high)] for low, high in itertools.pairwise(edges)]
    return np.array([tell(each) if each.size else np.nan for each in bins])


def _now_and_then(frames: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """NaN is skipped: two readings of a pixel are enough."""
    measured = np.isfinite(frames)
    count = measured.sum(axis=0)
    mean = np.where(measured, frames, 0.0).sum(axis=0) / np.maximum(count, 1)
    variance = (np.where(measured, frames - mean, 0.0) ** 2).sum(axis=0) / np.maximum(count - 1, 1)
    inside = [(count > 1) & (mean >= low) & (mean < high) for low, high in itertools.pairwise(edges)]
    return np.array([np.sqrt(variance[bin_].mean()) if bin_.any() else np.nan for bin_ in inside])


def _upper_edge_in(frames: np.ndarray, edges: np.ndarray) -> np.ndarray:
    return noise_by_distance(frames, np.nextafter(edges, np.inf))


# P4.7: the whole chain


def depth_from_raw(
    raw: np.ndarray,
    invalid: int,
    units: float,
    coefficients: np.ndarray,
    pattern: np.ndarray,
    focal: float,
    repeat: float,
) -> np.ndarray:
    """Depth (H, W) [m] of one raw frame: unit, range error, each pixel's own error, range to depth; NaN = none."""
    measured = np.where(raw == invalid, np.nan, raw / units)
    p = 2 * np.pi * 4 * measured / repeat
    true = measured - (coefficients[0] + coefficients[1] * np.sin(p) + coefficients[2] * np.cos(p)) - pattern
    return true / _lengths(raw.shape, focal)


def _lengths(shape: tuple[int, int], focal: float, off: float = 0.5) -> np.ndarray:
    v, u = np.indices(shape)
    return np.sqrt(1 + ((u - shape[1] / 2 + off) ** 2 + (v - shape[0] / 2 + off) ** 2) / focal**2)


def _one_frame(rng: np.random.Generator) -> tuple:
    height, width = int(rng.integers(4, 9)), int(rng.integers(4, 9))
    units, invalid = float(rng.choice([500, 1000, 4000, 5000])), int(rng.choice([0, 1, 65_000, 65_535]))
    raw = np.round(units * rng.uniform(0.8, 8.5, (height, width))).astype(np.uint16)
    raw[rng.random(raw.shape) < 0.1] = invalid
    raw.flat[2] = invalid
    coefficients = rng.choice((-1, 1), 3) * rng.uniform(0.01, 0.05, 3)
    pattern = rng.normal(0, 0.008, raw.shape)
    return raw, invalid, units, coefficients, pattern, float(rng.uniform(8, 40)), 9.993


def _nothing_came(rng: np.random.Generator) -> tuple:
    raw, invalid, *rest = _one_frame(rng)
    return np.full_like(raw, invalid), invalid, *rest


def _changed(**changes: Callable):
    """`depth_from_raw` with some of its arguments changed: a function of all of them each."""
    names = ("raw", "invalid", "units", "coefficients", "pattern", "focal", "repeat")

    def wrong(*given):
        arguments = dict(zip(names, given, strict=True))
        return depth_from_raw(**(arguments | {name: change(arguments) for name, change in changes.items()}))

    return wrong


def _depth_first(raw, invalid, units, coefficients, pattern, focal, repeat):
    measured = np.where(raw == invalid, np.nan, raw / units) / _lengths(raw.shape, focal)
    p = 2 * np.pi * 4 * measured / repeat
    return measured - (coefficients[0] + coefficients[1] * np.sin(p) + coefficients[2] * np.cos(p)) - pattern


def _errors_of_the_depth(raw, invalid, units, coefficients, pattern, focal, repeat):
    measured, none = np.where(raw == invalid, np.nan, raw / units), np.zeros(3)
    error = measured - depth_from_raw(raw, invalid, units, coefficients, pattern, 1e12, repeat)
    return depth_from_raw(raw, invalid, units, none, np.zeros(raw.shape), focal, repeat) - error


def _pattern_of_the_depth(raw, invalid, units, coefficients, pattern, focal, repeat):
    return depth_from_raw(raw, invalid, units, coefficients, np.zeros(raw.shape), focal, repeat) - pattern


def _pattern_first(raw, invalid, units, coefficients, pattern, focal, repeat):
    measured = np.where(raw == invalid, np.nan, raw / units) - pattern
    p = 2 * np.pi * 4 * measured / repeat
    true = measured - (coefficients[0] + coefficients[1] * np.sin(p) + coefficients[2] * np.cos(p))
    return true / _lengths(raw.shape, focal)


def _multiplied(*given):
    return depth_from_raw(*given) * _lengths(given[0].shape, given[5]) ** 2


def _still_range(*given):
    return depth_from_raw(*given) * _lengths(given[0].shape, given[5])


def _holes_measured(raw, invalid, *rest):
    return depth_from_raw(raw, -1, *rest)


def _zero_is_the_code(raw, invalid, *rest):
    return depth_from_raw(raw, 0, *rest)


def _half_a_pixel(*given):
    return _still_range(*given) / _lengths(given[0].shape, given[5], off=0.0)


def _overflowing(raw, invalid, units, coefficients, pattern, focal, repeat):
    found = depth_from_raw(raw, invalid, units, coefficients, pattern, focal, repeat)
    return np.nan_to_num(found)


EXERCISES = [
    Exercise(
        number="P4.1",
        level="warm-up",
        solution=invalid_code,
        inputs=_raw,
        cases=tuple(lambda rng, code=code: _raw_with(code, rng) for code in (0, 1, 32_001, 65_000, 65_535)),
        mistakes=(
            Mistake(lambda raw: 0, "0 is the code of many cameras, not of all. Let the frames tell: what repeats?"),
            Mistake(lambda raw: 65_535, "65535 is the code of some cameras. Let the frames tell: what repeats?"),
            Mistake(lambda raw: int(raw.min()), "The least number need not be the code: look at what repeats."),
            Mistake(lambda raw: int(raw.max()), "The greatest number need not be the code: look at what repeats."),
            Mistake(
                lambda raw: int((raw == invalid_code(raw)).sum()),
                "That is how often the code occurs. Which number is it?",
            ),
            Mistake(
                lambda raw: invalid_code(raw) / 1000,
                "You convert the code to metres. It is no distance: give the raw number.",
            ),
            Mistake(
                lambda raw: float(np.median(raw)), "The median is an ordinary measurement. Count how often each occurs."
            ),
            Mistake(
                lambda raw: int(np.unique(raw, return_counts=True)[1].argmax()),
                "That is its place in a list of numbers, not the number itself.",
            ),
            Mistake(lambda raw: int(np.bincount(raw.ravel())[1:].argmax()), "One too small: the count starts at 0."),
            Mistake(
                lambda raw: int(raw.flat[0]),
                "The first pixel may have been measured. Look at all of them: what repeats?",
            ),
        ),
    ),
    Exercise(
        number="P4.2",
        solution=unit_and_offset,
        inputs=_on_a_line,
        cases=(_no_offset,),
        mistakes=(
            Mistake(
                lambda numbers, distances: (
                    1 / unit_and_offset(numbers, distances)[0],
                    unit_and_offset(numbers, distances)[1],
                ),
                "Yours is metres a number. Asked for: numbers a metre.",
            ),
            Mistake(
                lambda numbers, distances: tuple(np.polyfit(distances, numbers, 1)),
                "Your offset is in raw numbers. How many metres is that?",
            ),
            Mistake(
                lambda numbers, distances: (
                    unit_and_offset(numbers, distances)[0],
                    -unit_and_offset(numbers, distances)[1],
                ),
                "The sign of the offset: it is positive where the camera reads too far.",
            ),
            Mistake(
                lambda numbers, distances: (float(np.sum(numbers * distances) / np.sum(distances**2)), 0.0),
                "You force the line through zero. The camera has an offset: a line has two numbers.",
            ),
            Mistake(
                lambda numbers, distances: (float(np.median(numbers / distances)), 0.0),
                "A quotient mixes unit and offset: near the camera the offset weighs most. Fit a line.",
            ),
            Mistake(
                lambda numbers, distances: (float(np.mean(numbers / distances)), 0.0),
                "A mean of quotients mixes unit and offset. Numbers over distances lie on a line: fit it.",
            ),
            Mistake(
                lambda numbers, distances: tuple(np.polyfit(numbers, distances, 1)),
                "You fit the distance over the numbers. Asked for: numbers a metre, so the other way round.",
            ),
            Mistake(
                lambda numbers, distances: unit_and_offset(numbers, distances)[::-1],
                "The two are exchanged: first the unit, then the offset.",
            ),
            Mistake(
                lambda numbers, distances: (
                    unit_and_offset(numbers, distances)[0],
                    1000 * unit_and_offset(numbers, distances)[1],
                ),
                "Your offset is in millimetres. Asked for: metres.",
            ),
        ),
    ),
    Exercise(
        number="P4.3",
        solution=focal_length,
        inputs=_wall,
        cases=(_odd_image, _no_corners),
        mistakes=(
            Mistake(
                lambda ranges, distance: _by_corners(ranges, distance, 0.0),
                "Half a pixel off: pixel centres are at whole numbers, so the middle is at (width - 1) / 2.",
            ),
            Mistake(_not_squared, "Pythagoras: it is the *square* of range / distance that is 1 + (pixels / f)^2."),
            Mistake(_root_forgotten, "That is the square of the focal length."),
            Mistake(
                _with_nan, "Pixels without measurement (NaN), or the one on the axis (0/0), spoil it. Leave them out."
            ),
            Mistake(_one_not_subtracted, "The 1 is missing: (range / distance)^2 = 1 + (pixels / f)^2."),
            Mistake(_in_metres, "Yours changes with the wall's distance: divide the range by it first."),
            Mistake(
                lambda ranges, distance: focal_length(ranges, distance) * distance,
                "That is in pixels times metres. The focal length does not know how far the wall is.",
            ),
            Mistake(lambda ranges, distance: 1 / focal_length(ranges, distance), "That is 1 / f."),
            Mistake(
                lambda ranges, distance: _by_a_line(ranges, distance, 0.0),
                "Half a pixel off: the middle of the image is at (width - 1) / 2.",
            ),
            Mistake(
                lambda ranges, distance: _by_a_line(ranges, distance, 0.5, power=1),
                "The ratio r / Z is squared in the equation.",
            ),
            Mistake(_the_first_corner, "That corner need not have been measured: let all pixels speak that were."),
        ),
    ),
    Exercise(
        number="P4.4",
        solution=bias_coefficients,
        inputs=_readings,
        cases=(_sr4000,),
        mistakes=(
            Mistake(
                lambda measured, true, repeat: -bias_coefficients(measured, true, repeat),
                "The other sign: the error is what the camera says minus what is true.",
            ),
            Mistake(
                lambda measured, true, repeat: _fitted(2 * np.pi * 4 * true / repeat, measured - true),
                "Your phase is of the true range. Later only the *measured* one is known: fit over that.",
            ),
            Mistake(
                lambda measured, true, repeat: _fitted(2 * np.pi * measured / repeat, measured - true),
                "Your wave goes round once within c / 2f. This error goes round four times.",
            ),
            Mistake(
                lambda measured, true, repeat: _fitted(2 * np.pi * 16 * measured / repeat, measured - true),
                "Your wave goes round sixteen times within c / 2f: the four is in it twice.",
            ),
            Mistake(
                lambda measured, true, repeat: bias_coefficients(measured, true, 9.993),
                "Your c / 2f is always 9.993 m: use the `repeat` that is given.",
            ),
            Mistake(
                lambda measured, true, repeat: bias_coefficients(measured, true, repeat)[[0, 2, 1]],
                "Sine and cosine are exchanged: (a, b, c) are constant, sine, cosine.",
            ),
            Mistake(
                lambda measured, true, repeat: _fitted(4 * measured / repeat, measured - true),
                "The phase is in turns: np.sin takes radians.",
            ),
            Mistake(
                lambda measured, true, repeat: np.array([bias_coefficients(measured, true, repeat)[0], *np.zeros(2)]),
                "You have the constant alone: where is the wave?",
            ),
            Mistake(
                _without_offset,
                "You take the mean away first. Constant and wave are not independent: fit all three at once.",
            ),
            Mistake(
                lambda measured, true, repeat: 1000 * bias_coefficients(measured, true, repeat),
                "Yours are in millimetres. Asked for: metres.",
            ),
            Mistake(
                lambda measured, true, repeat: bias_coefficients(measured, true, repeat)[[1, 2, 0]],
                "The constant comes first: (a, b, c).",
            ),
        ),
    ),
    Exercise(
        number="P4.5",
        solution=flying_pixels,
        inputs=_two_surfaces,
        cases=(_steep_floor, _nothing_measured),
        mistakes=(
            Mistake(
                _by_depth_itself,
                "You extrapolate Z itself. On a slanted plane Z is no line over the pixels; which function of Z is?",
            ),
            Mistake(
                _jumps, "You mark every jump: a slanted floor jumps from row to row, and an edge has two honest sides."
            ),
            Mistake(
                lambda depth, tolerance: _flying(depth, tolerance, 1 / depth, np.ones_like(depth)),
                "You compare a difference of 1/Z with metres. An error dq of 1/Z is one of Z^2 dq of Z.",
            ),
            Mistake(
                lambda depth, tolerance: _flying(depth, tolerance, 1 / depth, depth**2, need=4),
                "Yours wants support from *all* sides. At an edge the honest pixels have it from one.",
            ),
            Mistake(
                lambda depth, tolerance: _flying(depth, tolerance, 1 / depth, depth**2, ((0, 1), (0, -1))),
                "You look left and right alone. A thin upright pole is supported from above and below.",
            ),
            Mistake(
                lambda depth, tolerance: flying_pixels(depth, tolerance) | np.isnan(depth),
                "A pixel that was not measured does not fly: mark measured pixels alone.",
            ),
            Mistake(
                _between_its_neighbours,
                "You mark what lies between left and right. So does every pixel of a slanted wall.",
            ),
            Mistake(lambda depth, tolerance: ~flying_pixels(depth, tolerance), "Yours marks what does *not* fly."),
            Mistake(
                _round_the_edge, "np.roll brings in the other end of the image: beyond the edge there is no support."
            ),
            Mistake(
                lambda depth, tolerance: flying_pixels(depth, 0.05),
                "Your tolerance is always the same: use the one that is given.",
            ),
            Mistake(
                lambda depth, tolerance: np.isfinite(depth) & ~flying_pixels(depth, tolerance),
                "The mask is the wrong way round: True is for pixels that fly.",
            ),
        ),
    ),
    Exercise(
        number="P4.6",
        solution=noise_by_distance,
        inputs=_at_rest,
        cases=(_nothing_at_all, _means_on_the_edges),
        mistakes=(
            Mistake(
                lambda frames, edges: _by_bins(frames, edges, lambda s: s.mean(axis=0).std()),
                "That is how the scene varies from pixel to pixel. Noise is what varies from frame to frame.",
            ),
            Mistake(
                lambda frames, edges: _by_bins(frames, edges, lambda s: np.sqrt(s.var(axis=0).mean())),
                "You divide by M. The mean is estimated from the same M frames: divide by M - 1 (ddof=1).",
            ),
            Mistake(
                lambda frames, edges: _by_bins(frames, edges, lambda s: s.std(axis=0, ddof=1).mean()),
                "You average standard deviations, which is too little: average variances, then take the root.",
            ),
            Mistake(
                lambda frames, edges: _by_bins(frames, edges, lambda s: s.var(axis=0, ddof=1).mean()),
                "That is the variance: the root is missing.",
            ),
            Mistake(
                _now_and_then,
                "Pixels that were measured only now and then take part. Asked for: those measured in all frames.",
            ),
            Mistake(
                lambda frames, edges: np.nan_to_num(noise_by_distance(frames, edges)),
                "An empty bin has no noise that anyone measured: NaN, not 0.",
            ),
            Mistake(
                lambda frames, edges: _by_bins(frames, edges, lambda s: np.sqrt(s.var(axis=0, ddof=1).mean() / len(s))),
                "That is the error of the mean of M frames. Asked for: the noise of one.",
            ),
            Mistake(
                lambda frames, edges: _by_bins(frames, edges, lambda s: s.std(ddof=1)),
                "You throw all pixels of a bin together: then the scene itself counts as noise.",
            ),
            Mistake(
                lambda frames, edges: _by_bins(frames, edges, lambda s: np.diff(s, axis=0).std()),
                "A difference of two frames has the noise of both: root 2 too much.",
            ),
            Mistake(
                lambda frames, edges: 1000 * noise_by_distance(frames, edges),
                "Yours is in millimetres. Asked for: metres.",
            ),
            Mistake(
                _upper_edge_in,
                "A mean that lies on an edge belongs to the bin that begins there, not to the one that ends.",
            ),
        ),
    ),
    Exercise(
        number="P4.7",
        level="challenge",
        solution=depth_from_raw,
        inputs=_one_frame,
        cases=(_nothing_came,),
        mistakes=(
            Mistake(_depth_first, "The error is one of the *range*: take it away before you go from range to depth."),
            Mistake(
                _pattern_first,
                "You take the pattern away before the wave. Its phase is that of the reading itself.",
            ),
            Mistake(_multiplied, "Your depth exceeds the range: divide by the length of the ray."),
            Mistake(_still_range, "That is the range along the ray still."),
            Mistake(
                _holes_measured, "The code of no measurement became a distance in yours: NaN where raw == invalid."
            ),
            Mistake(_zero_is_the_code, "You take 0 for the code. It is given."),
            Mistake(_overflowing, "A pixel without measurement is NaN; yours is 0 m."),
            Mistake(_half_a_pixel, "Half a pixel off: the middle of the image is at (width - 1) / 2."),
            Mistake(
                _changed(coefficients=lambda given: -given["coefficients"]),
                "You add the range error. It is what the camera reads too far: take it away.",
            ),
            Mistake(
                _changed(pattern=lambda given: -given["pattern"]),
                "You add the pattern. It is what the pixel reads too far: take it away.",
            ),
            Mistake(
                _changed(pattern=lambda given: np.zeros(given["raw"].shape)),
                "Each pixel's own error, `pattern`, is not used.",
            ),
            Mistake(
                _changed(coefficients=lambda given: given["coefficients"] * [1, 0, 0]),
                "The wave is missing: you take away the constant alone.",
            ),
            Mistake(
                _changed(units=lambda given: 1000.0),
                "You take the numbers for millimetres. The unit is given.",
            ),
            Mistake(
                _changed(repeat=lambda given: 4 * given["repeat"]),
                "Your wave goes round once within c / 2f. This error goes round four times.",
            ),
            Mistake(
                _errors_of_the_depth,
                "Range error and pattern are errors of the *range*: both go before you divide by the ray's length.",
            ),
            Mistake(
                _pattern_of_the_depth,
                "The pattern is one of the *range*, too: take it away before you divide by the ray's length.",
            ),
            Mistake(
                lambda *given: depth_from_raw(*given) / _lengths(given[0].shape, given[5]),
                "You divide by 1 + s / f^2. The length of the ray is its root.",
            ),
        ),
    ),
]
