"""Figures of lesson 20: a frame beside its map, a track, a pair, and the panel that misreads a recording."""

import numpy as np
from matplotlib.figure import Figure

from course_lib.spherical_stereo.matching.alignment import FeatureMatches
from courseware.lessons.kit.display import described
from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.panel import Choice, Drawing, Panel, Slider
from courseware.lessons.lesson_20.own_panoramas import PanoramaPair
from courseware.lessons.lesson_20.recordings import READINGS, STAND_IN_FRAMES, Checker, Compared, Recording, recording
from courseware.plots import figures
from courseware.plots.panorama_drawing import draw_box, panorama


def compared_axes(compared: Compared) -> tuple[Figure, list]:
    """Draw a frame, the map seen from its pose, and their difference; return the figure and its three images."""
    figure, axes = figures.new_figure(1, 3, size=(9.4, 2.7))
    finite = compared.measured[np.isfinite(compared.measured)]
    limits = (0.0, float(np.ceil(np.percentile(finite, 98))) if len(finite) else 5.0)
    titles = ("Measured", "The map, from the given pose", "Difference")
    every = zip(axes, compared.images, titles, (limits, limits, (0.0, 0.3)), strict=True)
    drawn = [figures.depth_image(*one) for one in every]
    for a in axes[1:]:
        a.set_ylabel("v [pixels]")
    figures.colour_bar(figure, drawn[1], axes[:2])
    figures.colour_bar(figure, drawn[2], axes[2], "|z - z_map| [m]")
    return figure, drawn


def check_figure(compared: Compared) -> Figure:
    """Draw a frame, the map seen from its pose, and the difference of the two."""
    alt = "Three images: the depth that was measured, the map drawn from the same pose, and their small difference."
    return described(compared_axes(compared)[0], alt)


def reading_panel(given: Recording | None = None) -> Panel:
    """Read a recording in one wrong way after the other: what the picture and the two numbers say."""
    checker = Checker(given or recording())
    last = min(STAND_IN_FRAMES, len(checker.given.sequence)) - 1
    figure, drawn = compared_axes(checker(0))
    live = LiveFigure(figure, drawn)
    controls = [
        Choice("reading", "how the files are read", tuple(READINGS), next(iter(READINGS))),
        Slider("frame", "frame", 0, max(1, last), 0, 1),
        Slider("shift", "camera moved to the right [m]", -0.3, 0.3, 0.0, 0.01),
    ]

    def draw(reading: str, frame: float, shift: float) -> Drawing:
        frame = min(int(frame), last)  # for a single frame too, the slider has two ends
        compared = checker(frame, reading, shift)
        for image, values in zip(drawn, compared.images, strict=True):
            image.set_data(np.ma.masked_invalid(values))
        numbers = f"{compared.hits:.0%} of the measured pixels hit the map"
        if np.isfinite(compared.median):
            numbers = f"median |z - z_map| = {compared.median:.3f} m;  {numbers}"
        alt = f"Frame {frame}, read with {reading}: the measured depth, the map, and their difference. {numbers}."
        return Drawing(live.png(), alt, f"{reading}, camera moved by {shift:.2f} m\n{numbers}")

    return Panel("20 read it wrongly", controls, draw)


PANELS = {"20 read it wrongly": reading_panel}


def track_figure(given: Recording, estimated: np.ndarray) -> Figure:
    """Draw true and estimated camera positions over the first frames. estimated: `(T, 4, 4)`, camera to world."""
    true = given.sequence.camera_to_world[: len(estimated), :3, 3]
    moved, found = true - true[0], estimated[:, :3, 3] - true[0]
    reach = 1.1 * max(0.3, np.abs(moved).max(), np.abs(found).max())
    figure, axes = figures.new_figure(1, 3, size=(9.0, 2.5))
    for index, (a, name) in enumerate(zip(axes, "xyz", strict=True)):
        a.plot(moved[:, index], color="black", linewidth=3, alpha=0.35, label="given in poses.txt")
        a.plot(found[:, index], **(figures.line_style(0) | {"linestyle": "none"}), label="estimate")
        a.set(title=f"{name} since the first frame", xlabel="frame [-]", ylabel=f"{name} [m]", ylim=(-reach, reach))
    axes[0].legend(loc="lower left", fontsize=8, framealpha=0.9)
    return described(figure, "Given and estimated x, y and z over eight frames: x falls behind, most z lie too low.")


def disparity_picture(pair: PanoramaPair, features: FeatureMatches) -> Figure:
    """Draw the upper panorama, its boxes, and the matched features coloured by their vertical disparity in pixels."""
    figure, axes = figures.new_figure(size=(8.2, 3.4))
    panorama(axes, pair.upper, f"Upper camera: {len(features)} features found again below")
    for one in pair.upper_detections:
        draw_box(axes, one.box, pair.size[0], one.label)
    good = features.epipolar
    rows = features.vertical_disparity[good] * pair.size[1] / np.pi
    low, high = np.percentile(rows, (2, 98)) if good.any() else (0.0, 1.0)
    points = axes.scatter(*features.keypoints_upper[good].T, c=rows, s=6, cmap="plasma", vmin=low, vmax=high)
    axes.set_ylim(0.85 * pair.size[1], 0.2 * pair.size[1])  # neither tripod nor ceiling
    figure.colorbar(points, ax=axes, label="vertical disparity [pixels]", shrink=0.8)
    alt = "The upper panorama with boxes around its objects and features coloured by their vertical disparity."
    return described(figure, alt)
