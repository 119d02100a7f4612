"""OpenGL windows that need no display, and what becomes of them when the process forks.

A window lives in the process that opened it. After a fork the child has OpenGL's memory without its threads, and
whatever it asks of OpenGL waits for them for ever: to draw, to open another window, even to free the one it inherited.
So a child never touches the windows of its parent, and is refused one of its own.
"""

from __future__ import annotations

import os
import sys
import weakref

from course_lib.rendering.renderer import OpenGLError

if sys.platform.startswith("linux"):
    # Before VTK is imported for the first time: no display is needed. An empty value would crash VTK.
    os.environ["VTK_DEFAULT_OPENGL_WINDOW"] = os.environ.get("VTK_DEFAULT_OPENGL_WINDOW") or "vtkEGLRenderWindow"
    # Mesa keeps its compiled shaders in a file that it maps into memory: where the disk of the user's cache is full, it
    # ends the process (SIGBUS). Without it the first image takes as long as before.
    os.environ.setdefault("MESA_SHADER_CACHE_DISABLE", "true")

import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 - registers the OpenGL classes behind the name below
from vtkmodules.vtkRenderingCore import vtkRenderWindow

CURE = (
    "On Debian or Ubuntu: apt-get install libegl1 libgl1-mesa-dri libgl1 (`python3 course.py check` tells what is "
    'missing). Without OpenGL, DepthRenderer(..., backend="raster") gives the same images: leave out --backend vtk'
)

_windows: weakref.WeakSet[vtkRenderWindow] = weakref.WeakSet()
_process_of_the_first_window: int | None = None


def off_screen_window() -> vtkRenderWindow:
    """A new window off the screen, without multisampling, not yet of any size.

    Raises `OpenGLError` where OpenGL cannot start, and in a process forked from one that had opened a window.
    """
    global _process_of_the_first_window
    if _process_of_the_first_window is None:
        _process_of_the_first_window = os.getpid()
    require_own_process(_process_of_the_first_window)
    window = vtkRenderWindow()
    if window.GetClassName() == "vtkOSOpenGLRenderWindow":
        # VTK's last resort when EGL fails; drawing with it crashes where the OSMesa library is missing.
        raise OpenGLError(f"OpenGL cannot start without a display (EGL failed). {CURE}")
    window.SetOffScreenRendering(True)
    window.SetMultiSamples(0)
    _windows.add(window)
    return window


def require_own_process(process: int) -> None:
    """Raises `OpenGLError` unless this is the process of that number, the one that opened the window."""
    if process != os.getpid():
        raise OpenGLError(
            f"OpenGL was started in process {process}, and this is process {os.getpid()}, forked from it: a fork "
            'leaves the threads of OpenGL behind, and drawing would hang. Start workers with "spawn" or "forkserver" '
            '(multiprocessing.get_context("spawn")), or fork before the first renderer, or use backend="raster"'
        )


def _leave_windows_to_the_parent() -> None:
    """One reference too many, so that nothing in this forked child ever frees a window: that would hang as well."""
    for window in _windows:
        window.Register(None)


if hasattr(os, "register_at_fork"):  # not on Windows, which cannot fork
    os.register_at_fork(after_in_child=_leave_windows_to_the_parent)
