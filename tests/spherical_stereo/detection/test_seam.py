"""The seam: whatever an object's place and width, it is counted once, with the box it would have without a seam."""

import numpy as np
import pytest

from course_lib.spherical_stereo.detection import seam

WIDTH, IOU = 640, 0.45


def ideal_detections(u_min, object_width):
    """What a perfect network sees of one object on the extended image: every copy, cut by the image's ends."""
    end = WIDTH + seam.appended_columns(WIDTH)
    copies = []
    for turn in (-WIDTH, 0, WIDTH):
        left, right = max(u_min + turn, 0), min(u_min + object_width + turn, end)
        if right - left >= 8:  # a sliver is no detection
            copies.append([left, 100, right, 180])
    return np.array(copies, dtype=np.float64), np.linspace(0.7, 0.9, len(copies)), np.zeros(len(copies), dtype=int)


def test_the_left_quarter_is_appended_at_the_right(rng):
    image = rng.integers(0, 256, (64, 128, 3), dtype=np.uint8)
    assert np.array_equal(seam.extend_seam(image), np.hstack([image, image[:, :32]]))
    assert seam.valid_range(128) == (16, 144)


@pytest.mark.parametrize("object_width", [20, 100, 160, 175, 200, 320, 480, 630])
def test_an_object_of_any_width_at_any_column_is_counted_once_and_whole(object_width):
    for u_min in range(0, WIDTH, 7):
        boxes, scores, _ = seam.select_on_circle(*ideal_detections(u_min, object_width), WIDTH, IOU)
        assert len(boxes) == len(scores) == 1, f"at column {u_min}"
        assert boxes[0] == pytest.approx([u_min, 100, u_min + object_width, 180], abs=1e-9), f"at column {u_min}"


def test_two_objects_side_by_side_at_the_border_of_the_range_both_stay():
    start, _ = seam.valid_range(WIDTH)
    one, two = ideal_detections(start - 42, 40), ideal_detections(start + 2, 40)
    boxes, _, _ = seam.select_on_circle(*(np.concatenate(parts) for parts in zip(one, two, strict=True)), WIDTH, IOU)
    assert sorted(boxes[:, 0]) == pytest.approx([start - 42, start + 2])


def test_a_surer_copy_that_the_seam_cuts_gives_way_to_the_whole_one_even_when_both_centres_count():
    """A wide object: 28 of its columns are missing at the left end, and its middle is in the range all the same."""
    cut, whole = [0, 100, 165, 180], [WIDTH - 28, 100, WIDTH + 149, 180]
    assert seam.centres_in_range(np.array([cut, whole]), WIDTH).all()
    boxes, scores, _ = seam.select_on_circle(np.array([cut, whole]), np.array([0.9, 0.6]), np.zeros(2, int), WIDTH, IOU)
    assert (boxes.tolist(), scores.tolist()) == ([whole], [0.9])


def copies_at_the_border():
    """An object at the range's end: a faint copy just inside it, a clear one just before its start, a turn apart."""
    start, stop = seam.valid_range(WIDTH)
    return np.array([[stop - 22, 100, stop + 18, 180], [start - 22, 100, start + 18, 180]]), np.array([0.06, 0.95])


def test_a_faint_copy_in_the_range_does_not_hide_a_clear_one_in_the_margin():
    boxes, scores = copies_at_the_border()
    boxes[1] += 1
    found, found_scores, _ = seam.select_on_circle(boxes, scores, np.zeros(2, int), WIDTH, IOU)
    assert found.tolist() == [[boxes[0, 0] - WIDTH, 100, boxes[0, 2] - WIDTH, 180]]
    assert found_scores.tolist() == [0.95]


