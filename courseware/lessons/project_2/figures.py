"""The figure of project P2: the boxes of both images, and the map on which they were seen."""

from matplotlib.figure import Figure

from courseware.lessons.kit.display import described
from courseware.lessons.project_2.rooms import ProjectRoom, ProjectView
from courseware.plots.figures import new_figure
from courseware.plots.panorama_drawing import draw_box
from courseware.plots.room_figures import draw_pose, map_axes


def boxes_figure(room: ProjectRoom, view: ProjectView) -> Figure:
    """Draw the boxes of the upper and of the lower image, and the room with the pose that is wanted."""
    figure, (*images, plan) = new_figure(1, 3, size=(12.0, 3.4))
    width, height = view.size
    for axes, name, detections in zip(images, ("upper", "lower"), (view.upper, view.lower), strict=True):
        axes.set(xlim=(0, width), ylim=(0.75 * height, 0.35 * height), title=f"Boxes of the {name} image")
        axes.set(xlabel="column u [pixels]", ylabel="row v [pixels]")
        for one in detections:
            draw_box(axes, one.box, width, one.label)
    map_axes(plan, room.semantic_map, "The map, and the pose that is wanted")
    draw_pose(plan, *view.pose, "black")
    plan.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)
    return described(
        figure,
        "Left and middle: coloured boxes of furniture on the upper and the lower panorama, the same ones higher in the"
        " lower image. Right: the plan of the room with its landmarks and an arrow, the pose that is wanted.",
    )
