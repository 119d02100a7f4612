"""Exercises of lesson 11: from pixel to direction, the angle between two columns, the mean of several columns."""

from __future__ import annotations

import numpy as np

from course_lib.lessons.kit.exercises import Exercise, Mistake

# 11.1: from a pixel to a direction


def direction_of(u: float, v: float, width: int, height: int) -> np.ndarray:
    """Unit vector (3,) of edge coordinates on a panorama: x ahead, y left, z up."""
    return _from_angles((0.5 - u / width) * 2 * np.pi, (0.5 - v / height) * np.pi)


def _from_angles(azimuth: float, elevation: float) -> np.ndarray:
    ahead, left = np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth)
    return np.array([ahead, left, np.sin(elevation)])


def _pixel(rng: np.random.Generator) -> tuple:
    height = int(rng.choice([320, 512, 640, 960]))
    return float(rng.uniform(0, 2 * height)), float(rng.uniform(0.05, 0.95) * height), 2 * height, height


def _angles(u: float, v: float, width: int, height: int) -> tuple[float, float]:
    return (0.5 - u / width) * 2 * np.pi, (0.5 - v / height) * np.pi


def _no_cosine(u: float, v: float, width: int, height: int) -> np.ndarray:
    azimuth, elevation = _angles(u, v, width, height)
    return np.array([np.cos(azimuth), np.sin(azimuth), np.sin(elevation)])


def _polar_angle(u: float, v: float, width: int, height: int) -> np.ndarray:
    azimuth, _ = _angles(u, v, width, height)
    return _from_angles(azimuth, v / height * np.pi)


# 11.2: the angle from one column to another


def column_gap_deg(u_from: float, u_to: float, width: int) -> float:
    """Azimuth of one column minus that of another, degrees in [-180, 180)."""
    return float((_plain_gap(u_from, u_to, width) + 180) % 360 - 180)


def _plain_gap(u_from: float, u_to: float, width: int) -> float:
    return (u_from - u_to) / width * 360


def _columns(rng: np.random.Generator) -> tuple:
    """Two columns: on one side of the seam, or one on each side of it, in either order."""
    width = int(rng.choice([640, 1280, 1920]))
    u_from, u_to = rng.uniform(0.05, 0.5, size=2) * width
    if rng.random() < 0.5:
        u_from, u_to = rng.uniform(0, 0.1) * width, rng.uniform(0.9, 1) * width
    if rng.random() < 0.5:
        u_from, u_to = u_to, u_from
    return float(u_from), float(u_to), width


def _one_side_only(u_from: float, u_to: float, width: int) -> float:
    gap = _plain_gap(u_from, u_to, width)
    return gap - 360 if gap >= 180 else gap


def _other_side_only(u_from: float, u_to: float, width: int) -> float:
    gap = _plain_gap(u_from, u_to, width)
    return gap + 360 if gap < -180 else gap


# 11.3: the mean of several columns


def mean_column(columns: np.ndarray, width: int) -> float:
    """The mean of columns (n,) on the circle, in [0, width)."""
    angles = np.asarray(columns) / width * 2 * np.pi
    mean = np.arctan2(np.sin(angles).sum(), np.cos(angles).sum())
    return float(mean / (2 * np.pi) * width % width)


def _columns_of_an_object(rng: np.random.Generator) -> tuple:
    """Columns within a quarter of the panorama, across the seam in about half of the inputs."""
    width = int(rng.choice([640, 1280, 1920]))
    middle = rng.uniform(-0.08, 0.08) if rng.random() < 0.6 else rng.uniform(0.2, 0.8)
    columns = (middle + rng.uniform(-0.1, 0.1, size=int(rng.integers(4, 9)))) * width
    return columns % width, width


def _signed(columns: np.ndarray, width: int) -> float:
    angles = columns / width * 2 * np.pi
    return float(np.arctan2(np.sin(angles).sum(), np.cos(angles).sum()) / (2 * np.pi) * width)


def _unrolled(columns: np.ndarray, width: int) -> float:
    first = columns[0]
    return float((first + np.mean((columns - first + width / 2) % width - width / 2)) % width)


def _by_half_circle(columns: np.ndarray, width: int) -> float:
    angles = columns / width * np.pi
    return float(np.arctan2(np.sin(angles).sum(), np.cos(angles).sum()) / np.pi * width % width)


def _swapped_arctan2(columns: np.ndarray, width: int) -> float:
    angles = columns / width * 2 * np.pi
    return float(np.arctan2(np.cos(angles).sum(), np.sin(angles).sum()) / (2 * np.pi) * width % width)


