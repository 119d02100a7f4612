"""Exercises of lesson 20: raw depth to metres, K of a smaller image, a baseline measured, a baseline chosen."""

import numpy as np

from courseware.lessons.kit.exercise import Exercise


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
    }, example=(([[5000, 0, 65535]], 5000, 0), [[1.0, np.nan, 13.107]])),
    Exercise("20.2", resized_intrinsics, lambda rng: (some_k(rng), rng.choice([0.125, 0.25, 0.5, 2.0])), cases={
        "size unchanged": lambda rng: (some_k(rng), 1.0),
        "the paper's camera": lambda rng: (np.array([[217.0, 0, 87.5], [0, 217.0, 71.5], [0, 0, 1]]), 0.25),
    }),
    Exercise("20.3", baseline_from_marks, marks, cases={
        "images exchanged": lambda rng: marks(rng, side=-1),
        "an even number of marks": lambda rng: marks(rng, shown=slice(4), misread=[0.0, -6.0, -14.0, -25.0]),
        "marks of both signs": lambda rng: marks(rng, shown=slice(2, 7), misread=[200.0, 200.0, 0.0, 0.0, 0.0]),
        "one mark": lambda rng: marks(rng, shown=slice(3, 4)),
    }, example=(([260, 300], [240, 270.8], 512, [1.63, 1.07]), 0.2)),
    Exercise("20.4", baseline_needed, rig_and_limit, "challenge", tolerance=1e-5, cases={
        "the example": lambda rng: (4.0, 0.5, 960, 0.10),
        "no baseline is enough": lambda rng: (8.0, 2.0, 512, 0.05),
    }, example=((4, 0.5, 960, 0.1), 0.371)),
]
