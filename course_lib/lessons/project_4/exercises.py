"""Stages of project P4: from raw numbers of an unknown camera to depths, and how far to trust them."""

import itertools

import numpy as np

from course_lib.lessons.kit.exercises import Exercise


def squares(shape, middle=0.5):
    """Squared distance [pixels] of each pixel from the image's middle."""
    v, u = np.indices(shape)
    return (u - shape[1] / 2 + middle) ** 2 + (v - shape[0] / 2 + middle) ** 2


# P4.1: the code of "no measurement"


def invalid_code(raw):
    """The number that stands for "no measurement" in raw frames (M, H, W)."""
    # Measurements hardly repeat: the code is the number that occurs most.
    numbers, counts = np.unique(raw, return_counts=True)
    return int(numbers[np.argmax(counts)])


def raw_frames(rng: np.random.Generator, code: int | None = None) -> tuple:
    """Frames whose measurements hardly repeat; a twentieth of the pixels hold the code."""
    code = int(rng.choice([0, 1, 32_001, 65_000, 65_535])) if code is None else code
    low = int(rng.uniform(500, 5000))
    values = rng.permutation(np.arange(low, low + 40_000, 7))[: 3 * 12 * 16].reshape(3, 12, 16).astype(np.uint16)
    values[rng.random(values.shape) < rng.uniform(0.04, 0.12)] = code
    values.flat[rng.permutation(values.size - 1)[:3] + 1] = code
    values.flat[0] = low + 3  # the first pixel was measured: it is not the code
    return (values,)


def the_code_is_0(rng: np.random.Generator) -> tuple:
    return raw_frames(rng, 0)


def the_code_is_65535(rng: np.random.Generator) -> tuple:
    return raw_frames(rng, 65_535)


def the_code_is_another(rng: np.random.Generator) -> tuple:
    return raw_frames(rng, int(rng.choice([1, 32_001, 65_000])))


# P4.2: unit and offset


def unit_and_offset(numbers, distances):
    """Raw numbers a metre, and the offset [m], from mean raw numbers (K,) at taped distances (K,)."""
    # number = unit (distance + offset): a straight line.
    slope, intercept = np.polyfit(distances, numbers, 1)
    return slope, intercept / slope


def on_a_line(rng: np.random.Generator) -> tuple:
    units = float(rng.choice([500, 1000, 2000, 4000, 5000, 6000]))
    distances = np.sort(rng.uniform(0.8, 8.5, int(rng.integers(3, 9))))
    return units * (distances + rng.choice([-1, 1]) * rng.uniform(0.01, 0.1)), distances


def no_offset(rng: np.random.Generator) -> tuple:
    distances = np.array([1.0, 2.0, 4.0, 8.0])
    return 1000.0 * distances, distances


# P4.3: the focal length


def focal_length(ranges, distance):
    """Focal length [pixels] from ranges (H, W) [m] along the rays to a wall `distance` m ahead; NaN = none."""
    # (range / distance)^2 - 1 = square / f^2: a line through zero, by least squares, which spares the middle.
    s, y = squares(ranges.shape), (ranges / distance) ** 2 - 1
    used = np.isfinite(y)
    return np.sqrt((s[used] ** 2).sum() / (s[used] * y[used]).sum())


def by_median(ranges, more, middle=0.5):
    """The median over the pixels instead of a line; right if `more` is (range / distance)^2 - 1."""
    square = squares(ranges.shape, middle)
    used = np.isfinite(more) & (square > 0)
    return np.sqrt(np.median(square[used] / more[used]))


def a_wall(rng: np.random.Generator) -> tuple:
    focal, distance, shape = rng.uniform(8, 40), float(rng.uniform(0.8, 8.0)), tuple(rng.integers(6, 12, 2))
    ranges = distance * np.sqrt(1 + squares(shape) / focal**2)
    corner = ranges[0, 0]
    ranges[rng.random(shape) < 0.1] = np.nan
    ranges.flat[3], ranges[0, 0] = np.nan, corner
    return ranges, distance


