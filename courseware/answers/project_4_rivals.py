"""What stands beside a submission to project P4: no correction, the paper's assumption, and a calibration of ours."""

import numpy as np
from scipy.optimize import least_squares

from courseware.answers.project_4 import flying_pixels, invalid_code, squares
from courseware.lessons.project_4.sessions import REPEAT, UNITS

# Chosen on seeds 10,001 to 10,006.
FLYING = 0.06  # m: how far a pixel may lie from every line through two neighbours
ON_SURFACE = 0.03  # m: how far from the middle of a pair that it is averaged with
ROUNDS = 3  # of averaging


def as_told(walls, distances, intrinsics, frames) -> np.ndarray:
    """Find unit and code, believe the data sheet's focal length: the first frame of each place."""
    ranges, _ = in_metres(walls, distances, frames[:, 0])
    return ranges / ray_lengths(intrinsics[0, 0], frames.shape[-2:])


def pinhole_alone(walls, distances, intrinsics, frames) -> np.ndarray:
    """Take for granted what paper 1 does: a pinhole that is calibrated, and depths that are right."""
    ranges, wall_ranges = in_metres(walls, distances, frames[:, 0])
    return ranges / ray_lengths(fit_focal(mean_measured(wall_ranges, 1)), frames.shape[-2:])


def calibrated(walls, distances, intrinsics, frames) -> np.ndarray:
    """Fit focal length and range error together, then each pixel's own error; average frames and neighbours on one
    surface, and refuse flying pixels."""
    ranges, wall_ranges = in_metres(walls, distances, frames)
    mean_walls, shape = mean_measured(wall_ranges, 1), frames.shape[-2:]

    def errors(parameters: np.ndarray) -> np.ndarray:
        return mean_walls - _biased(distances[:, None, None] * ray_lengths(parameters[0], shape), parameters[1:])

    guess, scale = [fit_focal(mean_walls), 0.0, 0.0, 0.0], [10.0, 0.01, 0.01, 0.01]
    found = least_squares(lambda parameters: np.nan_to_num(errors(parameters)).ravel(), guess, x_scale=scale).x
    mean = mean_measured(ranges, 1) - np.nan_to_num(mean_measured(errors(found), 0))
    true = mean
    for _ in range(3):  # the error is a function of the true range
        true = mean - (_biased(true, found[1:]) - true)
    depth = true / ray_lengths(found[0], shape)
    return np.stack([_smoothed(np.where(flying_pixels(image, FLYING), np.nan, image)) for image in depth])


def in_metres(walls, distances, frames) -> tuple[np.ndarray, np.ndarray]:
    """Return ranges of the frames and of the walls in metres, NaN = no measurement: the unit is that of the middle."""
    invalid, (height, width) = invalid_code(walls), walls.shape[-2:]
    wall = np.where(walls == invalid, np.nan, walls.astype(np.float64))
    middle = wall[..., height // 2 - 3 : height // 2 + 3, width // 2 - 3 : width // 2 + 3]
    slope = np.polyfit(distances, np.nanmean(middle, axis=(1, 2, 3)), 1)[0]
    units = min(UNITS, key=lambda u: abs(np.log(u / slope)))
    return np.where(frames == invalid, np.nan, frames / units), wall / units


def mean_measured(values: np.ndarray, axis: int) -> np.ndarray:
    """Return the mean over an axis without NaN. It is NaN where all values are."""
    return np.ma.masked_invalid(values).mean(axis=axis).filled(np.nan)


def ray_lengths(focal: float, shape: tuple[int, int]) -> np.ndarray:
    """Return lengths `(H, W)` of the rays through the pixels' centres whose forward component is one."""
    return np.sqrt(1 + squares(shape) / focal**2)


def fit_focal(walls: np.ndarray) -> float:
    """Return the focal length with which flat walls `(K, H, W)`, each at an unknown distance, are flat."""

    def bent(parameters: np.ndarray) -> np.ndarray:
        flat = walls / ray_lengths(parameters[0], walls.shape[-2:])
        return np.nan_to_num(flat - np.nanmedian(flat, axis=(1, 2), keepdims=True)).ravel()

    return float(least_squares(bent, [80.0], loss="soft_l1", f_scale=0.02).x[0])


def _biased(true: np.ndarray, coefficients: np.ndarray) -> np.ndarray:
    """Return what the camera reads of true ranges: an offset, and a wave of four cycles over the unambiguous range."""
    phase = 2 * np.pi * 4 * true / REPEAT
    return true + coefficients[0] + coefficients[1] * np.sin(phase) + coefficients[2] * np.cos(phase)


def _smoothed(depth: np.ndarray) -> np.ndarray:
    """Average each pixel with the pairs of opposite neighbours that lie on one plane with it (1/Z is linear)."""
    q, (height, width) = 1 / depth, depth.shape
    for _ in range(ROUNDS):
        padded = np.pad(q, 1, constant_values=np.nan)
        total, weight = q.copy(), np.ones_like(q)
        for v, u in ((1, 2), (2, 1), (2, 2), (2, 0)):
            one, other = padded[v : v + height, u : u + width], padded[2 - v :, 2 - u :][:height, :width]
            middle = (one + other) / 2
            with np.errstate(invalid="ignore"):
                same = np.abs(middle - q) * depth**2 <= ON_SURFACE
            total += np.where(same, 2 * middle, 0.0)
            weight += 2.0 * same
        q = total / weight
    return 1 / q
