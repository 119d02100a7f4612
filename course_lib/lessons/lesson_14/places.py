"""Objects of the room from exact boxes: how far apart the columns of their centres are, and where they stand."""

from collections import namedtuple

import numpy as np

from course_lib.experiments.room_evaluation import counts_as_object
from course_lib.lessons.kit.room_photographs import pair_of, room_map
from course_lib.spherical_stereo.detection.detected_object import box_centre
from course_lib.spherical_stereo.panorama import pixel_to_direction
from course_lib.spherical_stereo.pose.rigid_fit import rotation_2d
from course_lib.spherical_stereo.ranging.triangulation import object_position, triangulation_covariance
from course_lib.spherical_stereo.recording import StereoPair, StereoRecording, TrueObject

SPACE = (
    "Two cameras on one axis, rays to twelve objects, thin green ellipsoids that point at the rig, and black balls at "
    "the true places: near ones beside small ellipsoids, far ones inside long ones."
)
PlacesInSpace = namedtuple("PlacesInSpace", "labels places covariances true cameras")
"""In the room, z up, the floor at 0, metres: `(n, 3)`, `(n, 3, 3)`, the map's x and y with the measured z, `(2, 3)`."""


def counting(pair: StereoPair, width: float) -> list[dict[int, TrueObject]]:
    """Return the objects of a pair that count, upper and lower, by their number in the room."""
    return [
        {thing.number: thing for thing in things if counts_as_object(thing, width)}
        for things in (pair.upper_objects, pair.lower_objects)
    ]


def azimuth_gaps(recording: StereoRecording) -> np.ndarray:
    """Return by how many columns the centres of two exact boxes of one object differ `(n,)`, all objects."""
    apart = [
        box_centre(upper[number].visible_box)[0] - box_centre(lower[number].visible_box)[0]
        for upper, lower in (counting(pair, recording.width) for pair in recording.pairs)
        for number in set(upper) & set(lower)
    ]
    return np.abs((np.array(apart) + recording.width / 2) % recording.width - recording.width / 2)


def places_in_space(recording: StereoRecording, name: str, sigma: float) -> PlacesInSpace:
    """Return the places of the objects of one pair, with covariances for noise of sigma radians on every angle."""
    pair, size, rig = pair_of(recording, name), (recording.width, recording.height), recording.rig
    upper, lower = counting(pair, recording.width)
    numbers = sorted(set(upper) & set(lower))
    rays = [
        pixel_to_direction(np.array([box_centre(seen[k].visible_box) for k in numbers]), *size)
        for seen in (upper, lower)
    ]
    turn, above = np.eye(3), np.array([*pair.pose[:2], rig.upper_height])
    turn[:2, :2] = rotation_2d(pair.pose[2])
    places = object_position(*rays, rig.baseline) @ turn.T + above
    covariances = turn @ triangulation_covariance(*rays, rig.baseline, sigma, sigma) @ turn.T
    true = np.column_stack([room_map().positions[numbers], places[:, 2]])
    cameras = np.array([above, above - [0, 0, rig.baseline]])
    return PlacesInSpace([upper[k].label for k in numbers], places, covariances, true, cameras)
