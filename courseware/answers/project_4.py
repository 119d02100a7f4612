"""Stages of project P4: from raw numbers of an unknown camera to depths, and how far to trust them."""

import numpy as np

from courseware.lessons.kit.exercise import Exercise


def squares(shape, middle=0.5):
    """Squared distance [pixels] of each pixel from the image's middle."""
    v, u = np.indices(shape)
    return (u - shape[1] / 2 + middle) ** 2 + (v - shape[0] / 2 + middle) ** 2


def invalid_code(raw):
    """The number that stands for "no measurement" in raw frames (M, H, W)."""
    # Measurements hardly repeat: the code is the number that occurs most.
    numbers, counts = np.unique(raw, return_counts=True)
    return int(numbers[np.argmax(counts)])


def raw_frames(rng: np.random.Generator, codes: tuple[int, ...] = (0, 1, 32_001, 65_000, 65_535)) -> tuple:
    """Draw frames whose measurements hardly repeat. A twentieth of the pixels hold one of the codes."""
    code, low = int(rng.choice(codes)), int(rng.uniform(500, 5000))
    values = rng.permutation(np.arange(low, low + 40_000, 7))[: 3 * 12 * 16].reshape(3, 12, 16).astype(np.uint16)
    values[rng.random(values.shape) < rng.uniform(0.04, 0.12)] = code
    values.flat[rng.permutation(values.size - 1)[:3] + 1] = code
    values.flat[0] = low + 3  # the first pixel was measured: it is not the code
    return (values,)


def unit_and_offset(numbers, distances):
    """Raw numbers a metre, and the offset [m], from mean raw numbers (K,) at taped distances (K,)."""
    # number = unit (distance + offset): a straight line.
    slope, intercept = np.polyfit(distances, numbers, 1)
    return slope, intercept / slope


def on_a_line(rng: np.random.Generator) -> tuple:
    units = float(rng.choice([500, 1000, 2000, 4000, 5000, 6000]))
    distances = np.sort(rng.uniform(0.8, 8.5, int(rng.integers(3, 9))))
    return units * (distances + rng.choice([-1, 1]) * rng.uniform(0.01, 0.1)), distances


def focal_length(ranges, distance):
    """Focal length [pixels] from ranges (H, W) [m] along the rays to a wall `distance` m ahead; NaN = none."""
    # (range / distance)^2 - 1 = square / f^2: a line through zero, by least squares, which spares the middle.
    s, y = squares(ranges.shape), (ranges / distance) ** 2 - 1
    used = np.isfinite(y)
    return np.sqrt((s[used] ** 2).sum() / (s[used] * y[used]).sum())


def a_wall(rng: np.random.Generator, corners: float = 1.0) -> tuple:
    """Draw a wall. corners: NaN if none of the four corners is measured."""
    focal, distance, shape = rng.uniform(8, 40), float(rng.uniform(0.8, 8.0)), tuple(rng.integers(6, 12, 2))
    ranges = distance * np.sqrt(1 + squares(shape) / focal**2)
    corner = ranges[0, 0]
    ranges[rng.random(shape) < 0.1] = np.nan
    ranges.flat[3], ranges[0, 0] = np.nan, corner
    ranges[[0, 0, -1, -1], [0, -1, 0, -1]] *= corners
    return ranges, distance


def bias_coefficients(measured, true, repeat):
    """Coefficients (a, b, c) [m] of the range error a + b sin p + c cos p, by least squares."""
    p = 2 * np.pi * 4 * measured / repeat
    columns = np.stack([np.ones_like(p), np.sin(p), np.cos(p)], axis=-1)
    return np.linalg.lstsq(columns, measured - true, rcond=None)[0]


def readings(rng: np.random.Generator, repeat: float | None = None) -> tuple:
    n, repeat = int(rng.integers(12, 40)), repeat or float(rng.uniform(5, 12))
    true = rng.uniform(0.1, 0.9, n) * repeat
    a, b, c = rng.choice((-1, 1), 3) * rng.uniform(0.01, 0.05, 3)
    p = 2 * np.pi * 4 * true / repeat
    return true + a + b * np.sin(p) + c * np.cos(p) + rng.normal(0, 0.003, n), true, repeat


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
    """Draw a slanted wall behind a nearer thing, pixels between them along one edge, and holes."""
    height, width = int(rng.integers(8, 13)), int(rng.integers(9, 14))
    v, u = np.indices((height, width))
    depth = 1 / (rng.uniform(0.12, 0.2) + rng.uniform(-0.01, 0.01) * u / width + rng.uniform(0.0, 0.02) * v / height)
    column = int(rng.integers(3, width - 3))
    depth[:, :column] = rng.uniform(1.2, 2.0)
    depth[:, column] = rng.uniform(2.8, 3.6, height)
    depth[int(rng.integers(height)), int(rng.integers(width))] = rng.uniform(2.5, 3.0)
    depth[rng.random(depth.shape) < 0.03] = np.nan
    return depth, float(rng.uniform(0.03, 0.08))


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
    """Draw frames of a scene at rest. Noise grows with distance, holes come and go, no pixel is in the last bin."""
    scene = rng.uniform(1, 7, (6, 8))
    values = scene + 0.004 * scene**2 * rng.standard_normal((int(rng.integers(3, 7)), 6, 8))
    values[rng.random(values.shape) < 0.04] = np.nan
    values[0, 0, 0] = np.nan
    return values, np.array([0.5, 2.0, 4.0, 7.5, 9.0])


