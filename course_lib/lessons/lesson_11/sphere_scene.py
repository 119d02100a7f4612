"""The interactive scene of lesson 11 as its notebook shows it: where it lies, and the titled frame around it.

`write_sphere_scene` writes it; that module is a command, so nothing imports it.
"""

from __future__ import annotations

import html

SCENE = "scenes/11_sphere.html"
"""Where the scene lies, from the folder notebooks/."""


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
