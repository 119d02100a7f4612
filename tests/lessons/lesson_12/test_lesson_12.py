"""What lesson 12 says of seams, thresholds and colours holds, whatever network is shipped."""

import numpy as np
import pytest

from course_lib.lessons.kit.room_photographs import the_image
from course_lib.lessons.lesson_12.figures import crop_of, hues_and_saturations, outline, part_of
from course_lib.lessons.lesson_12.learning import anchors, answering_cells, shape_overlap, training_picture
from course_lib.lessons.lesson_12.panel import seam_panel, where_they_count
from course_lib.lessons.lesson_12.scores import ThresholdScore, colours_against_map
from course_lib.lessons.lesson_12.seam_cuts import (
    CUTS,
    SOFA,
    Found,
    best_overlap,
    chosen_threshold,
    cut_counts,
    cut_sofa,
    cut_table,
    detector,
    pieces_of_sofa,
    said_of_the_sofa,
    true_object,
)
from course_lib.spherical_stereo.detection.colour import central_half, mean_hue_saturation
from course_lib.spherical_stereo.detection.seam import centres_in_range

WIDTH = 1280


def test_the_seam_cuts_the_sofa_where_the_slider_says():
    wanted, _ = mean_hue_saturation(the_image(), true_object(SOFA).visible_box)
    for percent in (0, 50, 100):
        cut = cut_sofa(percent)
        assert (WIDTH - cut.sofa[0]) % WIDTH / (cut.sofa[2] - cut.sofa[0]) == pytest.approx(percent / 100, abs=0.01)
        hue, _ = mean_hue_saturation(cut.image, tuple(cut.sofa))
        assert hue == pytest.approx(wanted, abs=1)


def test_the_extension_finds_the_whole_sofa_more_often_than_the_plain_image():
    cuts = {percent: cut_sofa(percent) for percent in CUTS[2:9:2]}
    without, with_it = (cut_counts(cuts, 0.3, extension)["once and whole"] for extension in (False, True))
    assert with_it > without
    assert sum(cut_counts(cuts, 0.3, True).values()) == len(cuts)
    assert len(cut_table(cuts, 0.3).splitlines()) == 1 + len(cuts)


def test_the_panels_objects_are_those_of_the_detector():
    cut = cut_sofa(50)
    objects, found = cut.objects(True, detector().score_threshold), detector().detect(cut.image)
    assert len(objects.boxes) == len(found)
    assert objects.labels == [one.label for one in found]
    assert objects.boxes == pytest.approx(np.array([one.box for one in found]), abs=0.5)


def test_a_higher_threshold_keeps_fewer():
    plain = cut_sofa(50).plain
    counts = [len(plain.above(threshold).boxes) for threshold in (0.1, 0.5, 0.9)]
    assert counts == sorted(counts, reverse=True)
    assert counts[0] > counts[-1]


def test_pieces_are_told_on_the_circle_and_by_class():
    sofa = np.array([1200.0, 300, 1360, 400])
    boxes = np.array([[0, 300, 80, 400], [1200, 300, 1280, 400], [1200, 300, 1360, 400], [400, 300, 480, 400]], float)
    index = {label: number for number, label in enumerate(detector().labels)}
    found = Found(boxes, np.full(4, 0.9), np.array([index["sofa"], index["sofa"], index["chair"], index["sofa"]]))
    assert pieces_of_sofa(found, sofa, WIDTH).tolist() == [0, 1]
    assert best_overlap(found, sofa, WIDTH) == pytest.approx(0.5)
    nothing = Found(np.zeros((0, 4)), np.zeros(0), np.zeros(0, int))
    assert len(pieces_of_sofa(nothing, sofa, WIDTH)) == 0
    assert best_overlap(nothing, sofa, WIDTH) == 0


def test_the_chosen_threshold_is_that_of_the_detector():
    assert chosen_threshold() == detector().score_threshold


def test_half_hidden_objects_differ_more_in_hue():
    colours = colours_against_map()
    gap = colours.hue_difference
    free, hidden = np.nanmedian(gap[colours.visible > 0.95]), np.nanmedian(gap[colours.visible < 0.6])
    assert free < 10 < hidden


def test_the_sofa_behind_the_table_has_the_wrong_hue():
    hues = [mean_hue_saturation(the_image(), true_object(number).visible_box)[0] for number in (0, 1, 2)]
    assert abs(hues[0] - hues[2]) < 10
    assert abs(hues[1] - hues[0]) > 30
    assert true_object(1).visible_fraction < 0.6


