"""What goes wrong is named: units, turned cameras, black frames, mirrored maps, far things, wrong pairs."""

import math
from dataclasses import replace

import numpy as np
import pytest

from course_lib.spherical_stereo.detection.detected_object import Detection, wrapped_box
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.matching.features import PanoramaFeatures, find_features, inside_box
from course_lib.spherical_stereo.outcomes import NoPartner, Reason
from course_lib.spherical_stereo.panorama import PanoramaError, StereoRig, open_view
from course_lib.spherical_stereo.pose.rigid_fit import rotation_2d
from course_lib.spherical_stereo.semantic_map.association import Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap
from tests.spherical_stereo.stereo_scene import (
    BASELINE,
    TRUE_POSE,
    WIDTH,
    KnowingDetector,
    boxes_of,
    mapped_scene,
    seen_turned,
)

UPPER, LOWER, MAP = mapped_scene()
RIG = StereoRig(BASELINE)


def locate(upper=UPPER, lower=LOWER, semantic_map=MAP, rig=RIG, **options):
    return SemanticLocalizer(rig, semantic_map, **options).localize(upper, lower, boxes_of(upper, lower))


def seen_by(image, detections=LOWER.detections):
    return open_view(image).replace(detections=detections)


def test_the_clean_twin_of_every_case_below_is_ok():
    found = locate()
    assert (found.status, found.reason, len(found.used_pairs)) == ("ok", None, 5)
    assert math.dist(found.pose[:2], TRUE_POSE[:2]) < 0.1
    assert np.linalg.norm(found.turn) < math.radians(0.3)
    assert found.rms_residual < 2 * found.statistics.expected_rms < 1.0
    assert found.statistics.degrees_of_freedom == 7
    # Two images and a detector give the same pose.
    detector = KnowingDetector((UPPER.image, LOWER.image, UPPER.detections, LOWER.detections))
    detected = SemanticLocalizer(RIG, MAP, detector).localize(UPPER.image, LOWER.image)
    assert (detected.pose, detected.unmatched) == (found.pose, ())
    assert set(detected.used_pairs) == {(one.observation, one.upper) for one in detected.objects}


def test_a_baseline_in_millimetres_is_named_and_one_in_other_units_is_implausible():
    with pytest.raises(PanoramaError, match="Is it in millimetres"):
        StereoRig(300)
    for baseline in (3.0, 1.0, 0.05):
        found = locate(rig=StereoRig(baseline))
        assert (found.status, found.reason, found.pose) == ("unable", Reason.IMPLAUSIBLE, None)
        assert found.rejected_pose is not None
        assert f"{found.rms_residual:.2f} m" in found.explanation
        assert locate(rig=StereoRig(baseline), reject_implausible=False).status == "ok", "the paper's method is silent"


@pytest.mark.parametrize("columns", [20, -20, 200])
def test_a_lower_camera_that_is_yawed_is_named(columns):
    boxes = wrapped_box([np.add(d.box, [columns, 0, columns, 0]) for d in LOWER.detections], WIDTH)
    detections = [replace(d, box=tuple(box)) for d, box in zip(LOWER.detections, boxes, strict=True)]
    found = locate(lower=seen_by(np.roll(LOWER.image, columns, axis=1), detections))
    assert (found.status, found.reason) == ("unable", Reason.TURNED)
    assert found.turn[2] == pytest.approx(2 * math.pi * columns / WIDTH, abs=math.radians(0.3))
    assert "of yaw" in found.explanation


@pytest.mark.parametrize(
    ("turn_deg", "is_named"), [((3, 0, 0), True), ((0, -3, 0), True), ((1.2, 1.2, 0), True), ((0.2, 0.2, 0.3), False)]
)
def test_a_lower_camera_that_is_tilted_by_more_than_a_little_is_named(turn_deg, is_named):
    tilted = seen_by(seen_turned(LOWER.image, np.radians(turn_deg)))
    found = locate(lower=tilted)
    assert (found.status, found.reason) == (("unable", Reason.TURNED) if is_named else ("ok", None))
    assert np.degrees(found.turn) == pytest.approx(turn_deg, abs=0.4 if is_named else 0.2)
    assert locate(lower=tilted, reject_implausible=False).turn is None, "the paper's method does not ask"


@pytest.mark.parametrize("dark", ["upper", "lower"])
def test_a_black_frame_is_unable_and_no_exception(dark):
    found = locate(**{dark: open_view(np.zeros_like(UPPER.image))})
    assert (found.status, found.reason) == ("unable", Reason.BLANK)
    assert f"the {dark} image is black" in found.explanation


