"""Figures of a stereo pair of panoramas: matched features, boxes with their distances, the objects from above."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from course_lib.spherical_stereo.panorama import View
from courseware.plots.figures import BLUE, ORANGE, VERMILION, new_figure
from courseware.plots.panorama_drawing import add_list, draw_objects, panorama

# Share of the disparities that the colours span; a few wild matches would else use up the scale.
_COLOUR_PERCENTILES = (2, 98)


def disparity_figure(upper_image: np.ndarray, features) -> Figure:
    """The upper panorama with every `FeatureMatches`, coloured by vertical disparity; crosses break the constraint."""
    figure, axes = new_figure(size=(11, 6))
    share = f", {100 * features.epipolar_share:.1f} % of equal azimuth" if len(features) else ": nothing to measure"
    panorama(axes, upper_image, f"{len(features)} matches{share}")
    good, disparity = features.epipolar, np.degrees(features.vertical_disparity)
    low, high = np.percentile(disparity[good], _COLOUR_PERCENTILES) if good.any() else (0.0, 1.0)
    points = axes.scatter(
        *features.keypoints_upper[good].T, c=disparity[good], s=9, cmap="plasma", vmin=low, vmax=high, linewidths=0
    )
    axes.scatter(*features.keypoints_upper[~good].T, marker="x", s=22, color=VERMILION, linewidths=1)
    figure.colorbar(points, ax=axes, label="vertical disparity [degrees]", shrink=0.7, extend="both")
    return figure


def distances_figure(views: Sequence[View], objects: Sequence, names: Sequence[str]) -> Figure:
    """Both panoramas, upper and lower, with the boxes of matched objects (`MeasuredObject`); their distances below."""
    boxes = np.array([d.box for view in views for d in view.detections])
    margin = 0.06 * views[0].height
    labels = [measured.label for measured in objects]
    figure, rows = new_figure(2, 1, size=(13, 8.4))
    for axes, view, side in zip(rows, views, ("Upper", "Lower"), strict=True):
        panorama(axes, view.image, f"{side} camera")
        axes.set_ylim(boxes[:, 3].max() + margin, boxes[:, 1].min() - margin)
    longest = max(map(len, names))
    lines = [
        f"{n:2d} {name:{longest}} {_metres(measured.disparity):>7} ({_metres(measured.box_centre)})"
        for n, (name, measured) in enumerate(zip(names, objects, strict=True), start=1)
    ]
    title = "number, object, horizontal range from disparities (from box centres)"
    add_list(figure, lines, 3, title, labels)
    for axes, view, side in zip(rows, views, ("upper", "lower"), strict=True):
        boxes = [view.detections[getattr(measured, side)].box for measured in objects]
        draw_objects(axes, boxes, labels, view.width)
    return figure


def _metres(measurement) -> str:
    return f"{measurement.horizontal_range_m:.2f} m" if measurement.outcome == "ok" else measurement.outcome


def room_figure(objects: Sequence, names: Sequence[str]) -> Figure:
    """The objects from above, in the upper camera's frame: distances from disparities and from box centres, joined."""
    figure, axes = new_figure(size=(9.0, 7))
    axes.plot(0, 0, marker="^", color="black", markersize=9)
    axes.annotate("rig", (0, 0), textcoords="offset points", xytext=(7, -3))
    styles = {"box_centre": ("s", ORANGE, "from box centres"), "disparity": ("o", BLUE, "from disparities")}
    for number, measured in enumerate(objects, start=1):
        azimuth = np.radians(measured.azimuth_deg)
        towards = np.array([np.cos(azimuth), np.sin(azimuth)])
        places = []
        for way, (marker, colour, _) in styles.items():
            one = getattr(measured, way)
            if one.outcome != "ok":
                continue
            ends = [towards * (one.horizontal_range_m + s * one.horizontal_sigma_m) for s in (-1, 1)]
            axes.plot(*np.transpose(ends), color=colour, linewidth=1.4)
            places.append(towards * one.horizontal_range_m)
            axes.plot(*places[-1], marker=marker, color=colour, markersize=5)
        if places:
            axes.annotate(str(number), places[-1], textcoords="offset points", xytext=(4, 4), fontsize=8)
    for marker, colour, label in styles.values():
        axes.plot([], [], marker=marker, color=colour, linestyle="-", label=label)
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
    axes.set(title="Objects from above, with one standard deviation", xlabel="x, forward [m]", ylabel="y, left [m]")
    axes.set_aspect("equal")
    longest = max(map(len, names), default=0)
    add_list(figure, [f"{n:2d} {name:{longest}}" for n, name in enumerate(names, start=1)], 3, "number, object")
    return figure