def corners_not_measured(rng: np.random.Generator) -> tuple:
    ranges, distance = a_wall(rng)
    ranges[[0, 0, -1, -1], [0, -1, 0, -1]] = np.nan
    return ranges, distance


def a_pixel_on_the_axis(rng: np.random.Generator) -> tuple:
    return 2.0 * np.sqrt(1 + squares((7, 9)) / 20.0**2), 2.0


# P4.4: the range error


def bias_coefficients(measured, true, repeat):
    """Coefficients (a, b, c) [m] of the range error a + b sin p + c cos p, by least squares."""
    p = 2 * np.pi * 4 * measured / repeat
    columns = np.stack([np.ones_like(p), np.sin(p), np.cos(p)], axis=-1)
    return np.linalg.lstsq(columns, measured - true, rcond=None)[0]


def without_offset(measured, true, repeat):
    p = 2 * np.pi * 4 * measured / repeat
    b, c = np.linalg.lstsq(np.stack([np.sin(p), np.cos(p)], axis=1), measured - true, rcond=None)[0]
    return np.array([np.mean(measured - true), b, c])


def readings(rng: np.random.Generator) -> tuple:
    n, repeat = int(rng.integers(12, 40)), float(rng.uniform(5, 12))
    true = rng.uniform(0.1, 0.9, n) * repeat
    a, b, c = rng.choice((-1, 1), 3) * rng.uniform(0.01, 0.05, 3)
    p = 2 * np.pi * 4 * true / repeat
    return true + a + b * np.sin(p) + c * np.cos(p) + rng.normal(0, 0.003, n), true, repeat


def the_sr4000(rng: np.random.Generator) -> tuple:
    measured, true, repeat = readings(rng)
    return measured / repeat * 9.993, true / repeat * 9.993, 9.993


# P4.5: flying pixels


def flying_pixels(depth, tolerance):
    """Mask (H, W): the measured pixels of a depth image [m] that no side supports to within tolerance [m]."""
    # Measured, and on no line of 1/Z through the next two pixels on any side.
    q = np.pad(1 / depth, 2, constant_values=np.nan)
    h, w = depth.shape
    support = np.zeros(depth.shape, dtype=bool)
    for dv, du in ((0, 1), (0, -1), (1, 0), (-1, 0)):
        one = q[2 + dv : 2 + dv + h, 2 + du : 2 + du + w]
        two = q[2 + 2 * dv : 2 + 2 * dv + h, 2 + 2 * du : 2 + 2 * du + w]
        support |= np.abs(2 * one - two - 1 / depth) * depth**2 <= tolerance
    return np.isfinite(depth) & ~support


def two_surfaces(rng: np.random.Generator) -> tuple:
    """A slanted wall behind a nearer thing, pixels between them along one edge, and holes."""
    height, width = int(rng.integers(8, 13)), int(rng.integers(9, 14))
    v, u = np.indices((height, width))
    depth = 1 / (rng.uniform(0.12, 0.2) + rng.uniform(-0.01, 0.01) * u / width + rng.uniform(0.0, 0.02) * v / height)
    column = int(rng.integers(3, width - 3))
    depth[:, :column] = rng.uniform(1.2, 2.0)
    depth[:, column] = rng.uniform(2.8, 3.6, height)
    depth[int(rng.integers(height)), int(rng.integers(width))] = rng.uniform(2.5, 3.0)
    depth[rng.random(depth.shape) < 0.03] = np.nan
    return depth, float(rng.uniform(0.03, 0.08))


def a_steep_floor(rng: np.random.Generator) -> tuple:
    """Neighbours differ by decimetres, and none of them flies."""
    return 1.2 * 20 / (np.arange(12)[:, None] * np.ones((1, 9)) + 3.0), 0.05


def nothing_measured(rng: np.random.Generator) -> tuple:
    return np.full((6, 7), np.nan), 0.05


def jumps(depth, tolerance):
    height, width = depth.shape
    padded = np.pad(depth, 1, constant_values=np.nan)
    sides = ((0, 1), (2, 1), (1, 0), (1, 2))
    return np.any([np.abs(padded[v : v + height, u : u + width] - depth) > tolerance for v, u in sides], axis=0)


