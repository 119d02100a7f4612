"""Lesson 14, triangulation: how noise of two directions becomes an ellipse, and two distances of every object."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.patches import Polygon

from course_lib.experiments.room import counts_as_object
from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Drawing, Panel, Slider
from course_lib.lessons.kit.paths import data_path
from course_lib.lessons.lesson_13.matching_scene import pair_of, scene
from course_lib.lessons.lesson_14.triangulation_figures import (
    errors_figure,
    growth_figure,
    places_figure,
    triangle_figure,
)
from course_lib.plots import figures
from course_lib.spherical_stereo.detection.boxes import box_centre, wrapped_box
from course_lib.spherical_stereo.detection.detected_object import Detection
from course_lib.spherical_stereo.matching.object_matching import match_views
from course_lib.spherical_stereo.panorama import direction_from_angles, pixel_to_direction
from course_lib.spherical_stereo.ranging.triangulation import (
    OK,
    object_position,
    triangulation_covariance,
    triangulation_outcome,
)
from course_lib.spherical_stereo.ranging.vertical_disparity import disparity_distance
from course_lib.spherical_stereo.recording import StereoRecording, read_stereo_recording
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

__all__ = [
    "errors_figure",
    "growth_figure",
    "pair_of",
    "places_figure",
    "scene",
    "triangle_figure",
]

PIXEL = 2 * np.pi / 1280
"""Radians of one pixel of the room's panoramas, in azimuth and in elevation alike."""
PLACES = ("02_a", "06_b", "08_a", "09_a")  # of experiment_2, where features are matched: all over the room
N_SAMPLES = 400
SAMPLES = np.random.default_rng(14).standard_normal((N_SAMPLES, 3))
"""Standard normal draws for azimuth, upper and lower elevation; the same for every setting: nothing flickers."""


def directions_to(point: np.ndarray, baseline: float) -> tuple[np.ndarray, np.ndarray]:
    """Unit vectors `(..., 3)` from the upper and the lower camera to points `(..., 3)` in the upper camera's frame."""
    point = np.asarray(point, dtype=np.float64)
    rays = point, point + np.array([0.0, 0.0, baseline])
    upper, lower = (ray / np.linalg.norm(ray, axis=-1, keepdims=True) for ray in rays)
    return upper, lower


def noisy_directions(point: np.ndarray, baseline: float, sigma: float) -> tuple[np.ndarray, np.ndarray]:
    """Directions `(N_SAMPLES, 3)` to one point, with noise of sigma radians on the azimuth and both elevations."""
    x, y, z = point
    azimuth, horizontal = np.arctan2(y, x), np.hypot(x, y)
    elevations = np.arctan2(z, horizontal), np.arctan2(z + baseline, horizontal)
    noise = sigma * SAMPLES.T
    end = np.pi / 2 - 1e-6
    upper, lower = (
        direction_from_angles(azimuth + noise[0], np.clip(e + n, -end, end))
        for e, n in zip(elevations, noise[1:], strict=True)
    )
    return upper, lower


def sampled_places(point: np.ndarray, baseline: float, sigma: float) -> tuple[np.ndarray, np.ndarray]:
    """Places `(k, 3)`, metres, of the noisy directions that have one, and the outcomes `(N_SAMPLES,)` of all."""
    upper, lower = noisy_directions(point, baseline, sigma)
    outcomes = triangulation_outcome(upper, lower)
    ok = outcomes == OK
    if not ok.any():
        return np.zeros((0, 3)), outcomes
    return object_position(upper[ok], lower[ok], baseline), outcomes


def ellipse(covariance: np.ndarray, centre: np.ndarray, n_sigma: float = 2.0) -> np.ndarray:
    """Outline `(60, 2)` of the points that are n_sigma standard deviations from the centre; covariance `(2, 2)`."""
    values, vectors = np.linalg.eigh(covariance)
    turn = np.linspace(0, 2 * np.pi, 60)
    axes = n_sigma * np.sqrt(np.maximum(values, 0))[:, None] * np.stack([np.cos(turn), np.sin(turn)])
    return centre + (vectors @ axes).T


