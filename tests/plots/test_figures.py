"""Figures: their style and depth images."""

import pkgutil
import subprocess
import sys

import numpy as np

import courseware.plots
from courseware.plots import figures


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


def test_commands_draw_where_there_is_no_ipython():
    names = [f"courseware.plots.{module.name}" for module in pkgutil.iter_modules(courseware.plots.__path__)]
    code = f"import sys; sys.modules['IPython'] = sys.modules['ipywidgets'] = None; import {', '.join(names)}"
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0
