"""How a scene is shown: the frame and the picture, and which page a student's own lines are written to."""

import io
import re

import numpy as np
import pytest
import pyvista
from PIL import Image

from courseware.lessons import show_scene
from courseware.lessons.kit import scene
from courseware.lessons.kit.display import FigureError
from courseware.lessons.kit.scene import MAX_PICTURE_BYTES, Scene, small_picture
from courseware.paths import STORE_SCENES
from courseware.plots import scenes
from courseware.plots.scene_page import ScenePageError
from courseware.plots.scenes import SceneError

WORDS = {"title": 'Axes & "more"', "alt": "The axes of a pose seen from above"}
STORED, YOURS = "scenes/99_axes.html", "scenes/yours/99_axes.html"
PICTURE = r'<img alt="The axes of a pose seen from above" src="data:image/png;base64,[^"]+"[^>]*>'


def axes_plotter(x: float = 1.0):
    plotter = scenes.new_plotter(viewpoint=(4, 3, 6), focus=(1, 2, 3))
    plotter.add_mesh(scenes.body_axes(np.array([x, 2.0, 3.0, 0, 0, 0]), 0.5), rgb=True)
    return plotter


@pytest.fixture
def shown(monkeypatch, tmp_path):
    """What `show_scene` displays in a notebook's folder, tmp_path."""
    monkeypatch.chdir(tmp_path)
    outputs = []
    monkeypatch.setattr(scene, "display", outputs.append)

    def show(x: float = 1.0, store: bool = False, **words) -> str:
        monkeypatch.setenv(STORE_SCENES, "1" if store else "")
        plotter = axes_plotter(x)
        show_scene(plotter, "99_axes", **(WORDS | words))
        assert plotter._closed
        bundle = outputs.pop()._repr_mimebundle_()
        assert bundle["text/plain"] == 'Scene: Axes & "more"'
        return bundle["text/html"]

    return show


def pages(folder) -> dict[str, tuple]:
    found = {path.relative_to(folder).as_posix(): path for path in folder.glob("**/*.html")}
    return {name: (path.stat().st_mtime_ns, path.read_bytes()) for name, path in found.items()}


def test_a_scene_is_a_titled_frame_and_below_it_a_folded_picture(shown):
    frame = r'<iframe src="scenes/99_axes.html" title="Axes &amp; &quot;more&quot;" width="100%" height="500"[^>]*>'
    folded = rf"<details><summary>[^<]+</summary>{PICTURE}</details>"
    assert re.fullmatch(f"{frame}</iframe>{folded}", shown(store=True))
    assert Scene("scenes/a.html", "A page that another program wrote", 300).html().endswith("</iframe>")


def test_the_same_lines_write_nothing_and_others_leave_the_stored_page_alone(shown, tmp_path):
    assert YOURS in shown(), "a lesson without its stored page"
    shown(store=True)
    before = pages(tmp_path)
    assert STORED in shown()
    assert pages(tmp_path) == before
    assert YOURS in shown(x=1.1)
    after = pages(tmp_path)
    assert before.keys() == after.keys() == {STORED, YOURS}
    assert before[STORED] == after[STORED]
    assert before[YOURS] != after[YOURS]


def test_where_no_page_can_be_made_or_written_the_picture_is_shown_and_the_cure(shown, tmp_path, monkeypatch):
    def no_page(*_):
        raise ScenePageError("PyVista lacks what writes pages: pip install <this>")

    (tmp_path / "scenes").write_text("a file, not a folder")
    assert re.match(f"{PICTURE}<p>", shown())
    monkeypatch.setattr(scene, "page_html", no_page)
    assert re.match(rf"{PICTURE}<p>.*pip install &lt;this&gt;</p>", shown())
    assert pages(tmp_path) == {}


def test_without_opengl_the_page_is_shown_alone(shown, monkeypatch):
    monkeypatch.setattr(scene, "draws", lambda plotter: False)
    assert shown(store=True).endswith("</iframe>")


def test_the_picture_shows_the_scene_and_a_restless_one_becomes_smaller():
    plotter = axes_plotter()
    picture = np.asarray(Image.open(io.BytesIO(small_picture(plotter))).convert("RGB"))
    assert picture.shape == (500, 800, 3)
    assert (np.ptp(picture.astype(int), axis=2) > 100).sum() > 500, "coloured axes on white"
    points = np.random.default_rng(0).uniform(-3, 5, size=(30_000, 3))
    plotter.add_mesh(pyvista.PolyData(points), scalars=points[:, 0], point_size=3)
    png = small_picture(plotter)
    assert len(png) <= MAX_PICTURE_BYTES
    assert Image.open(io.BytesIO(png)).width < 800


@pytest.mark.parametrize("name", ["frustum", "../01_frustum", "01_frustum.html", "1_a"])
def test_a_name_says_the_lesson(name):
    with pytest.raises(SceneError, match="lesson's number"):
        show_scene(axes_plotter(), name, **WORDS)


def test_words_and_objects_are_needed(shown):
    with pytest.raises(FigureError, match="alternative text"):
        shown(alt="axes")
    with pytest.raises(SceneError, match="empty"):
        show_scene(scenes.new_plotter(), "99_axes", **WORDS)
