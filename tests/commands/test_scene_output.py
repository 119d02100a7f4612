"""What a command says of its page: that it was written, or why not; its numbers do not depend on it."""

from __future__ import annotations

import numpy as np
import pytest

from course_lib.commands.scene_output import write_scene
from course_lib.plots.scene_page import ScenePageError
from course_lib.plots.scenes import body_axes, new_plotter
from course_lib.rendering.renderer import OpenGLError


def axes():
    plotter = new_plotter()
    plotter.add_mesh(body_axes(np.zeros(6), 0.5), rgb=True)
    return plotter, "Three axes: red x, green y, blue z"


def test_a_page_is_written_with_what_is_what_below_it(tmp_path):
    assert write_scene(tmp_path / "axes.html", "Three axes", axes) == "axes.html (to be turned in a browser)"
    page = (tmp_path / "axes.html").read_text()
    assert '<p id="help">Three axes. Three axes: red x, green y, blue z. Drag to turn' in page


@pytest.mark.parametrize("kind", [OpenGLError, ScenePageError, ImportError])
def test_where_none_can_be_made_the_reason_is_told(tmp_path, kind):
    def fails():
        raise kind("nothing to draw with")

    assert write_scene(tmp_path / "axes.html", "Three axes", fails) == "no axes.html (nothing to draw with)"
    assert list(tmp_path.iterdir()) == []
