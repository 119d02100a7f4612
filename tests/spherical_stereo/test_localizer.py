"""From detections to a pose: exact where the input is exact, turning with the rig, and unable with a reason."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given as examples
from hypothesis import settings
from hypothesis import strategies as st

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo import Noise, YoloDetector, mean_hue_saturation
from course_lib.spherical_stereo.detection.detected_object import Detection, DetectionError, wrapped_box
from course_lib.spherical_stereo.drawn_boxes import StereoBoxes
from course_lib.spherical_stereo.localizer import LocalizerError, SemanticLocalizer
from course_lib.spherical_stereo.matching.object_matching import ObjectMatch
from course_lib.spherical_stereo.outcomes import Reason
from course_lib.spherical_stereo.panorama import PanoramaError, StereoRig, direction_to_pixel
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, rotation_2d
from course_lib.spherical_stereo.semantic_map.association import AssociationError, Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap
from tests.spherical_stereo.stereo_scene import BASELINE, ROOM, KnowingDetector, mapped_scene, pair_from

WIDTH, HEIGHT = 1280, 640
RIG = StereoRig(0.3, 1.32)
CAMERAS = (1.32, 1.02)  # heights, metres
HEIGHTS = [0.4, 0.4, 0.45, 1.0, 0.6]
POSE = Pose2D(2.2, 2.6, 0.8)


def seen_around(landmark, direction):
    """A detection of the landmark whose box has its centre exactly in the direction."""
    u, v = direction_to_pixel(direction, WIDTH, HEIGHT)
    u_min = (u - 20) % WIDTH
    return Detection(landmark.label, 0.9, (u_min, v - 12, u_min + 40, v + 12), landmark.hue, landmark.saturation)


def views(pose, semantic_map=ROOM, heights=HEIGHTS):
    """Exact detections of every landmark in both images, and the matches between them."""
    body = (semantic_map.positions - pose[:2]) @ rotation_2d(pose.theta)
    directions = (np.column_stack([body, np.array(heights) - camera]) for camera in CAMERAS)
    sides = [list(map(seen_around, semantic_map.landmarks, side)) for side in directions]
    return *sides, [(i, i) for i in range(len(semantic_map))]


def moved(detections, shift):
    """The detections with their boxes moved by shift `(n, 4)` or `(4,)`, and to 0 <= u_min < width."""
    boxes = wrapped_box(np.array([one.box for one in detections]) + shift, WIDTH)
    return [replace(one, box=tuple(box)) for one, box in zip(detections, boxes, strict=True)]


def localize(upper=(), lower=(), matches=(), semantic_map=ROOM, **options):
    return SemanticLocalizer(RIG, semantic_map, **options).localize_detections(upper, lower, matches, (WIDTH, HEIGHT))


@examples(st.builds(Pose2D, st.floats(1.5, 4.5), st.floats(1.5, 3.4), st.floats(-3.1, 3.1)))
@settings(max_examples=50)
def test_exact_directions_give_the_exact_pose(pose):
    found = localize(*views(pose))
    assert (found.status, found.reason) == ("ok", None)
    assert found.pose[:2] == pytest.approx(pose[:2], abs=1e-9)
    assert wrap_angle(found.pose.theta - pose.theta) == pytest.approx(0, abs=1e-9)
    assert found.residuals == pytest.approx(np.zeros((5, 2)), abs=1e-9)


@pytest.mark.parametrize("columns", [1, 320, 640, 1279, -5, 3 * WIDTH + 100])
@pytest.mark.parametrize("seed", range(3))
def test_turning_the_rig_keeps_the_place_and_turns_the_heading_by_exactly_that_angle(columns, seed):
    rng = np.random.default_rng(seed)
    *sides, matches = views(POSE)
    sides = [moved(side, rng.normal(0, 1.0, (5, 4))) for side in sides]  # off by a pixel or so
    before = localize(*sides, matches)
    after = localize(*(moved(side, [columns, 0, columns, 0]) for side in sides), matches)
    assert before.residuals.std() > 0.01  # the boxes are off, so the place is one that only these boxes give
    assert after.pose[:2] == pytest.approx(before.pose[:2], abs=1e-9)
    turned = wrap_angle(before.pose.theta + 2 * np.pi * columns / WIDTH)
    assert wrap_angle(after.pose.theta - turned) == pytest.approx(0, abs=1e-9)
    assert after.covariance == pytest.approx(before.covariance, abs=1e-9)


def test_disparities_of_features_give_the_exact_pose_too():
    """Four features each, at the landmark itself and at heights above and below it."""
    upper, lower, _ = views(POSE)
    matches = []
    for i, place in enumerate((ROOM.positions - POSE[:2]) @ rotation_2d(POSE.theta)):
        points = np.column_stack([np.tile(place, (4, 1)), HEIGHTS[i] + np.array([-0.1, 0.0, 0.1, 0.2])])
        both = [direction_to_pixel(points - [0, 0, camera], WIDTH, HEIGHT) for camera in CAMERAS]
        matches.append(ObjectMatch(i, i, upper[i].label, *both))
    found = localize(upper, lower, matches, distance="disparity")
    assert found.pose == pytest.approx(POSE, abs=1e-9)
    assert np.linalg.eigvalsh(found.covariance).min() > 0


def test_everything_on_the_way_is_kept_and_as_certain_as_a_pixel_and_a_half_lets_it_be():
    upper, lower, matches = views(POSE)
    found = localize(upper, lower, matches)
    kept = found.upper_detections, found.lower_detections, found.matches
    assert kept == (tuple(upper), tuple(lower), tuple(matches))
    assert [one.outcome for one in found.objects] == ["ok"] * 5
    assert sorted(found.pairs) == sorted(found.used_pairs) == matches
    body = (ROOM.positions - POSE[:2]) @ rotation_2d(POSE.theta)
    assert [one.position[:2] for one in found.objects] == [pytest.approx(each) for each in body]
    # A pixel and a half of 1280: rho^2 sqrt(sec^4 e_u + sec^4 e_l) s / B along the ray, rho s across, s = 0.0075, and a
    # decimetre either way.
    for one, place, height in zip(found.observations, found.objects, HEIGHTS, strict=True):
        rho = math.hypot(one.x, one.y)
        secants = [1 + ((height - camera) / rho) ** 2 for camera in CAMERAS]
        along = math.hypot(0.0075 * rho**2 / 0.3 * math.hypot(*secants), 0.1)
        across = math.hypot(0.0075 * rho, 0.1)
        assert place.position[2] == pytest.approx(height - RIG.upper_height)
        assert np.sqrt(np.linalg.eigvalsh(one.covariance)) == pytest.approx([across, along], rel=1e-6)


ALL = [(i, i) for i in range(5)]
STACKED = SemanticMap([Landmark("table", 4, 4, 30, 40), Landmark("potted plant", 4, 4, 110, 60)])
TWO_CLASSES = SemanticMap([ROOM.landmarks[0], ROOM.landmarks[2]])
MIRRORED_ROOM = SemanticMap([replace(one, y=6.0 - one.y) for one in ROOM.landmarks])
WITHOUT_ANY = SemanticMap([Landmark("refrigerator", 1, 1, 30, 20), Landmark("cabinet", 2, 1, 30, 20)])
WITH_A_CHAIR = SemanticMap([Landmark("chair", 1, 1, 30, 20), Landmark("cabinet", 2, 1, 30, 20)])


@pytest.mark.parametrize(
    ("reason", "n_upper", "n_lower", "matches", "semantic_map"),
    [
        (Reason.NO_DETECTIONS, 0, 0, [], ROOM),
        (Reason.NO_DETECTIONS, 5, 0, [], ROOM),
        (Reason.ONE_DETECTION, 5, 1, [(0, 0)], ROOM),
        (Reason.TOO_FEW_IN_BOTH, 5, 5, [], ROOM),
        (Reason.TOO_FEW_IN_BOTH, 5, 5, [(3, 3)], ROOM),
        (Reason.UNMAPPED_ONLY, 5, 5, ALL, WITHOUT_ANY),
        (Reason.TOO_FEW_PAIRS, 5, 5, ALL, WITH_A_CHAIR),
        (Reason.TOO_FEW_PAIRS, 5, 5, ALL[:2], TWO_CLASSES),  # two sofas are seen: the second is left with the chair
        (Reason.MIRRORED, 5, 5, ALL, MIRRORED_ROOM),
    ],
)
def test_the_first_step_that_leaves_too_little_is_the_reason(reason, n_upper, n_lower, matches, semantic_map):
    found = localize(UPPER[:n_upper], LOWER[:n_lower], matches, semantic_map=semantic_map)
    assert (found.status, found.reason, found.pose, found.covariance) == ("unable", reason, None, None)
    assert found.explanation


def test_images_exchanged_or_given_twice_and_two_objects_at_one_place_are_reasons():
    assert localize(LOWER, UPPER, ALL).reason == Reason.SWAPPED
    assert localize(*views(POSE, STACKED, [0.4, 0.9]), semantic_map=STACKED).reason == Reason.COINCIDENT
    found = localize(UPPER, UPPER, ALL)
    assert {one.outcome for one in found.objects} == {"parallel"}
    assert (found.reason, "sofa: parallel" in found.explanation) == (Reason.TOO_FEW_DISTANCES, True)


PLAIN = SemanticLocalizer(RIG, ROOM)
IMAGE = np.full((64, 128, 3), (80, 90, 100), np.uint8)
UPPER, LOWER, _ = views(POSE)


@pytest.mark.parametrize(
    ("error", "says", "call"),
    [
        (LocalizerError, "association must be", lambda: localize(*views(POSE), association="best")),
        (LocalizerError, "distance must be one of", lambda: localize(*views(POSE), distance="lidar")),
        (LocalizerError, r"detector must be an object with detect.*got <object", lambda: localize(detector=object())),
        (LocalizerError, r"detector must be .*got <class", lambda: localize(detector=YoloDetector)),
        (LocalizerError, "noise must be", lambda: localize(noise=(0.0, 0.1, 0.1))),
        (DetectionError, "detect must return a list of Detection", lambda: detected([("sofa", 1.0)])),
        (DetectionError, "detect must return a list of Detection", lambda: detected(None)),
        (DetectionError, r"detection 0, sofa, has no colour: give hue", lambda: localize([bare(UPPER[0])], LOWER, [])),
        (PanoramaError, "twice as wide", lambda: SemanticLocalizer(RIG, ROOM, image_size=(100, 100))),
        (DetectionError, "names upper detection 0 and lower detection 9", lambda: localize(UPPER, LOWER, [(0, 9)])),
        (DetectionError, "joins a sofa to a chair", lambda: localize(UPPER, LOWER, [(0, 2)])),
        (DetectionError, "one detection twice", lambda: localize(UPPER, LOWER, [(0, 0), (0, 1)])),
        (DetectionError, "needs ObjectMatch with its features", lambda: localize(*views(POSE), distance="disparity")),
        (DetectionError, "on a panorama of 640 x 320", lambda: PLAIN.localize_detections(UPPER, [], [], (640, 320))),
        (LocalizerError, "observation 0 is a person", lambda: given("person", 1.0, 2.0, 30, 50)),
        (AssociationError, "observation: x and y", lambda: given("chair", math.nan, 2.0, 30, 50)),
        (LocalizerError, "no detector", lambda: PLAIN.localize(IMAGE, IMAGE)),
        (
            PanoramaError,
            "one size",
            lambda: SemanticLocalizer(RIG, ROOM, KnowingDetector()).localize(IMAGE, IMAGE[:32, :64]),
        ),
        (
            PanoramaError,
            "grey",
            lambda: SemanticLocalizer(RIG, ROOM, KnowingDetector()).localize(IMAGE, IMAGE[..., [0, 0, 0]]),
        ),
    ],
)
def test_a_mistake_of_the_callers_is_an_error_with_a_name(error, says, call):
    with pytest.raises(error, match=says):
        call()


def bare(one):
    return Detection(one.label, one.score, one.box)


def detected(found):
    """What becomes of two images in which a detector finds this."""
    return SemanticLocalizer(RIG, ROOM, SimpleNamespace(detect=lambda image: found)).localize(IMAGE, IMAGE)


def test_boxes_drawn_by_hand_take_the_place_of_a_detector():
    *images, upper, lower = pair_from(0.0, 0.0)
    semantic_map, size = mapped_scene()[2], images[0].shape[1::-1]
    by_detector = SemanticLocalizer(StereoRig(BASELINE), semantic_map, KnowingDetector((*images, upper, lower)))
    by_hand = SemanticLocalizer(StereoRig(BASELINE), semantic_map)
    found = by_hand.localize(*images, StereoBoxes(size, upper, lower))
    assert found.pose == by_detector.localize(*images).pose
    with pytest.raises(DetectionError, match="the boxes were drawn on images of"):
        by_hand.localize(*images, StereoBoxes((64, 32), upper, lower))


def test_a_detector_of_ones_own_need_not_know_colours_which_are_measured_in_the_images():
    *images, upper, lower = pair_from(0.0, 0.0)
    plain = KnowingDetector((*images, [bare(one) for one in upper], [bare(one) for one in lower]))
    found = SemanticLocalizer(StereoRig(BASELINE), mapped_scene()[2], plain).localize(*images)
    assert found.pose is not None
    for image, side in zip(images, (found.upper, found.lower), strict=True):
        for one in side.detections:
            assert (one.hue, one.saturation) == pytest.approx(mean_hue_saturation(image, one.box), nan_ok=True)


def test_the_noise_of_the_detector_can_be_set():
    rough, exact = (localize(*views(POSE), noise=Noise(sigma, 0.01, 0.01)) for sigma in (0.01, 0.002))
    assert np.trace(exact.covariance) < 0.1 * np.trace(rough.covariance)
    assert localize(*views(POSE), noise=Noise(0.1)).reason == Reason.TOO_FEW_DISTANCES  # beyond `max_range`, 2.1 m


def given(*values):
    return PLAIN.localize_observations([Observation(*values)])
