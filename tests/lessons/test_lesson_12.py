"""What lesson 12's panels and figures say of seams and colours agrees with the library."""

import numpy as np
import pytest

from course_lib.spherical_stereo.detection.colour import central_half, mean_hue_saturation
from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.detection.seam import centres_in_range
from courseware.lessons.kit.room_data import the_image
from courseware.lessons.lesson_12.figures import part_of, where_they_count
from courseware.lessons.lesson_12.measures import cut_sofa, hues_and_saturations, true_object
from courseware.paths import data_path


def test_the_seam_cuts_the_sofa_where_the_slider_says_and_objects_are_drawn_where_they_count():
    cut, detector = cut_sofa(70), YoloDetector.load(data_path("detector"))
    assert (1280 - cut.sofa[0]) / (cut.sofa[2] - cut.sofa[0]) == pytest.approx(0.7, abs=0.01)
    objects, found = cut.objects(True, detector.score_threshold), detector.detect(cut.image)
    assert objects.boxes == pytest.approx(np.array([one.box for one in found]), abs=0.5)
    drawn = where_they_count(objects.boxes, 1280)
    assert (drawn - objects.boxes)[:, [0, 2]] % 1280 == pytest.approx(0)
    assert centres_in_range(drawn, 1280).all()


def test_the_hues_shown_are_those_that_the_library_averages():
    box = true_object(2).visible_box
    assert part_of(box, 0.5) == pytest.approx(central_half(box))
    hues, saturations = hues_and_saturations(the_image(), part_of(box, 0.5))
    mean = np.degrees(np.angle(saturations @ np.exp(1j * np.radians(hues)))) % 360
    assert (mean, 100 * saturations.mean()) == pytest.approx(mean_hue_saturation(the_image(), box), abs=0.5)
