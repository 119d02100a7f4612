"""Right answers to lesson 11 by other ways than its solutions."""

import numpy as np
from scipy.spatial.transform import Rotation

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.panorama import azimuth_elevation, direction_from_angles, pixel_to_direction


def look(column, row, width, height):
    return direction_from_angles(-2 * np.pi * (column + 0.5) / width, np.pi / 2 - np.pi * (row + 0.5) / height)


def turned_until_it_fits(u_from, u_to, width):
    gap = (u_from - u_to) / width * 360
    while not -180 <= gap < 180:
        gap -= np.copysign(360, gap)
    return gap


def stretch_by_trying(columns, width):
    """Every point as the first one: the shortest of all."""
    return min(((u, u + np.max((columns - u) % width)) for u in columns), key=lambda pair: pair[1] - pair[0])


def stretch_twice(columns, width):
    """The list twice, a turn apart: the shortest row of n points."""
    n, twice = len(columns), [*sorted(columns), *sorted(columns + width)]
    return min(([twice[k], twice[k + n - 1]] for k in range(n)), key=np.ptp)


def by_scipy(*given):
    first, then = (pixel_to_direction(uv, *given[2:]) for uv in given[:2])
    return Rotation.align_vectors(first, then)[0].as_euler("ZYX", degrees=True)[::-1]


def by_angles(*given):
    """Off the poles: da = yaw - tan e (roll cos a + pitch sin a), de = roll sin a - pitch cos a."""
    (a, e), (a_then, e_then) = (azimuth_elevation(pixel_to_direction(uv, *given[2:])) for uv in given[:2])
    azimuths = [-np.tan(e) * np.cos(a), -np.tan(e) * np.sin(a), np.ones_like(a)]
    equations = np.hstack([azimuths, [np.sin(a), -np.cos(a), np.zeros_like(a)]]).T
    return np.degrees(np.linalg.lstsq(equations, np.r_[wrap_angle(a - a_then), e - e_then], rcond=None)[0])


RIGHT = [
    ("11.1", lambda *given: list(look(*given))),
    ("11.1", lambda c, r, w, h: pixel_to_direction([c + 0.5 + w / 2, r + 0.5], w, h)),
    ("11.1", lambda *given: look(*given).astype("f4")),
    ("11.2", lambda a, b, w: np.degrees(wrap_angle((a - b) / w * 2 * np.pi))),
    ("11.2", turned_until_it_fits),
    ("11.2", lambda a, b, w: (180 - (b - a) / w * 360) % 360 - 180),
    ("11.2", lambda a, b, w: np.array([((a - b) % w + w / 2) % w - w / 2]) / w * 360),
    ("11.3", stretch_by_trying),
    ("11.3", stretch_twice),
    ("11.3", lambda c, w: np.array(stretch_twice(c, w), np.float32)),
    ("11.4", by_scipy),
    ("11.4", lambda *given: tuple(by_scipy(*given).tolist())),
    ("11.4", by_angles),
]
