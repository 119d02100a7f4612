"""Matching objects of two panoramas: the right partners, one-to-one, and reasons where there is none."""

import numpy as np
import pytest

from course_lib.spherical_stereo.matching.alignment import SwappedImagesError, check_not_swapped, match_features
from course_lib.spherical_stereo.matching.epipolar import epipolar_residual
from course_lib.spherical_stereo.matching.features import PanoramaFeatures, detect_features, find_features, inside_box
from course_lib.spherical_stereo.matching.object_matching import match_objects, match_views, pair_by_most_matches
from course_lib.spherical_stereo.outcomes import NoPartner
from course_lib.spherical_stereo.panorama import StereoRig, View, azimuth_elevation_of_pixel, open_view
from tests.spherical_stereo.stereo_scene import BASELINE, HEIGHT, WIDTH, Seen, scene

RIG = StereoRig(BASELINE, 1.32)
LAST = 7  # the lower detections are in reverse order: partner of i is LAST - i
BOARDS, UPPER, LOWER, UPPER_SEEN, LOWER_SEEN = scene()
IN_THE_AIR = Seen("chair", (200.0, 10.0, 230.0, 30.0))  # where the scene has nothing at all
CABINET = UPPER_SEEN[7].box
UPPER_HALF = Seen("cabinet", (*CABINET[:3], (CABINET[1] + CABINET[3]) / 2))
WITHOUT_CABINET = [d for d in LOWER_SEEN if d.label != "cabinet"]
TIED = [("upper", 7), ("lower", 0), ("lower", 8)]


@pytest.fixture(scope="module")
def features():
    """Both views of the scene, with their features."""
    return [find_features(open_view(image)) for image in (UPPER, LOWER)]


def match_scene(features, upper=UPPER_SEEN, lower=LOWER_SEEN, **options):
    """The scene's matching, with its own detections unless others are given."""
    return match_views(features[0].replace(detections=upper), features[1].replace(detections=lower), RIG, **options)


def partners(matches):
    return {(m.upper, m.lower) for m in matches}


def test_every_object_finds_itself_by_features_in_its_boxes_that_obey_the_epipolar_constraint():
    matches = match_objects(UPPER, UPPER_SEEN, LOWER, LOWER_SEEN, RIG)
    assert partners(matches) == {(i, LAST - i) for i in range(8)}
    assert [m.label for m in matches] == [UPPER_SEEN[m.upper].label for m in matches]
    assert matches == sorted(matches, key=lambda m: m.n_matches, reverse=True)
    for match in matches:
        assert match.keypoints_upper.shape == match.keypoints_lower.shape == (match.n_matches, 2)
        assert inside_box(match.keypoints_upper, UPPER_SEEN[match.upper].box, WIDTH).all()
        assert inside_box(match.keypoints_lower, LOWER_SEEN[match.lower].box, WIDTH).all()
        upper, lower = (
            azimuth_elevation_of_pixel(one, WIDTH, HEIGHT) for one in (match.keypoints_upper, match.keypoints_lower)
        )
        assert epipolar_residual(*upper, *lower).max() <= 0.0151
        assert (lower[1] > upper[1]).all(), "the lower camera sees every point higher"
        assert len(np.unique(match.keypoints_lower, axis=0)) == match.n_matches, "features are matched one-to-one"


@pytest.mark.parametrize(
    ("upper", "lower", "n_matches", "unmatched"),
    [
        (UPPER_SEEN, LOWER_SEEN, 8, []),
        (UPPER_SEEN, [*LOWER_SEEN, LOWER_SEEN[0]], 7, [(*one, NoPartner.TIE) for one in TIED]),
        ([*UPPER_SEEN, IN_THE_AIR], LOWER_SEEN, 8, [("upper", 8, NoPartner.NO_MATCHES)]),
        ([*UPPER_SEEN, UPPER_HALF], LOWER_SEEN, 8, [("upper", 8, NoPartner.PARTNER_TAKEN)]),
        (UPPER_SEEN, WITHOUT_CABINET, 7, [("upper", 7, NoPartner.CLASS_NOT_IN_OTHER)]),
    ],
)
def test_a_detection_without_partner_says_why(features, upper, lower, n_matches, unmatched):
    matching = match_scene(features, upper, lower)
    assert partners(matching.matches) >= {(i, len(lower) - 1 - i) for i in range(7) if len(lower) < 9}
    assert (len(matching.matches), matching.unmatched) == (n_matches, unmatched)


