"""What draws in lessons about OpenGL: OpenGL itself, or the compiled z-buffer on a computer without it."""

import functools

from course_lib.rendering.errors import OpenGLError
from course_lib.rendering.renderer import Backend


@functools.cache  # so that a kernel says it once
def vtk() -> Backend:
    """Return "vtk". Where OpenGL cannot start, print so and return "raster", so that the lesson runs to its end."""
    from course_lib.rendering.vtk_backend import off_screen_window

    try:
        off_screen_window()
    except OpenGLError:
        print('OpenGL is missing on this computer. The backend "raster" draws the same images in its place, but what')
        print("the lesson says about OpenGL's rounding and speed does not show. Cure: python3 course.py check")
        return "raster"
    return "vtk"
