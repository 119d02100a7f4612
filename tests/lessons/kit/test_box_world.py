"""The lessons' world of boxes: rays meet it where they should, as they meet the same boxes made of triangles."""

import numpy as np
import pytest

from course_lib.geometry import BODY_FROM_OPTICAL
from course_lib.lessons.kit.box_world import Box, BoxWorld
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer

AHEAD = Box((2.0, -1.0, -1.0), (3.0, 1.0, 1.0), 0.5)


def test_a_ray_meets_the_nearest_face_squarely_or_not_at_all():
    hits = BoxWorld([Box((4.0, -1.0, -1.0), (5.0, 1.0, 1.0), 0.2), AHEAD]).cast(
        np.zeros(3), np.array([[1.0, 0, 0], [2.0, 0, 0], [-1.0, 0, 0], [0, 1.0, 0]])
    )
    assert hits.distance[:2] == pytest.approx([2.0, 1.0])
    assert hits.cosine[:2] == pytest.approx([1.0, 1.0])
    assert hits.face.tolist() == [1, 1, -1, -1]
    assert np.isinf(hits.distance[2:]).all()


def test_incidence_is_measured_on_the_face_that_is_met():
    slanted = np.array([[1.0, 0.3, 0.0], [1.0, 0.0, -0.2]])
    hits = BoxWorld([AHEAD]).cast(np.zeros(3), slanted)
    assert hits.cosine == pytest.approx(1 / np.linalg.norm(slanted, axis=1), abs=1e-6)


def test_the_boxes_and_their_triangles_give_the_same_depth_image():
    world = BoxWorld([AHEAD, Box((3.5, 0.2, -2.0), (4.0, 2.5, 0.4), 0.5), Box((6.0, -9.0, -9.0), (6.1, 9.0, 9.0), 0.5)])
    camera = DepthCamera.sr4000().resized(44, 36)
    with DepthRenderer(world.mesh(), camera) as renderer:
        image = renderer.render(np.zeros(6))[0]
    by_boxes = world.cast(np.zeros(3), camera.rays() @ BODY_FROM_OPTICAL.T).distance
    assert np.isclose(image, by_boxes, rtol=0, atol=0.001).mean() > 0.99


def test_a_box_without_a_volume_is_refused():
    with pytest.raises(ValueError, match="high"):
        BoxWorld([Box((0, 0, 0), (1, 0, 1), 0.5)])
    with pytest.raises(ValueError, match="boxes"):
        BoxWorld([])
