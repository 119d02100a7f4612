"""Depth images of a map from any pose: the heart of paper 1 (section 3.3).

    camera           a pinhole depth camera: its pixels, their rays, its projection
    scene_map        the map, triangles in the world frame, from any mesh file
    sensor           3.3.2, eq. (7): the camera's own points become a depth image as the simulated views do
    renderer         3.3.1, eq. (6): a depth image for every particle, by one of the backends
    vtk_backend      OpenGL's z-buffer, the choice on a graphics card
    raster           a z-buffer in compiled loops, the choice on a processor
    ray              a ray through every pixel centre: the reference for the others
    chunks           cuts large triangles, and leaves out what no view can see
    simplification   fewer triangles that look the same to a depth camera
    compiled         compiles loops with Numba, and keeps the result
    errors           what can go wrong, by name

Nothing here knows of a filter: `course_lib.depth_mcl` compares the images.
"""

# ruff: noqa: F401 - the public names
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.errors import OpenGLError, RendererClosedError, SceneMapError, SceneMapWarning
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from course_lib.rendering.sensor import depth_image_from_points, subsample_depth
