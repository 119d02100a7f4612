"""Exercises of lesson 20: raw depth to metres, K of a smaller image, a baseline measured, a baseline chosen."""

import numpy as np

from courseware.lessons.kit.exercises import Exercise


def to_metres(raw, units_per_metre, invalid):
    """Depth in metres (H, W) of raw 16-bit numbers; NaN where a pixel holds `invalid`."""
    # NaN at the holes, units to metres elsewhere.
    return np.where(raw == invalid, np.nan, raw / units_per_metre)


def raw_images(rng: np.random.Generator) -> tuple:
    invalid = int(rng.choice([0, 65535]))
    raw = rng.integers(400, 60_000, size=(3, int(rng.integers(4, 7)))).astype(np.uint16)
    holes = rng.choice(raw.size, size=3, replace=False)
    # The last is the other number that marks no measurement elsewhere: here it is a depth like any other.
    raw.flat[holes] = [invalid, invalid, 65535 - invalid]
    return raw, float(rng.choice([1000, 5000, 4000])), invalid


def resized_intrinsics(k, scale):
    """K (3, 3) of the same camera after its image was resized by `scale`; pixel centres at whole numbers."""
    # Lengths from the image's edge scale; the edge is at -0.5.
    resized = k.copy()
    resized[[0, 1], [0, 1]] *= scale
    resized[:2, 2] = scale * (k[:2, 2] + 0.5) - 0.5
    return resized


def some_k(rng: np.random.Generator) -> np.ndarray:
    fx, cx, cy = rng.uniform(400, 700), rng.uniform(300, 340), rng.uniform(220, 260)
    return np.array([[fx, 0, cx], [0, fx * rng.uniform(0.9, 1.1), cy], [0, 0, 1.0]])


def baseline_from_marks(v_upper, v_lower, height, distance):
    """Baseline [m], the median over marks at horizontal distances (n,) seen at rows (n,) of two panoramas."""
    # Each mark's height as seen from both cameras; the baseline is the difference.
    e_upper, e_lower = (np.pi * (0.5 - np.asarray(v) / height) for v in (v_upper, v_lower))
    return np.median(distance * (np.tan(e_lower) - np.tan(e_upper)))


def marks(rng: np.random.Generator, side: int = 1, shown: slice = slice(None), misread: object = 0.0) -> tuple:
    """Draw marks. side: -1 exchanges the cameras. misread: further errors of the lower rows of the marks shown."""
    height, baseline, n = int(rng.choice([512, 640, 1024])), side * rng.uniform(0.15, 0.5), 7
    distance = rng.uniform(0.8, 3.0, size=n)
    drop = rng.uniform(-0.3, 0.8, size=n)  # metres from the upper camera down to the mark
    v_upper = height * (0.5 + np.arctan(drop / distance) / np.pi)
    v_lower = height * (0.5 + np.arctan((drop - baseline) / distance) / np.pi) + rng.normal(0, 0.4, size=n)
    v_lower[0] += 25.0  # a row that was misread: the mean would follow it, and the middle one does not
    return v_upper[shown], v_lower[shown] + misread, height, distance[shown]


def baseline_needed(distance, row_error, height, limit):
    """Least baseline [m] at which a mark's distance is known to `limit` [m] (one sigma); NaN if there is none."""
    # sigma_rho = sqrt(2) sigma_e (rho^2 / B + B / 4), since 1 / cos(e)^2 = 1 + (B / 2 rho)^2.
    reach = limit / (np.sqrt(2) * np.pi * row_error / height)  # the farthest distance that any baseline serves
    if reach < distance:
        return np.nan
    return 2 * (reach - np.sqrt(reach**2 - distance**2))  # B^2 / 4 - reach B + rho^2 = 0


def rig_and_limit(rng: np.random.Generator) -> tuple:
    """Draw a mark, far or near, and an error that a baseline allows, seldom not."""
    distance, height, row_error = rng.uniform(1, 6), int(rng.choice([512, 640, 960, 1024])), rng.uniform(0.2, 1.5)
    reach = distance * rng.uniform(0.9, 8)
    return float(distance), float(row_error), height, float(reach * np.sqrt(2) * np.pi * row_error / height)