class Distances(NamedTuple):
    """Horizontal ranges of objects, metres, one element an object."""

    true: np.ndarray
    """From the rig to the map's centroid."""
    box_centres: np.ndarray
    """From the centres of two boxes; NaN: no distance."""
    features: np.ndarray
    """From the disparities of matched features; NaN: no distance, or not asked for."""


def room_map() -> SemanticMap:
    """The surveyed map of the room."""
    return SemanticMap.load(data_path("room/semantic_map.json"))


def box_range(box_upper: Sequence[float], box_lower: Sequence[float], baseline: float, size: tuple[int, int]) -> float:
    """Horizontal range [m] from the centres of two boxes (edge coordinates); NaN where they give none."""
    upper, lower = (pixel_to_direction(box_centre(np.asarray(box)), *size) for box in (box_upper, box_lower))
    if triangulation_outcome(upper, lower) != OK:
        return float("nan")
    return float(np.linalg.norm(object_position(upper, lower, baseline)[:2]))


def exact_box_ranges(recording: StereoRecording, sigma_pixels: float = 0.0, seed: int = 14) -> Distances:
    """All objects of a recording that both images show, from their exact boxes, with noise on the boxes' centres.

    sigma_pixels: standard deviation of each centre's row, pixels. No image is read.
    """
    rng, landmarks, size = np.random.default_rng(seed), room_map(), (recording.width, recording.height)
    true, measured = [], []
    for pair in recording.pairs:
        upper, lower = (
            {thing.number: thing.visible_box for thing in things if counts_as_object(thing, recording.width)}
            for things in (pair.upper_objects, pair.lower_objects)
        )
        for number in sorted(set(upper) & set(lower)):
            shifts = sigma_pixels * rng.standard_normal(2)
            boxes = [np.add(box, [0, s, 0, s]) for box, s in zip((upper[number], lower[number]), shifts, strict=True)]
            true.append(np.linalg.norm(landmarks.positions[number] - pair.pose[:2]))
            measured.append(box_range(*boxes, recording.rig.baseline, size))
    return Distances(np.array(true), np.array(measured), np.full(len(true), np.nan))


def both_ranges(
    recording: StereoRecording, places: Sequence[str], sigma_pixels: float = 0.0, seed: int = 14
) -> Distances:
    """Objects matched by their features at some places, with both distances; the boxes' edges are off by some pixels.

    sigma_pixels: standard deviation of every edge of every box, pixels. A match of two different objects is left out.
    """
    rng, landmarks, rows = np.random.default_rng(seed), room_map(), []
    for name in places:
        one, pair = scene(name), pair_of(recording, name)
        size = (one.upper.features.width, one.upper.features.height)
        upper, lower = (_shaken(view.objects, sigma_pixels, size, rng) for view in (one.upper, one.lower))
        found = match_views(one.upper.view(upper), one.lower.view(lower), one.rig)
        for match in found.matches:
            number = one.upper.numbers[match.upper]
            if number == one.lower.numbers[match.lower]:
                true = np.linalg.norm(landmarks.positions[number] - pair.pose[:2])
                boxes = upper[match.upper].box, lower[match.lower].box
                features = disparity_distance(match, *size, one.rig.baseline).horizontal_range
                rows.append((true, box_range(*boxes, one.rig.baseline, size), features))
    return Distances(*np.array(rows).T)


