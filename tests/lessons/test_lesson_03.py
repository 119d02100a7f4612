"""What lesson 03 says about its corridor and its z-buffer holds."""

import numpy as np
import pytest

from courseware.answers.lesson_03 import off_the_cut
from courseware.lessons.lesson_03.figures import renderer_of


@pytest.mark.parametrize("backend", ["vtk", "ray"])
def test_a_side_wall_does_not_tell_x_and_a_near_plane_cuts_the_pillar_away(backend):
    def view(x, y, yaw=0.0, near=0.1):
        return renderer_of(near, backend).render(np.array([x, y, 1.2, 0, 0, yaw]))[0]

    np.testing.assert_allclose([view(3.0, 0, np.pi / 2), view(3.1, 0, np.pi / 2)], 1.5, atol=0.001)
    assert np.isinf(view(0.5, 0, np.pi / 2)).mean() > 0.05
    assert [view(4.7, 0.6)[72, 88], view(4.7, 0.6, near=1.0)[72, 88]] == pytest.approx([0.3, 3.3], abs=0.001)


def test_a_wrong_cut_is_told_by_what_is_wrong_with_it():
    corners = np.array([[0.0, 0, 3], [4, 0, -1], [0, 2, 3]])
    cut = np.array([[0.0, 0, 3], [2, 0, 1], [2, 1, 1], [0, 2, 3]])
    wrong = {"crosses itself": cut[[0, 2, 1, 3]], "should have 4": cut[:3], "not their places": cut * [1.1, 1, 1]}
    for words, polygon in (wrong | {"before the near plane": corners, "rows of three": [1, 2]}).items():
        assert words in off_the_cut((corners, 1.0), polygon)
    assert off_the_cut((corners - [0, 0, 9], 1.0), []) is None
