"""Figures of project P4."""

import numpy as np
from matplotlib.figure import Figure

from course_lib.lessons.project_4.sessions import Secrets, Session
from course_lib.plots import figures


def room_figure(given: Session, secrets: Secrets) -> Figure:
    """One raw frame from each place, in the unit that only the secrets tell, so that all seeds look alike."""
    figure, axes = figures.new_figure(1, len(given.frames), size=(9.4, 2.3))
    for number, (a, place) in enumerate(zip(axes, given.frames, strict=True)):
        shown = np.where(place[0] == secrets.invalid, np.nan, place[0] / secrets.units)
        drawn = figures.depth_image(a, shown, f"place {number}", (0.0, 9.0))
    for a in axes[1:]:
        a.set_ylabel("v [pixels]")
    figures.colour_bar(figure, drawn, axes, "range as read [m]")
    return figure