def _shaken(objects: Sequence[Detection], sigma: float, size: tuple[int, int], rng) -> list[Detection]:
    """The objects with every edge of their boxes off by a normal number of pixels (boxes keep 4 pixels a side)."""
    shaken = []
    for one in objects:
        u_min, v_min, u_max, v_max = np.add(one.box, sigma * rng.standard_normal(4))
        v_min, v_max = max(v_min, 0.0), min(v_max, size[1])
        box = wrapped_box([u_min, v_min, max(u_max, u_min + 4), max(v_max, v_min + 4)], size[0])
        shaken.append(Detection(one.label, one.score, tuple(box), one.hue, one.saturation))
    return shaken


def cuboid_range(horizontal_range: float, size: Sequence[float], upper_height: float, baseline: float) -> float:
    """Range [m] that exact boxes give of a cuboid (depth, width, height; metres) on the floor, its face to the rig.

    Its centre is horizontal_range metres away. Its boxes are those of its corners and edges, as a panorama shows them.
    """
    step = np.linspace(-0.5, 0.5, 41)
    x, y, z = np.meshgrid(step * size[0], step * size[1], (step + 0.5) * size[2])
    x = x + horizontal_range
    rays = []
    for height in (upper_height, upper_height - baseline):
        e, a = np.arctan2(z - height, np.hypot(x, y)), np.arctan2(y, x)
        rays.append(direction_from_angles((a.min() + a.max()) / 2, (e.min() + e.max()) / 2))
    return float(np.linalg.norm(object_position(*rays, baseline)[:2]))


def places_in_room(places: np.ndarray, pose: Sequence[float]) -> np.ndarray:
    """Horizontal places `(n, 2)` in the room of places `(n, 3)` in the rig's frame; pose: [x, y, heading]."""
    c, s = np.cos(pose[2]), np.sin(pose[2])
    return places[:, :2] @ np.array([[c, s], [-s, c]]) + np.asarray(pose[:2])


def triangulation_panel() -> Panel:
    """Sliders for the object, the rig and the noise; the triangle from the side, and from above the error ellipse."""
    figure, (side, above) = figures.new_figure(1, 2, size=(9.8, 3.9))
    side.set(title="From the side: rays, one sigma wide", xlabel="horizontal range [m]", ylabel="height [m]")
    side.set(xlim=(-0.3, 10), ylim=(-0.1, 3.1))
    above.set(title="From above: where the object may be", xlabel="x, forward [m]", ylabel="y, left [m]")
    above.set(xlim=(-0.5, 10), ylim=(-4.2, 4.2))
    colours = (figures.BLUE, figures.ORANGE)
    wedges = [side.add_patch(Polygon(np.zeros((3, 2)), color=colour, alpha=0.35)) for colour in colours]
    (cameras,) = side.plot([], [], "o", color="black", markersize=6)
    clouds = [axes.plot([], [], ".", color="0.45", markersize=2)[0] for axes in (side, above)]
    objects = [axes.plot([], [], "*", color=figures.VERMILION, markersize=8)[0] for axes in (side, above)]
    above.plot(0, 0, "o", color="black", markersize=6, label="rig")
    (ray,) = above.plot([], [], color="0.6", linewidth=0.8)
    (outline,) = above.plot([], [], color=figures.BLUE, linewidth=1.8, label="two sigma, first order")
    above.plot([], [], ".", color="0.45", label="400 noisy measurements")
    above.legend(loc="upper left", fontsize=7.5)
    live = LiveFigure(figure, [*wedges, cameras, ray, *clouds, outline, *objects])

    def draw(x: float, y: float, z: float, camera: float, baseline: float, sigma: float) -> Drawing:
        point, noise = np.array([x, y, z - camera]), sigma * PIXEL
        upper, lower = directions_to(point, baseline)
        covariance = triangulation_covariance(upper, lower, baseline, noise, noise)
        rho, d = np.hypot(x, y), float(np.linalg.norm(point))
        towards = np.array([x, y]) / rho
        across = np.array([-towards[1], towards[0]])
        along_sigma, across_sigma = (np.sqrt(way @ covariance[:2, :2] @ way) for way in (towards, across))
        cloud, outcomes = sampled_places(point, baseline, noise)
        for wedge, height in zip(wedges, (camera, camera - baseline), strict=True):
            e = np.arctan2(z - height, rho) + np.array([-noise, noise])
            wedge.set_xy([(0, height), *((12 * np.cos(a), height + 12 * np.sin(a)) for a in e)])
        cameras.set_data([0, 0], [camera, camera - baseline])
        clouds[0].set_data(np.hypot(cloud[:, 0], cloud[:, 1]), cloud[:, 2] + camera)
        clouds[1].set_data(cloud[:, 0], cloud[:, 1])
        objects[0].set_data([rho], [z])
        objects[1].set_data([x], [y])
        ray.set_data([0, x], [0, y])
        outline.set_data(*ellipse(covariance[:2, :2], np.array([x, y])).T)
        parallax = np.diff([np.arcsin(v[2]) for v in (upper, lower)])[0] / PIXEL
        lines = [
            f"d {d:.2f} m, horizontal range {rho:.2f} m, parallax e_l - e_u {parallax:.1f} pixels",
            f"sigma along the ray {along_sigma:.2f} m, across {across_sigma:.3f} m; "
            f"no distance (parallel or diverging): {(outcomes != OK).mean():.0%} of the measurements",
        ]
        alt = f"Two rays from the side and the error ellipse from above. {' '.join(lines)}"
        return Drawing(live.png(), alt, "\n".join(lines))

    controls = [
        Slider("x", "object: x, forward [m]", 0.5, 9.0, 5.0, 0.1),
        Slider("y", "object: y, left [m]", -3.0, 3.0, 1.0, 0.1),
        Slider("z", "object: height of its centre [m]", 0.0, 2.5, 0.5, 0.1),
        Slider("camera", "upper camera: height [m]", 1.0, 2.5, 1.44, 0.02),
        Slider("baseline", "baseline B [m]", 0.05, 0.9, 0.3, 0.05),
        Slider("sigma", "noise of every angle [pixels]", 0.0, 4.0, 1.0, 0.25),
    ]
    return Panel("14 distance and error ellipse", controls, draw)


