"""Objects that are large, or half hidden: what the centres of their boxes say of their range."""

from collections.abc import Sequence

import numpy as np

from course_lib.lessons.kit.panorama_features import scene
from course_lib.lessons.kit.room_photographs import pair_of, room_map, room_recording
from course_lib.lessons.lesson_14.ranges import box_range
from course_lib.spherical_stereo.matching.object_matching import match_views
from course_lib.spherical_stereo.panorama import direction_from_angles
from course_lib.spherical_stereo.ranging.object_positions import disparity_distance
from course_lib.spherical_stereo.ranging.triangulation import object_position


def cuboid_range(horizontal_range: float, size: Sequence[float], upper_height: float, baseline: float) -> float:
    """Return the range [m] that exact boxes give of a cuboid (depth, width, height) on the floor, its face to the rig.

    Its centre is horizontal_range metres away. Its boxes are those of its corners and edges, as a panorama shows them.
    """
    step = np.linspace(-0.5, 0.5, 41)
    x, y, z = np.meshgrid(step * size[0] + horizontal_range, step * size[1], (step + 0.5) * size[2])
    rays = []
    for height in (upper_height, upper_height - baseline):
        e, a = np.arctan2(z - height, np.hypot(x, y)), np.arctan2(y, x)
        rays.append(direction_from_angles((a.min() + a.max()) / 2, (e.min() + e.max()) / 2))
    return float(np.linalg.norm(object_position(*rays, baseline)[:2]))


def ranges_of_one_object(name: str, number: int) -> dict[str, float]:
    """Return ranges [m] of an object at a place: of the map, of its visible boxes, of its whole boxes, of features."""
    one, pair = scene(name), pair_of(room_recording(2), name)
    size, baseline = (one.upper.features.width, one.upper.features.height), one.rig.baseline
    pairing = tuple(side.numbers.index(number) for side in (one.upper, one.lower))
    found = match_views(one.upper.view(), one.lower.view(), one.rig).matches
    (match,) = [m for m in found if (m.upper, m.lower) == pairing]
    seen = [{t.number: t for t in things}[number] for things in (pair.upper_objects, pair.lower_objects)]
    return {
        "map": float(np.linalg.norm(room_map().positions[number] - pair.pose[:2])),
        "boxes of what is visible": box_range([t.visible_box for t in seen], baseline, size),
        "boxes of the whole object": box_range([t.unoccluded_box for t in seen], baseline, size),
        "features": disparity_distance(match, *size, baseline).horizontal_range,
    }
