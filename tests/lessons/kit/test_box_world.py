"""The lessons' world of boxes: rays meet it where they should, as they meet the same boxes made of triangles."""

import numpy as np
import pytest

from course_lib.geometry import BODY_FROM_OPTICAL
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from courseware.lessons.kit.box_world import Box, BoxWorld

AHEAD = Box((2.0, -1.0, -1.0), (3.0, 1.0, 1.0), 0.5)


def test_a_ray_meets_the_nearest_face_or_none_and_its_slant_is_measured_on_this_face():
    rays = np.array(
        [[1.0, 0, 0], [2.0, 0, 0], [1.0, 0.3, 0], [1.0, 0, -0.2], [-1.0, 0, 0], [-1.0, 0.1, 0], [0, 1.0, 0]]
    )
    origins = np.array([[-0.5, 0.2, 0.1]] * 5 + [[5.5, 0.2, 0.1]] + [[-0.5, 0.2, 0.1]])
    hits = BoxWorld([Box((4.0, -1.0, -1.0), (5.0, 1.0, 1.0), 0.2), AHEAD]).cast(origins, rays)
    assert hits.distance == pytest.approx([2.5, 1.25, 2.5, 2.5, np.inf, 0.5, np.inf])
    assert hits.cosine == pytest.approx((hits.face >= 0) * np.abs(rays[:, 0]) / np.linalg.norm(rays, axis=1), abs=1e-6)
    assert hits.face.tolist() == [1, 1, 1, 1, -1, 0, -1]


def test_the_boxes_and_their_triangles_give_the_same_depth_image():
    world = BoxWorld([AHEAD, Box((3.5, 0.2, -2.0), (4.0, 2.5, 0.4), 0.5), Box((6.0, -9.0, -9.0), (6.1, 9.0, 9.0), 0.5)])
    camera = DepthCamera.sr4000().resized(44, 36)
    with DepthRenderer(world.mesh(), camera) as renderer:
        image = renderer.render(np.zeros(6))[0]
    by_boxes = world.cast(np.zeros(3), camera.rays() @ BODY_FROM_OPTICAL.T).distance
    assert np.isclose(image, by_boxes, rtol=0, atol=0.001).mean() > 0.99


@pytest.mark.parametrize("boxes", [[], [Box((0, 0, 0), (1, 0, 1), 0.5)]])
def test_a_box_without_a_volume_is_refused(boxes):
    with pytest.raises(ValueError, match="high"):
        BoxWorld(boxes)