def scene_recording() -> StereoRecording:
    """The recording that `scene` is of."""
    return read_stereo_recording(data_path("room/experiment_2"))


def ranges_of_one_object(name: str, number: int) -> dict[str, float]:
    """Horizontal ranges [m] of one object of the room at one place: the map's, and three measured ones.

    From the boxes around what is visible, from those around the whole object, and from its matched features.
    Raises `KeyError` for an unknown place, `ValueError` where an image does not show the object.
    """
    one, pair = scene(name), pair_of(scene_recording(), name)
    size, baseline = (one.upper.features.width, one.upper.features.height), one.rig.baseline
    upper, lower = (view.numbers.index(number) for view in (one.upper, one.lower))
    found = match_views(one.upper.view(), one.lower.view(), one.rig)
    (match,) = [m for m in found.matches if (m.upper, m.lower) == (upper, lower)]
    seen = [{t.number: t for t in things}[number] for things in (pair.upper_objects, pair.lower_objects)]
    return {
        "map": float(np.linalg.norm(room_map().positions[number] - pair.pose[:2])),
        "boxes of what is visible": box_range(*(t.visible_box for t in seen), baseline, size),
        "boxes of the whole object": box_range(*(t.unoccluded_box for t in seen), baseline, size),
        "features": disparity_distance(match, *size, baseline).horizontal_range,
    }


def typical_error(measured: np.ndarray, true: np.ndarray, bins: Sequence[tuple[float, float]]) -> list[float]:
    """Median of |measured - true| [m] of the objects whose true range lies in each bin (least, greatest) [m]."""
    error = np.abs(measured - true)
    return [float(np.nanmedian(error[(true >= low) & (true < high)])) for low, high in bins]


PANELS = {"14 distance and error ellipse": triangulation_panel}
