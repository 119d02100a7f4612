"""What lesson 13 says of columns, look and place, turned cameras, plain objects and ties holds."""

import numpy as np
import pytest

from course_lib.lessons.kit.panorama_features import EXPERIMENT, PLACE, scene
from course_lib.lessons.kit.room_photographs import pair_of, room_recording
from course_lib.lessons.lesson_13.matching import (
    WAYS,
    count_table,
    matches_in_boxes,
    matches_when_turned,
    negative_scene,
    object_names,
    part_of,
    plain_object,
    score,
    turned,
    turned_objects,
    turned_scene,
)
from course_lib.lessons.lesson_13.panel import band, matching_panel
from course_lib.lessons.lesson_13.sphere_scene import half_circle, upright_plane
from course_lib.spherical_stereo.matching.epipolar import epipolar_pairs, epipolar_residual
from course_lib.spherical_stereo.matching.features import inside_box
from course_lib.spherical_stereo.matching.object_matching import NO_MATCHES, match_views
from course_lib.spherical_stereo.panorama import azimuth_elevation_of_pixel, open_view


@pytest.fixture(scope="module")
def one():
    return scene(PLACE)


@pytest.fixture(scope="module")
def panel():
    return matching_panel()


def columns(degrees: float) -> float:
    return degrees / 360 * 1280


def test_counting_both_ways_at_once_is_what_the_library_does(one):
    counts = count_table(one, "both")
    found = match_views(one.upper.view(), one.lower.view(), one.rig)
    assert len(found.matches) == 12
    assert all(counts[match.upper, match.lower] == match.n_matches for match in found.matches)


def test_the_constraint_leaves_fewer_than_60_of_thousands_of_features(one):
    near = epipolar_pairs(one.upper.features, one.lower.features, max_hamming=486)
    candidates = np.bincount(near.upper, minlength=len(one.upper.features))
    assert 10 < np.median(candidates) < 60
    assert len(one.lower.features) > 3000


@pytest.mark.parametrize("way", WAYS)
def test_each_way_pairs_every_object_rightly_from_exact_boxes(one, way):
    found = score([one], way)
    assert (found.right, found.wrong) == (12, 0)
    assert found.in_both == 12


def test_the_constraint_leaves_hardly_a_match_between_two_different_objects(one):
    assert score([one], "both").share_off < 0.01
    assert score([one], "AKAZE alone").share_off > 0.05


def test_an_unknown_way_is_refused(one):
    part = part_of(one.upper.features, one.upper.objects[0].box)
    with pytest.raises(ValueError, match="geometry alone"):
        matches_in_boxes(part, part, 0.3, "magic")


def test_half_a_degree_hardly_matters_and_at_three_no_true_match_is_left(one):
    straight, all_old = matches_when_turned(one, 0.0)
    assert straight == all_old
    assert matches_when_turned(one, columns(0.5))[1] > 0.9 * straight
    total, old = matches_when_turned(one, columns(3.0))
    assert total > 100
    assert old == 0


def test_right_pairs_come_from_wrong_matches(one):
    assert score([turned_scene(one, columns(3.0))], "both").right >= 10
    assert score([turned_scene(one, columns(10.0))], "both").right <= 8
    assert score([turned_scene(one, columns(10.0))], "AKAZE alone").right == 12


def test_an_object_painted_plain_has_no_match(one):
    painted = [
        open_view(plain_object(side.image, side.objects[0].box)).replace(detections=side.objects)
        for side in (one.upper, one.lower)
    ]
    result = match_views(*painted, one.rig)
    assert [(left.index, left.reason) for left in result.unmatched if left.side == "upper"] == [(0, NO_MATCHES)]


def test_turning_there_and_back_changes_nothing(one):
    back = turned(turned(one.lower.features, 100.0), -100.0)
    assert np.allclose(back.keypoints, one.lower.features.keypoints)
    boxes = [other.box for other in turned_objects(turned_objects(one.lower.objects, 100.0, 1280), -100.0, 1280)]
    assert np.allclose(boxes, [other.box for other in one.lower.objects])


