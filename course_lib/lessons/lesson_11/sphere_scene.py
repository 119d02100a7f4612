"""The interactive scene of lesson 11: a panorama beside the unit sphere, one point on both, to be dragged on either.

    python -m course_lib.lessons.lesson_11.sphere_scene

writes notebooks/scenes/11_sphere.html: one file with its picture inside, which needs no network and no kernel. Its
script computes with the same two formulas as `sphere.pixel_to_direction` and `sphere.direction_to_pixel`.
"""

from __future__ import annotations

import base64
import html
from pathlib import Path

from course_lib.lessons.kit.paths import REPOSITORY, data_path

SCENE = "scenes/11_sphere.html"
"""Where the scene lies, from the folder notebooks/."""

PICTURE = "room/experiment_1/05_b_upper.jpg"
"""A panorama with a sofa across its seam."""

_TEMPLATE = Path(__file__).with_name("sphere_scene.html")
_PLACEHOLDER = "PANORAMA"


class Scene:
    """A scene in a titled frame, as a notebook shows it."""

    def __init__(self, source: str, title: str, height: int) -> None:
        self.source, self.title, self.height = source, title, height

    def _repr_mimebundle_(self, include=None, exclude=None) -> dict:
        frame = (
            f'<iframe src="{self.source}" title="{html.escape(self.title)}" width="100%" height="{self.height}"'
            ' style="border: 0"></iframe>'
        )
        return {"text/plain": repr(self), "text/html": frame}

    def __repr__(self) -> str:
        return f"Scene: {self.title}"


def scene_html() -> str:
    """The whole scene as text, its panorama inside."""
    picture = base64.b64encode(data_path(PICTURE).read_bytes()).decode("ascii")
    before, _, after = _TEMPLATE.read_text(encoding="utf-8").rpartition(_PLACEHOLDER)
    return before + picture + after


def write_scene(path: Path) -> Path:
    """Write the scene to `path` and return it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(scene_html(), encoding="utf-8")
    return path


if __name__ == "__main__":
    written = write_scene(REPOSITORY / "notebooks" / SCENE)
    print(f"{written.relative_to(REPOSITORY)}: {written.stat().st_size / 1000:.0f} kB")
