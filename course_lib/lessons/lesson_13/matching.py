"""Three ways to match the features in two boxes, how they score, and a lower camera that is turned."""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from course_lib.lessons.kit.panorama_features import Scene
from course_lib.spherical_stereo.detection.detected_object import Detection, box_centre, wrapped_box
from course_lib.spherical_stereo.matching.epipolar import (
    EPIPOLAR_TOLERANCE,
    RATIO,
    EpipolarPairs,
    allowed_by_rig,
    best_pairs,
    epipolar_pairs,
)
from course_lib.spherical_stereo.matching.features import PanoramaFeatures, detect_features, inside_box
from course_lib.spherical_stereo.matching.object_matching import pair_by_most_matches
from course_lib.spherical_stereo.panorama import azimuth_elevation_of_pixel

PLACES = ("02_a", "06_b", "08_a", "09_a")  # where the ways are compared: all over the room
WAYS = ("both", "AKAZE alone", "geometry alone")
EVERYWHERE = 1.57  # radians: a tolerance that lets everything through
ALL_BITS = 486  # of an AKAZE descriptor: no two differ in more


def object_names(objects: Sequence[Detection], width: int, height: int) -> list[str]:
    """What to call objects: class and azimuth of the box centre in degrees, such as "chair at -143"."""
    azimuths, _ = azimuth_elevation_of_pixel(box_centre([one.box for one in objects]), width, height)
    return [f"{one.label} at {np.degrees(a):+.0f}" for one, a in zip(objects, azimuths, strict=True)]


def part_of(features: PanoramaFeatures, box: Sequence[float]) -> PanoramaFeatures:
    """The features inside a box (edge coordinates, pixels)."""
    inside = inside_box(features.keypoints, np.asarray(box), features.width)
    return replace(features, keypoints=features.keypoints[inside], descriptors=features.descriptors[inside])


def turned(features: PanoramaFeatures, columns: float) -> PanoramaFeatures:
    """The features of a camera turned about its axis: all of them move by so many columns (pixels), around the seam."""
    return replace(features, keypoints=(features.keypoints + np.array([columns, 0.0])) % [features.width, np.inf])


def turned_objects(objects: Sequence[Detection], columns: float, width: int) -> list[Detection]:
    """The objects that a camera turned by so many columns sees."""
    shift = np.array([columns % width, 0, columns % width, 0])
    return [replace(one, box=tuple(wrapped_box(one.box + shift, width))) for one in objects]


def matches_in_boxes(
    upper: PanoramaFeatures, lower: PanoramaFeatures, baseline: float, way: str, tolerance: float = EPIPOLAR_TOLERANCE
) -> EpipolarPairs:
    """Pairs of features inside two boxes. way: "both" as `match_objects`, or one half of it alone.

    "AKAZE alone": each the other's nearest descriptor, and clearly so, wherever it lies. "geometry alone": whatever the
    epipolar constraint and the rig allow, whatever it looks like. Raises `ValueError` for another way.
    """
    if way == "both":
        best = best_pairs(epipolar_pairs(upper, lower, tolerance), RATIO)
    elif way == "AKAZE alone":
        return best_pairs(epipolar_pairs(upper, lower, EVERYWHERE), RATIO)
    elif way == "geometry alone":
        best = epipolar_pairs(upper, lower, tolerance, ALL_BITS)
    else:
        raise ValueError(f"way must be one of {WAYS}; got {way!r}")
    return best.where(allowed_by_rig(best, baseline))


def count_table(one: Scene, way: str) -> np.ndarray:
    """Matches `(n, m)` of every upper object with every lower object of its class."""
    uppers, lowers = ([part_of(v.features, o.box) for o in v.objects] for v in (one.upper, one.lower))
    counts = np.zeros((len(uppers), len(lowers)), dtype=int)
    for i, j in np.ndindex(counts.shape):
        if one.upper.objects[i].label == one.lower.objects[j].label:
            counts[i, j] = len(matches_in_boxes(uppers[i], lowers[j], one.rig.baseline, way))
    return counts


class Score(NamedTuple):
    """How many objects were paired rightly and wrongly, of those that both images show."""

    right: int
    wrong: int
    in_both: int
    share_off: float
    """Share of the matches that join two different objects."""


def score(places: Sequence[Scene], way: str) -> Score:
    """Pairs by most matches over several places, judged by what the boxes really show."""
    right = wrong = both = stray = total = 0
    for one in places:
        counts = count_table(one, way)
        pairs, _, _ = pair_by_most_matches(counts)
        good = sum(one.upper.numbers[i] == one.lower.numbers[j] for i, j in pairs)
        right, wrong = right + good, wrong + len(pairs) - good
        both += len(set(one.upper.numbers) & set(one.lower.numbers))
        same = np.equal.outer(one.upper.numbers, one.lower.numbers)
        stray, total = stray + counts[~same].sum(), total + counts.sum()
    return Score(right, wrong, both, float(stray / total))


def turned_scene(one: Scene, columns: float) -> Scene:
    """The same place with its lower camera turned about its axis by so many columns (pixels)."""
    lower = one.lower
    width = lower.features.width
    moved = lower._replace(
        image=np.roll(lower.image, round(columns), axis=1),
        objects=turned_objects(lower.objects, columns, width),
        features=turned(lower.features, columns),
    )
    return one._replace(lower=moved)


def negative_scene(one: Scene) -> Scene:
    """The same place with its lower photograph as a negative: everything where it was, and nothing looks the same."""
    image = 255 - one.lower.image
    return one._replace(lower=one.lower._replace(image=image, features=detect_features(image)))


def matches_when_turned(one: Scene, columns: float) -> tuple[int, int]:
    """Matches inside the boxes of one object when the lower camera is turned, and how many of them are old ones.

    An old one joins the same two features as before the turn; all others are matches by chance.
    """
    crooked = turned_scene(one, columns)
    now, before = (
        {(i, *pair) for i in range(len(place.upper.objects)) for pair in _own_matches(place, i)}
        for place in (crooked, one)
    )
    return len(now), len(now & before)


def _own_matches(one: Scene, i: int) -> list[tuple[int, int]]:
    """Matched features of upper object i and the lower box that shows the same object; none where there is no such."""
    if one.upper.numbers[i] not in one.lower.numbers:
        return []
    j = one.lower.numbers.index(one.upper.numbers[i])
    parts = (part_of(v.features, v.objects[k].box) for v, k in ((one.upper, i), (one.lower, j)))
    pairs = matches_in_boxes(*parts, one.rig.baseline, "both")
    return list(zip(pairs.upper.tolist(), pairs.lower.tolist(), strict=True))


def plain_object(image: np.ndarray, box: Sequence[float], margin: int = 25) -> np.ndarray:
    """The panorama with a box and a margin (pixels) around it painted in the box's mean colour.

    The margin keeps the edge of the paint, which has features, out of the box. Not for boxes at the seam.
    """
    u_min, v_min, u_max, v_max = (round(edge) for edge in box)
    painted = image.copy()
    painted[v_min - margin : v_max + margin, u_min - margin : u_max + margin] = image[v_min:v_max, u_min:u_max].mean(
        axis=(0, 1)
    )
    return painted
