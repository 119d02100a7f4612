"""One detected object: its class by one name, its box on the circle of columns, and values that can be."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from course_lib.spherical_stereo.detection import detected_object as objects

WIDTH = 1280.0


def box(u, v, across, down):
    return np.array([u, v, u + across, v + down])


@pytest.mark.parametrize(
    ("name", "label"), [("couch", "sofa"), ("tvmonitor", "television"), ("dining table", "table"), (" Chair ", "chair")]
)
def test_names_of_coco_and_voc_in_any_spelling_become_one_label(name, label):
    assert objects.canonical_label(name) == label


@pytest.mark.parametrize(
    ("a", "b", "overlap"),
    [
        (box(10, 20, 30, 40), box(10, 20, 30, 40), 1),
        (box(10, 20, 30, 40), box(40, 20, 30, 40), 0),
        (box(0, 0, 20, 10), box(10, 0, 20, 10), 1 / 3),
        (box(1270, 0, 40, 10), box(-10, 0, 40, 10), 1),  # one turn earlier
        (box(1270, 0, 20, 10), box(0, 0, 10, 10), 0.5),  # across the seam
        (box(0, 0, 700, 1), box(640, 0, 700, 1), (60 + 60) / (1400 - 120)),  # they meet at both ends
    ],
)
def test_boxes_overlap_on_the_circle(a, b, overlap):
    assert objects.box_iou([a], [b], WIDTH) == pytest.approx(overlap)


def test_every_pair_has_its_place_in_the_table():
    a, b = [box(0, 0, 10, 10), box(50, 0, 10, 10)], [box(50, 0, 10, 10)] * 3
    assert objects.box_iou(a, b, WIDTH).tolist() == [[0, 0, 0], [1, 1, 1]]
    assert objects.box_iou(a, [], WIDTH).shape == (2, 0)


@given(st.floats(0, 1279), st.floats(1, 1280), st.floats(0, 1279), st.floats(1, 1280), st.integers(-3000, 3000))
def test_turning_both_boxes_keeps_their_overlap(u_a, across_a, u_b, across_b, columns):
    a, b = box(u_a, 100, across_a, 50), box(u_b, 120, across_b, 60)
    turn = np.array([columns, 0, columns, 0])
    assert objects.box_iou([a + turn], [b + turn], WIDTH) == pytest.approx(objects.box_iou([a], [b], WIDTH), abs=1e-9)
    assert 0 <= objects.box_iou([a], [b], WIDTH)[0, 0] <= 1 + 1e-12


@pytest.mark.parametrize("bad", [[1, 2, 3], [np.nan, 0, 1, 1], [10, 0, 5, 1], [0, 3, 5, 3], [0, 0, 1281, 1]])
def test_boxes_that_cannot_be_are_named(bad):
    with pytest.raises(objects.DetectionError, match="boxes must"):
        objects.box_iou([bad], [[0, 0, 1, 1]], WIDTH)


def test_a_detection_has_its_canonical_label_and_its_place_on_the_circle_with_a_colour_or_without():
    detection = objects.Detection("Couch", 0.5, (250, 10, 270, 40), 20.0, 55.0)
    assert detection.label == "sofa"
    assert "hue 20 deg, saturation 55 %, centre (260, 25)" in detection.describe()
    bare = objects.Detection("Couch", 0.5, (250, 10, 270, 40))
    assert bare.is_grey
    assert np.isnan(bare.saturation)
    assert objects.box_centre(detection.box).tolist() == [260, 25]
    assert objects.wrapped_box((506, 10, 526, 40), 256).tolist() == list(detection.box)


@pytest.mark.parametrize(
    ("field", "bad"),
    [
        ("label", ["_-", 3]),
        ("score", [float("nan"), 1.1, -0.1]),
        ("hue", [360.0, -1.0]),
        ("saturation", [101.0, -1.0]),
        ("box", [(1, 2, 3), (3, 2, 1, 4), (-1, 2, 3, 4), (1, 2, 3, np.inf), (1, -2, 3, 4), (1, 4, 3, 2)]),
    ],
)
def test_a_detection_that_cannot_be_is_refused(field, bad):
    good = {"label": "sofa", "score": 0.9, "box": (1, 2, 3, 4), "hue": 10.0, "saturation": 50.0}
    for value in bad:
        with pytest.raises(objects.DetectionError, match=field):
            objects.Detection(**(good | {field: value}))