def between_its_neighbours(depth, tolerance):
    left, right = np.roll(depth, 1, axis=1), np.roll(depth, -1, axis=1)
    return (np.minimum(left, right) + tolerance < depth) & (depth < np.maximum(left, right) - tolerance)


def round_the_edge(depth, tolerance):
    q, supported = 1 / depth, np.zeros(depth.shape, dtype=bool)
    for axis, step in itertools.product((0, 1), (1, -1)):
        off = 2 * np.roll(q, step, axis) - np.roll(q, 2 * step, axis) - q
        supported |= np.abs(off) * depth**2 <= tolerance
    return np.isfinite(depth) & ~supported


# P4.6: noise by distance


def noise_by_distance(frames, edges):
    """Standard deviation (B,) [m] of one reading over time, for distances between edges (B + 1,) [m]."""
    # Root of the mean variance over time, bin by bin.
    whole = np.isfinite(frames).all(axis=0)
    mean, variance = frames[:, whole].mean(axis=0), frames[:, whole].var(axis=0, ddof=1)
    found = np.full(len(edges) - 1, np.nan)
    for i in range(len(found)):
        inside = (mean >= edges[i]) & (mean < edges[i + 1])
        if inside.any():
            found[i] = np.sqrt(variance[inside].mean())
    return found


def at_rest(rng: np.random.Generator) -> tuple:
    """Frames of a scene at rest; noise grows with distance; holes come and go; no pixel in the last bin."""
    scene = rng.uniform(1, 7, (6, 8))
    values = scene + 0.004 * scene**2 * rng.standard_normal((int(rng.integers(3, 7)), 6, 8))
    values[rng.random(values.shape) < 0.04] = np.nan
    values[0, 0, 0] = np.nan
    return values, np.array([0.5, 2.0, 4.0, 7.5, 9.0])


def means_on_the_edges(rng: np.random.Generator) -> tuple:
    """Means that lie on an edge to the last digit: 1 m and 2 m belong to the bin that begins there, 4 m to none."""
    middle = np.array([[1.0, 1.5, 2.0], [2.0, 3.0, 4.0]])
    spread = np.array([[0.25, 0.125, 0.5], [0.25, 0.125, 1.0]])
    return np.stack([middle - spread, middle + spread]), np.array([1.0, 2.0, 4.0])


def nothing_at_all(rng: np.random.Generator) -> tuple:
    return np.full((3, 4, 5), np.nan), np.array([1.0, 2.0, 3.0])


def by_bins(frames, edges, tell):
    """A mistake: `tell` of the series (M, n) of the pixels in a bin."""
    series = frames[:, np.isfinite(frames).all(axis=0)]
    mean = series.mean(axis=0)
    bins = [series[:, (mean >= low) & (mean < high)] for low, high in itertools.pairwise(edges)]
    return np.array([tell(each) if each.size else np.nan for each in bins])


def measured_now_and_then(frames, edges):
    """A mistake: NaN is skipped; two readings of a pixel are enough."""
    measured = np.isfinite(frames)
    count = measured.sum(axis=0)
    mean = np.where(measured, frames, 0.0).sum(axis=0) / np.maximum(count, 1)
    variance = (np.where(measured, frames - mean, 0.0) ** 2).sum(axis=0) / np.maximum(count - 1, 1)
    inside = [(count > 1) & (mean >= low) & (mean < high) for low, high in itertools.pairwise(edges)]
    return np.array([np.sqrt(variance[one].mean()) if one.any() else np.nan for one in inside])


# P4.7: the whole chain


def depth_from_raw(raw, invalid, units, coefficients, pattern, focal, repeat):
    """Depth (H, W) [m] of one raw frame (H, W); NaN where nothing was measured."""
    # Unit, range error, pattern, and only then depth.
    measured = np.where(raw == invalid, np.nan, raw / units)
    p = 2 * np.pi * 4 * measured / repeat
    error = coefficients[0] + coefficients[1] * np.sin(p) + coefficients[2] * np.cos(p)
    return (measured - error - pattern) / np.sqrt(1 + squares(raw.shape) / focal**2)


