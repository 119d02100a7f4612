"""A pair of panoramas for lesson 20: the reader's own folder, else one pair of the simulated room."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from course_lib.experiments.room import exact_detections
from course_lib.files import is_given
from course_lib.lessons.kit.room_photographs import room_map, room_recording
from course_lib.plots import figures
from course_lib.plots.panorama_drawing import draw_box, panorama
from course_lib.spherical_stereo.matching.features import FeatureMatches
from course_lib.spherical_stereo.panorama import (
    StereoRig,
    View,
    azimuth_elevation_of_pixel,
    open_pair,
    read_panorama,
)
from course_lib.spherical_stereo.pose.localization import Localization
from course_lib.spherical_stereo.ranging.object_positions import MeasuredObject, measure_objects
from course_lib.spherical_stereo.recording import read_stereo_boxes
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

STAND_IN_PAIR = 3  # of the room's experiment 1: most objects in view (chosen)
NEAR = 0.02
"""Radians of vertical disparity: nearer than fifty baselines, so that a row more or less is not everything (chosen)."""
IMAGE_ENDINGS = (".png", ".jpg", ".jpeg")
MAP_FILES = ("map.json", "map.csv")
_DRAWN_SHARE = (0.2, 0.85)  # of the image's height: neither ceiling nor tripod


class MissingPanoramaError(FileNotFoundError):
    """A folder without an upper or a lower panorama."""


class MissingBaselineError(ValueError):
    """A pair of panoramas of which nobody said how far apart its cameras stood."""


class AmbiguousFileError(ValueError):
    """A folder with two files of which one must be meant."""


class NoNearFeatureError(ValueError):
    """A pair of panoramas in which no matched feature is near enough to measure its distance."""


class PanoramaPair(NamedTuple):
    """Two panoramas of one rig, with boxes, map and true pose where there are any."""

    name: str
    upper: np.ndarray
    """`(H, W, 3)` uint8 BGR."""
    lower: np.ndarray
    rig: StereoRig
    upper_detections: Sequence
    """From boxes drawn by hand; empty where there are none."""
    lower_detections: Sequence
    semantic_map: SemanticMap | None
    true_pose: np.ndarray | None
    """[x, y, theta], metres and radians."""

    @property
    def size(self) -> tuple[int, int]:
        """Width and height, pixels."""
        return self.upper.shape[1], self.upper.shape[0]

    def views(self) -> tuple[View, View]:
        """Both as the library hands them on, with their detections."""
        upper, lower = open_pair(self.upper, self.lower)
        return upper.replace(detections=self.upper_detections), lower.replace(detections=self.lower_detections)


def panorama_pair(
    folder: str | Path | None = None, baseline: float | None = None, boxes: str | Path | None = None
) -> PanoramaPair:
    """The reader's pair: upper and lower image, and where they are there, boxes.json and map.json or map.csv.

    folder: None for the course's stand-in. baseline: metres between the cameras. boxes: a boxes file elsewhere.
    Raises `MissingPanoramaError`, `MissingBaselineError`, `AmbiguousFileError`, and what reading the files raises.
    """
    if folder is None:
        return _stand_in()
    folder = Path(folder)
    upper, lower = (read_panorama(_image(folder, side)) for side in ("upper", "lower"))
    open_pair(upper, lower)
    if baseline is None:
        raise MissingBaselineError(f"how many metres is the upper camera of {folder.name} above the lower one?")
    if boxes is None and is_given(folder / "boxes.json"):
        boxes = folder / "boxes.json"
    views = read_stereo_boxes(boxes).on(upper, lower) if boxes is not None else ()
    detections = [view.detections for view in views] or ([], [])
    path = _only_one(folder, MAP_FILES)
    semantic_map = SemanticMap.load(path) if path else None
    return PanoramaPair(folder.name, upper, lower, StereoRig(baseline), *detections, semantic_map, None)


def near_features(features: FeatureMatches) -> np.ndarray:
    """Indices of the matched features whose vertical disparity is above `NEAR`. Raises `NoNearFeatureError`."""
    found = np.flatnonzero(features.epipolar & (features.vertical_disparity > NEAR))
    if found.size == 0:
        kept = int(np.sum(features.epipolar))
        raise NoNearFeatureError(
            f"{len(features)} features of the two panoramas match, {kept} of them within their column, none of them "
            f"nearer than {1 / NEAR:.0f} baselines: are both images sharp, upright, of one place, moment and rig?"
        )
    return found


def _image(folder: Path, side: str) -> Path:
    path = _only_one(folder, [f"{side}{ending}" for ending in IMAGE_ENDINGS])
    if path is None:
        raise MissingPanoramaError(f"no {side} panorama in {folder}: name it {side}.png or {side}.jpg")
    return path


def _only_one(folder: Path, names: Sequence[str]) -> Path | None:
    """The file of one of these names; None for none. Raises `AmbiguousFileError` for two."""
    found = [folder / name for name in names if is_given(folder / name)]
    if len(found) > 1:
        told = " and ".join(path.name for path in found)
        raise AmbiguousFileError(f"{folder} has {told}, and one of them is read: leave that one there")
    return found[0] if found else None


def _stand_in() -> PanoramaPair:
    recorded = room_recording(1)
    pair = recorded.pairs[STAND_IN_PAIR]
    upper, lower = pair.images()
    detections = [
        exact_detections(objects, image)[0]
        for objects, image in ((pair.upper_objects, upper), (pair.lower_objects, lower))
    ]
    return PanoramaPair("stand-in: the simulated room", upper, lower, recorded.rig, *detections, room_map(), pair.pose)


def disparity_picture(pair: PanoramaPair, features: FeatureMatches) -> Figure:
    """The upper panorama with its boxes, and every matched feature coloured by its vertical disparity in pixels."""
    figure, axes = figures.new_figure(size=(8.2, 3.4))
    panorama(axes, pair.upper, f"Upper camera: {len(features)} features found again below")
    for one in pair.upper_detections:
        draw_box(axes, one.box, pair.size[0], one.label)
    good = features.epipolar
    rows = features.vertical_disparity[good] * pair.size[1] / np.pi
    low, high = np.percentile(rows, (2, 98)) if good.any() else (0.0, 1.0)
    points = axes.scatter(*features.keypoints_upper[good].T, c=rows, s=6, cmap="cividis", vmin=low, vmax=high)
    axes.set_ylim(_DRAWN_SHARE[1] * pair.size[1], _DRAWN_SHARE[0] * pair.size[1])
    figure.colorbar(points, ax=axes, label="vertical disparity [pixels]", shrink=0.8)
    return figure


def horizontal_ranges(
    keypoints_upper: np.ndarray, keypoints_lower: np.ndarray, width: int, height: int, baseline: float
) -> np.ndarray:
    """Return horizontal ranges `(k,)` in metres of matched features `(k, 2)`: rho = baseline / (tan e_l - tan e_u).

    A match whose disparity is not positive gives infinity. Source: paper 2, section 2.4.
    """
    (_, upper), (_, lower) = (
        azimuth_elevation_of_pixel(keypoints, width, height) for keypoints in (keypoints_upper, keypoints_lower)
    )
    slope = np.tan(lower) - np.tan(upper)
    return np.where(slope > 0, baseline / np.where(slope > 0, slope, 1.0), np.inf)


def measured_objects(pair: PanoramaPair, matches: Sequence, baseline: float | None = None) -> list[MeasuredObject]:
    """Both distances of every matched object. baseline: metres, in place of the rig's."""
    rig = pair.rig if baseline is None else StereoRig(baseline)
    return measure_objects(matches, *pair.views(), rig)


