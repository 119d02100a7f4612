"""Show a 3D scene as a page that the reader can turn, and as a picture for browsers without scripts.

The lesson's own page is `notebooks/scenes/NAME.html`. Only `tools.refresh` writes it. A student who changes the cell,
or whose processor rounds otherwise, gets another page, `scenes/yours/NAME.html`, which git ignores.
"""

from __future__ import annotations

import html
import importlib
import os
import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from IPython.display import display
from PIL import Image

from course_lib.files import atomic_write
from courseware.lessons.kit.compression import small_png
from courseware.lessons.kit.display import Picture
from courseware.lessons.kit.exercises import package_name
from courseware.paths import STORE_SCENES
from courseware.plots.scene_page import ScenePageError, page_html
from courseware.plots.scenes import SceneError, draws

if TYPE_CHECKING:
    import pyvista

MAX_PICTURE_BYTES = 60_000


@dataclass(frozen=True)
class Scene:
    """A page in a frame, and below it a folded picture of the same scene. If there is no page, only the picture.
    Without OpenGL there is no picture.

    source: path of the page, relative to the notebook's folder. height: of the frame [pixels]. no_page: why there is
    no page.
    """

    source: str
    title: str
    height: int = 500
    picture: Picture | None = None
    no_page: str = ""

    def html(self) -> str:
        if self.no_page:
            picture = self.picture.html() if self.picture else ""
            return f"{picture}<p>This scene cannot be turned here: {html.escape(self.no_page)}</p>"
        frame = (
            f'<iframe src="{self.source}" title="{html.escape(self.title)}" width="100%" height="{self.height}"'
            ' style="border: 0"></iframe>'
        )
        folded = "<details><summary>The same as a picture</summary>{}</details>"
        return frame + (folded.format(self.picture.html()) if self.picture else "")

    def _repr_mimebundle_(self, include=None, exclude=None) -> dict:
        return {"text/plain": repr(self), "text/html": self.html()}

    def __repr__(self) -> str:
        return f"Scene: {self.title}"


def show_scene(plotter: pyvista.Plotter, name: str, title: str, alt: str = "") -> None:
    """Display a scene as a page that the reader can turn, with a picture of it. Closes the plotter.

    name: of the page; it starts with the lesson's number ("01_frustum"). title: of the frame and the page. alt: a
    sentence that says what the scene shows; by default `SCENE_ALT` of the lesson's figures.py. Raises `SceneError` for
    an invalid name or an empty scene, and `FigureError` for an `alt` that is too short.
    """
    if not re.fullmatch(r"(\d\d|[FP]\d)_[a-z0-9_]+", name):
        raise SceneError(f"a scene's name must be the lesson's number and a word, such as '01_frustum'; got {name!r}")
    alt = alt or importlib.import_module(f"courseware.lessons.{package_name(name[:2])}.figures").SCENE_ALT
    try:
        picture = Picture(small_picture(plotter), alt) if draws(plotter) else None
        display(Scene(_page_path(page_html(plotter, title, alt), name), title, picture=picture))
    except (ScenePageError, OSError) as reason:
        display(Scene("", title, picture=picture, no_page=str(reason)))
    finally:
        plotter.close()


def small_picture(plotter: pyvista.Plotter) -> bytes:
    """Return the scene's first view as a PNG of at most 60 kB. Raises `SceneError` if it is empty."""
    if not plotter.actors:
        raise SceneError("the scene is empty: add something with plotter.add_mesh(...)")
    return small_png(Image.fromarray(plotter.screenshot(return_img=True)), 800, MAX_PICTURE_BYTES)


def _page_path(page: str, name: str) -> str:
    """Return the page's path, relative to the notebook's folder. Write the page if it is new or has changed."""
    path = Path("scenes") / f"{name}.html"
    if not os.environ.get(STORE_SCENES):
        if path.is_file() and path.read_text(encoding="utf-8") == page:
            return path.as_posix()
        path = path.parent / "yours" / path.name
    path.parent.mkdir(parents=True, exist_ok=True)
    atomic_write(path, page)
    return path.as_posix()
