"""Show a 3D scene as a page that the reader can turn, and as a picture for browsers without scripts.

The lesson's own page is `notebooks/scenes/NAME.html`. Only `tools.refresh` writes it. A student who changes the cell
gets another page, `scenes/yours/NAME.html`, which git ignores.
"""

from __future__ import annotations

import html
import os
import re
from pathlib import Path
from typing import TYPE_CHECKING

from IPython.display import display
from PIL import Image

from course_lib.files import atomic_write
from course_lib.lessons.kit.compression import compress
from course_lib.lessons.kit.display import Picture
from course_lib.lessons.kit.same_scene import same_scene
from course_lib.paths import STORE_SCENES
from course_lib.plots.scene_page import ScenePageError, page_html
from course_lib.plots.scenes import SceneError

if TYPE_CHECKING:
    import pyvista

HEIGHT = 500  # pixels of the frame
MAX_PICTURE_BYTES = 60_000
_WIDTHS = (800, 640, 480, 320)  # of the picture; the first that is small enough in bytes is used


class Scene:
    """A page in a frame, and below it a folded picture of the same scene.

    source: path of the page, relative to the notebook's folder. height: of the frame [pixels].
    """

    def __init__(self, source: str, title: str, height: int = HEIGHT, picture: Picture | None = None) -> None:
        self.source, self.title, self.height, self.picture = source, title, height, picture

    def html(self) -> str:
        frame = (
            f'<iframe src="{self.source}" title="{html.escape(self.title)}" width="100%" height="{self.height}"'
            ' style="border: 0"></iframe>'
        )
        if self.picture is None:
            return frame
        return f"{frame}<details><summary>The same as a picture</summary>{self.picture.html()}</details>"

    def _repr_mimebundle_(self, include=None, exclude=None) -> dict:
        return {"text/plain": repr(self), "text/html": self.html()}

    def __repr__(self) -> str:
        return f"Scene: {self.title}"


class PictureOfAScene(Scene):
    """The picture of a scene whose page cannot be written, with the reason."""

    def __init__(self, title: str, picture: Picture, reason: str) -> None:
        super().__init__("", title, picture=picture)
        self.reason = reason

    def html(self) -> str:
        return f"{self.picture.html()}<p>This scene cannot be turned here: {html.escape(self.reason)}</p>"


def show_scene(plotter: pyvista.Plotter, name: str, title: str, alt: str) -> None:
    """Display a scene as a page that the reader can turn, with a picture of it. Closes the plotter.

    name: of the page; it starts with the lesson's number ("01_frustum"). title: of the frame and the page. alt: a
    sentence that says what the scene shows. Raises `SceneError` for an invalid name or an empty scene, and
    `FigureError` for an `alt` that is too short.
    """
    if not re.fullmatch(r"(\d\d|P\d)_[a-z0-9_]+", name):
        raise SceneError(f"a scene's name must be the lesson's number and a word, such as '01_frustum'; got {name!r}")
    try:
        picture = Picture(small_picture(plotter), alt)
        display(Scene(_page_path(page_html(plotter, title, alt), name), title, picture=picture))
    except (ScenePageError, OSError) as reason:
        display(PictureOfAScene(title, picture, str(reason)))
    finally:
        plotter.close()


def small_picture(plotter: pyvista.Plotter) -> bytes:
    """Return the scene's first view as a PNG of at most 60 kB. Raises `SceneError` if it is empty or too large."""
    if not plotter.actors:
        raise SceneError("the scene is empty: add something with plotter.add_mesh(...)")
    picture = Image.fromarray(plotter.screenshot(return_img=True))
    for width in _WIDTHS:
        size = (width, round(width * picture.height / picture.width))
        png = compress(picture.resize(size, Image.Resampling.LANCZOS))
        if len(png) <= MAX_PICTURE_BYTES:
            return png
    raise SceneError(f"the scene's picture has {len(png)} bytes at {size[0]} pixels; at most {MAX_PICTURE_BYTES} fit")


def _page_path(page: str, name: str) -> str:
    """Return the page's path, relative to the notebook's folder. Write the page if it is new or has changed."""
    stored = Path("scenes") / f"{name}.html"
    if os.environ.get(STORE_SCENES):
        return _write(stored, page)
    if stored.is_file() and same_scene(page, stored.read_text(encoding="utf-8")):
        return stored.as_posix()
    return _write(stored.parent / "yours" / stored.name, page)


def _write(path: Path, page: str) -> str:
    path.parent.mkdir(parents=True, exist_ok=True)
    atomic_write(path, page)
    return path.as_posix()
