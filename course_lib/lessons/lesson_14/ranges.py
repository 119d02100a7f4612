"""Ranges of the room's objects, from the centres of boxes and from matched features."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from course_lib.experiments.room_evaluation import counts_as_object
from course_lib.lessons.kit.intervals import median_text
from course_lib.lessons.kit.panorama_features import scene
from course_lib.lessons.kit.room_photographs import pair_of, room_map, room_recording
from course_lib.spherical_stereo.detection.detected_object import Detection, box_centre, wrapped_box
from course_lib.spherical_stereo.matching.object_matching import match_views
from course_lib.spherical_stereo.panorama import direction_from_angles, pixel_to_direction
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, rotation_2d
from course_lib.spherical_stereo.ranging.object_positions import disparity_distance
from course_lib.spherical_stereo.ranging.triangulation import (
    OK,
    object_position,
    triangulation_covariance,
    triangulation_outcome,
)
from course_lib.spherical_stereo.recording import StereoPair, StereoRecording, TrueObject

NO_DISTANCE = 100.0
"""Metres that a missing distance counts as where errors are ranked."""
PLACES = ("02_a", "06_b", "08_a", "09_a")  # of experiment_2, where features are matched: all over the room


class Distances(NamedTuple):
    """Horizontal ranges of objects, metres, one element an object."""

    true: np.ndarray
    """From the rig to the map's centroid."""
    box_centres: np.ndarray
    """From the centres of two boxes; NaN: no distance."""
    features: np.ndarray
    """From the disparities of matched features; NaN: no distance, or not asked for."""


def box_range(box_upper: Sequence[float], box_lower: Sequence[float], baseline: float, size: tuple[int, int]) -> float:
    """Horizontal range [m] from the centres of two boxes (edge coordinates); NaN where they give none."""
    upper, lower = (pixel_to_direction(box_centre(np.asarray(box)), *size) for box in (box_upper, box_lower))
    if triangulation_outcome(upper, lower) != OK:
        return float("nan")
    return float(np.linalg.norm(object_position(upper, lower, baseline)[:2]))


def exact_box_ranges(recording: StereoRecording, sigma_pixels: float = 0.0, seed: int = 14) -> Distances:
    """All objects of a recording that both images show, from their exact boxes, with noise on the boxes' centres.

    sigma_pixels: standard deviation of each centre's row, pixels. No image is read.
    """
    rng, landmarks, size = np.random.default_rng(seed), room_map(), (recording.width, recording.height)
    true, measured = [], []
    for pair in recording.pairs:
        upper, lower = _counting(pair, recording.width)
        for number in sorted(set(upper) & set(lower)):
            exact = upper[number].visible_box, lower[number].visible_box
            shifts = sigma_pixels * rng.standard_normal(2)
            boxes = [np.add(box, [0, s, 0, s]) for box, s in zip(exact, shifts, strict=True)]
            true.append(np.linalg.norm(landmarks.positions[number] - pair.pose[:2]))
            measured.append(box_range(*boxes, recording.rig.baseline, size))
    return Distances(np.array(true), np.array(measured), np.full(len(true), np.nan))


def both_ranges(
    recording: StereoRecording, places: Sequence[str], sigma_pixels: float = 0.0, seed: int = 14
) -> Distances:
    """Objects matched by their features at some places, with both distances; the boxes' edges are off by some pixels.

    sigma_pixels: standard deviation of every edge of every box, pixels. A match of two different objects is left out.
    """
    rng, landmarks, rows = np.random.default_rng(seed), room_map(), []
    for name in places:
        one, pair = scene(name), pair_of(recording, name)
        size = (one.upper.features.width, one.upper.features.height)
        upper, lower = (_shaken(view.objects, sigma_pixels, size, rng) for view in (one.upper, one.lower))
        found = match_views(one.upper.view(upper), one.lower.view(lower), one.rig)
        for match in found.matches:
            number = one.upper.numbers[match.upper]
            if number == one.lower.numbers[match.lower]:
                true = np.linalg.norm(landmarks.positions[number] - pair.pose[:2])
                boxes = upper[match.upper].box, lower[match.lower].box
                features = disparity_distance(match, *size, one.rig.baseline).horizontal_range
                rows.append((true, box_range(*boxes, one.rig.baseline, size), features))
    return Distances(*np.array(rows).T)


def _shaken(objects: Sequence[Detection], sigma: float, size: tuple[int, int], rng) -> list[Detection]:
    """The objects with every edge of their boxes off by a normal number of pixels (boxes keep 4 pixels a side)."""
    shaken = []
    for one in objects:
        u_min, v_min, u_max, v_max = np.add(one.box, sigma * rng.standard_normal(4))
        v_min, v_max = max(v_min, 0.0), min(v_max, size[1])
        box = wrapped_box([u_min, v_min, max(u_max, u_min + 4), max(v_max, v_min + 4)], size[0])
        shaken.append(Detection(one.label, one.score, tuple(box), one.hue, one.saturation))
    return shaken


