"""Figures of panoramas: numbers that stay apart, boxes on both sides of the seam."""

from itertools import combinations

import numpy as np
import pytest

from courseware.plots.figures import new_figure
from courseware.plots.panorama_drawing import draw_box, draw_numbers, panorama

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
