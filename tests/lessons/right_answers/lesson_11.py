"""Right answers to lesson 11 by other ways than its solutions."""

import numpy as np
from scipy.spatial.transform import Rotation

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.panorama import direction_from_angles, pixel_to_direction

PI = np.pi


def look(azimuth, elevation):
    flat = np.cos(elevation)
    return [flat * np.cos(azimuth), flat * np.sin(azimuth), np.sin(elevation)]


def gap_deg(a, b, w):
    return (a - b) / w * 360


def turned_until_it_fits(a, b, w):
    gap = gap_deg(a, b, w)
    while gap >= 180:
        gap -= 360
    while gap < -180:
        gap += 360
    return gap


def stretch_by_trying(columns, width):
    """Every point as the first one: the shortest of all."""
    ends = [(u, float(u + np.max((columns - u) % width))) for u in columns]
    return min(ends, key=lambda pair: pair[1] - pair[0])


def stretch_twice(columns, width):
    """The list twice, a turn apart: n points in a row, the shortest such row."""
    n = len(columns)
    twice = sorted(columns) + sorted(columns + width)
    k = min(range(n), key=lambda k: twice[k + n - 1] - twice[k])
    return [twice[k], twice[k + n - 1]]


def by_scipy(before, after, width, height):
    first, then = (pixel_to_direction(uv, width, height) for uv in (before, after))
    return Rotation.align_vectors(first, then)[0].as_euler("ZYX", degrees=True)[::-1]


RIGHT = [
    ("11.1", lambda c, r, w, h: look(-2 * PI * (c + 0.5) / w, PI / 2 - PI * (r + 0.5) / h)),
    ("11.1", lambda c, r, w, h: pixel_to_direction([c + 0.5 + w / 2, r + 0.5], w, h)),
    (
        "11.1",
        lambda c, r, w, h: direction_from_angles(-2 * PI * (c + 0.5) / w, PI / 2 - PI * (r + 0.5) / h).astype("f4"),
    ),
    ("11.2", lambda a, b, w: np.degrees(wrap_angle((a - b) / w * 2 * PI))),
    ("11.2", turned_until_it_fits),
    ("11.2", lambda a, b, w: (180 - gap_deg(b, a, w)) % 360 - 180),
    ("11.2", lambda a, b, w: np.array([((a - b) % w + w / 2) % w - w / 2]) / w * 360),
    ("11.3", stretch_by_trying),
    ("11.3", stretch_twice),
    ("11.3", lambda c, w: np.array(stretch_twice(c, w), np.float32)),
    ("11.4", by_scipy),
    ("11.4", lambda *g: tuple(by_scipy(*g).tolist())),
]
