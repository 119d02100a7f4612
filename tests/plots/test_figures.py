"""Figures: what a figure must have, and what a stored picture carries."""

from __future__ import annotations

import io
import re

import numpy as np
import pytest
from PIL import Image

from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.plots import figures


def finished_figure():
    figure, axes = figures.new_figure()
    axes.plot([0, 1], [0, 1], **figures.line_style(0))
    axes.set(title="A line", xlabel="x [m]", ylabel="weight [-]")
    return figure, axes


def test_a_finished_figure_is_accepted_and_small():
    figure, _ = finished_figure()
    figures.require_labels(figure)
    assert len(figures.png_bytes(figure)) < 40_000


@pytest.mark.parametrize(
    ("change", "words"),
    [({"title": ""}, "no title"), ({"xlabel": "x"}, "no unit"), ({"ylabel": ""}, "no unit")],
)
def test_a_figure_without_title_or_units_is_refused(change, words):
    figure, axes = finished_figure()
    axes.set(**change)
    with pytest.raises(figures.FigureError, match=words):
        figures.show(figure, alt="A line that rises from left to right.")


def test_a_colour_bar_needs_a_unit_too():
    figure, axes = figures.new_figure()
    image = figures.depth_image(axes, np.ones((3, 4)), "Depth", (0, 2))
    figures.colour_bar(figure, image, axes, "depth")
    with pytest.raises(figures.FigureError, match="colour bar"):
        figures.require_labels(figure)


@pytest.mark.parametrize("alt", ["", "a plot", "figure 1"])
def test_alternative_text_must_say_something(alt):
    with pytest.raises(figures.FigureError, match="alternative text"):
        figures.Picture(b"", alt)


def test_a_picture_carries_its_alternative_text_safely():
    picture = figures.Picture(b"png", 'A "quoted" <wall> seen & measured')
    bundle = picture._repr_mimebundle_()
    assert 'alt="A &quot;quoted&quot; &lt;wall&gt; seen &amp; measured"' in bundle["text/html"]
    assert bundle["text/plain"].startswith("Picture: A ")


def test_series_differ_in_colour_marker_and_line():
    styles = [figures.line_style(k) for k in range(7)]
    for key in ("color", "marker", "linestyle"):
        assert len({str(style[key]) for style in styles}) == 7


def test_where_nothing_was_hit_the_hatched_ground_shows_through():
    _, axes = figures.new_figure()
    depth = np.array([[1.0, np.inf, np.nan]])
    image = figures.depth_image(axes, depth, "Depth", (0, 2))
    assert image.to_rgba(np.ma.masked_invalid(depth))[0, :, 3].tolist() == [1, 0, 0]
    assert axes.patch.get_hatch()


def test_compression_keeps_the_picture():
    rng = np.random.default_rng(0)
    rgb = np.kron(rng.integers(0, 255, (4, 5, 3)), np.ones((20, 20, 1))).astype(np.uint8)
    back = np.asarray(Image.open(io.BytesIO(figures.compress(rgb))).convert("RGB"))
    assert back.shape == rgb.shape
    assert np.abs(back.astype(int) - rgb).max() <= 12


def test_compression_keeps_the_colour_of_a_thin_line_on_a_smooth_ground():
    ground = np.linspace(0, 1, 300)[:, None] * np.ones(400)
    rgb = np.stack([200 * ground, 220 * ground, 255 - 200 * ground], axis=-1).astype(np.uint8)
    rgb[:, 200] = (213, 94, 0)
    back = np.asarray(Image.open(io.BytesIO(figures.compress(rgb))).convert("RGB")).astype(int)
    assert np.abs(back[:, 200] - (213, 94, 0)).max() <= 12


def test_a_live_figure_shows_new_data_like_a_fresh_one():
    def made(data):
        figure, axes = finished_figure()
        (line,) = axes.plot([0, 1], data)
        return LiveFigure(figure, [line]), line

    live, line = made([0.2, 0.4])
    before = live.png()
    line.set_data([0, 1], [0.9, 0.1])
    after = live.png()
    fresh, _ = made([0.9, 0.1])
    assert before != after
    assert after == fresh.png()
    line.set_data([0, 1], [0.2, 0.4])
    assert live.png() == before


def test_figures_leave_nothing_in_matplotlibs_global_state():
    import matplotlib.pyplot

    finished_figure()
    assert matplotlib.pyplot.get_fignums() == []


def test_the_picture_is_an_address_in_html():
    html = figures.Picture(b"\x89PNG", "A wall seen from above").html()
    assert re.search(r'src="data:image/png;base64,[A-Za-z0-9+/=]+"', html)
