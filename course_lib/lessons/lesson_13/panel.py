"""Lesson 13's panel: an object of the upper panorama, its band and its matches in the lower one."""

from collections.abc import Sequence
from itertools import zip_longest

import numpy as np
from matplotlib.patches import Polygon, Rectangle

from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider, Switch
from course_lib.lessons.kit.panorama_features import scene
from course_lib.lessons.lesson_13.figures import ROWS, strip
from course_lib.lessons.lesson_13.matching import features_by_object, matches_in_boxes, object_names
from course_lib.lessons.lesson_13.turned import turned, turned_objects
from course_lib.plots import figures
from course_lib.spherical_stereo.matching.epipolar import EPIPOLAR_TOLERANCE


def band(box: Sequence[float], tolerance: float, width: int, height: int) -> np.ndarray:
    """Return the outline `(k, 2)` [pixels] of where the other camera may see what is in a box."""
    rows = np.linspace(*ROWS, 16)
    sine = np.sin(tolerance) / np.cos((0.5 - rows / height) * np.pi)
    margin = np.arcsin(np.minimum(sine, 1.0)) / (2 * np.pi) * width
    left, right = np.stack([box[0] - margin, rows], -1), np.stack([box[2] + margin, rows], -1)
    return np.concatenate([left, right[::-1]])


def matching_panel() -> Panel:
    """Choose an object of the upper image: its column, its candidates and its matches in the lower one."""
    one = scene()
    upper, lower = one.upper, one.lower
    size = width, _ = upper.features.width, upper.features.height
    names, uppers, lowers = object_names(upper.objects, *size), features_by_object(upper), features_by_object(lower)
    figure, (above, below) = figures.new_figure(2, 1, size=(8.4, 4.8))
    strip(above, upper.image, "Upper camera: the chosen object, its features (matched ones are large)")
    strip(below, lower.image, "Lower camera: epipolar band, objects of the same class, number of matches")
    turns = (0, -width)  # everything twice, a turn apart: what crosses the seam shows on both sides

    def frame(axes, colour) -> list[Rectangle]:
        look = {"fill": False, "linewidth": 1.8, "edgecolor": colour}
        return [axes.add_patch(Rectangle((0, 0), 1, 1, **look)) for _ in turns]

    chosen_frame, frames = frame(above, figures.YELLOW), [frame(below, "white") for _ in range(3)]
    ground = {"facecolor": "white", "edgecolor": "none", "pad": 1.0, "alpha": 0.85}
    numbers = [below.text(0, 0, "", fontsize=9, ha="center", va="bottom", bbox=ground) for _ in frames]
    colour = {"color": figures.SKY_BLUE, "alpha": 0.35}
    bands = [axes.add_patch(Polygon(np.zeros((3, 2)), **colour)) for axes in (above, below) for _ in turns]
    (all_features,) = above.plot([], [], ".", color="white", markersize=2)
    look = {"color": figures.YELLOW, "markersize": 3.5, "mec": "black", "mew": 0.4}
    dots = [axes.plot([], [], "o", **look)[0] for axes in figure.axes]
    (crosses,) = below.plot([], [], "X", color=figures.VERMILION, markersize=6, mec="white", mew=0.5)
    # Over the picture at rest, and shown only when the camera is turned: an image is what takes longest to draw.
    picture = below.imshow(below.images[0].get_array(), extent=below.images[0].get_extent(), interpolation="nearest")
    boxes = [rectangle for frame in frames for rectangle in frame]
    live = LiveFigure(figure, [picture, *bands, *chosen_frame, *boxes, all_features, *dots, crosses, *numbers])

    def place(frame: list[Rectangle], box: Sequence[float]) -> None:
        for rectangle, shift in zip(frame, turns, strict=True):
            rectangle.set_bounds(box[0] + shift, box[1], box[2] - box[0], box[3] - box[1])

    def draw(chosen: str, tolerance: float, turn: float, constraint: bool) -> Drawing:
        i, columns = names.index(chosen), turn / 360 * width
        what, seen = upper.objects[i], turned_objects(lower.objects, columns, width)
        same = [j for j, other in enumerate(seen) if other.label == what.label]
        found = {}
        for j in same:
            there, way = turned(lowers[j], columns), "both" if constraint else "AKAZE alone"
            pairs = matches_in_boxes(uppers[i], there, one.rig.baseline, way, tolerance)
            found[j] = uppers[i].keypoints[pairs.upper], there.keypoints[pairs.lower]
        counts = {j: len(points[0]) for j, points in found.items()}
        ranked = [*sorted(counts.values(), reverse=True), 0]
        best = max(counts, key=counts.get) if ranked[0] > ranked[1] else None
        place(chosen_frame, what.box)
        shown = band(what.box, tolerance, *size) if constraint else np.full((3, 2), -9.0)
        for patch, shift in zip(bands, turns * 2, strict=True):
            patch.set_xy(shown + np.array([shift, 0]))
        for rectangles, number, j in zip_longest(frames, numbers, same):
            box = (-9, -9, -8, -8) if j is None else seen[j].box
            place(rectangles, box)
            middle = min((box[0] + box[2]) / 2 % width, width - 20)
            number.set(position=(middle, box[1] - 4), text="" if j is None else str(counts[j]))
        picture.set_visible(round(columns) != 0)
        if picture.get_visible():
            picture.set_data(np.roll(lower.image[ROWS[0] : ROWS[1], :, ::-1], round(columns), axis=1))
        all_features.set_data(*uppers[i].keypoints.T)
        nothing = np.zeros((0, 2))
        for line, points in zip(dots, found.get(best, (nothing, nothing)), strict=True):
            line.set_data(*points.T)
        crosses.set_data(*np.concatenate([nothing, *(points[1] for j, points in found.items() if j != best)]).T)
        below_names, verdict = (
            object_names(seen, *size),
            "no partner: nothing matches, or two partners with equally many",
        )
        if best is not None:
            right = "right" if upper.numbers[i] == lower.numbers[best] else "WRONG"
            verdict = f"partner: {below_names[best]}, which is {right}"
        table = ", ".join(f"{below_names[j]}: {count}" for j, count in counts.items()) or "none of this class"
        words = f"features in the box: {len(uppers[i])}; matches with {table}", verdict
        alt = f"Upper and lower panorama with one object's band and matches. {' '.join(words)}"
        return Drawing(live.png(), alt, "\n".join(words))

    chairs = [i for i, thing in enumerate(upper.objects) if thing.label == "chair"]
    nearest = max(chairs, key=lambda i: upper.objects[i].size[1])  # the chair that stands before another chair
    controls = [
        Choice("chosen", "object of the upper image", tuple(names), names[nearest]),
        Slider("tolerance", "tolerance [rad]", 0.001, 0.1, EPIPOLAR_TOLERANCE, 0.001),
        Slider("turn", "lower camera turned by [degrees]", -5.0, 5.0, 0.0, 0.25),
        Switch("constraint", "use the epipolar constraint", True),
    ]
    return Panel("13 one object in two panoramas", controls, draw, photograph=True)


PANELS = {"13 one object in two panoramas": matching_panel}