# fmt: off
EXERCISES = [
    Exercise("20.1", to_metres, raw_images, "warm-up", cases={
        "nothing measured": lambda rng: (np.zeros((2, 3), dtype=np.uint16), 1000.0, 0),
        "all measured": lambda rng: (rng.integers(1, 60_000, size=(2, 4)).astype(np.uint16), 5000.0, 0),
    }, mistakes="""
        raw == invalid => raw <= invalid
        Only a pixel that is equal to `invalid` is a hole, not every one that is smaller or larger.
        raw == invalid => raw == 0
        raw == invalid => (raw == 0) | (raw == 65535)
        Each file has its own number for a hole: `invalid`. Both 0 and 65535 may be depths like any other.
        raw == invalid => raw != invalid
        The two are exchanged: yours is NaN where there is a measurement.
        raw == invalid => raw / units_per_metre == invalid
        You compare metres with `invalid`. It is a raw number: compare before you divide.
        ... => return raw / units_per_metre
        Pixels without a measurement have become depths. They must be NaN: compare the raw numbers with `invalid`.
        raw / units_per_metre => raw / 1000
        You always divide by 1000. The file says how many units make a metre: use `units_per_metre`.
        raw / units_per_metre => raw // units_per_metre
        Yours are whole metres: `//` throws the rest away. Use `/`.
        np.nan => 0.0
        A hole is NaN: 0 would be a surface at the lens, and inf is a simulated ray that hit nothing.
        raw == invalid => (raw == invalid) | (raw == 0)
        You make a hole of every 0. Only `invalid` marks a hole: with invalid = 65535, a 0 is a depth of 0 m.
    """),
    Exercise("20.2", resized_intrinsics, lambda rng: (some_k(rng), rng.choice([0.125, 0.25, 0.5, 2.0])), cases={
        "size unchanged": lambda rng: (some_k(rng), 1.0),
        "the paper's camera": lambda rng: (np.array([[217.0, 0, 87.5], [0, 217.0, 71.5], [0, 0, 1]]), 0.25),
    }, mistakes="""
        scale * (k[:2, 2] + 0.5) - 0.5 => scale * k[:2, 2]
        scale * (k[:2, 2] + 0.5) - 0.5 => scale * (k[:2, 2] + 0.5)
        cx and cy are half a pixel off. The image's edge is at -0.5: add 0.5 before you scale, subtract 0.5 after it.
        resized[[0, 1], [0, 1]] *= scale => resized[[0, 1], [0, 1]] = scale * (k[[0, 1], [0, 1]] + 0.5) - 0.5
        The half pixel belongs to positions, cx and cy. A focal length is a length: it has no origin.
        resized[[0, 1], [0, 1]] *= scale => pass
        fx and fy are unchanged. They are in pixels too: with half the pixels they are half as long.
        resized[:2, 2] = scale * (k[:2, 2] + 0.5) - 0.5 => pass
        cx and cy are unchanged: they would lie outside the middle of the new image.
        ... => return k * scale
        Only focal lengths and positions scale: a pinhole's K ends in [0, 0, 1].
        ... => return resized_intrinsics(k, 1 / scale)
        You divide by the scale. An image of half the width (scale 0.5) has half the focal length.
        return resized => resized[1, 1] = resized[0, 0]; return resized
        You take the column's number for the row as well: fx and fy may differ, and so do cx and cy.
    """),
    Exercise("20.3", baseline_from_marks, marks, cases={
        "images exchanged": lambda rng: marks(rng, side=-1),
        "an even number of marks": lambda rng: marks(rng, shown=slice(4), misread=[0.0, -6.0, -14.0, -25.0]),
        "marks of both signs": lambda rng: marks(rng, shown=slice(2, 7), misread=[200.0, 200.0, 0.0, 0.0, 0.0]),
        "one mark": lambda rng: marks(rng, shown=slice(3, 4)),
    }, mistakes="""
        np.tan(e_lower) - np.tan(e_upper) => e_lower - e_upper
        You subtract the angles themselves. Heights go with their tangents: rho tan(e).
        np.tan(e_lower) - np.tan(e_upper) => np.tan(e_lower - e_upper)
        The tangent of a difference is not the difference of the tangents. Subtract the tangents, mark by mark.
        np.tan(e_lower) - np.tan(e_upper) => np.sin(e_lower) - np.sin(e_upper)
        sin(e) goes with the slanted distance. `distance` is horizontal: use tan(e).
        np.pi * => 180 *
        np.pi * => 2 * np.pi *
        The rows run from straight up to straight down. That is pi radians, not 2 pi, and not 180.
        0.5 - np.asarray(v) / height => np.asarray(v) / height
        Rows count from the top, elevations from the horizon, upwards: e = (1/2 - v / height) pi.
        np.asarray(v) / height => np.asarray(v) / (height - 1)
        You divide by height - 1. The symbol table counts `height` rows from straight up to straight down.
        ... => return abs(baseline_from_marks(v_upper, v_lower, height, distance))
        (np.tan(e_lower) - np.tan(e_upper)) => abs(np.tan(e_lower) - np.tan(e_upper))
        You drop the sign. A negative baseline says that the images are exchanged: leave it as it comes.
        return np.median( => return (
        Yours has one number for each mark. Return their median, one number.
        (np.tan(e_lower) - np.tan(e_upper)) => np.tan(e_lower)) - np.median(distance * np.tan(e_upper)
        Two medians may be of different marks. Compute the baseline from each mark, then take one median.
    """),
    Exercise("20.4", baseline_needed, rig_and_limit, "challenge", tolerance=1e-5, cases={
        "the example": lambda rng: (4.0, 0.5, 960, 0.10),
        "no baseline is enough": lambda rng: (8.0, 2.0, 512, 0.05),
    }, mistakes="""
        return np.nan => return np.inf
        Where even the best baseline is not good enough the task asks for NaN.
        return 2 * (reach - np.sqrt(reach**2 - distance**2)) => return 2 * distance
        There the error is least. The task asks for the *least baseline* whose error is still within the limit.
        2 * (reach - np.sqrt(reach**2 - distance**2)) => distance**2 / reach and also reach < distance => reach < 0
        Close: that is for far marks. Near the rig the angles are not small: keep 1 / cos(e)^2.
        np.sqrt(2) * np.pi => np.pi
        Two rows are read, one on each image, and each is wrong on its own: their variances add.
        np.sqrt(2) * np.pi => 2 * np.pi
        You add the two rows' errors. They are independent: add their variances, then take the root.
        np.sqrt(2) * np.pi => np.sqrt(2) * 2 * np.pi
        Rows run from straight up to straight down. That is pi radians, not 2 pi.
        reach - np.sqrt => reach + np.sqrt
        Two baselines give just that error. The *least* is asked for: the other root.
    """),
]
