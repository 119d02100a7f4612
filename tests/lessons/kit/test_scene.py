"""How a scene is shown: the frame and the picture, and which page a student's own lines are written to."""

import io
import re

import numpy as np
import pytest
from PIL import Image

from course_lib.lessons import show_scene
from course_lib.lessons.kit import scene
from course_lib.lessons.kit.compression import png_bytes
from course_lib.lessons.kit.display import FigureError, Picture
from course_lib.lessons.kit.scene import MAX_PICTURE_BYTES, Scene, small_picture
from course_lib.paths import STORE_SCENES
from course_lib.plots import figures, scenes
from course_lib.plots.scene_page import ScenePageError
from course_lib.plots.scenes import SceneError

WORDS = {"title": 'Axes & "more"', "alt": "The axes of a pose seen from above"}
STORED, YOURS = "scenes/99_axes.html", "scenes/yours/99_axes.html"


def axes_plotter(x: float = 1.0):
    plotter = scenes.new_plotter(viewpoint=(4, 3, 6), focus=(1, 2, 3))
    plotter.add_mesh(scenes.body_axes(np.array([x, 2.0, 3.0, 0, 0, 0]), 0.5), rgb=True)
    return plotter


@pytest.fixture
def shown(monkeypatch, tmp_path):
    """What `show_scene` displays in a notebook's folder, tmp_path."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv(STORE_SCENES, raising=False)
    outputs = []
    monkeypatch.setattr(scene, "display", outputs.append)

    def show(x: float = 1.0, store: bool = False, **words) -> dict:
        if store:
            monkeypatch.setenv(STORE_SCENES, "1")
        show_scene(axes_plotter(x), "99_axes", **(WORDS | words))
        monkeypatch.delenv(STORE_SCENES, raising=False)
        return outputs.pop()._repr_mimebundle_()

    return show


def pages(folder) -> list[str]:
    return sorted(path.relative_to(folder).as_posix() for path in folder.glob("**/*.html"))


def test_a_scene_is_a_titled_frame_and_below_it_a_folded_picture(shown):
    bundle = shown(store=True)
    assert bundle["text/plain"] == 'Scene: Axes & "more"'
    found = re.fullmatch(
        r'<iframe src="scenes/99_axes.html" title="Axes &amp; &quot;more&quot;" width="100%" height="\d+"[^>]*>'
        r"</iframe>"
        r"<details><summary>[^<]+</summary>"
        r'<img alt="The axes of a pose seen from above" src="data:image/png;base64,[^"]+"[^>]*></details>',
        bundle["text/html"],
    )
    assert found


def test_refresh_stores_the_page_and_the_same_lines_write_nothing(shown, tmp_path):
    shown(store=True)
    before = (tmp_path / STORED).stat()
    assert STORED in shown()["text/html"]
    assert pages(tmp_path) == [STORED]
    assert (tmp_path / STORED).stat().st_mtime_ns == before.st_mtime_ns


def test_changed_lines_are_shown_and_leave_the_stored_page_alone(shown, tmp_path):
    shown(store=True)
    before = (tmp_path / STORED).read_bytes()
    assert YOURS in shown(x=1.1)["text/html"]
    assert pages(tmp_path) == [STORED, YOURS]
    assert (tmp_path / STORED).read_bytes() == before
    assert (tmp_path / YOURS).read_bytes() != before


def test_a_page_of_another_processor_is_still_the_stored_one(shown, tmp_path):
    shown(store=True)
    assert STORED in shown(x=1.00001)["text/html"]
    assert pages(tmp_path) == [STORED]


def test_a_lesson_without_its_stored_page_writes_its_own(shown, tmp_path):
    assert YOURS in shown()["text/html"]
    assert pages(tmp_path) == [YOURS]


def test_where_no_page_can_be_made_the_picture_is_shown_and_the_cure(shown, tmp_path, monkeypatch):
    def no_page(*_):
        raise ScenePageError("PyVista lacks what writes pages: pip install <this>")

    monkeypatch.setattr(scene, "page_html", no_page)
    bundle = shown()
    assert bundle["text/plain"] == 'Scene: Axes & "more"'
    assert "<iframe" not in bundle["text/html"]
    assert bundle["text/html"].startswith('<img alt="The axes of a pose seen from above"')
    assert "pip install &lt;this&gt;" in bundle["text/html"]
    assert pages(tmp_path) == []


def test_where_nothing_can_be_written_the_picture_is_shown(shown, tmp_path):
    (tmp_path / "scenes").write_text("a file, not a folder")
    assert "<iframe" not in shown()["text/html"]


def test_the_picture_shows_the_scene_and_is_small():
    picture = np.asarray(Image.open(io.BytesIO(small_picture(axes_plotter()))).convert("RGB"))
    assert picture.shape == (500, 800, 3)
    assert (picture.max(axis=2).astype(int) - picture.min(axis=2) > 100).sum() > 500, "coloured axes on white"


def test_a_restless_picture_becomes_smaller():
    import pyvista

    plotter = axes_plotter()
    points = np.random.default_rng(0).uniform(-3, 5, size=(30_000, 3))
    plotter.add_mesh(pyvista.PolyData(points), scalars=points[:, 0], point_size=3)
    png = small_picture(plotter)
    assert len(png) <= MAX_PICTURE_BYTES
    assert Image.open(io.BytesIO(png)).width < 800


def test_the_plotter_is_closed(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(scene, "display", lambda _: None)
    plotter = axes_plotter()
    show_scene(plotter, "99_axes", **WORDS)
    assert plotter._closed


@pytest.mark.parametrize("name", ["frustum", "../01_frustum", "01_frustum.html", "1_a"])
def test_a_name_says_the_lesson(name):
    with pytest.raises(SceneError, match="lesson's number"):
        show_scene(axes_plotter(), name, **WORDS)


def test_words_are_needed(shown):
    with pytest.raises(FigureError, match="alternative text"):
        shown(alt="axes")


def test_an_empty_scene_is_refused():
    with pytest.raises(SceneError, match="empty"):
        show_scene(scenes.new_plotter(), "99_axes", **WORDS)


def test_a_scene_without_a_picture_is_its_frame():
    bundle = Scene("scenes/a.html", 'A "quoted" title', 300)._repr_mimebundle_()
    assert bundle["text/html"].startswith('<iframe src="scenes/a.html" title="A &quot;quoted&quot; title"')
    assert bundle["text/html"].endswith("</iframe>")
    png = png_bytes(figures.new_figure(size=(1, 1))[0])
    assert Scene("a", "A title", picture=Picture(png, "A picture of something seen")).html().endswith("</details>")
