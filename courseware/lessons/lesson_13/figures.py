"""Figures of lesson 13: strips of both panoramas, the table of counts, what the scene shows, and the panel."""

from collections.abc import Sequence
from itertools import chain

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon, Rectangle

from course_lib.spherical_stereo.matching.epipolar import EPIPOLAR_TOLERANCE
from courseware.lessons.kit.display import described
from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.panel import Choice, Drawing, Panel, Slider, Switch
from courseware.lessons.kit.room_data import scene
from courseware.lessons.lesson_13 import matching
from courseware.plots.figures import BLUE, SKY_BLUE, VERMILION, YELLOW, new_figure
from courseware.plots.panorama_drawing import draw_box
from courseware.plots.scenes import polydata

TOP, BOTTOM = 260, 600  # rows [pixels]: where the furniture is on a panorama 640 high, and a number above it
SCENE_ALT = (
    "Two grey spheres, one above the other, and a black point beside them. A yellow upright plane through all three "
    "cuts each sphere in a circle: bold on the point's side, dashed behind; a ray leads to the point."
)


def strip(axes: Axes, image_bgr: np.ndarray, title: str) -> None:
    """Draw the middle rows of a panorama, over its whole width, in edge coordinates."""
    width = image_bgr.shape[1]
    axes.imshow(image_bgr[TOP:BOTTOM, :, ::-1], extent=(0, width, BOTTOM, TOP))
    axes.grid(False)
    axes.set(title=title, xlabel="column u [pixels]", ylabel="row v [pixels]", xlim=(0, width), ylim=(BOTTOM, TOP))


def idea_figure(images: Sequence[np.ndarray], detections: Sequence[Sequence], columns: Sequence[float]) -> Figure:
    """Return strips of both panoramas, upper first, with their boxes and vertical lines at these columns [pixels]."""
    figure, rows = new_figure(2, 1, size=(8.4, 5.6))
    for axes, image, found, side in zip(rows, images, detections, ("Upper", "Lower"), strict=True):
        strip(axes, image, f"{side} camera")
        for one in found:
            draw_box(axes, one.box, image.shape[1], one.label)
        for column in columns:
            axes.axvline(column, color="white", linewidth=2.6)
            axes.axvline(column, color=BLUE, linewidth=1.4)
    alt = "Strips of the upper and the lower panorama. A blue line at the left edge of each chair runs through both: "
    return described(
        figure, alt + "it meets the same chair in both, which stands a little higher in the lower picture."
    )


def counts_figure(counts: np.ndarray, upper_names: Sequence[str], lower_names: Sequence[str]) -> Figure:
    """Return the table of matches `(n, m)` as a heat map. Names begin with the class; only equal classes are shown."""
    figure, axes = new_figure(size=(7.6, 4.8))
    classes = [np.array([name.partition(" at ")[0] for name in names]) for names in (upper_names, lower_names)]
    compared, roots = np.equal.outer(*classes), np.sqrt(counts)
    axes.imshow(np.ma.masked_array(roots, ~compared), cmap="plasma", aspect="auto")
    axes.grid(False)
    for i, j in np.argwhere(compared):
        colour = "white" if roots[i, j] < 0.6 * roots.max() else "black"
        axes.text(j, i, str(counts[i, j]), ha="center", va="center", fontsize=8, color=colour)
    axes.set_xticks(range(len(lower_names)), lower_names, rotation=40, ha="right", fontsize=8)
    axes.set_yticks(range(len(upper_names)), upper_names, fontsize=8)
    axes.set_title("Matched features of every two objects of one class (white: not compared)")
    axes.set_xlabel("object of the lower image [class, azimuth in degrees]")
    axes.set_ylabel("object of the upper image [class, azimuth in degrees]")
    alt = "Table of matches of every two objects of one class: large numbers on the diagonal, where both boxes show "
    return described(figure, alt + "one object, and nearly nothing elsewhere.")


def half_circle(towards: np.ndarray) -> np.ndarray:
    """Return points `(61, 3)` of the unit sphere's epipolar half-circle of direction `towards` `(3,)`, upright rig."""
    flat = np.append(towards[:2] / np.linalg.norm(towards[:2]), 0.0)
    elevation = np.linspace(np.pi / 2, -np.pi / 2, 61)[:, None]
    return np.cos(elevation) * flat + np.sin(elevation) * [0.0, 0.0, 1.0]


def upright_plane(towards: np.ndarray, low: float, high: float):
    """Return the vertical plane through the z axis and a little past `towards` [m], from low to high, as PolyData."""
    ray = towards[:2] / np.linalg.norm(towards[:2])
    behind, ahead = -1.4 * ray, towards[:2] + 0.25 * ray
    corners = [[*behind, low], [*ahead, low], [*ahead, high], [*behind, high]]
    return polydata(corners, [[0, 1, 2], [0, 2, 3]])


def band(box: Sequence[float], tolerance: float, width: int, height: int) -> np.ndarray:
    """Return the outline `(k, 2)` [pixels] of where the other camera may see what is in a box."""
    rows = np.linspace(TOP, BOTTOM, 16)
    sine = np.sin(tolerance) / np.cos((0.5 - rows / height) * np.pi)
    margin = np.arcsin(np.minimum(sine, 1.0)) / (2 * np.pi) * width
    left, right = np.stack([box[0] - margin, rows], -1), np.stack([box[2] + margin, rows], -1)
    return np.concatenate([left, right[::-1]])