def _arctan_of_ratio(columns: np.ndarray, width: int) -> float:
    angles = columns / width * 2 * np.pi
    return float(np.arctan(np.sin(angles).sum() / np.cos(angles).sum()) / (2 * np.pi) * width % width)


def _still_an_angle(columns: np.ndarray, width: int) -> float:
    return mean_column(columns, width) / width * 2 * np.pi


EXERCISES = [
    Exercise(
        number="11.1",
        reference=direction_of,
        inputs=_pixel,
        mistakes=(
            Mistake(
                lambda u, v, w, h: _from_angles((u / w - 0.5) * 2 * np.pi, (0.5 - v / h) * np.pi),
                "Your picture is mirrored: columns run to the right, but azimuth grows to the left (y is left).",
            ),
            Mistake(
                lambda u, v, w, h: _from_angles((0.5 - u / w) * 2 * np.pi, (v / h - 0.5) * np.pi),
                "Yours is upside down: row 0 is straight up, so elevation falls with the row.",
            ),
            Mistake(
                lambda u, v, w, h: _from_angles((u / w - 0.5) * 2 * np.pi, (v / h - 0.5) * np.pi),
                "Both signs are turned around: azimuth falls with the column, elevation falls with the row.",
            ),
            Mistake(
                _no_cosine,
                "Your vectors are longer than 1 off the horizon: x and y shrink with the cosine of the elevation.",
            ),
            Mistake(
                lambda u, v, w, h: _from_angles((0.5 - u / w) * np.pi, (0.5 - v / h) * np.pi),
                "Your panorama spans half a turn: the whole width is 2 pi.",
            ),
            Mistake(
                lambda u, v, w, h: _from_angles((0.5 - u / w) * 2 * np.pi, (0.5 - v / h) * 2 * np.pi),
                "Your elevation runs over a whole turn: from straight up to straight down it is pi.",
            ),
            Mistake(
                lambda u, v, w, h: _from_angles(-u / w * 2 * np.pi, (0.5 - v / h) * np.pi),
                "Your azimuth is 0 at the left edge. It is 0 in the middle: that is where the camera looks.",
            ),
            Mistake(
                _polar_angle,
                "You measure from straight up, so at the horizon yours is 90 degrees. Elevation is 0 there.",
            ),
            Mistake(
                lambda u, v, w, h: _from_angles((0.5 - u / w) * 360, (0.5 - v / h) * 180),
                "np.cos and np.sin take radians; you give them degrees.",
            ),
            Mistake(
                lambda u, v, w, h: direction_of(u + 0.5, v + 0.5, w, h),
                "You add half a pixel. These are edge coordinates already: the middle of the image is W/2, H/2.",
            ),
            Mistake(
                lambda u, v, w, h: direction_of(u, v, w, h)[[1, 0, 2]],
                "x and y are swapped: x (ahead) takes the cosine of the azimuth, y (left) the sine.",
            ),
            Mistake(
                lambda u, v, w, h: direction_of(u, v, 1280, 640),
                "Your image is always 1280 x 640: use the arguments.",
            ),
            Mistake(
                lambda u, v, w, h: _from_angles(u / w * 2 * np.pi, (0.5 - v / h) * np.pi),
                "Your azimuth is 0 at the left edge and grows to the right. It is 0 in the middle and grows leftwards.",
            ),
            Mistake(
                lambda u, v, w, h: _from_angles((0.5 - u / w) * 2 * np.pi, (0.5 - v / w) * np.pi),
                "You divide the row by the width. Rows run over the height.",
            ),
            Mistake(
                lambda u, v, w, h: direction_of(u, v, w, h)[[1, 2, 0]] * [-1, -1, 1],
                "That is x right, y down, z forward, as in a depth camera. Here x is ahead, y left, z up.",
            ),
            Mistake(
                lambda u, v, w, h: np.array([*direction_of(u, v, w, h)[:2], np.cos((0.5 - v / h) * np.pi)]),
                "z is the sine of the elevation: 0 on the horizon, 1 straight up.",
            ),
        ),
    ),
    Exercise(
        number="11.2",
        reference=column_gap_deg,
        inputs=_columns,
        mistakes=(
            Mistake(
                _plain_gap,
                "Across the seam yours is nearly a whole turn. Bring the difference back to [-180, 180).",
            ),
            Mistake(
                lambda a, b, w: column_gap_deg(b, a, w),
                "Your sign is turned around: azimuth grows to the left, where columns get smaller.",
            ),
            Mistake(
                lambda a, b, w: _plain_gap(b, a, w),
                "Two things: azimuth grows where columns get smaller, and the seam needs a wrap to [-180, 180).",
            ),
            Mistake(
                lambda a, b, w: abs(column_gap_deg(a, b, w)),
                "The sign is lost: left is positive, right is negative.",
            ),
            Mistake(
                lambda a, b, w: _plain_gap(a, b, w) % 360,
                "Yours lies in [0, 360): something 10 degrees to the right comes out as 350.",
            ),
            Mistake(
                _one_side_only,
                "You mend differences of 180 and more only. Those below -180 need it as well.",
            ),
            Mistake(
                _other_side_only,
                "You mend differences below -180 only. Those of 180 and more need it as well.",
            ),
            Mistake(
                lambda a, b, w: (_plain_gap(a, b, w) + 90) % 180 - 90,
                "You wrap at 90 degrees. A difference may be as large as half a turn.",
            ),
            Mistake(
                lambda a, b, w: float(np.radians(column_gap_deg(a, b, w))),
                "These are radians; the task asks for degrees.",
            ),
            Mistake(
                lambda a, b, w: column_gap_deg(a, b, w) / 360 * w,
                "That is the difference in columns, wrapped. Turn it into degrees.",
            ),
            Mistake(
                lambda a, b, w: column_gap_deg(a, b, 1280),
                "Your image is always 1280 columns wide: use the argument.",
            ),
            Mistake(
                lambda a, b, w: float(np.sign(a - b) * abs(column_gap_deg(a, b, w))),
                "The size is right. But across the seam the shorter way goes to the other side: wrap sign and all.",
            ),
            Mistake(
                lambda a, b, w: float(column_gap_deg(a, b, 2 * w)),
                "The whole width is 360 degrees; in yours it is 180.",
            ),
            Mistake(
                lambda a, b, w: float((_plain_gap(a, b, w) / 2 + 90) % 180 - 90),
                "You took 180 degrees for the whole width, and wrapped by 180. It is 360.",
            ),
            Mistake(
                lambda a, b, w: float(_plain_gap(a, b, w) % 180),
                "The remainder by 180 makes opposite directions alike. `(d + 180) % 360 - 180` keeps them apart.",
            ),
        ),
    ),
    Exercise(
        number="11.3",
        reference=mean_column,
        inputs=_columns_of_an_object,
        mistakes=(
            Mistake(
                lambda columns, width: float(np.mean(columns)),
                "That is the plain mean: across the seam it lands on the opposite side. Average on the circle.",
            ),
            Mistake(
                lambda columns, width: float(np.median(columns)),
                "A median does not know the circle either: across the seam it lies on one edge.",
            ),
            Mistake(
                _unrolled,
                "Nearly: you unroll the columns and take a plain mean. Add up unit vectors: not quite the same.",
            ),
            Mistake(
                _signed,
                "Some of yours are negative: columns lie in [0, width). A remainder mends it.",
            ),
            Mistake(
                _by_half_circle,
                "The whole width is one turn, 2 pi. In yours the two edges are opposite directions.",
            ),
            Mistake(
                _swapped_arctan2,
                "np.arctan2 takes the sine first, then the cosine.",
            ),
            Mistake(
                _arctan_of_ratio,
                "np.arctan cannot tell a direction from its opposite. np.arctan2, with two arguments, can.",
            ),
            Mistake(
                _still_an_angle,
                "That is an angle in radians. Turn it into a column.",
            ),
            Mistake(
                lambda columns, width: float((columns.min() + columns.max()) / 2),
                "The middle between the least and the greatest column: across the seam that is the opposite side.",
            ),
            Mistake(
                lambda columns, width: mean_column(columns, 1280),
                "Your image is always 1280 columns wide: use the argument.",
            ),
            Mistake(
                lambda columns, width: (width / 2 - mean_column(columns, width)) % width,
                "You go to angles from the middle, leftwards: come back to columns the same way, not from the edge.",
            ),
            Mistake(
                lambda columns, width: -mean_column(columns, width) % width,
                "Your mean is mirrored: come back from the angle to the column the same way as you went.",
            ),
            Mistake(
                lambda columns, width: float(np.angle(np.exp(1j * columns / width * 360).sum()) / 360 * width % width),
                "np.sin and np.cos take radians: the whole width is 2 pi.",
            ),
            Mistake(
                lambda columns, width: float(round(mean_column(columns, width))),
                "Columns are edge coordinates here, with fractions: do not round.",
            ),
        ),
    ),
]
