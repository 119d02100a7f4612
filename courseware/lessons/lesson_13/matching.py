"""Three ways to match the features in two boxes and how they score, also when the lower photograph is changed."""

from collections import namedtuple
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from course_lib.spherical_stereo.detection.detected_object import Detection, box_centre, wrapped_box
from course_lib.spherical_stereo.matching import epipolar
from course_lib.spherical_stereo.matching.features import PanoramaFeatures, detect_features, inside_box
from course_lib.spherical_stereo.matching.object_matching import pair_by_most_matches
from course_lib.spherical_stereo.panorama import azimuth_elevation_of_pixel
from courseware.lessons.kit.room_data import Scene, Side

PLACES = ("02_a", "06_b", "08_a", "09_a")  # where the ways are compared: all over the room
WAYS = ("both", "AKAZE alone", "geometry alone")
# Objects paired rightly and wrongly, of those in both images; share of matches that join two different objects.
Score = namedtuple("Score", "right wrong in_both share_off")


def object_names(objects: Sequence[Detection], width: int, height: int) -> list[str]:
    """Return class and azimuth of the box centre in degrees of each object, such as "chair at -143"."""
    azimuths, _ = azimuth_elevation_of_pixel(box_centre([one.box for one in objects]), width, height)
    return [f"{one.label} at {np.degrees(a):+.0f}" for one, a in zip(objects, azimuths, strict=True)]


def features_by_object(side: Side) -> list[PanoramaFeatures]:
    """Return the features inside the box of each object."""
    whole = side.features
    chosen = [inside_box(whole.keypoints, np.asarray(one.box), whole.width) for one in side.objects]
    return [replace(whole, keypoints=whole.keypoints[k], descriptors=whole.descriptors[k]) for k in chosen]


def matches_in_boxes(
    upper: PanoramaFeatures, lower: PanoramaFeatures, baseline: float, way: str, tolerance=epipolar.EPIPOLAR_TOLERANCE
) -> epipolar.EpipolarPairs:
    """Return the pairs of features inside two boxes. way: "both" as `match_objects`, or one half of it alone.

    "AKAZE alone": each the other's nearest descriptor, and clearly so, wherever it lies. "geometry alone": whatever the
    epipolar constraint and the rig allow, whatever it looks like.
    """
    if way == "AKAZE alone":  # a right angle lets every pair through
        return epipolar.best_pairs(epipolar.epipolar_pairs(upper, lower, 1.57))
    if way == "geometry alone":  # no two AKAZE descriptors differ in more than 486 bits
        found = epipolar.epipolar_pairs(upper, lower, tolerance, 486)
    else:
        found = epipolar.best_pairs(epipolar.epipolar_pairs(upper, lower, tolerance))
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
    total = np.zeros(5, dtype=int)
    for one in places:
        counts, same = count_table(one, way), np.equal.outer(one.upper.numbers, one.lower.numbers)
        good = [same[pair] for pair in pair_by_most_matches(counts)[0]]
        total += [sum(good), len(good) - sum(good), same.sum(), counts[~same].sum(), counts.sum()]
    return Score(*total[:3].tolist(), total[3] / total[4])


def matches_when_turned(one: Scene, columns: float) -> tuple[int, int]:
    """Count matches inside the boxes of one object when the lower camera is turned, and those that were there before.

    A match that was there before joins the same two features as without the turn. All others are there by chance.
    """
    found = []
    for place in (one, turned_scene(one, columns)):
        uppers, lowers = features_by_object(place.upper), features_by_object(place.lower)
        same = np.argwhere(np.equal.outer(place.upper.numbers, place.lower.numbers))
        pairs = ((i, matches_in_boxes(uppers[i], lowers[j], place.rig.baseline, "both")) for i, j in same)
        found.append({(i, *pair) for i, p in pairs for pair in zip(p.upper.tolist(), p.lower.tolist(), strict=True)})
    return len(found[1]), len(found[1] & found[0])


def turned(features: PanoramaFeatures, columns: float) -> PanoramaFeatures:
    """Move features by so many columns [pixels] around the seam, as a camera that turns about its axis sees them."""
    return replace(features, keypoints=(features.keypoints + np.array([columns, 0.0])) % [features.width, np.inf])


def turned_objects(objects: Sequence[Detection], columns: float, width: int) -> list[Detection]:
    shift = np.array([columns % width, 0, columns % width, 0])
    return [replace(one, box=tuple(wrapped_box(one.box + shift, width))) for one in objects]


def turned_scene(one: Scene, columns: float) -> Scene:
    """Return the same place with its lower camera turned about its axis by so many columns [pixels]."""
    side = one.lower
    objects, features = turned_objects(side.objects, columns, side.features.width), turned(side.features, columns)
    return one._replace(lower=Side(np.roll(side.image, round(columns), axis=1), objects, side.numbers, features))


def negative_scene(one: Scene) -> Scene:
    """Return the same place with a negative below: everything where it was, and nothing looks the same."""
    image = 255 - one.lower.image
    return one._replace(lower=one.lower._replace(image=image, features=detect_features(image)))


def plain_object(image: np.ndarray, box: Sequence[float]) -> np.ndarray:
    """Return the panorama with a box, not at the seam, and 25 pixels around it in the box's mean colour.

    This margin keeps the edge of the paint, which has features, out of the box.
    """
    u_min, v_min, u_max, v_max = (round(edge) for edge in box)
    painted = image.copy()
    painted[v_min - 25 : v_max + 25, u_min - 25 : u_max + 25] = image[v_min:v_max, u_min:u_max].mean(axis=(0, 1))
    return painted
