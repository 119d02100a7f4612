"""Make the rooms of projects P2 and P3: photograph each room, and note what the method of paper 2 sees in it."""

import json
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from course_lib.files import atomic_write
from course_lib.spherical_stereo.detection.detector import YoloDetector
from courseware.experiments import observed_rooms
from courseware.experiments.room import localize_pair
from courseware.experiments.runner import kept_rows
from courseware.simulation.room.look_alike_recording import RecordingModels, surveyed_room

POSES = 4  # at each of the paper's two heights


def record_room(seed: int, detector, poses: int = POSES, models: RecordingModels = observed_rooms.MODELS) -> dict:
    """Make a room, photograph and survey it, and note what the method sees from each pose; for JSON.

    detector: the network, or its folder.
    """
    detector = YoloDetector.load(detector) if isinstance(detector, str) else detector
    room, semantic_map = surveyed_room(seed, models)
    views = []
    for _, localizer, pair in observed_rooms.photographed_pairs(room, semantic_map, seed, poses, models, detector):
        result = localize_pair(pair, localizer)
        found = result.localization
        views.append(
            {
                "pose": np.round(pair.pose, 4).tolist(),
                "baseline": localizer.rig.baseline,
                "size": result.size,
                "upper": _rounded([[d.label, d.score, d.box, _hue(d), d.saturation] for d in found.upper_detections]),
                "lower": _rounded([[d.label, d.score, d.box, _hue(d), d.saturation] for d in found.lower_detections]),
                "observations": _rounded(observed_rooms.record_of_observations(found.observations)),
                "shows": list(result.true_landmarks),
            }
        )
    landmarks = _rounded([[one.label, one.x, one.y, _hue(one), one.saturation] for one in semantic_map.landmarks])
    about = {"seed": seed, "look_alike": room.objects[0].label, "map": landmarks}
    return {**about, "walls": semantic_map.walls.tolist(), "views": views}


def _hue(one) -> float | None:
    """Return a hue as JSON holds it. 359.99999 is rounded to 0, not to 360."""
    return None if np.isnan(one.hue) else round(one.hue, 4) % 360.0


def _rounded(value):
    """Return the numbers of a nested list to four decimals."""
    if isinstance(value, list | tuple):
        return [_rounded(one) for one in value]
    return round(value, 4) if isinstance(value, float) else value


def write_rooms(
    path: Path, seeds: Sequence[int], detector: Path, work: Path, processes: int | None = None,
    progress: Callable = iter,
) -> int:  # fmt: skip
    """Write the rooms of these seeds into a file, and return the number of their views.

    detector: folder of the network. work: folder of finished rooms. A run that was stopped goes on from there.
    """
    points = [{"seed": seed, "detector": str(detector.absolute())} for seed in seeds]
    rooms = kept_rows(record_room, points, Path(work) / f"{path.stem}.jsonl", processes, progress)
    text = json.dumps({"version": 1, "rooms": rooms}, separators=(",", ":"))
    atomic_write(path, text.replace('{"seed"', '\n{"seed"') + "\n")
    return sum(len(room["views"]) for room in rooms)
