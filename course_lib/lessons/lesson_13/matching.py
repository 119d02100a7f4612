"""Three ways to match the features in two boxes, and how they score."""

from collections import namedtuple
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from course_lib.lessons.kit.panorama_features import Scene, Side
from course_lib.lessons.lesson_13.turned import turned_scene
from course_lib.spherical_stereo.detection.detected_object import Detection, box_centre
from course_lib.spherical_stereo.matching import epipolar
from course_lib.spherical_stereo.matching.features import PanoramaFeatures, inside_box
from course_lib.spherical_stereo.matching.object_matching import pair_by_most_matches
from course_lib.spherical_stereo.panorama import azimuth_elevation_of_pixel

PLACES = ("02_a", "06_b", "08_a", "09_a")  # where the ways are compared: all over the room
WAYS = ("both", "AKAZE alone", "geometry alone")
EVERYWHERE = 1.57  # radians: a tolerance that lets everything through
ALL_BITS = 486  # of an AKAZE descriptor: no two differ in more

Score = namedtuple("Score", "right wrong in_both share_off")
"""Objects paired rightly and wrongly, of those in both images; share of matches that join two different objects."""


def object_names(objects: Sequence[Detection], width: int, height: int) -> list[str]:
    """Return class and azimuth of the box centre in degrees of each object, such as "chair at -143"."""
    azimuths, _ = azimuth_elevation_of_pixel(box_centre([one.box for one in objects]), width, height)
    return [f"{one.label} at {np.degrees(a):+.0f}" for one, a in zip(objects, azimuths, strict=True)]


def features_by_object(side: Side) -> list[PanoramaFeatures]:
    """Return the features inside the box of each object."""
    features, found = side.features, []
    for one in side.objects:
        inside = inside_box(features.keypoints, np.asarray(one.box), features.width)
        kept = {"keypoints": features.keypoints[inside], "descriptors": features.descriptors[inside]}
        found.append(replace(features, **kept))
    return found


def matches_in_boxes(
    upper: PanoramaFeatures,
    lower: PanoramaFeatures,
    baseline: float,
    way: str,
    tolerance: float = epipolar.EPIPOLAR_TOLERANCE,
) -> epipolar.EpipolarPairs:
    """Return the pairs of features inside two boxes. way: "both" as `match_objects`, or one half of it alone.

    "AKAZE alone": each the other's nearest descriptor, and clearly so, wherever it lies. "geometry alone": whatever the
    epipolar constraint and the rig allow, whatever it looks like.
    """
    if way == "AKAZE alone":
        return epipolar.best_pairs(epipolar.epipolar_pairs(upper, lower, EVERYWHERE), epipolar.RATIO)
    if way == "geometry alone":
        found = epipolar.epipolar_pairs(upper, lower, tolerance, ALL_BITS)
    else:
        found = epipolar.best_pairs(epipolar.epipolar_pairs(upper, lower, tolerance), epipolar.RATIO)
    return found.where(epipolar.allowed_by_rig(found, baseline))


def count_table(one: Scene, way: str) -> np.ndarray:
    """Return the matches `(n, m)` of every upper object with every lower object of its class."""
    uppers, lowers = features_by_object(one.upper), features_by_object(one.lower)
    counts = np.zeros((len(uppers), len(lowers)), dtype=int)
    for i, j in np.ndindex(counts.shape):
        if one.upper.objects[i].label == one.lower.objects[j].label:
            counts[i, j] = len(matches_in_boxes(uppers[i], lowers[j], one.rig.baseline, way))
    return counts


def score(places: Sequence[Scene], way: str) -> Score:
    """Pair by most matches at several places, and compare with what the boxes really show."""
    right = wrong = in_both = off = total = 0
    for one in places:
        counts, same = count_table(one, way), np.equal.outer(one.upper.numbers, one.lower.numbers)
        good = [same[pair] for pair in pair_by_most_matches(counts)[0]]
        right, wrong, in_both = right + sum(good), wrong + len(good) - sum(good), in_both + same.sum()
        off, total = off + counts[~same].sum(), total + counts.sum()
    return Score(right, wrong, in_both, off / total)


def matches_when_turned(one: Scene, columns: float) -> tuple[int, int]:
    """Count matches inside the boxes of one object when the lower camera is turned, and those that were there before.

    Those of before join the same two features as without the turn; all others are matches by chance.
    """
    now, before = own_matches(turned_scene(one, columns)), own_matches(one)
    return len(now), len(now & before)


def own_matches(one: Scene) -> set[tuple]:
    """Return (object, feature, feature) of all matches in two boxes of one object."""
    uppers, lowers = features_by_object(one.upper), features_by_object(one.lower)
    found = set()
    for i, j in np.argwhere(np.equal.outer(one.upper.numbers, one.lower.numbers)):
        pairs = matches_in_boxes(uppers[i], lowers[j], one.rig.baseline, "both")
        found |= {(i, *pair) for pair in zip(pairs.upper.tolist(), pairs.lower.tolist(), strict=True)}
    return found
