"""What a lesson's figure must have to be shown, and what a stored picture carries."""

import io

import numpy as np
import pytest
from PIL import Image

from courseware.lessons.kit.compression import compress, png_bytes
from courseware.lessons.kit.display import FigureError, Picture, described, require_labels, show
from courseware.plots import figures


def finished_figure():
    figure, axes = figures.new_figure()
    axes.plot([0, 1], [0, 1], **figures.line_style(0))
    axes.set(title="A line", xlabel="x [m]", ylabel="weight [-]")
    return described(figure, "A line that rises from left to right."), axes


def pixels(png: bytes) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int)


@pytest.mark.parametrize(
    ("change", "words"), [({"title": ""}, "no title"), ({"xlabel": "x"}, "no unit"), ({"ylabel": ""}, "no unit")]
)
def test_a_figure_without_title_or_units_is_refused(change, words):
    figure, axes = finished_figure()
    require_labels(figure)
    axes.set(**change)
    with pytest.raises(FigureError, match=words):
        show(figure)


def test_a_colour_bar_needs_a_unit_too():
    figure, axes = figures.new_figure()
    figures.colour_bar(figure, figures.depth_image(axes, np.ones((3, 4)), "Depth", (0, 2)), axes, "depth")
    with pytest.raises(FigureError, match="colour bar"):
        require_labels(figure)
    figure.axes[-1].set_ylabel("depth [m]")
    require_labels(figure)


def test_a_photograph_keeps_its_colours_and_a_drawing_its_few(monkeypatch):
    """A palette makes patches of a smooth ramp of a thousand colours."""
    figure, axes = finished_figure()
    u, v = np.meshgrid(np.linspace(0, 1, 200), np.linspace(0, 1, 100))
    axes.imshow(np.dstack([u, v, 1 - u]), extent=(0, 1, 0, 1))
    shown = []
    monkeypatch.setattr("courseware.lessons.kit.display.display", shown.append)
    show(figure)
    show(figure, photograph=True)
    few, many = (len(np.unique(pixels(one.data).reshape(-1, 3), axis=0)) for one in shown)
    assert few <= 128
    assert many > 1000
    assert len(shown[0].data) < 40_000
    assert "data:image/webp;base64," in shown[1].html()
    drawing = np.kron(np.random.default_rng(0).integers(0, 255, (4, 5, 3)), np.ones((20, 20, 1))).astype(np.uint8)
    assert np.abs(pixels(compress(drawing)) - drawing).max() <= 12


@pytest.mark.parametrize("alt", ["", "a plot", "one two three"])
def test_alternative_text_must_say_something(alt):
    with pytest.raises(FigureError, match="alternative text"):
        Picture(b"", alt)


@pytest.mark.parametrize("inches", [3, 10])
def test_a_picture_carries_its_words_is_sharp_on_fine_screens_and_is_never_wider_than_its_place(inches):
    png = png_bytes(figures.new_figure(size=(inches, 1))[0])
    bundle = Picture(png, 'A "wall" <a>\n&', ratio=2)._repr_mimebundle_()
    assert Image.open(io.BytesIO(png)).width == 200 * inches
    assert 'alt="A &quot;wall&quot; &lt;a&gt; &amp;" src="data:image/png;base64,' in bundle["text/html"]
    assert f'" width="{100 * inches}" style="max-width: 100%; height: auto">' in bundle["text/html"]
    assert bundle["text/plain"] == 'Picture: A "wall" <a> &'


def test_lines_stay_lines_with_a_caption_and_the_same_bytes_and_names_of_categories_need_no_unit(monkeypatch):
    shown = []
    monkeypatch.setattr("courseware.lessons.kit.display.display", shown.append)
    for _ in range(2):
        figure, axes = figures.new_figure(size=(5, 2))
        axes.bar(["paper", "ours"], [1, 2])
        axes.set(title="Errors", ylabel="error [m]")
        show(figure, "Figure 1.1. Two errors.", "Two bars, the second is higher")
    first, second = (picture.html() for picture in shown)
    assert first == second
    assert "data:image/svg+xml;base64," in first
    assert first.endswith("<p><em>Figure 1.1. Two errors.</em></p>")