def distances_table(objects: Sequence[MeasuredObject], most: int = 8) -> str:
    """The first objects with their two horizontal distances, metres; a line that says so where there are none."""
    if not objects:
        return "0 objects: draw boxes on both images (boxes.json), or load a detector that knows your classes"
    lines = [f"{'object':14} {'features':>8} {'from box centres [m]':>21} {'from disparities [m]':>21}"]
    for one in list(objects)[:most]:
        cells = [
            f"{way.horizontal_range_m:21.2f}" if way.outcome == "ok" else f"{way.outcome:>21}"
            for way in (one.box_centre, one.disparity)
        ]
        lines.append(f"{one.label:14} {one.n_matches:>8} {''.join(cells)}")
    return "\n".join(lines)


def fit_text(found: Localization, true_pose: np.ndarray | None) -> str:
    """What came of a localization, in a line: median residual, and the error where the truth is known."""
    if found.pose is None:
        return f"unable: {found.reason}"
    residual = np.median(np.linalg.norm(found.residuals, axis=1))
    text = f"{len(found.used_pairs)} pairs, median residual {residual:.2f} m"
    if true_pose is None:
        return f"{text}, pose ({found.pose.x:.2f}, {found.pose.y:.2f}) m"
    return f"{text}, position wrong by {np.hypot(*(np.array(found.pose[:2]) - true_pose[:2])):.2f} m"