def test_the_part_of_a_half_is_the_librarys_central_half():
    box = (1200.0, 300.0, 1380.0, 420.0)
    assert part_of(box, 0.5) == pytest.approx(central_half(box))
    assert part_of(part_of(box, 0.5), 2.0) == pytest.approx(box)


def test_hues_of_a_part_are_those_that_the_library_averages():
    box = true_object(SOFA).visible_box
    hues, saturations = hues_and_saturations(the_image(), part_of(box, 0.5))
    angle = np.radians(hues)
    mean = np.degrees(np.arctan2((saturations * np.sin(angle)).sum(), (saturations * np.cos(angle)).sum())) % 360
    hue, saturation = mean_hue_saturation(the_image(), box)
    assert mean == pytest.approx(hue, abs=0.5)
    assert 100 * saturations.mean() == pytest.approx(saturation, abs=0.1)


def test_a_crop_goes_around_the_seam_and_says_where_it_is():
    image = np.zeros((640, 1280, 3), np.uint8)
    image[:, :40], image[:, -40:] = (255, 0, 0), (0, 0, 255)
    crop, scale, corner = crop_of(image, (1240.0, 300.0, 1320.0, 380.0), 100)
    assert scale == pytest.approx(1.0)
    assert corner == pytest.approx([1230, 290])
    assert crop[50, 30].tolist() == [255, 0, 0], "red, left of the seam, in RGB"
    assert crop[50, 70].tolist() == [0, 0, 255]
    assert outline((1, 2, 3, 4))[0].tolist() == outline((1, 2, 3, 4))[-1].tolist()


def test_the_extension_switch_changes_what_the_panel_says_of_the_sofa():
    panel = seam_panel([50])
    off, on = (panel.draw(**(panel.defaults() | {"extension": e, "threshold": 0.3})).summary for e in (False, True))
    overlap = [float(text.split("(IoU) ")[1].split(";")[0]) for text in (off, on)]
    assert overlap[1] > overlap[0]


@pytest.mark.parametrize("percent", [50, 70])
def test_the_panel_draws_a_counted_box_where_its_centre_counts(percent):
    boxes = cut_sofa(percent).objects(True, 0.5).boxes
    drawn = where_they_count(boxes, WIDTH)
    assert centres_in_range(drawn, WIDTH).all()
    assert (drawn - boxes)[:, 0] % WIDTH == pytest.approx(0)
    assert drawn[:, 2] - drawn[:, 0] == pytest.approx(boxes[:, 2] - boxes[:, 0])
    assert not centres_in_range(boxes, WIDTH).all(), "some box of this image needs the turn"


def test_the_network_says_sofa_and_something_else_of_the_cut_sofa_and_sofa_of_the_whole_one():
    halves, whole = (said_of_the_sofa(cut_sofa(50), extension, 0.5) for extension in (False, True))
    assert halves[0].label == "sofa"
    assert all(said.overlap < 0.6 for said in halves)
    assert len(halves) == 2
    assert [said.label for said in whole] == ["sofa"]
    assert whole[0].overlap == pytest.approx(best_overlap(cut_sofa(50).objects(True, 0.5), cut_sofa(50).sofa, WIDTH))


def test_scores_of_a_threshold():
    score = ThresholdScore(right=51, made=53, wanted=54)
    assert (score.precision, score.recall) == (51 / 53, 51 / 54)
    assert np.isnan(ThresholdScore(0, 0, 54).precision)


def test_the_shapes_are_those_of_the_networks_file_and_their_grids_grow_with_them():
    shapes, strides = anchors()
    assert shapes[0].tolist() == [23, 32]
    assert shapes[-1].tolist() == [210, 160]
    assert strides.tolist() == [8] * 3 + [16] * 3 + [32] * 3


def test_the_training_picture_shows_its_objects_inside_it():
    taught = training_picture()
    assert taught.image.shape == (640, 1280, 3)
    assert len(taught.labels) == len(taught.boxes) == 10
    areas = (taught.boxes[:, 2:] - taught.boxes[:, :2]).prod(axis=1)
    assert (np.diff(areas) <= 0).all()


def test_shapes_overlap_as_the_training_has_it():
    found = shape_overlap(np.array([[40.0, 60.0], [20.0, 30.0]]), np.array([[40, 60], [80, 30]]))
    assert found == pytest.approx(np.array([[1.0, 1200 / 3600], [0.25, 600 / 2400]]))


def test_three_cells_answer_for_a_centre():
    assert answering_cells(np.array([49.9, 17.4])).tolist() == [[49, 17], [50, 17], [49, 16]]
    assert answering_cells(np.array([3.2, 5.6])).tolist() == [[3, 5], [2, 5], [3, 6]]