def rays(raw, focal):
    """Lengths (H, W) of the pixels' rays, whose forward component is one."""
    return np.sqrt(1 + squares(raw.shape) / focal**2)


def errors_of_the_depth(raw, invalid, units, coefficients, pattern, focal, repeat):
    """A mistake: the wave's phase is that of the range, but the errors are taken off the depth."""
    measured = np.where(raw == invalid, np.nan, raw / units)
    p = 2 * np.pi * 4 * measured / repeat
    error = coefficients[0] + coefficients[1] * np.sin(p) + coefficients[2] * np.cos(p)
    return measured / rays(raw, focal) - error - pattern


def one_frame(rng: np.random.Generator) -> tuple:
    shape = tuple(rng.integers(4, 9, 2))
    units, invalid = float(rng.choice([500, 1000, 4000, 5000])), int(rng.choice([0, 1, 65_000, 65_535]))
    raw = np.round(units * rng.uniform(0.8, 8.5, shape)).astype(np.uint16)
    raw[rng.random(shape) < 0.1] = invalid
    raw.flat[2] = invalid
    coefficients = rng.choice((-1, 1), 3) * rng.uniform(0.01, 0.05, 3)
    return raw, invalid, units, coefficients, rng.normal(0, 0.008, shape), float(rng.uniform(8, 40)), 9.993


def no_pixel_measured(rng: np.random.Generator) -> tuple:
    raw, invalid, *rest = one_frame(rng)
    return np.full_like(raw, invalid), invalid, *rest


