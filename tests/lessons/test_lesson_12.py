"""What lesson 12's panels and figures say of seams and colours agrees with the library."""

import numpy as np
import pytest

from course_lib.lessons.kit.room_photographs import the_image
from course_lib.lessons.lesson_12.figures import CROP, crop_of, part_of
from course_lib.lessons.lesson_12.measures import hues_and_saturations
from course_lib.lessons.lesson_12.panel import where_they_count
from course_lib.lessons.lesson_12.seam_cuts import SOFA, cut_sofa, true_object
from course_lib.paths import data_path
from course_lib.spherical_stereo.detection.colour import central_half, mean_hue_saturation
from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.detection.seam import centres_in_range


@pytest.mark.parametrize("percent", [0, 30, 100])
def test_the_seam_cuts_the_sofa_where_the_slider_says(percent):
    cut = cut_sofa(percent)
    assert (1280 - cut.sofa[0]) % 1280 / (cut.sofa[2] - cut.sofa[0]) == pytest.approx(percent / 100, abs=0.01)
    hues = [
        mean_hue_saturation(*given)[0]
        for given in ((cut.image, cut.sofa), (the_image(), true_object(SOFA).visible_box))
    ]
    assert hues[0] == pytest.approx(hues[1], abs=1)


def test_objects_are_those_of_the_detector_and_drawn_where_they_count():
    cut, detector = cut_sofa(70), YoloDetector.load(data_path("detector"))
    objects, found = cut.objects(True, detector.score_threshold), detector.detect(cut.image)
    assert objects.boxes == pytest.approx(np.array([one.box for one in found]), abs=0.5)
    drawn = where_they_count(objects.boxes, 1280)
    assert (drawn - objects.boxes)[:, [0, 2]] % 1280 == pytest.approx(0)
    assert centres_in_range(drawn, 1280).all()
    assert not centres_in_range(objects.boxes, 1280).all(), "some box needs the turn"


def test_the_hues_shown_are_those_that_the_library_averages():
    box = true_object(SOFA).visible_box
    assert part_of(box, 0.5) == pytest.approx(central_half(box))
    hues, saturations = hues_and_saturations(the_image(), part_of(box, 0.5))
    mean = np.degrees(np.angle(saturations @ np.exp(1j * np.radians(hues)))) % 360
    assert (mean, 100 * saturations.mean()) == pytest.approx(mean_hue_saturation(the_image(), box), abs=0.5)


def test_a_crop_goes_around_the_seam_and_says_where_it_is():
    image = np.zeros((640, 1280, 3), np.uint8)
    image[:, :40], image[:, -40:] = (255, 0, 0), (0, 0, 255)
    crop, corner, side = crop_of(image, (1240.0, 300.0, 1320.0, 380.0))
    assert [*corner, side] == pytest.approx([1230, 290, 100])
    assert crop[CROP // 2, [CROP * 3 // 10, CROP * 7 // 10]].tolist() == [[255, 0, 0], [0, 0, 255]], "RGB"
