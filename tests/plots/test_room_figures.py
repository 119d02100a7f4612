"""Figures of a room from above show what they were given: a swap, doubt, confusions; no legend hides anything."""

from types import SimpleNamespace

import numpy as np

from course_lib.spherical_stereo.pose.rigid_fit import Pose2D
from course_lib.spherical_stereo.semantic_map.association import Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap
from courseware.experiments.ambiguity import AmbiguityMap
from courseware.plots.room_figures import ambiguity_figure, pose_figure
from tests.beyond.look_alikes.look_alike_scene import SYMMETRIC


def test_a_line_joins_each_measured_object_to_its_landmark_and_a_swap_crosses():
    landmarks = [Landmark("sofa", x, 1.0, 20.0, 50.0) for x in (1.0, 3.0)]
    measured = [Observation("sofa", x, 1.5, 20.0, 50.0) for x in (1.0, 3.0)]
    pose = Pose2D(0.0, 0.0, 0.0)
    found = SimpleNamespace(pose=pose, observations=measured, used_pairs=((0, 1), (1, 0)))
    result = SimpleNamespace(pair=SimpleNamespace(pose=pose), localization=found, true_landmarks=(0, 1))
    figure = pose_figure(SemanticMap(landmarks), result, "swapped")
    axes = figure.axes[0]
    dashed = [line.get_xydata().tolist() for line in axes.lines if line.get_linestyle() == "--"]
    assert dashed == [[[1.0, 1.5], [3.0, 1.0]], [[3.0, 1.5], [1.0, 1.0]]]
    figure.draw_without_rendering()
    assert not axes.get_legend().get_window_extent().overlaps(axes.get_window_extent())


def test_doubt_is_dark_and_only_real_confusions_are_drawn():
    confused = np.zeros((2, 5, 5))
    confused[:, 0, 1] = 0.4
    confused[:, 3, 4] = 0.001
    found = AmbiguityMap(np.array([[0.5, 0.5], [1.5, 0.5]]), np.array([1.0, 0.25]), confused, 1.0)
    axes = ambiguity_figure(SYMMETRIC, found).axes[0]
    np.testing.assert_allclose(axes.collections[0].get_array(), [0.0, 0.75])
    assert [text.get_text() for text in axes.texts] == ["40 %"]
    dashed = [line for line in axes.lines if line.get_linestyle() == "--"]
    np.testing.assert_allclose(dashed[0].get_xydata(), SYMMETRIC.positions[[0, 1]])