def means_on_the_edges(rng: np.random.Generator) -> tuple:
    """Return means that lie on an edge to the last digit: 1 m and 2 m begin a bin, 4 m belongs to none."""
    middle = np.array([[1.0, 1.5, 2.0], [2.0, 3.0, 4.0]])
    spread = np.array([[0.25, 0.125, 0.5], [0.25, 0.125, 1.0]])
    return np.stack([middle - spread, middle + spread]), np.array([1.0, 2.0, 4.0])


def depth_from_raw(raw, invalid, units, coefficients, pattern, focal, repeat):
    """Depth (H, W) [m] of one raw frame (H, W); NaN where nothing was measured."""
    # Unit, range error, pattern, and only then depth.
    measured = np.where(raw == invalid, np.nan, raw / units)
    p = 2 * np.pi * 4 * measured / repeat
    error = coefficients[0] + coefficients[1] * np.sin(p) + coefficients[2] * np.cos(p)
    return (measured - error - pattern) / np.sqrt(1 + squares(raw.shape) / focal**2)


def one_frame(rng: np.random.Generator, lost: float = 0.1) -> tuple:
    """Draw one frame. lost: share of its pixels without measurement."""
    shape = tuple(rng.integers(4, 9, 2))
    units, invalid = float(rng.choice([500, 1000, 4000, 5000])), int(rng.choice([0, 1, 65_000, 65_535]))
    raw = np.round(units * rng.uniform(0.8, 8.5, shape)).astype(np.uint16)
    raw[rng.random(shape) < lost] = invalid
    raw.flat[2] = invalid
    coefficients = rng.choice((-1, 1), 3) * rng.uniform(0.01, 0.05, 3)
    return raw, invalid, units, coefficients, rng.normal(0, 0.008, shape), float(rng.uniform(8, 40)), 9.993


# fmt: off
EXERCISES = [
    Exercise("P4.1", invalid_code, raw_frames, "warm-up", cases={
        "the code is 0": lambda rng: raw_frames(rng, (0,)),
        "the code is 65535": lambda rng: raw_frames(rng, (65_535,)),
        "the code is another": lambda rng: raw_frames(rng, (1, 32_001, 65_000)),
    }, example=(([[[0, 2012, 0], [1987, 0, 2043]]],), 0)),
    Exercise("P4.2", unit_and_offset, on_a_line, cases={
        "no offset": lambda rng: (np.array([1000.0, 2000.0, 4000.0, 8000.0]), np.array([1.0, 2.0, 4.0, 8.0])),
    }, example=(([1050, 2050, 4050], [1, 2, 4]), (1000, 0.05))),
    Exercise("P4.3", focal_length, a_wall, cases={
        "a pixel on the axis": lambda rng: (2.0 * np.sqrt(1 + squares((7, 9)) / 20.0**2), 2.0),
        "corners not measured": lambda rng: a_wall(rng, np.nan),
    }),
    Exercise("P4.4", bias_coefficients, readings, cases={"the SR4000": lambda rng: readings(rng, 9.993)}),
    Exercise("P4.5", flying_pixels, two_surfaces, cases={
        # Neighbours differ by decimetres, and none of them flies.
        "a steep floor": lambda rng: (1.2 * 20 / (np.arange(12)[:, None] * np.ones((1, 9)) + 3.0), 0.05),
        "nothing measured": lambda rng: (np.full((6, 7), np.nan), 0.05),
    }),
    Exercise("P4.6", noise_by_distance, at_rest, cases={
        "nothing at all": lambda rng: (np.full((3, 4, 5), np.nan), np.array([1.0, 2.0, 3.0])),
        "means on the edges": means_on_the_edges,
    }),
    Exercise("P4.7", depth_from_raw, one_frame, "challenge", cases={
        "no pixel measured": lambda rng: one_frame(rng, 1.0),
    }),
]
