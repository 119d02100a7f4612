"""Right answers to lesson 11 by other ways than its solutions."""

import numpy as np
from scipy.spatial.transform import Rotation

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.panorama import pixel_to_direction


def stretch_by_trying(columns, width):
    """Every point as the first one: the shortest of all."""
    return min(((u, u + np.max((columns - u) % width)) for u in columns), key=lambda pair: pair[1] - pair[0])


def by_scipy(*given):
    first, then = (pixel_to_direction(uv, *given[2:]) for uv in given[:2])
    return Rotation.align_vectors(first, then)[0].as_euler("ZYX", degrees=True)[::-1]


RIGHT = [
    ("11.1", lambda c, r, w, h: pixel_to_direction([c + 0.5 + w / 2, r + 0.5], w, h)),
    ("11.2", lambda a, b, w: np.degrees(wrap_angle((a - b) / w * 2 * np.pi))),
    ("11.3", stretch_by_trying),
    ("11.4", by_scipy),
]
