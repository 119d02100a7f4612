"""Lesson 13, matching two spheres: one pair of panoramas of the room, and three ways to count matches in boxes."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from matplotlib.patches import Polygon, Rectangle

from course_lib.lessons import figures
from course_lib.lessons.live_figure import LiveFigure
from course_lib.lessons.matching_figures import (
    ROWS,
    counts_figure,
    matched_figure,
    pair_figure,
    spheres_figure,
    strip,
)
from course_lib.lessons.panel import Choice, Drawing, Panel, Slider, Switch
from course_lib.lessons.paths import data_path
from course_lib.spherical_stereo.boxes import box_centre
from course_lib.spherical_stereo.detected_object import Detection
from course_lib.spherical_stereo.epipolar import (
    EPIPOLAR_TOLERANCE,
    EpipolarPairs,
    allowed_by_rig,
    best_pairs,
    epipolar_pairs,
)
from course_lib.spherical_stereo.experiment import exact_detections
from course_lib.spherical_stereo.feature_matching import RATIO
from course_lib.spherical_stereo.features import PanoramaFeatures, detect_features, inside_box
from course_lib.spherical_stereo.sphere import StereoRig, azimuth_elevation_of_pixel
from course_lib.spherical_stereo.stereo_matching import pair_by_most_matches
from course_lib.spherical_stereo.stereo_recording import StereoPair, StereoRecording, read_stereo_recording

__all__ = [
    "counts_figure",
    "matched_figure",
    "pair_figure",
    "spheres_figure",
]

EXPERIMENT, PLACE = "room/experiment_2", "09_a"  # a chair stands before another, and a table lies across the seam
PLACES = ("02_a", "06_b", "08_a", "09_a")  # where the ways are compared: all over the room
WAYS = ("both", "AKAZE alone", "geometry alone")
EVERYWHERE = 1.57  # radians: a tolerance that lets everything through
ALL_BITS = 486  # of an AKAZE descriptor: no two differ in more


class View(NamedTuple):
    """One panorama: its picture, what is on it, and its features."""

    image: np.ndarray
    """`(H, W, 3)` uint8 BGR."""
    objects: list[Detection]
    """With their exact boxes."""
    numbers: list[int]
    """Line of each object in the map."""
    features: PanoramaFeatures


class Scene(NamedTuple):
    """Both panoramas of one place."""

    upper: View
    lower: View
    rig: StereoRig


def pair_of(recording: StereoRecording, name: str) -> StereoPair:
    """The pair of that name, such as "09_a". Raises `KeyError` where there is none."""
    pairs = {pair.name: pair for pair in recording.pairs}
    return pairs[name]


@functools.lru_cache(maxsize=8)
def scene(name: str = PLACE) -> Scene:
    """One place of the experiment's room, features found: half a second, once."""
    recording = read_stereo_recording(data_path(EXPERIMENT))
    pair = pair_of(recording, name)
    views = [
        View(image, *exact_detections(things, image), detect_features(image))
        for image, things in zip(pair.images(), (pair.upper_objects, pair.lower_objects), strict=True)
    ]
    return Scene(*views, recording.rig)


def object_names(objects: Sequence[Detection], width: int, height: int) -> list[str]:
    """What to call objects: class and azimuth of the box centre in degrees, such as "chair at -143"."""
    azimuths, _ = azimuth_elevation_of_pixel(box_centre([one.box for one in objects]), width, height)
    return [f"{one.label} at {np.degrees(a):+.0f}" for one, a in zip(objects, azimuths, strict=True)]


def part_of(features: PanoramaFeatures, box: Sequence[float]) -> PanoramaFeatures:
    """The features inside a box (edge coordinates, pixels)."""
    inside = inside_box(features.keypoints, np.asarray(box), features.width)
    return replace(features, keypoints=features.keypoints[inside], descriptors=features.descriptors[inside])


def turned(features: PanoramaFeatures, columns: float) -> PanoramaFeatures:
    """The features of a camera turned about its axis: all of them move by so many columns (pixels), around the seam."""
    return replace(features, keypoints=(features.keypoints + np.array([columns, 0.0])) % [features.width, np.inf])


def turned_objects(objects: Sequence[Detection], columns: float, width: int) -> list[Detection]:
    """The objects that a camera turned by so many columns sees."""
    moved = [replace(one, box=tuple(np.add(one.box, [columns % width, 0, columns % width, 0]))) for one in objects]
    return [one.wrapped(width) for one in moved]


