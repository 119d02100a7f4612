"""The page in three dimensions that a command writes beside its figures, where this computer can make one."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # imported where it is used, so that --help does not wait for it
    import pyvista


def write_scene(path: Path, title: str, make: Callable[[], tuple[pyvista.Plotter, str]]) -> str:
    """Write the scene that `make` gives, and return the file's name, or the reason why there is no page."""
    from course_lib.plots.scene_page import ScenePageError, write_page
    from course_lib.rendering.renderer import OpenGLError

    try:
        plotter, words = make()
        try:
            write_page(plotter, path, title, f"{title}. {words}", words)
        finally:
            plotter.close()
    except (ScenePageError, OpenGLError, ImportError) as reason:
        return f"no {path.name} ({reason})"
    return f"{path.name} (to be turned in a browser)"
