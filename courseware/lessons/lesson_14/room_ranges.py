"""Places and ranges of the room's objects, from exact boxes, from boxes with noise, and from matched features."""

from collections import namedtuple
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from course_lib.spherical_stereo.detection.detected_object import Detection, box_centre, wrapped_box
from course_lib.spherical_stereo.matching.object_matching import match_views
from course_lib.spherical_stereo.outcomes import ObjectOutcome
from course_lib.spherical_stereo.panorama import direction_from_angles, pixel_to_direction
from course_lib.spherical_stereo.pose.rigid_fit import rotation_2d
from course_lib.spherical_stereo.ranging import triangulation
from course_lib.spherical_stereo.ranging.object_positions import disparity_distance
from courseware.experiments.room_evaluation import counts_as_object
from courseware.lessons.kit.intervals import median_text
from courseware.lessons.kit.room_data import pair_of, room_map, room_recording, scene
from courseware.simulation.room.stereo_recording import StereoPair, StereoRecording, TrueObject

PLACES = ("02_a", "06_b", "08_a", "09_a")  # of experiment_2, where features are matched: all over the room
# In the room, z up, the floor at 0, metres: `(n, 3)`, `(n, 3, 3)`, the map's x and y with the measured z, `(2, 3)`.
PlacesInSpace = namedtuple("PlacesInSpace", "labels places covariances true cameras")
# Horizontal ranges [m] of objects: from the map, from the centres of two boxes and from features (NaN: none).
Distances = namedtuple("Distances", "true box_centres features")


def seen_by_both(pair: StereoPair, width: float) -> dict[int, tuple[TrueObject, TrueObject]]:
    """Return the objects that count in both images of a pair, upper and lower, by their number in the room."""
    upper, lower = (
        {thing.number: thing for thing in things if counts_as_object(thing, width)}
        for things in (pair.upper_objects, pair.lower_objects)
    )
    return {number: (upper[number], lower[number]) for number in sorted(set(upper) & set(lower))}


def azimuth_gaps(recording: StereoRecording) -> np.ndarray:
    """Return by how many columns the centres of two exact boxes of one object differ `(n,)`, all objects."""
    seen = [both for pair in recording.pairs for both in seen_by_both(pair, recording.width).values()]
    apart = np.diff([[box_centre(thing.visible_box)[0] for thing in both] for both in seen])[:, 0]
    return np.abs((apart + recording.width / 2) % recording.width - recording.width / 2)


def true_range(pair: StereoPair, number: int) -> float:
    """Return the horizontal range [m] of an object of the map from where a pair was photographed."""
    return float(np.linalg.norm(room_map().positions[number] - pair.pose[:2]))


def places_in_space(recording: StereoRecording, name: str, sigma: float) -> PlacesInSpace:
    """Return the places of the objects of one pair, with covariances for noise of sigma radians on every angle."""
    pair, size, rig = pair_of(recording, name), (recording.width, recording.height), recording.rig
    seen = seen_by_both(pair, recording.width)
    centres = np.array([[box_centre(thing.visible_box) for thing in both] for both in seen.values()])
    rays = [pixel_to_direction(centres[:, side], *size) for side in (0, 1)]
    turn, above = np.eye(3), np.array([*pair.pose[:2], rig.upper_height])
    turn[:2, :2] = rotation_2d(pair.pose[2])
    places = triangulation.object_position(*rays, rig.baseline) @ turn.T + above
    covariances = turn @ triangulation.triangulation_covariance(*rays, rig.baseline, sigma, sigma) @ turn.T
    true = np.column_stack([room_map().positions[list(seen)], places[:, 2]])
    cameras = np.array([above, above - [0, 0, rig.baseline]])
    return PlacesInSpace([upper.label for upper, _ in seen.values()], places, covariances, true, cameras)


def box_range(boxes: Sequence[Sequence[float]], baseline: float, size: tuple[int, int]) -> float:
    """Return the horizontal range [m] from the centres of two boxes, upper first; NaN if they give none."""
    rays = [pixel_to_direction(box_centre(np.asarray(box)), *size) for box in boxes]
    if triangulation.triangulation_outcome(*rays) != ObjectOutcome.OK:
        return float("nan")
    return float(np.linalg.norm(triangulation.object_position(*rays, baseline)[:2]))


def exact_box_ranges(recording: StereoRecording, sigma_pixels: float = 0.0) -> Distances:
    """Return the ranges of all objects in both images, from exact boxes with noise on the rows of their centres."""
    rng, size, rows = np.random.default_rng(14), (recording.width, recording.height), []
    for pair in recording.pairs:
        for number, both in seen_by_both(pair, recording.width).items():
            shifts = sigma_pixels * rng.standard_normal(2)
            boxes = [np.add(thing.visible_box, [0, s, 0, s]) for thing, s in zip(both, shifts, strict=True)]
            rows.append((true_range(pair, number), box_range(boxes, recording.rig.baseline, size), np.nan))
    return Distances(*np.array(rows).T)


def both_ranges(recording: StereoRecording, places: Sequence[str], sigma_pixels: float = 0.0) -> Distances:
    """Return both ranges of the objects that are matched rightly at some places, with noise on all edges of boxes."""
    rng, rows, size = np.random.default_rng(14), [], (recording.width, recording.height)
    for one, pair in ((scene(name), pair_of(recording, name)) for name in places):
        upper, lower = (shaken(view.objects, sigma_pixels, size, rng) for view in (one.upper, one.lower))
        for match in match_views(one.upper.view(upper), one.lower.view(lower), one.rig).matches:
            number = one.upper.numbers[match.upper]
            if number == one.lower.numbers[match.lower]:
                centres = box_range([upper[match.upper].box, lower[match.lower].box], one.rig.baseline, size)
                features = disparity_distance(match, *size, one.rig.baseline).horizontal_range
                rows.append((true_range(pair, number), centres, features))
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

    A missing distance counts as 100 m, more than any other error, because otherwise the worst boxes would not count.
    """
    errors = np.nan_to_num(errors, nan=100.0)
    return ", ".join(median_text(errors[(true >= low) & (true < high)], 2) for low, high in bins)


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
    return float(np.linalg.norm(triangulation.object_position(*rays, baseline)[:2]))


def ranges_of_one_object(name: str, number: int) -> dict[str, float]:
    """Return ranges [m] of an object at a place: of the map, of its visible boxes, of its whole boxes, of features."""
    one, pair = scene(name), pair_of(room_recording(2), name)
    size, baseline = (one.upper.features.width, one.upper.features.height), one.rig.baseline
    pairing = tuple(side.numbers.index(number) for side in (one.upper, one.lower))
    found = match_views(one.upper.view(), one.lower.view(), one.rig).matches
    (match,) = [m for m in found if (m.upper, m.lower) == pairing]
    seen = [t for things in (pair.upper_objects, pair.lower_objects) for t in things if t.number == number]
    return {
        "map": true_range(pair, number),
        "boxes of what is visible": box_range([t.visible_box for t in seen], baseline, size),
        "boxes of the whole object": box_range([t.unoccluded_box for t in seen], baseline, size),
        "features": disparity_distance(match, *size, baseline).horizontal_range,
    }