def test_a_turned_camera_moves_features_with_their_objects(one):
    crooked = turned_scene(one, 300.0).lower
    for before, after in zip(one.lower.objects, crooked.objects, strict=True):
        inside = [
            inside_box(view.features.keypoints, np.array(o.box), 1280).sum()
            for view, o in ((one.lower, before), (crooked, after))
        ]
        assert abs(inside[0] - inside[1]) <= 1


def test_the_edge_of_the_band_is_the_tolerance_away_from_the_box():
    box, tolerance = (600.0, 400.0, 640.0, 450.0), 0.05
    outline = band(box, tolerance, 1280, 640)
    left = outline[: len(outline) // 2]
    a, e = azimuth_elevation_of_pixel(left, 1280, 640)
    a_box, _ = azimuth_elevation_of_pixel(np.array([600.0, 400.0]), 1280, 640)
    assert epipolar_residual(a_box, e, a, e) == pytest.approx(np.full(len(left), tolerance), rel=1e-6)


def test_objects_are_named_by_class_and_azimuth(one):
    names = object_names(one.upper.objects, 1280, 640)
    assert len(set(names)) == len(names)
    assert "table at -175" in names


def test_there_is_no_pair_of_an_unknown_name():
    with pytest.raises(KeyError):
        pair_of(room_recording(EXPERIMENT), "99_z")


def test_the_panel_finds_the_table_across_the_seam(panel):
    summary = panel.draw(**(panel.defaults() | {"chosen": "table at -175"})).summary
    assert "partner: table at -175, which is right" in summary


def test_without_the_constraint_the_panel_counts_matches_with_other_chairs(panel):
    def strangers(constraint: bool) -> int:
        line = panel.draw(**(panel.defaults() | {"constraint": constraint})).summary.splitlines()[0]
        return sum(int(part.rsplit(": ")[-1]) for part in line.split("matches with ")[1].split(", ")[:2])

    assert strangers(True) == 0
    assert strangers(False) > 3


def test_the_panel_says_which_objects_a_turned_camera_leaves_without_partner(panel):
    names = panel.controls["chosen"].options
    summaries = [panel.draw(**(panel.defaults() | {"chosen": name, "turn": 5.0})).summary for name in names]
    assert 1 <= sum("no partner" in summary for summary in summaries) <= 4


def test_a_negative_breaks_the_look_and_a_far_turn_the_place(one):
    assert score([negative_scene(one)], "geometry alone").right == 12
    assert score([negative_scene(one)], "AKAZE alone").right < 10
    assert score([turned_scene(one, columns(20.0))], "geometry alone").right < 10
    assert score([turned_scene(one, columns(20.0))], "AKAZE alone").right == 12


def test_the_half_circle_is_where_the_residual_is_zero():
    towards = np.array([2.2, 1.4, -1.5])
    circle = half_circle(towards)
    azimuth, elevation = np.arctan2(circle[1:-1, 1], circle[1:-1, 0]), np.arcsin(circle[1:-1, 2])
    assert np.linalg.norm(circle, axis=1) == pytest.approx(1)
    residual = epipolar_residual(np.arctan2(1.4, 2.2), -0.5, azimuth, elevation)
    assert residual == pytest.approx(0, abs=1e-9)
    assert circle[0] == pytest.approx([0, 0, 1], abs=1e-9)
    assert circle[-1] == pytest.approx([0, 0, -1], abs=1e-9)


def test_the_plane_holds_the_axis_and_the_point_and_stands_upright():
    point = np.array([2.2, 1.4, -1.5])
    plane = upright_plane(point, low=-3.6, high=1.2)
    normal = np.cross(point, [0, 0, 1])
    assert np.abs(np.asarray(plane.points) @ normal).max() < 1e-6
    assert plane.bounds[4:] == pytest.approx((-3.6, 1.2))
    assert plane.bounds[0] < 0 < point[0] < plane.bounds[1]