def matching_panel() -> Panel:
    """Choose an object of the upper image: its column, its candidates and its matches in the lower one."""
    one = scene()
    upper, lower = one.upper, one.lower
    size = width, _ = upper.features.width, upper.features.height
    names = matching.object_names(upper.objects, *size)
    uppers, lowers = (matching.features_by_object(side) for side in (upper, lower))
    figure, (above, below) = new_figure(2, 1, size=(8.4, 4.8))
    strip(above, upper.image, "Upper camera: the chosen object, its features (matched ones are large)")
    strip(below, lower.image, "Lower camera: epipolar band, objects of the same class, number of matches")
    turns = (0, -width)  # everything twice, a turn apart: what crosses the seam shows on both sides
    frames = [  # of the chosen object, then of up to three candidates
        [axes.add_patch(Rectangle((0, 0), 1, 1, fill=False, linewidth=1.8, edgecolor=colour)) for _ in turns]
        for axes, colour in ((above, YELLOW), *[(below, "white")] * 3)
    ]
    ground = {"facecolor": "white", "edgecolor": "none", "pad": 1.0, "alpha": 0.85}
    numbers = [below.text(0, 0, "", fontsize=9, ha="center", va="bottom", bbox=ground) for _ in frames[1:]]
    wide = {"color": SKY_BLUE, "alpha": 0.35}
    bands = [axes.add_patch(Polygon(np.zeros((3, 2)), **wide)) for axes in (above, below) for _ in turns]
    (all_features,) = above.plot([], [], ".", color="white", markersize=2)
    dots = [axes.plot([], [], "o", color=YELLOW, markersize=3.5, mec="black", mew=0.4)[0] for axes in figure.axes]
    (crosses,) = below.plot([], [], "X", color=VERMILION, markersize=6, mec="white", mew=0.5)
    # Over the picture at rest, and shown only when the camera is turned: an image is what takes longest to draw.
    picture = below.imshow(below.images[0].get_array(), extent=below.images[0].get_extent(), interpolation="nearest")
    live = LiveFigure(figure, [picture, *bands, *chain(*frames), all_features, *dots, crosses, *numbers])

    def draw(chosen: str, tolerance: float, turn: float, constraint: bool) -> Drawing:
        i, columns = names.index(chosen), turn / 360 * width
        what, seen = upper.objects[i], matching.turned_objects(lower.objects, columns, width)
        found, way = {}, "both" if constraint else "AKAZE alone"
        for j in [j for j, other in enumerate(seen) if other.label == what.label]:
            there = matching.turned(lowers[j], columns)
            pairs = matching.matches_in_boxes(uppers[i], there, one.rig.baseline, way, tolerance)
            found[j] = uppers[i].keypoints[pairs.upper], there.keypoints[pairs.lower]
        counts = {j: len(points[0]) for j, points in found.items()}
        ranked = [*sorted(counts.values(), reverse=True), 0]
        best = max(counts, key=counts.get) if ranked[0] > ranked[1] else None
        shown = band(what.box, tolerance, *size) if constraint else np.full((3, 2), -9.0)
        for patch, shift in zip(bands, turns * 2, strict=True):
            patch.set_xy(shown + np.array([shift, 0]))
        boxes = [*(seen[j].box for j in found), *[(-9, -9, -8, -8)] * 3][:3]  # frames without an object lie outside
        for frame, box in zip(frames, [what.box, *boxes], strict=True):
            for rectangle, shift in zip(frame, turns, strict=True):
                rectangle.set_bounds(box[0] + shift, box[1], box[2] - box[0], box[3] - box[1])
        for number, box, count in zip(numbers, boxes, [*counts.values(), "", "", ""], strict=False):
            middle = min((box[0] + box[2]) / 2 % width, width - 20)
            number.set(position=(middle, box[1] - 4), text=str(count))
        picture.set_visible(round(columns) != 0)
        if picture.get_visible():
            picture.set_data(np.roll(lower.image[TOP:BOTTOM, :, ::-1], round(columns), axis=1))
        all_features.set_data(*uppers[i].keypoints.T)
        nothing = np.zeros((0, 2))
        for line, points in zip(dots, found.get(best, (nothing, nothing)), strict=True):
            line.set_data(*points.T)
        crosses.set_data(*np.concatenate([nothing, *(points[1] for j, points in found.items() if j != best)]).T)
        below_names = matching.object_names(seen, *size)
        verdict = "no partner: nothing matches, or two partners with equally many"
        if best is not None:
            right = "right" if upper.numbers[i] == lower.numbers[best] else "WRONG"
            verdict = f"partner: {below_names[best]}, which is {right}"
        table = ", ".join(f"{below_names[j]}: {count}" for j, count in counts.items()) or "none of this class"
        words = f"features in the box: {len(uppers[i])}; matches with {table}", verdict
        alt = f"Upper and lower panorama with one object's band and matches. {' '.join(words)}"
        return Drawing(live.png(), alt, "\n".join(words))

    chairs = [name for name, thing in zip(names, upper.objects, strict=True) if thing.label == "chair"]
    boxes = {name: upper.objects[names.index(name)].box for name in chairs}
    nearest = max(chairs, key=lambda name: boxes[name][3] - boxes[name][1])  # the tallest stands before another chair
    controls = [
        Choice("chosen", "object of the upper image", tuple(names), nearest),
        Slider("tolerance", "tolerance [rad]", 0.001, 0.1, EPIPOLAR_TOLERANCE, 0.001),
        Slider("turn", "lower camera turned by [degrees]", -5.0, 5.0, 0.0, 0.25),
        Switch("constraint", "use the epipolar constraint", True),
    ]
    return Panel("13 one object in two panoramas", controls, draw, photograph=True)


PANELS = {"13 one object in two panoramas": matching_panel}
