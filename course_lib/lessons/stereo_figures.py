"""Figures of a stereo pair of panoramas: matched features, boxes with their distances, the objects from above."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from course_lib.lessons.figures import BLUE, ORANGE, SKY_BLUE, VERMILION, new_figure

# Share of the disparities that the colours span; a few wild matches would else use up the scale.
_COLOUR_PERCENTILES = (2, 98)


def panorama_axes(axes: Axes, image_bgr: np.ndarray, title: str) -> None:
    """Shows a panorama with azimuth and elevation in degrees along its edges, in edge coordinates of its pixels."""
    height, width = image_bgr.shape[:2]
    axes.imshow(cv2.cvtColor(image_bgr, cv2.COLOR_BGR2RGB), extent=(0, width, height, 0))
    azimuths, elevations = np.arange(180, -181, -60), np.arange(90, -91, -30)
    axes.set_xticks((0.5 - azimuths / 360) * width, [f"{a}" for a in azimuths])
    axes.set_yticks((0.5 - elevations / 180) * height, [f"{e}" for e in elevations])
    axes.set(title=title, xlabel="azimuth [degrees]", ylabel="elevation [degrees]", xlim=(0, width), ylim=(height, 0))
    axes.grid(visible=False)


def disparity_figure(upper_image: np.ndarray, features) -> Figure:
    """The upper panorama with every matched feature, coloured by its vertical disparity; crosses break the constraint.

    features: `FeatureMatches`.
    """
    figure, axes = new_figure(size=(11, 6))
    panorama_axes(axes, upper_image, f"{len(features)} matches, {100 * features.epipolar_share:.1f} % of equal azimuth")
    good, disparity = features.epipolar, np.degrees(features.vertical_disparity)
    low, high = np.percentile(disparity[good], _COLOUR_PERCENTILES) if good.any() else (0.0, 1.0)
    points = axes.scatter(
        *features.keypoints_upper[good].T, c=disparity[good], s=9, cmap="cividis", vmin=low, vmax=high, linewidths=0
    )
    axes.scatter(*features.keypoints_upper[~good].T, marker="x", s=22, color=VERMILION, linewidths=1)
    figure.colorbar(points, ax=axes, label="vertical disparity [degrees]", shrink=0.7, extend="both")
    return figure


def distances_figure(images: Sequence[np.ndarray], detections: Sequence[Sequence], objects: Sequence) -> Figure:
    """Both panoramas, one above the other, with the boxes of matched objects, numbered, and their distances.

    images, detections: (upper, lower). objects: `MeasuredObject` of each match.
    """
    boxes = np.array([d.box for found in detections for d in found])
    margin = 0.04 * images[0].shape[0]
    figure, rows = new_figure(2, 1, size=(13, 7))
    for axes, image, found, side in zip(rows, images, detections, ("upper", "lower"), strict=True):
        panorama_axes(axes, image, f"{side} camera: number, horizontal range from disparities (from box centres)")
        axes.set_ylim(boxes[:, 3].max() + margin, boxes[:, 1].min() - margin)
        for number, measured in enumerate(objects, start=1):
            text = f"{number}\n{_metres(measured.disparity)}\n({_metres(measured.box_centre)})"
            _draw_box(axes, found[getattr(measured, side)].box, text, image.shape[1])
    return figure


def _metres(measurement) -> str:
    return f"{measurement.horizontal_range_m:.2f} m" if measurement.outcome == "ok" else measurement.outcome


def _draw_box(axes: Axes, box, text: str, width: int) -> None:
    """A box with its text; a box across the seam is drawn on both sides of it."""
    u_min, v_min, u_max, v_max = box
    for shift in (0, -width) if u_max > width else (0,):
        axes.add_patch(
            Rectangle(
                (u_min + shift, v_min), u_max - u_min, v_max - v_min, fill=False, edgecolor=SKY_BLUE, linewidth=1.2
            )
        )
    axes.text(
        u_min + 1,
        v_min + 1,
        text,
        fontsize=6,
        color="white",
        verticalalignment="top",
        clip_on=True,
        bbox={"facecolor": "black", "alpha": 0.6, "pad": 0.6, "linewidth": 0},
    )


def room_figure(objects: Sequence, names: Sequence[str]) -> Figure:
    """The objects from above, in the upper camera's frame: distances from disparities and from box centres, joined."""
    figure, axes = new_figure(size=(7.5, 7))
    axes.plot(0, 0, marker="^", color="black", markersize=9)
    axes.annotate("rig", (0, 0), textcoords="offset points", xytext=(7, -3))
    styles = {"box_centre": ("s", ORANGE, "from box centres"), "disparity": ("o", BLUE, "from disparities")}
    for number, (measured, name) in enumerate(zip(objects, names, strict=True), start=1):
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
            axes.annotate(f"{number} {name}", places[-1], textcoords="offset points", xytext=(5, 4), fontsize=7)
    for marker, colour, label in styles.values():
        axes.plot([], [], marker=marker, color=colour, linestyle="-", label=label)
    axes.legend(loc="upper right")
    axes.set(title="Objects from above, with one standard deviation", xlabel="x, forward [m]", ylabel="y, left [m]")
    axes.set_aspect("equal")
    return figure
