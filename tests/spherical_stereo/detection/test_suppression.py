"""Suppression: of boxes that show one object the best stays, and objects that merely overlap all stay."""

import numpy as np
import pytest

from course_lib.spherical_stereo.detection.seam import suppress_in_image, vote_on_boxes

BOX = np.array([100.0, 50, 200, 150])


def shifted(*offsets):
    return np.array([BOX + np.array([offset, 0, offset, 0]) for offset in offsets])


def test_the_best_of_overlapping_boxes_stays():
    kept = suppress_in_image(shifted(0, 5, -5), np.array([0.6, 0.9, 0.7]), np.zeros(3, int), 0.45)
    assert kept.tolist() == [1]


def test_boxes_that_overlap_less_than_the_limit_all_stay_the_best_first():
    kept = suppress_in_image(shifted(0, 60, 120), np.array([0.6, 0.9, 0.7]), np.zeros(3, int), 0.45)
    assert kept.tolist() == [1, 2, 0]


def test_a_suppressed_box_suppresses_nothing():
    """A chain: the second goes because of the first; the third overlaps only the second and stays."""
    kept = suppress_in_image(shifted(0, 30, 60), np.array([0.9, 0.8, 0.7]), np.zeros(3, int), 0.45)
    assert kept.tolist() == [0, 2]


def test_across_classes_only_boxes_that_nearly_coincide_are_one_object():
    scores, classes = np.array([0.9, 0.8]), np.array([0, 1])
    assert suppress_in_image(shifted(0, 25), scores, classes, 0.45).tolist() == [0, 1]
    assert suppress_in_image(shifted(0, 4), scores, classes, 0.45).tolist() == [0]


def test_boxes_that_nearly_coincide_vote_weighted_by_their_scores():
    boxes = np.array([[0, 0, 100, 100], [4, 0, 104, 100], [300, 0, 400, 100]], float)
    voted = vote_on_boxes(boxes, np.array([0.6, 0.2, 0.9]), np.array([1, 1, 1]), np.array([0, 2]))
    np.testing.assert_allclose(voted, [[1, 0, 101, 100], [300, 0, 400, 100]])


@pytest.mark.parametrize(
    ("box", "score", "kind"),
    [((60, 0, 160, 100), 0.5, 1), ((4, 0, 104, 100), 0.5, 2), ((4, 0, 104, 100), 0.09, 1)],
    ids=["far away", "another class", "hardly sure"],
)
def test_others_have_no_vote(box, score, kind):
    boxes = np.array([(0, 0, 100, 100), box], float)
    voted = vote_on_boxes(boxes, np.array([0.6, score]), np.array([1, kind]), np.array([0]))
    np.testing.assert_allclose(voted, boxes[:1])
