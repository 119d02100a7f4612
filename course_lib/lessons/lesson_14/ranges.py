"""Ranges of the room's objects from the centres of boxes and from matched features, with noise on the boxes."""

from collections import namedtuple
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from course_lib.lessons.kit.intervals import median_text
from course_lib.lessons.kit.panorama_features import scene
from course_lib.lessons.kit.room_photographs import pair_of, room_map
from course_lib.lessons.lesson_14.places import counting
from course_lib.spherical_stereo.detection.detected_object import Detection, box_centre, wrapped_box
from course_lib.spherical_stereo.matching.object_matching import match_views
from course_lib.spherical_stereo.panorama import pixel_to_direction
from course_lib.spherical_stereo.ranging.object_positions import disparity_distance
from course_lib.spherical_stereo.ranging.triangulation import OK, object_position, triangulation_outcome
from course_lib.spherical_stereo.recording import StereoRecording

NO_DISTANCE = 100.0
"""Metres that a missing distance counts as where errors are ranked."""
PLACES = ("02_a", "06_b", "08_a", "09_a")  # of experiment_2, where features are matched: all over the room

Distances = namedtuple("Distances", "true box_centres features")
"""Horizontal ranges [m] of objects: from the map, from the centres of two boxes and from features (NaN: none)."""


def box_range(boxes: Sequence[Sequence[float]], baseline: float, size: tuple[int, int]) -> float:
    """Return the horizontal range [m] from the centres of two boxes, upper first; NaN if they give none."""
    upper, lower = (pixel_to_direction(box_centre(np.asarray(box)), *size) for box in boxes)
    if triangulation_outcome(upper, lower) != OK:
        return float("nan")
    return float(np.linalg.norm(object_position(upper, lower, baseline)[:2]))


def exact_box_ranges(recording: StereoRecording, sigma_pixels: float = 0.0) -> Distances:
    """Return the ranges of all objects in both images, from exact boxes with noise on the rows of their centres."""
    rng, size, rows = np.random.default_rng(14), (recording.width, recording.height), []
    for pair in recording.pairs:
        upper, lower = counting(pair, recording.width)
        for number in sorted(set(upper) & set(lower)):
            exact, shifts = (upper[number], lower[number]), sigma_pixels * rng.standard_normal(2)
            boxes = [np.add(thing.visible_box, [0, s, 0, s]) for thing, s in zip(exact, shifts, strict=True)]
            true = np.linalg.norm(room_map().positions[number] - pair.pose[:2])
            rows.append((true, box_range(boxes, recording.rig.baseline, size), np.nan))
    return Distances(*np.array(rows).T)


def both_ranges(recording: StereoRecording, places: Sequence[str], sigma_pixels: float = 0.0) -> Distances:
    """Return both ranges of the objects that are matched rightly at some places, with noise on all edges of boxes."""
    rng, rows = np.random.default_rng(14), []
    for name in places:
        one, pair = scene(name), pair_of(recording, name)
        size = (one.upper.features.width, one.upper.features.height)
        upper, lower = (shaken(view.objects, sigma_pixels, size, rng) for view in (one.upper, one.lower))
        for match in match_views(one.upper.view(upper), one.lower.view(lower), one.rig).matches:
            number = one.upper.numbers[match.upper]
            if number == one.lower.numbers[match.lower]:
                true = np.linalg.norm(room_map().positions[number] - pair.pose[:2])
                boxes = upper[match.upper].box, lower[match.lower].box
                features = disparity_distance(match, *size, one.rig.baseline).horizontal_range
                rows.append((true, box_range(boxes, one.rig.baseline, size), features))
    return Distances(*np.array(rows).T)


def shaken(objects: Sequence[Detection], sigma: float, size: tuple[int, int], rng) -> list[Detection]:
    """Return the objects with every edge of their boxes off by a normal number of pixels (boxes keep 4 a side)."""
    found = []
    for one in objects:
        u_min, v_min, u_max, v_max = np.add(one.box, sigma * rng.standard_normal(4))
        v_min, v_max = max(v_min, 0.0), min(v_max, size[1])
        box = wrapped_box([u_min, v_min, max(u_max, u_min + 4), max(v_max, v_min + 4)], size[0])
        found.append(replace(one, box=tuple(box)))
    return found


def error_texts(errors: np.ndarray, true: np.ndarray, bins: Sequence[tuple[float, float]]) -> str:
    """Return the median error [m] with its interval, of the objects whose true range lies in each bin [m].

    A missing distance counts as `NO_DISTANCE`: greater than any other error, or the worst boxes would not count.
    """
    errors = np.nan_to_num(errors, nan=NO_DISTANCE)
    return ", ".join(median_text(errors[(true >= low) & (true < high)], 2) for low, high in bins)
