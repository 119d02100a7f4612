"""A pair of panoramas for lesson 20: the reader's own folder, else one pair of the simulated room."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from course_lib.files import is_given
from course_lib.spherical_stereo.drawn_boxes import read_stereo_boxes
from course_lib.spherical_stereo.matching.alignment import FeatureMatches
from course_lib.spherical_stereo.panorama import StereoRig, View, azimuth_elevation_of_pixel, open_pair, read_panorama
from course_lib.spherical_stereo.pose.localization import Localization
from course_lib.spherical_stereo.ranging.object_positions import MeasuredObject, measure_objects
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap
from courseware.experiments.room import exact_detections
from courseware.lessons.kit.room_data import room_map, room_recording

STAND_IN_PAIR = 3  # of the room's experiment 1: most objects in view (chosen)
NEAR = 0.02  # radians of vertical disparity: nearer than fifty baselines, so that a row matters little (chosen)


class PanoramaPair(NamedTuple):
    """Two panoramas of one rig, with boxes, map and true pose where there are any."""

    name: str
    upper: np.ndarray  # (H, W, 3) uint8 BGR
    lower: np.ndarray
    rig: StereoRig
    upper_detections: Sequence  # from boxes drawn by hand, may be empty
    lower_detections: Sequence
    semantic_map: SemanticMap | None
    true_pose: np.ndarray | None  # [x, y, theta], metres and radians

    @property
    def size(self) -> tuple[int, int]:
        """Return width and height in pixels."""
        return self.upper.shape[1], self.upper.shape[0]

    def views(self) -> tuple[View, View]:
        """Return both panoramas as the library's views, with their detections."""
        upper, lower = open_pair(self.upper, self.lower)
        return upper.replace(detections=self.upper_detections), lower.replace(detections=self.lower_detections)


def panorama_pair(
    folder: str | Path | None = None, baseline: float | None = None, boxes: str | Path | None = None
) -> PanoramaPair:
    """Read the reader's pair: upper and lower image, and where they are there, boxes.json and map.json or map.csv.

    folder: None for the course's stand-in. baseline: metres between the cameras. boxes: a boxes file elsewhere.
    Raises FileNotFoundError or ValueError if something is missing or doubled, and what reading the files raises.
    """
    if folder is None:
        recorded = room_recording(1)
        pair = recorded.pairs[STAND_IN_PAIR]
        images, objects = pair.images(), (pair.upper_objects, pair.lower_objects)
        detections = [exact_detections(*one)[0] for one in zip(objects, images, strict=True)]
        given = "stand-in: the simulated room", *images, recorded.rig
        return PanoramaPair(*given, *detections, room_map(), pair.pose)
    folder, views = Path(folder), []
    for side in ("upper", "lower"):
        if not (path := _only_one(folder, [f"{side}.png", f"{side}.jpg", f"{side}.jpeg"])):
            raise FileNotFoundError(f"no {side} panorama in {folder}: name it {side}.png or {side}.jpg")
        views.append(read_panorama(path))
    views = open_pair(*views)
    if baseline is None:
        raise ValueError(f"how many metres is the upper camera of {folder.name} above the lower one?")
    if boxes is None and is_given(folder / "boxes.json"):
        boxes = folder / "boxes.json"
    views = views if boxes is None else read_stereo_boxes(boxes).on(*views)
    images, detections = ([getattr(view, name) for view in views] for name in ("image", "detections"))
    semantic_map = SemanticMap.load(path) if (path := _only_one(folder, ["map.json", "map.csv"])) else None
    return PanoramaPair(folder.name, *images, StereoRig(baseline), *detections, semantic_map, None)


def _only_one(folder: Path, names: Sequence[str]) -> Path | None:
    """Return the file of one of these names, None for none. Raises ValueError for two."""
    found = [folder / name for name in names if is_given(folder / name)]
    if len(found) > 1:
        told = " and ".join(path.name for path in found)
        raise ValueError(f"{folder} has {told}, and one of them is read: leave that one there")
    return found[0] if found else None


def near_features(features: FeatureMatches) -> np.ndarray:
    """Return indices of the matched features whose vertical disparity is above `NEAR`. Raises ValueError for none."""
    found = np.flatnonzero(features.epipolar & (features.vertical_disparity > NEAR))
    if found.size == 0:
        raise ValueError(
            f"{len(features)} features of the two panoramas match, {np.sum(features.epipolar)} of them within their "
            f"column, none of them nearer than {1 / NEAR:.0f} baselines: are both images sharp, upright, of one place, "
            "moment and rig?"
        )
    return found


def horizontal_ranges(
    uv_upper: np.ndarray, uv_lower: np.ndarray, width: int, height: int, baseline: float
) -> np.ndarray:
    """Return ranges `(k,)` [m] of matched features `(k, 2)`: rho = baseline / (tan e_l - tan e_u) (paper 2, 2.4)."""
    upper, lower = (azimuth_elevation_of_pixel(uv, width, height)[1] for uv in (uv_upper, uv_lower))
    return baseline / (np.tan(lower) - np.tan(upper))


def measured_objects(pair: PanoramaPair, matches: Sequence, baseline: float | None = None) -> list[MeasuredObject]:
    """Return both distances of every matched object. baseline: metres, in place of the rig's."""
    return measure_objects(matches, *pair.views(), pair.rig if baseline is None else StereoRig(baseline))


def distances_table(objects: Sequence[MeasuredObject]) -> str:
    """Return a table of the first eight objects with both horizontal distances [m], or a line if there are none."""
    if not objects:
        return "0 objects: draw boxes on both images (boxes.json), or load a detector that knows your classes"
    lines = [f"{'object':14} {'features':>8} {'from box centres [m]':>21} {'from disparities [m]':>21}"]
    for one in objects[:8]:
        ways = (one.box_centre, one.disparity)
        cells = [f"{way.horizontal_range_m:.2f}" if way.outcome == "ok" else way.outcome for way in ways]
        lines.append(f"{one.label:14} {one.n_matches:>8} {cells[0]:>21}{cells[1]:>21}")
    return "\n".join(lines)


def fit_text(found: Localization, true_pose: np.ndarray | None) -> str:
    """Return the result of a localization in a line: median residual, and the error where the truth is known."""
    if found.pose is None:
        return f"unable: {found.reason}"
    residual = np.median(np.linalg.norm(found.residuals, axis=1))
    text = f"{len(found.used_pairs)} pairs, median residual {residual:.2f} m"
    if true_pose is None:
        return f"{text}, pose ({found.pose.x:.2f}, {found.pose.y:.2f}) m"
    return f"{text}, position wrong by {np.hypot(*(np.array(found.pose[:2]) - true_pose[:2])):.2f} m"
