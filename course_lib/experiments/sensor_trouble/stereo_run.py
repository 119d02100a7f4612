"""Paper 2's method, with the library's own matcher, on walks through generated rooms with troubles.

The method has no memory: a pair that is as it was undisturbed has the very answer that it had undisturbed, which is
looked up and not computed again. So it has recovered with the first good pair, by construction.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from course_lib.beyond.guarded_stereo import NO_IMAGE, GuardedRig
from course_lib.beyond.look_alikes.consistent import associate_consistent
from course_lib.experiments.look_alikes import LARGEST_ERROR_M, LARGEST_TURN_DEG, pose_errors
from course_lib.experiments.sensor_trouble.panoramas import PERIOD, TROUBLES, Pair, troubled_walk
from course_lib.experiments.sensor_trouble.placing import Arrival, generator
from course_lib.experiments.sensor_trouble.score import Gate
from course_lib.files import temporary_folder
from course_lib.simulation.room.look_alike_recording import (
    RecordingModels,
    WalkModel,
    experiment_of,
    photograph_walks,
    surveyed_room,
)
from course_lib.simulation.room.measurement_places import CAMERA_HEIGHTS
from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.panorama import StereoRig
from course_lib.spherical_stereo.pose.localization import OK

GATE = Gate(LARGEST_ERROR_M, LARGEST_TURN_DEG)


class RememberedAnswers:
    """A `SemanticLocalizer` that is asked once for each pair of images: arrays that are the same objects."""

    def __init__(self, localizer: SemanticLocalizer) -> None:
        self._localizer = localizer
        self._answers: dict[tuple[int, int], tuple] = {}

    def localize(self, upper: np.ndarray, lower: np.ndarray):
        """The localizer's answer."""
        key = id(upper), id(lower)
        if key not in self._answers:
            # The images are kept with the answer, so that no other array can come to have their identity.
            self._answers[key] = upper, lower, self._localizer.localize(upper, lower)
        return self._answers[key][2]


def watched_pairs(localizer, arrivals: Sequence[Arrival], true_poses: np.ndarray) -> list[dict]:
    """What became of every pair that was due: outcome, whether a pose was given, its errors (None without one).

    localizer: `SemanticLocalizer`, or one that remembers. true_poses: `(T, 3)` [x, y, heading].
    """
    rig = GuardedRig(localizer, PERIOD)
    frames = []
    for arrival, true in zip(arrivals, true_poses, strict=True):
        if arrival.image is None:
            frames.append({"outcome": NO_IMAGE, "confident": False, "position_m": None, "rotation_deg": None})
            continue
        watched = rig.localize(*arrival.image, arrival.time)
        pose = None if watched.localization is None else watched.localization.pose
        dx, dy, turn = pose_errors(pose, true)
        frames.append(
            {
                "outcome": watched.outcome,
                "confident": watched.outcome == OK,
                "position_m": None if pose is None else float(np.hypot(dx, dy)),
                "rotation_deg": None if pose is None else turn,
            }
        )
    return frames


def room_trouble(detector: str, seed: int, frames: int, shares: Sequence[float]) -> dict:
    """A point of a sweep: a walk through a seed's room undisturbed, and with every trouble at every share (0 to 1).

    detector: folder of the network. As `depth_run.corridor_trouble` gives it.
    """
    models = RecordingModels()
    room, semantic_map = surveyed_room(seed, models)
    with temporary_folder() as folder:
        walk = next(photograph_walks(folder, room, seed, 1, frames, models, WalkModel()))
    upper, lower = CAMERA_HEIGHTS[experiment_of(0)]
    localizer = SemanticLocalizer(
        StereoRig(round(upper - lower, 6), upper),
        semantic_map,
        YoloDetector.load(detector),
        association=associate_consistent,
    )
    pairs = [(view.upper_image, view.lower_image) for view in walk]
    return troubles_of(localizer, pairs, np.array([view.pose for view in walk]), seed, shares)


def troubles_of(
    localizer: SemanticLocalizer,
    pairs: Sequence[Pair],
    true_poses: np.ndarray,
    seed: int,
    shares: Sequence[float],
    troubles: Sequence[str] = TROUBLES,
) -> dict:
    """`room_trouble` of a walk that was photographed."""
    remembering = RememberedAnswers(localizer)
    calm = watched_pairs(remembering, [Arrival(pair, PERIOD * k) for k, pair in enumerate(pairs)], true_poses)
    rows = []
    for trouble in troubles:
        for share in shares:
            arrivals, runs = troubled_walk(trouble, pairs, share, generator(seed, trouble, share))
            frames = watched_pairs(remembering, arrivals, true_poses)
            rows.append({"trouble": trouble, "share": share, "runs": runs, "frames": frames})
    return {"undisturbed": calm, "troubles": rows}
