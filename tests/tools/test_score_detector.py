"""A detector is scored against exact boxes: hits, misses, false alarms. Photographs of a room come from its seed."""

from itertools import islice

import numpy as np
import pytest

from course_lib.spherical_stereo.detection.detected_object import Detection
from courseware.simulation.room.stereo_recording import TrueObject
from tools.score_detector import DetectionScoreError, photographs, score_detector


class Sees:
    """A detector that reports the same two sofas in every image."""

    def detect(self, image):
        return [Detection("sofa", 0.9, (u, 300.0, u + 100.0, 380.0), 10.0, 50.0) for u in (500.0, 900.0)]


def test_hits_misses_and_false_alarms_are_counted_and_what_does_not_count_is_left_out():
    boxes = [(u, 300.0, u + 100.0, 380.0) for u in (500.0, 700.0, 900.0)]
    shares = (1.0, 1.0, 0.2)
    things = [TrueObject(k, "sofa", box, box, shares[k]) for k, box in enumerate(boxes)]
    image = np.zeros((640, 1280, 3), np.uint8)
    found = score_detector(Sees(), [(image, things), (image, things[1:])])
    assert found == (2, 3, 1, 1)
    assert (found.precision, found.recall) == (0.5, pytest.approx(1 / 3))
    with pytest.raises(DetectionScoreError, match="no object"):
        score_detector(Sees(), [(image, [])])


@pytest.mark.slow
def test_the_photographs_of_a_room_come_from_its_seed_and_their_boxes_lie_on_them():
    (image, things), (again, _) = (next(islice(photographs(5), 1)) for _ in range(2))
    np.testing.assert_array_equal(image, again)
    assert image.shape == (640, 1280, 3)
    assert len(things) >= 3
    for thing in things:
        u_min, v_min, u_max, v_max = thing.visible_box
        assert 0 <= u_min < 1280
        assert u_min < u_max <= u_min + 1280
        assert 0 <= v_min < v_max <= 640
