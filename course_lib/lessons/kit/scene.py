"""How a lesson shows a scene in three dimensions: a page to be turned by hand, and its picture where no script runs.

The page that comes with the lesson is `notebooks/scenes/NAME.html`; only `tools.refresh` writes it. Whoever changes
the lines of a cell sees a page of their own, `scenes/yours/NAME.html`, which git ignores.
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
_WIDTHS = (800, 640, 480, 320)  # of the picture, fewer pixels until it is small enough


class Scene:
    """A page in a titled frame that fits, and below it, folded, the same as a picture.

    source: of the page, from the notebook's folder. height: pixels.
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
    """Where no page can be written: the picture alone, and the reason with its cure."""

    def __init__(self, title: str, picture: Picture, reason: str) -> None:
        super().__init__("", title, picture=picture)
        self.reason = reason

    def html(self) -> str:
        return f"{self.picture.html()}<p>This scene cannot be turned here: {html.escape(self.reason)}</p>"


def show_scene(plotter: pyvista.Plotter, name: str, title: str, alt: str) -> None:
    """Display a scene as a page to be turned by hand, and its picture for where no script runs; closes the plotter.

    name: of its page, the lesson's number first ("01_frustum"). title: of frame and page. alt: what it shows, in a
    sentence. Raises `SceneError` for another kind of name, an empty scene, or words that are missing.
    """
    if not re.fullmatch(r"(\d\d|P\d)_[a-z0-9_]+", name):
        raise SceneError(f"a scene's name is the lesson's number and a word, such as '01_frustum'; got {name!r}")
    try:
        picture = Picture(small_picture(plotter), alt)
        display(Scene(_written(page_html(plotter, title, alt), name), title, picture=picture))
    except (ScenePageError, OSError) as reason:
        display(PictureOfAScene(title, picture, str(reason)))
    finally:
        plotter.close()


def small_picture(plotter: pyvista.Plotter) -> bytes:
    """The scene as it is first seen, as a PNG of at most 60 kB. Raises `SceneError` where that cannot be."""
    if not plotter.actors:
        raise SceneError("the scene is empty: add something with plotter.add_mesh(...)")
    picture = Image.fromarray(plotter.screenshot(return_img=True))
    for width in _WIDTHS:
        size = (width, round(width * picture.height / picture.width))
        png = compress(picture.resize(size, Image.Resampling.LANCZOS))
        if len(png) <= MAX_PICTURE_BYTES:
            return png
    raise SceneError(f"the picture of this scene has {len(png)} bytes at {size[0]} pixels, at most {MAX_PICTURE_BYTES}")


def _written(page: str, name: str) -> str:
    """Where the page is to be found from the notebook's folder, the kernel's own; written if it is not there yet."""
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
