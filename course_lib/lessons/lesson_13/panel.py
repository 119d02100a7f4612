"""Lesson 13's panel: an object of the upper panorama, its band and its matches in the lower one."""

from collections.abc import Sequence

import numpy as np
from matplotlib.patches import Polygon, Rectangle

from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider, Switch
from course_lib.lessons.kit.panorama_features import Scene, scene
from course_lib.lessons.lesson_13.figures import ROWS, strip
from course_lib.lessons.lesson_13.matching import matches_in_boxes, object_names, part_of, turned, turned_objects
from course_lib.plots import figures
from course_lib.spherical_stereo.matching.epipolar import EPIPOLAR_TOLERANCE


def band(box: Sequence[float], tolerance: float, width: int, height: int) -> np.ndarray:
    """Outline `(k, 2)`, pixels, of where the other camera may see what is in a box: its columns and the tolerance."""
    rows = np.linspace(*ROWS, 16)
    sine = np.sin(tolerance) / np.cos((0.5 - rows / height) * np.pi)
    margin = np.arcsin(np.minimum(sine, 1.0)) / (2 * np.pi) * width
    left, right = np.stack([box[0] - margin, rows], -1), np.stack([box[2] + margin, rows], -1)
    return np.concatenate([left, right[::-1]])


def matching_panel() -> Panel:
    """Choose an object of the upper image: its column, its candidates and its matches in the lower one."""
    one = scene()
    width, height = one.upper.features.width, one.upper.features.height
    names = object_names(one.upper.objects, width, height)
    uppers, lowers = ([part_of(v.features, o.box) for o in v.objects] for v in (one.upper, one.lower))
    figure, (above, below) = figures.new_figure(2, 1, size=(8.4, 4.8))
    strip(above, one.upper.image, "Upper camera: the chosen object, its features (matched ones are large)")
    strip(below, one.lower.image, "Lower camera: epipolar band, objects of the same class, number of matches")
    turns = (0, -width)  # everything twice, a turn apart: what crosses the seam shows on both sides
    look = {"fill": False, "linewidth": 1.8}
    chosen_boxes = [above.add_patch(Rectangle((0, 0), 1, 1, edgecolor=figures.YELLOW, **look)) for _ in turns]
    candidates = [
        (
            [below.add_patch(Rectangle((0, 0), 1, 1, edgecolor="white", **look)) for _ in turns],
            below.text(0, 0, "", fontsize=9, ha="center", va="bottom", color="black", bbox=_LABEL),
        )
        for _ in range(3)
    ]
    bands = [
        axes.add_patch(Polygon(np.zeros((3, 2)), color=figures.SKY_BLUE, alpha=0.35))
        for axes in (above, below)
        for _ in turns
    ]
    (all_features,) = above.plot([], [], ".", color="white", markersize=2)
    dots = [
        axes.plot([], [], "o", color=figures.YELLOW, markersize=3.5, mec="black", mew=0.4)[0] for axes in figure.axes
    ]
    (crosses,) = below.plot([], [], "X", color=figures.VERMILION, markersize=6, mec="white", mew=0.5)
    # Over the picture at rest, and shown only when the camera is turned: an image is what takes longest to draw.
    picture = below.imshow(below.images[0].get_array(), extent=below.images[0].get_extent(), interpolation="nearest")
    boxes = [box for rectangles, _ in candidates for box in rectangles]
    live = LiveFigure(
        figure,
        [picture, *bands, *chosen_boxes, *boxes, all_features, *dots, crosses, *(text for _, text in candidates)],
    )

    def draw(chosen: str, tolerance: float, turn: float, constraint: bool) -> Drawing:
        i, columns = names.index(chosen), turn / 360 * width
        what = one.upper.objects[i]
        seen = turned_objects(one.lower.objects, columns, width)
        same = [j for j, other in enumerate(seen) if other.label == what.label]
        found = {}
        for j in same:
            lower = turned(lowers[j], columns)
            pairs = matches_in_boxes(uppers[i], lower, one.rig.baseline, _way(constraint), tolerance)
            found[j] = uppers[i].keypoints[pairs.upper], lower.keypoints[pairs.lower]
        counts = {j: len(points[0]) for j, points in found.items()}
        ranked = [*sorted(counts.values(), reverse=True), 0]
        best = max(counts, key=counts.get) if ranked[0] > ranked[1] else None
        _place(chosen_boxes, what.box, width)
        shown = band(what.box, tolerance, width, height)
        for patch, shift in zip(bands, turns * 2, strict=True):
            patch.set_xy(shown + np.array([shift, 0]) if constraint else np.full((3, 2), -9.0))
        for k, (rectangles, text) in enumerate(candidates):
            if k < len(same):
                box = seen[same[k]].box
                _place(rectangles, box, width)
                text.set_position((min((box[0] + box[2]) / 2 % width, width - 20), box[1] - 4))
                text.set_text(str(counts[same[k]]))
            else:
                _place(rectangles, (-9, -9, -8, -8), width)
                text.set_text("")
        picture.set_visible(round(columns) != 0)
        if picture.get_visible():
            picture.set_data(np.roll(one.lower.image[ROWS[0] : ROWS[1], :, ::-1], round(columns), axis=1))
        all_features.set_data(*uppers[i].keypoints.T)
        nothing = np.zeros((0, 2))
        for line, points in zip(dots, found.get(best, (nothing, nothing)), strict=True):
            line.set_data(*points.T)
        strangers = [points[1] for j, points in found.items() if j != best]
        crosses.set_data(*np.concatenate([nothing, *strangers]).T)
        return Drawing(live.png(), *_words(one, i, best, counts, object_names(seen, width, height), len(uppers[i])))

    controls = [
        Choice("chosen", "object of the upper image", tuple(names), names[_default(one)]),
        Slider("tolerance", "tolerance [rad]", 0.001, 0.1, EPIPOLAR_TOLERANCE, 0.001),
        Slider("turn", "lower camera turned by [degrees]", -5.0, 5.0, 0.0, 0.25),
        Switch("constraint", "use the epipolar constraint", True),
    ]
    return Panel("13 one object in two panoramas", controls, draw, photograph=True)


_LABEL = {"facecolor": "white", "edgecolor": "none", "pad": 1.0, "alpha": 0.85}


def _way(constraint: bool) -> str:
    return "both" if constraint else "AKAZE alone"


def _default(one: Scene) -> int:
    """The chair that stands before another chair."""
    chairs = [i for i, thing in enumerate(one.upper.objects) if thing.label == "chair"]
    return max(chairs, key=lambda i: one.upper.objects[i].size[1])


def _place(rectangles: list[Rectangle], box: Sequence[float], width: int) -> None:
    for rectangle, shift in zip(rectangles, (0, -width), strict=True):
        rectangle.set_bounds(box[0] + shift, box[1], box[2] - box[0], box[3] - box[1])


def _words(one: Scene, i: int, best: int | None, counts: dict[int, int], names: list[str], n: int) -> tuple[str, str]:
    """Alternative text and summary of what the panel shows."""
    table = ", ".join(f"{names[j]}: {count}" for j, count in counts.items()) or "none of this class"
    verdict = "no partner: nothing matches, or two partners with equally many"
    if best is not None:
        right = one.upper.numbers[i] == one.lower.numbers[best]
        verdict = f"partner: {names[best]}, which is {'right' if right else 'WRONG'}"
    summary = f"features in the box: {n}; matches with {table}\n{verdict}"
    return f"Upper and lower panorama with one object's band and matches. {' '.join(summary.splitlines())}", summary


PANELS = {"13 one object in two panoramas": matching_panel}
