"""What a lesson's figure must have to be shown, and what a stored picture carries."""

import io
import re

import numpy as np
import pytest
from PIL import Image

from course_lib.lessons.kit.compression import png_bytes
from course_lib.lessons.kit.display import FigureError, Picture, require_labels, show
from course_lib.plots import figures

PNG = png_bytes(figures.new_figure(size=(1, 1))[0])


def finished_figure():
    figure, axes = figures.new_figure()
    axes.plot([0, 1], [0, 1], **figures.line_style(0))
    axes.set(title="A line", xlabel="x [m]", ylabel="weight [-]")
    return figure, axes


def test_a_finished_figure_is_accepted_and_small():
    figure, _ = finished_figure()
    require_labels(figure)
    assert len(png_bytes(figure)) < 40_000


@pytest.mark.parametrize(
    ("change", "words"),
    [({"title": ""}, "no title"), ({"xlabel": "x"}, "no unit"), ({"ylabel": ""}, "no unit")],
)
def test_a_figure_without_title_or_units_is_refused(change, words):
    figure, axes = finished_figure()
    axes.set(**change)
    with pytest.raises(FigureError, match=words):
        show(figure, alt="A line that rises from left to right.")


def test_a_colour_bar_needs_a_unit_too():
    figure, axes = figures.new_figure()
    image = figures.depth_image(axes, np.ones((3, 4)), "Depth", (0, 2))
    figures.colour_bar(figure, image, axes, "depth")
    with pytest.raises(FigureError, match="colour bar"):
        require_labels(figure)


def test_a_photograph_keeps_its_colours(monkeypatch):
    """A smooth ramp of colours, a thousand of them: a palette makes patches of it, a JPEG does not."""
    ramp = np.stack(np.meshgrid(np.linspace(0, 1, 200), np.linspace(0, 1, 100)), axis=-1)
    figure, axes = figures.new_figure()
    axes.imshow(np.dstack([ramp, 1 - ramp[..., :1]]))
    axes.set(title="A ramp", xlabel="u [pixels]", ylabel="v [pixels]")
    shown = []
    monkeypatch.setattr("course_lib.lessons.kit.display.display", shown.append)
    show(figure, alt="Colours that change smoothly across the picture.")
    show(figure, alt="Colours that change smoothly across the picture.", photograph=True)
    colours = [
        len(np.unique(np.asarray(Image.open(io.BytesIO(one.data)).convert("RGB")).reshape(-1, 3), axis=0))
        for one in shown
    ]
    assert colours[0] <= 128
    assert colours[1] > 1000
    assert "data:image/webp;base64," in shown[1].html()


@pytest.mark.parametrize("alt", ["", "a plot", "figure 1"])
def test_alternative_text_must_say_something(alt):
    with pytest.raises(FigureError, match="alternative text"):
        Picture(b"", alt)


def test_a_picture_carries_its_alternative_text_safely():
    picture = Picture(PNG, 'A "quoted" <wall> seen & measured')
    bundle = picture._repr_mimebundle_()
    assert 'alt="A &quot;quoted&quot; &lt;wall&gt; seen &amp; measured"' in bundle["text/html"]
    assert bundle["text/plain"].startswith("Picture: A ")


def test_the_picture_is_an_address_in_html():
    html = Picture(PNG, "A wall seen from above").html()
    assert re.search(r'src="data:image/png;base64,[A-Za-z0-9+/=]+"', html)


@pytest.mark.parametrize(("inches", "least"), [(3, 300), (10, 640)])
def test_a_wide_figure_is_scrolled_rather_than_shrunk_until_nobody_reads_it(inches, least):
    picture = Picture(png_bytes(figures.new_figure(size=(inches, 1))[0]), "An empty figure for a test")
    assert f"min-width: {least}px" in picture.html()
