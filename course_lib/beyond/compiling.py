"""What takes seconds at the first step on a computer can be done before the first image comes."""

import numpy as np

from course_lib.beyond.lost_and_found.free_space import FreeSpace
from course_lib.beyond.lost_and_found.stored_views import StoredViews, look_at
from course_lib.beyond.six_dof.image_motion import View, compiled_motion_equations
from course_lib.beyond.six_dof.refinement import compiled_normal_equations
from course_lib.depth_mcl.likelihood import compiled_likelihood
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap


def warm_up() -> None:
    """Compile every loop of the filters and the search now: render an image, weigh it, refine by it, and look it up.

    The first call on a computer takes seconds and says so; later ones take a moment, because compiled code is kept.
    """
    camera = DepthCamera.from_fov(4, 3, 60.0, 45.0)
    wall = SceneMap(np.array([[2.0, -5, -5], [2, 5, -5], [2, 0, 5]]), np.array([[0, 1, 2]]))
    with DepthRenderer(wall, camera, "raster") as renderer:
        images = renderer.render(np.zeros(6))
    compiled_likelihood(images[0], images)
    compiled_normal_equations(images[0], images, camera, 0.1)
    view = View.of(images[0], camera, images[0].size)
    compiled_motion_equations(view, view.points.reshape(-1, 3), np.eye(4)[None], 0.1)
    StoredViews(FreeSpace(wall), wall.origin, max_places=1).scores(look_at(view.points, np.eye(3)), 0.1)