def test_a_suppressed_box_gives_its_score_to_the_one_that_replaced_it_only():
    """Three boxes in a row: the middle one goes with the left, whose rank is greater, and not with the right."""
    start, stop = seam.valid_range(WIDTH)
    left, right = [stop - 30, 100, stop + 10, 180], [start - 10, 100, start + 30, 180]
    middle = [start - 20.5, 100, start + 19.5, 180]  # in the margin, and overlaps both
    scores = np.array([0.5, 0.4, 0.9])
    boxes, found_scores, _ = seam.select_on_circle(
        np.array([left, right, middle]), scores, np.zeros(3, int), WIDTH, IOU
    )
    assert (boxes[:, 0].tolist(), found_scores.tolist()) == ([start - 30, start - 10], [0.9, 0.4])


def test_a_low_threshold_holds_the_result_of_a_higher_one():
    boxes, scores = copies_at_the_border()
    elsewhere = [[300.0, 100, 360, 180], [305.0, 100, 362, 180], [200.0, 100, 240, 180]]
    boxes, scores = np.concatenate([boxes, elsewhere]), np.concatenate([scores, [0.8, 0.3, 0.2]])
    for threshold in (0.1, 0.25, 0.5, 0.9):
        found, found_scores, _ = seam.select_on_circle(boxes, scores, np.zeros(5, int), WIDTH, IOU)
        above = scores >= threshold
        alone, alone_scores, _ = seam.select_on_circle(
            boxes[above], scores[above], np.zeros(above.sum(), int), WIDTH, IOU
        )
        assert found[found_scores >= threshold].tolist() == alone.tolist()
        assert found_scores[found_scores >= threshold].tolist() == alone_scores.tolist()


def test_halves_of_two_objects_are_not_joined():
    quarter = seam.appended_columns(WIDTH)
    high = [0.0, 20, quarter + 40, 60]
    low = [WIDTH - 50.0, 200, WIDTH + quarter, 300]
    for boxes, classes in (([high, low], [0, 0]), ([high, [*low[:1], 20, low[2], 60]], [0, 1])):
        joined, _, _ = seam.join_cut_pairs(np.array(boxes), np.array([0.9, 0.8]), np.array(classes), WIDTH)
        assert len(joined) == 2


BOX = np.array([100.0, 50, 200, 150])


def shifted(*offsets):
    return BOX + np.array(offsets).reshape(-1, 1) * [1, 0, 1, 0]


@pytest.mark.parametrize(
    ("offsets", "scores", "classes", "kept"),
    [
        ((0, 5, -5), (0.6, 0.9, 0.7), (0, 0, 0), [1]),  # the best stays
        ((0, 60, 120), (0.6, 0.9, 0.7), (0, 0, 0), [1, 2, 0]),  # they overlap less than the limit
        ((0, 30, 60), (0.9, 0.8, 0.7), (0, 0, 0), [0, 2]),  # a suppressed box suppresses nothing
        ((0, 25), (0.9, 0.8), (0, 1), [0, 1]),  # two classes
        ((0, 4), (0.9, 0.8), (0, 1), [0]),  # two classes that nearly coincide
        ((), (), (), []),
    ],
)
def test_of_overlapping_boxes_the_best_stays(offsets, scores, classes, kept):
    found = seam.suppress_in_image(shifted(*offsets), np.array(scores), np.array(classes), 0.45)
    assert found.tolist() == kept


def test_boxes_that_nearly_coincide_vote_weighted_by_their_scores_and_no_others():
    boxes = np.array([[0, 0, 100, 100], [4, 0, 104, 100], [300, 0, 400, 100]], float)
    voted = seam.vote_on_boxes(boxes, np.array([0.6, 0.2, 0.9]), np.array([1, 1, 1]), np.array([0, 2]))
    np.testing.assert_allclose(voted, [[1, 0, 101, 100], [300, 0, 400, 100]])
    for u, score, kind in ((60, 0.5, 1), (4, 0.5, 2), (4, 0.09, 1)):  # far away, another class, hardly sure
        boxes = np.array([(0, 0, 100, 100), (u, 0, u + 100, 100)], float)
        voted = seam.vote_on_boxes(boxes, np.array([0.6, score]), np.array([1, kind]), np.array([0]))
        np.testing.assert_allclose(voted, boxes[:1])