def test_an_object_at_200_metres_is_too_far_and_moves_nothing():
    before = locate()
    parallax = BASELINE / 200 / math.pi * UPPER.height
    far = Detection("chair", 0.9, (300.0, 128.0, 340.0, 150.0), 60.0, 50.0)
    pairs = [*((m.upper, m.lower) for m in before.matches), (5, 5)]
    upper = [*UPPER.detections, far]
    lower = [*LOWER.detections, replace(far, box=(300.0, 128.0 - parallax, 340.0, 150.0 - parallax))]
    size = (WIDTH, WIDTH // 2)
    found = SemanticLocalizer(RIG, MAP).localize_detections(upper, lower, pairs, size)
    assert [one.outcome for one in found.objects] == ["ok"] * 5 + ["too far"]
    assert found.pose == pytest.approx(before.pose, abs=1e-9)
    paper = SemanticLocalizer(RIG, MAP, reject_implausible=False).localize_detections(upper, lower, pairs, size)
    assert math.hypot(*paper.objects[5].position[:2]) == pytest.approx(200, rel=0.03)


def test_a_mirrored_map_gives_no_pose():
    for axis in ("x", "y"):
        mirrored = SemanticMap([replace(one, **{axis: 6.0 - getattr(one, axis)}) for one in MAP.landmarks])
        assert locate(semantic_map=mirrored).reason in (Reason.IMPLAUSIBLE, Reason.MIRRORED)


def test_one_matched_feature_makes_no_object():
    """Only one feature is left in the chair's box of the upper image; in the paper's method that is an object."""
    view = find_features(UPPER)
    inside = inside_box(view.features.keypoints, UPPER.detections[2].box, WIDTH)
    chair = next(m for m in locate().matches if m.upper == 2)
    kept = ~inside | (view.features.keypoints == chair.keypoints_upper[0]).all(axis=1)
    thin = PanoramaFeatures(view.features.keypoints[kept], view.features.descriptors[kept], *view.size)
    found = locate(upper=view.replace(features=thin))
    assert ("upper", 2, NoPartner.TOO_FEW_FEATURES) in found.unmatched
    paper = locate(upper=view.replace(features=thin), reject_implausible=False)
    assert {m.upper: m.n_matches for m in paper.matches}[2] == 1


def observations(moved=(0.0, 0.0), hues=MAP.hues):
    """The landmarks as seen from the true pose, the first moved by so many metres, with a decimetre of noise each."""
    body = (MAP.positions - TRUE_POSE[:2]) @ rotation_2d(TRUE_POSE.theta)
    body[0] += moved
    return [
        Observation(one.label, *place, hue, 50.0, 0.01 * np.eye(2))
        for one, place, hue in zip(MAP.landmarks, body, hues, strict=True)
    ]


@pytest.mark.parametrize("weighted_fit", [False, True])
def test_a_far_outlier_is_implausible_and_a_small_one_is_not(weighted_fit):
    localizer = SemanticLocalizer(RIG, MAP, weighted_fit=weighted_fit)
    assert localizer.localize_observations(observations((0.3, 0.0))).status == "ok"
    found = localizer.localize_observations(observations((0.0, 3.0)))
    assert (found.status, found.reason, found.covariance) == ("unable", Reason.IMPLAUSIBLE, None)
    # Two look-alikes that were exchanged are implausible too.
    swapped = MAP.hues[[1, 0, 2, 3, 4]]
    found = localizer.localize_observations(observations(hues=swapped))
    assert set(found.used_pairs) == {(0, 1), (1, 0), (2, 2), (3, 3), (4, 4)}
    assert found.reason == Reason.IMPLAUSIBLE


def test_the_map_is_asked_for_the_colours_of_the_upper_image():
    """Grey below, and in another order: nothing but the upper image's colours can tell the two sofas apart."""
    lower = [replace(d, hue=math.nan, saturation=0.0) for d in LOWER.detections[::-1]]
    matches = [(i, 4 - i) for i in range(5)]
    found = SemanticLocalizer(RIG, MAP).localize_detections(UPPER.detections, lower, matches, UPPER.size)
    assert [one.hue for one in found.observations] == pytest.approx(MAP.hues.tolist(), nan_ok=True)
    assert {one.saturation for one in found.observations} == {50.0}
    assert sorted(found.used_pairs) == [(i, i) for i in range(5)]
