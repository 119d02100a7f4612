"""Figures of project P1."""

from matplotlib.figure import Figure

from course_lib.lessons.project_1.recordings import Recording
from course_lib.plots import figures


def frames_figure(run: Recording, indices: tuple[int, ...] = (0, 13, 26, 39)) -> Figure:
    """Some depth images of a recording."""
    figure, axes = figures.new_figure(1, len(indices), size=(9.4, 2.3))
    for a, index in zip(axes, indices, strict=True):
        drawn = figures.depth_image(a, run.frames[index], f"frame {index}", (0.0, 10.0))
    for a in axes[1:]:
        a.set_ylabel("v [pixels]")
    figures.colour_bar(figure, drawn, axes)
    return figure
