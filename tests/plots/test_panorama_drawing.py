"""Figures of panoramas and of poses: numbers that stay apart, lines that show a swap, nothing hidden by a legend."""

from itertools import combinations
from types import SimpleNamespace

import numpy as np
import pytest

from course_lib.plots.figures import new_figure
from course_lib.plots.panorama_drawing import draw_box, draw_numbers, panorama
from course_lib.plots.room_figures import pose_figure
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D
from course_lib.spherical_stereo.semantic_map.association import Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap

WIDTH = 1280
IMAGE = np.full((WIDTH // 2, WIDTH, 3), 120, np.uint8)
# As the shipped room crowds them: small boxes inside and beside each other, one across the seam.
CROWD = [(1000.0 + 9 * k, 300.0 + 6 * k, 1045.0 + 9 * k, 350.0 + 5 * k) for k in range(9)]
BOXES = [*CROWD, (1250.0, 310.0, 1300.0, 400.0), (1262.0, 305.0, 1279.0, 330.0), (0.0, 300.0, 30.0, 340.0)]


def texts(axes):
    return {one.get_text(): one.get_window_extent() for one in axes.texts}


def test_numbers_of_crowded_boxes_cover_neither_each_other_nor_the_edge():
    figure, axes = new_figure(size=(10.0, 6.0))
    panorama(axes, IMAGE, "crowd")
    draw_numbers(axes, BOXES, ["chair"] * len(BOXES), WIDTH)
    figure.draw_without_rendering()
    shown = texts(axes)
    assert list(shown) == [str(n) for n in range(1, len(BOXES) + 1)]
    assert [(a, b) for a, b in combinations(shown, 2) if shown[a].overlaps(shown[b])] == []
    picture = axes.get_window_extent()
    assert all(picture.x0 <= extent.x0 and extent.x1 <= picture.x1 for extent in shown.values())


@pytest.mark.parametrize(("box", "frames"), [((100, 200, 160, 260), 1), ((1250, 200, 1310, 260), 2)])
def test_a_box_across_the_seam_is_drawn_on_both_sides(box, frames):
    _, axes = new_figure()
    panorama(axes, IMAGE, "seam")
    draw_box(axes, box, WIDTH, "sofa", "sofa")
    assert len(axes.patches) == frames
    assert list(texts(axes)) == ["sofa"]


def test_a_line_joins_each_measured_object_to_its_landmark_and_a_swap_crosses():
    landmarks = [Landmark("sofa", 1.0, 1.0, 20.0, 50.0), Landmark("sofa", 3.0, 1.0, 20.0, 50.0)]
    measured = [Observation("sofa", 1.0, 1.5, 20.0, 50.0), Observation("sofa", 3.0, 1.5, 20.0, 50.0)]
    result = SimpleNamespace(
        pair=SimpleNamespace(pose=(0.0, 0.0, 0.0)),
        localization=SimpleNamespace(pose=Pose2D(0.0, 0.0, 0.0), observations=measured, used_pairs=((0, 1), (1, 0))),
        true_landmarks=(0, 1),
    )
    figure = pose_figure(SemanticMap(landmarks), result, "swapped")
    axes = figure.axes[0]
    dashed = [line.get_xydata().tolist() for line in axes.lines if line.get_linestyle() == "--"]
    assert dashed == [[[1.0, 1.5], [3.0, 1.0]], [[3.0, 1.5], [1.0, 1.0]]]
    figure.draw_without_rendering()
    assert not axes.get_legend().get_window_extent().overlaps(axes.get_window_extent())
