"""The figure of project P1."""

from matplotlib.figure import Figure

from courseware.lessons.kit.display import described
from courseware.lessons.project_1.recordings import Recording
from courseware.plots.figures import depth_images


def frames_figure(run: Recording) -> Figure:
    """Some depth images of a recording."""
    shown = [0, 13, 26, 39]
    figure = depth_images(run.frames[shown], [f"frame {index}" for index in shown], (0.0, 10.0), (9.4, 2.3))
    for axes in figure.axes[1:4]:
        axes.set_ylabel("v [pixels]")
    alt = "Four depth images of a corridor: both side walls, the floor, and the far end without measurement."
    return described(figure, alt)
