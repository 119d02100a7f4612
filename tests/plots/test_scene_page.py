"""The page of a scene: its words, the same bytes for the same scene, no network."""

import base64
import os
import re
import subprocess
import sys
import zlib

import numpy as np
import pytest

from courseware.commands.output import write_scene
from courseware.plots import scenes
from courseware.plots.scene_page import ScenePageError, page_html

WORDS = {"title": 'Axes & "more"', "alt": "The axes of a pose <seen> from above"}
STATE = np.array([1.0, 2.0, 3.0, 0.1, 0.2, 0.3])


def axes_page(state=STATE, colour="#0072B2", **words) -> str:
    plotter = scenes.new_plotter(viewpoint=(4, 3, 6), focus=(1, 2, 3))
    plotter.add_mesh(scenes.body_axes(state, 0.5), rgb=True)
    plotter.add_mesh(scenes.path(np.array([[0.0, 0, 0], [1, 2, 3]])), color=colour, line_width=3)
    page = page_html(plotter, **(WORDS | words))
    plotter.close()
    return page


@pytest.fixture(scope="module")
def page() -> str:
    return axes_page()


def test_a_page_has_title_language_and_words_is_small_and_loads_nothing(page):
    words = "The axes of a pose &lt;seen&gt; from above"
    assert page.startswith('<!doctype html>\n<html lang="en">')
    assert "<title>Axes &amp; &quot;more&quot;</title>" in page
    assert f'name="description" content="{words}"' in page
    assert f'aria-label="{words}"' in page
    assert len(page) < 600_000
    assert re.findall(r'(?:src|href)="(?!data:)[^"]*"|https?:', page) == []
    viewer = zlib.decompress(base64.b64decode(re.search(r'atob\("([^"]+)"\)', page)[1])).decode()
    assert "vtk-js/icon" not in viewer, "trame-vtk's viewer fetches its icons from the network"
    assert "default-src 'none'" in page


def test_the_same_scene_gives_the_same_bytes_also_in_another_process(page, tmp_path):
    assert axes_page() == page
    code = f"import runpy; page = runpy.run_path({__file__!r})['axes_page']; open('page', 'w').write(page())"
    subprocess.run([sys.executable, "-c", code], cwd=tmp_path, check=True)
    assert (tmp_path / "page").read_text() == page


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="other systems bring OpenGL along")
def test_without_opengl_the_page_is_the_same_and_only_a_picture_cannot_be_drawn(page, tmp_path):
    assert scenes.draws(scenes.new_plotter())
    code = f"import runpy; found = runpy.run_path({__file__!r}); open('page', 'w').write(found['axes_page']())\n"
    code += "print(found['scenes'].draws(found['scenes'].new_plotter()))"
    hidden = os.environ | {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent", "DISPLAY": ""}
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, env=hidden, capture_output=True, text=True)
    assert (done.stdout, done.stderr) == ("False\n", "")
    assert (tmp_path / "page").read_text() == page


@pytest.mark.parametrize("kind", [ScenePageError, ImportError])
def test_a_command_tells_why_it_wrote_no_page(tmp_path, kind):
    def fails():
        raise kind("nothing to draw with")

    assert write_scene(tmp_path / "axes.html", "Three axes", fails) == "no axes.html (nothing to draw with)"
    assert list(tmp_path.iterdir()) == []
