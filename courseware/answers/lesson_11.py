"""Exercises of lesson 11: another panorama's pixels, the way to turn, a stretch across the seam, a knocked tripod."""

import numpy as np

from course_lib.geometry import pose_matrix
from course_lib.spherical_stereo.panorama import direction_from_angles, direction_to_pixel, pixel_to_direction
from courseware.lessons.kit.exercise import Exercise

WIDTHS = (640, 1280, 1920)


def direction_of(column, row, width, height):
    """Unit vector (3,) of a pixel of a panorama whose left edge is ahead; 0 is a pixel's middle."""
    # Half a pixel first, then the two angles; azimuth falls from 0 at the left edge.
    azimuth = -(column + 0.5) / width * 2 * np.pi
    elevation = (0.5 - (row + 0.5) / height) * np.pi
    flat = np.cos(elevation)
    return np.array([flat * np.cos(azimuth), flat * np.sin(azimuth), np.sin(elevation)])


def a_pixel(rng: np.random.Generator) -> tuple:
    height = int(rng.choice([320, 512, 640, 960]))
    return float(rng.uniform(0, 2 * height)), float(rng.uniform(0.05, 0.95) * height), 2 * height, height


def column_gap_deg(u_from, u_to, width):
    """Degrees in [-180, 180) from one column to the other, positive to the left."""
    # The difference in degrees, wrapped.
    gap = (u_from - u_to) / width * 360
    return (gap + 180) % 360 - 180


def two_columns(rng: np.random.Generator) -> tuple:
    """Return two columns on one side of the seam, or one on each side of it, in either order."""
    width = int(rng.choice(WIDTHS))
    ends = ((0.05, 0.5), (0.05, 0.5)) if rng.random() < 0.5 else ((0, 0.1), (0.9, 1))
    u_from, u_to = rng.permutation([float(rng.uniform(*end)) * width for end in ends])
    return float(u_from), float(u_to), width


def shortest_stretch(columns, width):
    """(u_min, u_max) of the shortest stretch with all columns (n,); u_max may pass the width."""
    # The largest gap is left out; the gap across the seam is one of them.
    around = np.sort(columns)
    gaps = np.diff(np.append(around, around[0] + width))
    largest = gaps.argmax()
    start = around[(largest + 1) % len(around)]
    return start, start + width - gaps[largest]


def points_of_an_object(rng: np.random.Generator) -> tuple:
    """Return columns within 0.1 to 0.6 of a turn, unsorted, in half of the inputs across the seam."""
    width, spread = int(rng.choice(WIDTHS)), rng.uniform(0.05, 0.3)
    middle = rng.uniform(-0.8, 0.8) * spread if rng.random() < 0.6 else rng.uniform(0.35, 0.65)
    return (middle + rng.uniform(-spread, spread, int(rng.integers(4, 9)))) * width % width, width


def knock(before, after, width, height):
    """Roll, pitch, yaw [degrees] of the second pose in the first, from pixels (n, 2) of far points."""
    # d - d' = w x d', three equations for each point, solved by least squares.
    first, then = (pixel_to_direction(uv, width, height) for uv in (before, after))
    moves = [np.cross(axis, then) for axis in np.eye(3)]  # for a turn about x, y, z by 1
    equations = np.stack(moves, axis=-1).reshape(-1, 3)
    w, *_ = np.linalg.lstsq(equations, (first - then).ravel(), rcond=None)
    return tuple(np.degrees(w))


def knocked(rng: np.random.Generator, azimuth=None, largest=1.0) -> tuple:
    """Return far points at these azimuths [rad] (default: all around), before and after a turn of `largest` degrees."""
    width = int(rng.choice(WIDTHS))
    azimuth = rng.uniform(-np.pi, np.pi, int(rng.integers(8, 15))) if azimuth is None else azimuth
    first = direction_from_angles(azimuth, rng.uniform(-0.9, 0.6, len(azimuth)))
    turn = pose_matrix(np.radians([0, 0, 0, *rng.uniform(-largest, largest, 3)]))[:3, :3]
    before, after = (direction_to_pixel(d, width, width // 2) for d in (first, first @ turn))
    return before, after, width, width // 2


def the_first_point_twice(rng: np.random.Generator) -> tuple:
    """Return two equal points first: together they leave the turn about their own direction open."""
    before, after, *size = knocked(rng)
    return before[[0, *range(len(before))]], after[[0, *range(len(after))]], *size


# fmt: off
EXERCISES = [
    Exercise("11.1", direction_of, a_pixel, "warm-up", cases={
        "straight ahead": lambda rng: (-0.5, 319.5, 1280, 640), "straight up": lambda rng: (100.0, -0.5, 1280, 640),
        "a column beyond the right edge": lambda rng: (1290.0, 400.0, 1280, 640),
        "a column beyond the left edge": lambda rng: (-20.0, 400.0, 1280, 640),
    }, example=((959.5, 159.5, 1280, 640), [0.0, 0.707, 0.707])),
    Exercise("11.2", column_gap_deg, two_columns, cases={
        "half a turn": lambda rng: (960.0, 320.0, 1280), "half a turn to the left": lambda rng: (320.0, 960.0, 1280),
        "equal columns": lambda rng: (77.0, 77.0, 1280), "the two edges": lambda rng: (0.0, 1280.0, 1280),
        "u_max of a box across the seam": lambda rng: (1410.0, 130.0, 1280),
        "more than a turn": lambda rng: (10.0, 1900.0, 1280), "nearly two turns": lambda rng: (2500.0, 40.0, 1280),
    }, example=((1260, 20, 1280), -11.25)),
    Exercise("11.3", shortest_stretch, points_of_an_object, cases={
        name: lambda rng, columns=columns: (np.array(columns), 1280) for name, columns in {
            "one point": [300.0], "equal points": [5.0, 5.0, 5.0], "across the seam": [1270.0, 2.0, 1278.0, 18.0],
            "a point on the seam": [0.0, 1200.0], "across the middle": [630.0, 645.0, 650.0],
            "more than half a turn": [300.0, 700.0, 1000.0, 1250.0],
            "most of them at one end": [300.0, 310.0, 320.0, 330.0, 700.0, 1100.0],
        }.items()
    }, example=(([1270, 2, 1278, 18], 1280), (1270, 1298))),
    Exercise("11.4", knock, knocked, "challenge", tolerance=0.05, cases={
        "no knock": lambda rng: knocked(rng, largest=0.0),
        "points behind": lambda rng: knocked(rng, np.pi + rng.uniform(-0.02, 0.02, 12)),
        "the first point twice": the_first_point_twice,
    }, example=(
        ([[640, 320], [320, 400], [1270, 250]], [[642.85, 321.04], [322.41, 401.79], [1273.48, 248.87]], 1280, 640),
        (0.5, -0.3, 0.8),
    )),
]