def matches_in_boxes(
    upper: PanoramaFeatures, lower: PanoramaFeatures, baseline: float, way: str, tolerance: float = EPIPOLAR_TOLERANCE
) -> EpipolarPairs:
    """Pairs of features inside two boxes. way: "both" as `match_objects`, or one half of it alone.

    "AKAZE alone": each the other's nearest descriptor, and clearly so, wherever it lies. "geometry alone": whatever the
    epipolar constraint and the rig allow, whatever it looks like. Raises `ValueError` for another way.
    """
    if way == "both":
        best = best_pairs(epipolar_pairs(upper, lower, tolerance), RATIO)
    elif way == "AKAZE alone":
        return best_pairs(epipolar_pairs(upper, lower, EVERYWHERE), RATIO)
    elif way == "geometry alone":
        best = epipolar_pairs(upper, lower, tolerance, ALL_BITS)
    else:
        raise ValueError(f"way must be one of {WAYS}; got {way!r}")
    return best.where(allowed_by_rig(best, baseline))


def count_table(one: Scene, way: str) -> np.ndarray:
    """Matches `(n, m)` of every upper object with every lower object of its class."""
    uppers, lowers = ([part_of(v.features, o.box) for o in v.objects] for v in (one.upper, one.lower))
    counts = np.zeros((len(uppers), len(lowers)), dtype=int)
    for i, j in np.ndindex(counts.shape):
        if one.upper.objects[i].label == one.lower.objects[j].label:
            counts[i, j] = len(matches_in_boxes(uppers[i], lowers[j], one.rig.baseline, way))
    return counts


class Score(NamedTuple):
    """How many objects were paired rightly and wrongly, of those that both images show."""

    right: int
    wrong: int
    in_both: int
    share_off: float
    """Share of the matches that join two different objects."""


def score(places: Sequence[Scene], way: str) -> Score:
    """Pairs by most matches over several places, judged by what the boxes really show."""
    right = wrong = both = stray = total = 0
    for one in places:
        counts = count_table(one, way)
        pairs, _, _ = pair_by_most_matches(counts)
        good = sum(one.upper.numbers[i] == one.lower.numbers[j] for i, j in pairs)
        right, wrong = right + good, wrong + len(pairs) - good
        both += len(set(one.upper.numbers) & set(one.lower.numbers))
        same = np.equal.outer(one.upper.numbers, one.lower.numbers)
        stray, total = stray + counts[~same].sum(), total + counts.sum()
    return Score(right, wrong, both, float(stray / total))


def turned_scene(one: Scene, columns: float) -> Scene:
    """The same place with its lower camera turned about its axis by so many columns (pixels)."""
    lower = one.lower
    width = lower.features.width
    moved = lower._replace(
        image=np.roll(lower.image, round(columns), axis=1),
        objects=turned_objects(lower.objects, columns, width),
        features=turned(lower.features, columns),
    )
    return one._replace(lower=moved)


def matches_when_turned(one: Scene, columns: float) -> tuple[int, int]:
    """Matches inside the boxes of one object when the lower camera is turned, and how many of them are old ones.

    An old one joins the same two features as before the turn; all others are matches by chance.
    """
    crooked = turned_scene(one, columns)
    now, before = (
        {(i, *pair) for i in range(len(place.upper.objects)) for pair in _own_matches(place, i)}
        for place in (crooked, one)
    )
    return len(now), len(now & before)


def _own_matches(one: Scene, i: int) -> list[tuple[int, int]]:
    """Matched features of upper object i and the lower box that shows the same object; none where there is no such."""
    if one.upper.numbers[i] not in one.lower.numbers:
        return []
    j = one.lower.numbers.index(one.upper.numbers[i])
    parts = (part_of(v.features, v.objects[k].box) for v, k in ((one.upper, i), (one.lower, j)))
    pairs = matches_in_boxes(*parts, one.rig.baseline, "both")
    return list(zip(pairs.upper.tolist(), pairs.lower.tolist(), strict=True))


def plain_object(image: np.ndarray, box: Sequence[float], margin: int = 25) -> np.ndarray:
    """The panorama with a box and a margin (pixels) around it painted in the box's mean colour.

    The margin keeps the edge of the paint, which has features, out of the box. Not for boxes at the seam.
    """
    u_min, v_min, u_max, v_max = (round(edge) for edge in box)
    painted = image.copy()
    painted[v_min - margin : v_max + margin, u_min - margin : u_max + margin] = image[v_min:v_max, u_min:u_max].mean(
        axis=(0, 1)
    )
    return painted


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
    picture = below.images[0]
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
    return Panel("13 one object in two panoramas", controls, draw)


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
