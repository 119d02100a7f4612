"""The figure of project P3: what a view shows, in the body frame, and the map that it is to be found on."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse

from course_lib.plots.figures import new_figure
from course_lib.plots.panorama_drawing import class_style
from course_lib.plots.room_figures import map_axes
from course_lib.spherical_stereo.semantic_map.association import Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap


def view_figure(observations: Sequence[Observation], semantic_map: SemanticMap) -> Figure:
    """Left: observed places with their ellipses of two standard deviations. Right: the map."""
    figure, (body, plan) = new_figure(1, 2, size=(9.0, 4.0))
    for one in observations:
        colour, marker = class_style(one.label)
        variances, axes = np.linalg.eigh(one.covariance)
        angle = float(np.degrees(np.arctan2(axes[1, 1], axes[0, 1])))
        size = 4 * np.sqrt(variances)
        body.add_patch(Ellipse((one.x, one.y), size[1], size[0], angle=angle, facecolor=colour, alpha=0.25))
        body.plot(one.x, one.y, marker=marker, color=colour, markersize=7)
    body.plot(0, 0, marker=(3, 0, -90), color="black", markersize=11)
    body.set(title="Seen: body frame, 2-sigma ellipses", xlabel="forward x [m]", ylabel="left y [m]", aspect="equal")
    map_axes(plan, semantic_map, "The map")
    plan.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)
    return figure