def test_swapped_images_are_told_from_the_sign_of_the_disparity(features, rng):
    with pytest.raises(SwappedImagesError, match="swapped"):
        match_objects(LOWER, LOWER_SEEN, UPPER, UPPER_SEEN, RIG)
    with pytest.raises(SwappedImagesError, match="Swap the two images"):
        match_features(features[1].features, features[0].features)
    # Disparities of either sign are no exchange.
    check_not_swapped(rng.normal(0, 0.05, 1000))
    check_not_swapped(np.zeros(0))
    check_not_swapped(np.full(4, -0.1))  # four coins may well all show tails
    with pytest.raises(SwappedImagesError):
        check_not_swapped(np.full(40, -0.1))


def test_an_object_needs_as_many_features_as_are_asked_for(features):
    counts = {m.upper: m.n_matches for m in match_scene(features).matches}
    fewest = min(counts.values()) + 1
    matching = match_scene(features, min_features=fewest)
    assert {m.upper for m in matching.matches} == {i for i, n in counts.items() if n >= fewest}
    assert {item.reason for item in matching.unmatched} == {NoPartner.TOO_FEW_FEATURES}


def test_whole_panoramas_match_mostly_at_equal_azimuth(features):
    """The search knows nothing of the constraint, so the share that obeys it is a finding."""
    upper, lower = (view.features for view in features)
    matches = match_features(upper, lower)
    assert len(matches) > 100
    assert matches.epipolar_share > 0.9
    assert np.median(matches.vertical_disparity[matches.epipolar]) > 0.03
    assert np.median(np.abs(matches.azimuth_difference)) < 0.5 * 2 * np.pi / WIDTH
    rolled = detect_features(np.roll(LOWER, 100, axis=1))
    assert not match_features(upper, rolled).epipolar_share > 0.1


@pytest.mark.parametrize(
    ("counts", "pairs", "rows", "columns"),
    [
        ([[5, 9], [3, 4]], [(0, 1), (1, 0)], set(), set()),
        ([[4, 0], [0, 4]], [(0, 0), (1, 1)], set(), set()),  # equal, but no row or column in common
        ([[4], [4]], [], {0, 1}, {0}),
        ([[4, 4, 0], [0, 3, 1]], [(1, 2)], {0}, {0, 1}),
        ([[6, 4, 4], [7, 0, 0]], [(1, 0)], {0}, {1, 2}),
        (np.zeros((0, 3)), [], set(), set()),
    ],
)
def test_the_largest_count_makes_a_pair_and_equal_ones_a_tie(counts, pairs, rows, columns):
    found = pair_by_most_matches(np.array(counts))
    assert (sorted(found[0]), found[1], found[2]) == (pairs, rows, columns)


def lone_feature(elevations, bits):
    """A view of one chair with features straight ahead whose descriptors have so many bits set."""
    keypoints = np.array([[WIDTH / 2, (0.5 - e / np.pi) * HEIGHT] for e in elevations])
    descriptors = np.array([np.packbits(np.arange(488) < n) for n in bits])
    box = (WIDTH / 2 - 20, 60.0, WIDTH / 2 + 20, 200.0)
    view = View(WIDTH, HEIGHT, detections=[Seen("chair", box)])
    return view.replace(features=PanoramaFeatures(keypoints, descriptors, WIDTH, HEIGHT))


@pytest.mark.parametrize(("second", "matched"), [(26, 1), (24, 0), (21, 0)])
def test_a_feature_with_two_partners_nearly_alike_is_matched_to_neither(second, matched):
    """20 of 25 bits is Lowe's ratio of 0.8."""
    found = match_views(lone_feature([-0.2], [0]), lone_feature([-0.1, 0.0], [20, second]), RIG)
    assert len(found.matches) == matched