# fmt: off
EXERCISES = [
    Exercise("P4.1", invalid_code, raw_frames, "warm-up", cases=[
        the_code_is_0, the_code_is_65535, the_code_is_another,
    ], mistakes="""
        ... => return 0
        ... => return 65_535
        0 and 65535 are the codes of many cameras, not of all. Let the frames tell: what repeats?
        ... => return int(raw.min())
        ... => return int(raw.max())
        The least or the greatest number need not be the code: look at what repeats.
        ... => return int((raw == invalid_code(raw)).sum())
        That is how often the code occurs. Which number is it?
        int(numbers => (1 / 1000) * int(numbers
        You convert the code to metres. It is no distance: give the raw number.
        ... => return float(np.median(raw))
        The median is an ordinary measurement. Count how often each occurs.
        numbers[np.argmax(counts)] => np.argmax(counts)
        That is its place in a list of numbers, not the number itself.
        ... => return int(np.bincount(raw.ravel())[1:].argmax())
        One too small: the count starts at 0.
        ... => return int(raw.flat[0])
        The first pixel may have been measured. Look at all of them: what repeats?
    """),
    Exercise("P4.2", unit_and_offset, on_a_line, cases=[no_offset], mistakes="""
        return slope => return 1 / slope
        Yours is metres a number. Asked for: numbers a metre.
        intercept / slope => intercept
        Your offset is in raw numbers. How many metres is that?
        intercept / slope => -intercept / slope
        The sign of the offset: it is positive where the camera reads too far.
        ... => return np.sum(numbers * distances) / np.sum(distances**2), 0.0
        You force the line through zero. The camera has an offset: a line has two numbers.
        ... => return np.median(numbers / distances), 0.0
        ... => return np.mean(numbers / distances), 0.0
        A quotient mixes unit and offset: near the camera the offset weighs most. Fit a line.
        ... => return tuple(np.polyfit(numbers, distances, 1))
        You fit the distance over the numbers. Asked for: numbers a metre, so the other way round.
        slope, intercept / slope => intercept / slope, slope
        The two are exchanged: first the unit, then the offset.
        intercept / slope => 1000 * intercept / slope
        Your offset is in millimetres. Asked for: metres.
    """),
    Exercise("P4.3", focal_length, a_wall, cases=[a_pixel_on_the_axis, corners_not_measured], mistakes="""
        squares(ranges.shape) => squares(ranges.shape, 0.0)
        ... => return by_median(ranges, (ranges / distance) ** 2 - 1, middle=0.0)
        Half a pixel off: pixel centres are at whole numbers, so the middle is at (width - 1) / 2.
        (ranges / distance) ** 2 - 1 => ranges / distance - 1
        ... => return by_median(ranges, ranges / distance - 1)
        Pythagoras: it is the *square* of range / distance that is 1 + (pixels / f)^2.
        return np.sqrt( => return (
        That is the square of the focal length.
        used = np.isfinite(y) => used = np.ones(y.shape, bool)
        ... => return np.sqrt(np.median(squares(ranges.shape) / ((ranges / distance) ** 2 - 1)))
        Pixels without measurement (NaN), or the one on the axis (0/0), spoil it. Leave them out.
        ** 2 - 1 => ** 2
        ... => return by_median(ranges, (ranges / distance) ** 2)
        The 1 is missing: (range / distance)^2 = 1 + (pixels / f)^2.
        (ranges / distance) ** 2 - 1 => ranges**2 - distance**2
        Yours changes with the wall's distance: divide the range by it first.
        return np.sqrt => return distance * np.sqrt
        That is in pixels times metres. The focal length does not know how far the wall is.
        return np.sqrt => return 1 / np.sqrt
        That is 1 / f.
        ... => return np.sqrt(squares(ranges.shape)[0, 0] / ((ranges[0, 0] / distance) ** 2 - 1))
        That corner need not have been measured: let all pixels speak that were.
    """),
    Exercise("P4.4", bias_coefficients, readings, cases=[the_sr4000], mistakes="""
        measured - true => true - measured
        The other sign: the error is what the camera says minus what is true.
        4 * measured => 4 * true
        Your phase is of the true range. Later only the *measured* one is known: fit over that.
        4 * measured => measured
        Your wave goes round once within c / 2f. This error goes round four times.
        4 * measured => 16 * measured
        Your wave goes round sixteen times within c / 2f: the four is in it twice.
        / repeat => / 9.993
        Your c / 2f is always 9.993 m: use the `repeat` that is given.
        np.sin(p), np.cos(p) => np.cos(p), np.sin(p)
        Sine and cosine are exchanged: (a, b, c) are constant, sine, cosine.
        2 * np.pi * 4 => 4
        The phase is in turns: np.sin takes radians.
        ... => return np.append(bias_coefficients(measured, true, repeat)[0], [0.0, 0.0])
        You have the constant alone: where is the wave?
        ... => return without_offset(measured, true, repeat)
        You take the mean away first. Constant and wave are not independent: fit all three at once.
        ... => return 1000 * bias_coefficients(measured, true, repeat)
        Yours are in millimetres. Asked for: metres.
        np.ones_like(p), np.sin(p), np.cos(p) => np.sin(p), np.cos(p), np.ones_like(p)
        The constant comes first: (a, b, c).
    """),
    Exercise("P4.5", flying_pixels, two_surfaces, cases=[a_steep_floor, nothing_measured], mistakes="""
        np.pad(1 / depth, => np.pad(depth, and also two - 1 / depth) * depth**2 => two - depth)
        You extrapolate Z itself. On a slanted plane Z is no line over the pixels; which function of Z is?
        ... => return jumps(depth, tolerance)
        You mark every jump: a slanted floor jumps from row to row, and an edge has two honest sides.
        * depth**2 =>
        You compare a difference of 1/Z with metres. An error dq of 1/Z is one of Z^2 dq of Z.
        np.zeros(depth.shape, dtype=bool) => np.ones(depth.shape, dtype=bool) and also |= => &=
        Yours wants support from *all* sides. At an edge the honest pixels have it from one.
        , (1, 0), (-1, 0) =>
        You look left and right alone. A thin upright pole is supported from above and below.
        np.isfinite(depth) & ~support => ~support
        A pixel that was not measured does not fly: mark measured pixels alone.
        ... => return between_its_neighbours(depth, tolerance)
        You mark what lies between left and right. So does every pixel of a slanted wall.
        ... => return ~flying_pixels(depth, tolerance)
        ... => return np.isfinite(depth) & ~flying_pixels(depth, tolerance)
        The mask is the wrong way round: True is for pixels that fly.
        ... => return round_the_edge(depth, tolerance)
        np.roll brings in the other end of the image: beyond the edge there is no support.
        ... => return flying_pixels(depth, 0.05)
        Your tolerance is always the same: use the one that is given.
    """),
    Exercise("P4.6", noise_by_distance, at_rest, cases=[nothing_at_all, means_on_the_edges], mistakes="""
        ... => return by_bins(frames, edges, lambda series: series.mean(axis=0).std())
        That is how the scene varies from pixel to pixel. Noise is what varies from frame to frame.
        , ddof=1 =>
        You divide by M. The mean is estimated from the same M frames: divide by M - 1 (ddof=1).
        np.sqrt(variance[inside].mean()) => np.sqrt(variance[inside]).mean()
        You average standard deviations, which is too little: average variances, then take the root.
        np.sqrt(variance[inside].mean()) => variance[inside].mean()
        That is the variance: the root is missing.
        ... => return measured_now_and_then(frames, edges)
        Pixels that were measured only now and then take part. Asked for: those measured in all frames.
        np.full(len(edges) - 1, np.nan) => np.zeros(len(edges) - 1)
        An empty bin has no noise that anyone measured: NaN, not 0.
        variance[inside].mean() => variance[inside].mean() / len(frames)
        That is the error of the mean of M frames. Asked for: the noise of one.
        ... => return by_bins(frames, edges, lambda series: series.std(ddof=1))
        You throw all pixels of a bin together: then the scene itself counts as noise.
        ... => return by_bins(frames, edges, lambda series: np.diff(series, axis=0).std())
        A difference of two frames has the noise of both: root 2 too much.
        ... => return 1000 * noise_by_distance(frames, edges)
        Yours is in millimetres. Asked for: metres.
        mean >= edges => mean > edges and also mean < edges => mean <= edges
        A mean that lies on an edge belongs to the bin that begins there, not to the one that ends.
    """),
    Exercise("P4.7", depth_from_raw, one_frame, "challenge", cases=[no_pixel_measured], mistakes="""
        raw / units) => raw / units) / rays(raw, focal) and also return ( => return rays(raw, focal) * (
        ... => return errors_of_the_depth(raw, invalid, units, coefficients, pattern, focal, repeat)
        error - pattern) / np.sqrt(1 + squares(raw.shape) / focal**2) => error) / rays(raw, focal) - pattern
        Range error and pattern are errors of the *range*: both go before you divide by the ray's length.
        p = 2 => measured = measured - pattern; p = 2 and also - pattern) => )
        You take the pattern away before the wave. Its phase is that of the reading itself.
        ) / np.sqrt => ) * np.sqrt
        Your depth exceeds the range: divide by the length of the ray.
        / np.sqrt(1 + squares(raw.shape) / focal**2) =>
        That is the range along the ray still.
        raw == invalid => raw == -1
        The code of no measurement became a distance in yours: NaN where raw == invalid.
        raw == invalid => raw == 0
        You take 0 for the code. It is given.
        ... => return np.nan_to_num(depth_from_raw(raw, invalid, units, coefficients, pattern, focal, repeat))
        A pixel without measurement is NaN; yours is 0 m.
        squares(raw.shape) => squares(raw.shape, 0.0)
        Half a pixel off: the middle of the image is at (width - 1) / 2.
        - error => + error
        You add the range error. It is what the camera reads too far: take it away.
        - pattern => + pattern
        You add the pattern. It is what the pixel reads too far: take it away.
        - pattern =>
        Each pixel's own error, `pattern`, is not used.
        + coefficients[1] * np.sin(p) + coefficients[2] * np.cos(p) =>
        The wave is missing: you take away the constant alone.
        raw / units => raw / 1000
        You take the numbers for millimetres. The unit is given.
        4 * measured => measured
        Your wave goes round once within c / 2f. This error goes round four times.
        / np.sqrt(1 + => / (1 +
        You divide by 1 + s / f^2. The length of the ray is its root.
    """),
]
