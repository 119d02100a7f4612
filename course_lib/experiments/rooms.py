"""Paper 2's experiment in rooms that nobody shaped: a room a seed, made on the fly, 20 poses at both heights in each.

What takes long, photographs, detection, stereo matching and triangulation (sections 2.2 to 2.4), is done once for each
room and kept in a file: the observations, and what each of them really shows. What follows, map matching and fit
(2.5, 2.6), is done anew whenever the rooms are summarized (`rooms_summary`), so that every variant of it is judged on
the same observations.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path

import cv2
import numpy as np

from course_lib.experiments.detector_evaluation import match_image
from course_lib.experiments.results import write_results
from course_lib.experiments.room import SOURCES, PairResult, localize_pair
from course_lib.experiments.sweeps import finished
from course_lib.files import temporary_folder
from course_lib.simulation.room.look_alike_recording import RecordingModels, photograph_room, surveyed_room
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.recording import read_stereo_recording
from course_lib.spherical_stereo.semantic_map.association import Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap
from course_lib.worker_pool import worker_pool


@dataclass(frozen=True)
class RoomsOptions:
    """What the observations of a room depend on, beside its seed.

    poses: at each height. models: how rooms are made. detector: words that tell one network from another, such as its
    checksum; results of another one are not reused.
    """

    poses: int = 20
    models: RecordingModels = field(default_factory=RecordingModels)
    detector: str = ""

    def as_dict(self) -> dict:
        """As JSON reads it back: what a stored room is compared with."""
        return json.loads(json.dumps(asdict(self)))


Observe = Callable[[int, RoomsOptions, object], dict]
LoadDetector = Callable[[], object]  # a plain function of a module, or a partial of one: it is sent to other processes


def observe_room(seed: int, options: RoomsOptions, detector) -> dict:
    """Make a room, photograph and survey it, and note what the method sees from each pose; for JSON.

    detector: anything with `detect(image_bgr)`. Source: paper 2, sections 2.2 to 2.4 and 3.
    """
    room, semantic_map = surveyed_room(seed, options.models)
    alike = room.objects[0].label
    poses = []
    with temporary_folder() as temporary:
        folders = photograph_room(temporary, room, seed, options.poses, options.models)
        for number, folder in enumerate(folders, start=1):
            recording = read_stereo_recording(folder)
            localizer = SemanticLocalizer(
                recording.rig,
                semantic_map,
                detector,
                image_size=(recording.width, recording.height),
                reject_implausible=False,
            )
            for pair in recording.pairs:
                results = {source: localize_pair(pair, localizer, source) for source in SOURCES}
                poses.append({"experiment": number, "name": pair.name, "pose": pair.pose.tolist()} | _seen(results))
    return {
        "seed": seed,
        "options": options.as_dict(),
        "look_alike": {"label": alike, "n": sum(thing.label == alike for thing in room.objects)},
        "map": [[one.label, one.x, one.y, _or_none(one.hue), one.saturation] for one in semantic_map.landmarks],
        "walls": semantic_map.walls.tolist(),
        "poses": poses,
    }


def _seen(results: dict[str, PairResult]) -> dict:
    """Observations and their truth by source; how the detector did on the two images; seconds from images to pose."""
    from_images = results["images"]
    found, pair, width = from_images.localization, from_images.pair, from_images.size[0]
    counted = [
        match_image(detections, objects, width)
        for detections, objects in (
            (found.upper_detections, pair.upper_objects),
            (found.lower_detections, pair.lower_objects),
        )
    ]
    return {
        "sources": {
            source: {
                "observations": record_of_observations(result.localization.observations),
                "true_landmarks": list(result.true_landmarks),
            }
            for source, result in results.items()
        },
        "objects": sum(one.n_objects for one in counted),
        "found": sum(int(one.correct.sum()) for one in counted),
        "detections": sum(len(one.correct) for one in counted),
        "seconds": from_images.seconds,
    }


def record_of_observations(observations: Sequence[Observation]) -> list[list]:
    """Observations as a room's record holds them: label, x, y, hue (None: grey), saturation, covariance."""
    return [
        [one.label, one.x, one.y, _or_none(one.hue), one.saturation, np.asarray(one.covariance).tolist()]
        for one in observations
    ]


def stored_observations(entry: dict) -> list[Observation]:
    """The observations of one pose and source, from a room's record."""
    return [
        Observation(label, x, y, np.nan if hue is None else hue, saturation, np.array(covariance))
        for label, x, y, hue, saturation, covariance in entry["observations"]
    ]


def stored_map(room: dict) -> SemanticMap:
    """The semantic map of a room's record."""
    return SemanticMap(
        [Landmark(label, x, y, np.nan if hue is None else hue, s) for label, x, y, hue, s in room["map"]],
        walls=room.get("walls"),
    )


def observe_rooms(
    seeds: Sequence[int],
    options: RoomsOptions,
    load_detector: LoadDetector,
    folder: str | Path,
    processes: int = 1,
    progress: Callable[[Iterable], Iterable] = iter,
    observe: Observe | None = None,
) -> list[dict]:
    """The records of many rooms, in the order of the seeds; rooms that the folder holds already are not made again.

    observe: what makes the record of one room; None: `observe_room`. `room_views.observe_views` has options of its own.

    Every finished room is written to the folder at once as room_SEED.json, and read back when the options agree.
    load_detector: called once in every process. processes: how many rooms are made at a time, each in a fresh process
    (an OpenGL window belongs to one). progress: wraps the loop over the rooms that are still to be made (tqdm).
    Raises `ValueError` for negative seeds or fewer than one process.
    """
    if processes < 1 or any(seed < 0 for seed in seeds):
        raise ValueError(f"processes {processes}, seeds {list(seeds)}: expected one or more, and no negative seed")
    folder, observe = Path(folder), observe or observe_room
    rooms = {seed: _read_room(folder, seed, options) for seed in seeds}
    missing = [seed for seed, room in rooms.items() if room is None]
    if processes == 1 or len(missing) <= 1:
        detector = load_detector() if missing else None
        for seed in progress(missing):
            rooms[seed] = _keep(folder, observe(seed, options, detector))
        return [rooms[seed] for seed in seeds]
    with worker_pool(min(processes, len(missing)), _start_worker, (load_detector,)) as pool:
        jobs = [pool.submit(_observe_in_worker, observe, seed, options) for seed in missing]
        for job in progress(finished(jobs)):
            room = _keep(folder, job.result())
            rooms[room["seed"]] = room
    return [rooms[seed] for seed in seeds]


_worker: dict = {}


def _start_worker(load_detector: LoadDetector) -> None:
    # One room a core: what draws and what computes must not start threads for every core again.
    os.environ["LP_NUM_THREADS"] = "1"
    cv2.setNumThreads(1)
    _worker["detector"] = load_detector()


def _observe_in_worker(observe: Observe, seed: int, options: RoomsOptions) -> dict:
    return observe(seed, options, _worker["detector"])


def _file(folder: Path, seed: int) -> Path:
    return folder / f"room_{seed:05d}.json"


def _keep(folder: Path, room: dict) -> dict:
    write_results(_file(folder, room["seed"]), room)
    return room


def _read_room(folder: Path, seed: int, options: RoomsOptions) -> dict | None:
    """The stored record of a room, or None where there is none, or one made with other options."""
    try:
        room = json.loads(_file(folder, seed).read_text())
    except (OSError, json.JSONDecodeError):
        return None
    return room if room.get("options") == options.as_dict() else None


def _or_none(hue: float) -> float | None:
    return None if np.isnan(hue) else hue