def cuboid_range(horizontal_range: float, size: Sequence[float], upper_height: float, baseline: float) -> float:
    """Range [m] that exact boxes give of a cuboid (depth, width, height; metres) on the floor, its face to the rig.

    Its centre is horizontal_range metres away. Its boxes are those of its corners and edges, as a panorama shows them.
    """
    step = np.linspace(-0.5, 0.5, 41)
    x, y, z = np.meshgrid(step * size[0], step * size[1], (step + 0.5) * size[2])
    x = x + horizontal_range
    rays = []
    for height in (upper_height, upper_height - baseline):
        e, a = np.arctan2(z - height, np.hypot(x, y)), np.arctan2(y, x)
        rays.append(direction_from_angles((a.min() + a.max()) / 2, (e.min() + e.max()) / 2))
    return float(np.linalg.norm(object_position(*rays, baseline)[:2]))


def places_in_room(places: np.ndarray, pose: Sequence[float]) -> np.ndarray:
    """Horizontal places `(n, 2)` in the room of places `(n, 3)` in the rig's frame; pose: [x, y, heading]."""
    return Pose2D(*pose).apply(places[:, :2])


def ranges_of_one_object(name: str, number: int) -> dict[str, float]:
    """Horizontal ranges [m] of one object of the room at one place: the map's, and three measured ones.

    From the boxes around what is visible, from those around the whole object, and from its matched features.
    Raises `KeyError` for an unknown place, `ValueError` where an image does not show the object.
    """
    one, pair = scene(name), pair_of(room_recording(2), name)
    size, baseline = (one.upper.features.width, one.upper.features.height), one.rig.baseline
    upper, lower = (view.numbers.index(number) for view in (one.upper, one.lower))
    found = match_views(one.upper.view(), one.lower.view(), one.rig)
    (match,) = [m for m in found.matches if (m.upper, m.lower) == (upper, lower)]
    seen = [{t.number: t for t in things}[number] for things in (pair.upper_objects, pair.lower_objects)]
    return {
        "map": float(np.linalg.norm(room_map().positions[number] - pair.pose[:2])),
        "boxes of what is visible": box_range(*(t.visible_box for t in seen), baseline, size),
        "boxes of the whole object": box_range(*(t.unoccluded_box for t in seen), baseline, size),
        "features": disparity_distance(match, *size, baseline).horizontal_range,
    }


def azimuth_gaps(recording: StereoRecording) -> np.ndarray:
    """By how many columns the centres of two exact boxes of one object differ `(n,)`, all objects of a recording."""
    width, gaps = recording.width, []
    for pair in recording.pairs:
        upper, lower = _counting(pair, width)
        for number in set(upper) & set(lower):
            apart = box_centre(upper[number].visible_box)[0] - box_centre(lower[number].visible_box)[0]
            gaps.append(abs((apart + width / 2) % width - width / 2))
    return np.array(gaps)


def _counting(pair: StereoPair, width: float) -> list[dict[int, TrueObject]]:
    """The objects of a pair that count, upper and lower, by their number in the room."""
    return [
        {thing.number: thing for thing in things if counts_as_object(thing, width)}
        for things in (pair.upper_objects, pair.lower_objects)
    ]


class PlacesInSpace(NamedTuple):
    """Objects of one pair of photographs in the room: z up, the floor at 0, metres."""

    labels: tuple[str, ...]
    places: np.ndarray
    """`(n, 3)`, from the centres of exact boxes."""
    covariances: np.ndarray
    """`(n, 3, 3)` of these places."""
    true: np.ndarray
    """`(n, 3)`: the map's x and y. A map knows no height: z is the measured one."""
    cameras: np.ndarray
    """`(2, 3)`, upper and lower."""


def places_in_space(recording: StereoRecording, name: str, sigma: float) -> PlacesInSpace:
    """Places of the objects of one pair, with their covariances for noise of sigma radians on every angle."""
    pair, size, rig = pair_of(recording, name), (recording.width, recording.height), recording.rig
    upper, lower = _counting(pair, recording.width)
    numbers = sorted(set(upper) & set(lower))
    rays = [
        pixel_to_direction(np.array([box_centre(seen[k].visible_box) for k in numbers]), *size)
        for seen in (upper, lower)
    ]
    x, y, heading = pair.pose
    turn = np.eye(3)
    turn[:2, :2] = rotation_2d(heading)
    above = np.array([x, y, rig.upper_height])
    places = object_position(*rays, rig.baseline) @ turn.T + above
    covariances = turn @ triangulation_covariance(*rays, rig.baseline, sigma, sigma) @ turn.T
    true = np.column_stack([room_map().positions[numbers], places[:, 2]])
    cameras = np.array([above, above - [0, 0, rig.baseline]])
    return PlacesInSpace(tuple(upper[k].label for k in numbers), places, covariances, true, cameras)


def error_texts(errors: np.ndarray, true: np.ndarray, bins: Sequence[tuple[float, float]]) -> str:
    """Median error [m] with its bootstrap interval, of the objects whose true range lies in each bin [m].

    No distance (NaN) counts as an error of `NO_DISTANCE`: greater than any other, or the worst boxes would not count.
    """
    errors = np.where(np.isnan(errors), NO_DISTANCE, errors)
    return ", ".join(median_text(errors[(true >= low) & (true < high)], 2) for low, high in bins)
