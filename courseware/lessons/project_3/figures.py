"""The figure of project P3: what a view shows, in the body frame, and the map that it is to be found on."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse

from course_lib.spherical_stereo.semantic_map.association import Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap
from courseware.lessons.kit.display import described
from courseware.plots.figures import new_figure
from courseware.plots.panorama_drawing import class_style
from courseware.plots.room_figures import map_axes


def view_figure(observations: Sequence[Observation], semantic_map: SemanticMap) -> Figure:
    """Draw the observed places with their ellipses of two standard deviations, and the map beside them."""
    figure, (body, plan) = new_figure(1, 2, size=(9.0, 4.0))
    for one in observations:
        colour, marker = class_style(one.label)
        variances, axes = np.linalg.eigh(one.covariance)
        (height, width), angle = 4 * np.sqrt(variances), float(np.degrees(np.arctan2(axes[1, 1], axes[0, 1])))
        body.add_patch(Ellipse((one.x, one.y), width, height, angle=angle, facecolor=colour, alpha=0.25))
        body.plot(one.x, one.y, marker=marker, color=colour, markersize=7)
    body.plot(0, 0, marker=(3, 0, -90), color="black", markersize=11)
    body.set(title="Seen: body frame, 2-sigma ellipses", xlabel="forward x [m]", ylabel="left y [m]", aspect="equal")
    map_axes(plan, semantic_map, "The map")
    plan.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)
    return described(
        figure,
        "Left: observed places around the rig, each with an ellipse that is long along its ray and grows outward. "
        "Right: the plan of the room with all its landmarks, several of one class.",
    )
