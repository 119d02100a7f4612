"""Lost and found: kidnap the camera, start it anywhere, leave it in peace, and count how often it finds itself.

A recording is played to some frame, then nothing is seen for a while, and it goes on from a frame in another place:
a kidnapping. Gravity is what an accelerometer would say: the truth's, with a degree of noise.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

import numpy as np

from course_lib.beyond.lost_and_found.global_search import GlobalSearch
from course_lib.beyond.lost_and_found.recovery import RecoveringLocalizer
from course_lib.depth_mcl.evaluation import pose_errors
from course_lib.depth_mcl.localizer import NoMeasurementWarning
from course_lib.depth_mcl.sequence import DepthSequence, read_sequence
from course_lib.experiments.runner import Outcome, Runner
from course_lib.files import temporary_folder
from course_lib.geometry import optical_pose, state_from_optical_pose
from course_lib.paths import data_path
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from course_lib.simulation.corridor.seeded_recording import building_of_data, record_seed

GRAVITY_SIGMA = np.deg2rad(1.0)
RIGHT = 0.20, 20.0  # metres, degrees: within both, a place is the right one
BEFORE, COVERED, AFTER = 12, 5, 30  # frames of a kidnapping: followed, nothing seen, elsewhere
MIN_JUMP = 1.0, 40.0  # metres, degrees: a kidnapping moves the camera by one of them at least
START_FRAMES = 20


def run(runner: Runner, *, seeds: list[int], recording: Path | None, data: Path | None) -> Outcome:
    """Run `demo lost`: the trials that are missing, then all of them together."""
    if recording:
        read_sequence(recording).require_poses()  # told now, not after the first run
        folder = recording.absolute()
        function, common = trial, {"map_file": str(folder / "map.ply"), "sequence": str(folder)}
    else:
        function, common = corridor_trial, {"data": str((data or data_path("corridor")).absolute())}
    trials = runner.rows(function, [{**common, "seed": seed} for seed in seeds], "lost", "trial")
    result = {"seeds": seeds, **summarize(trials)}
    return Outcome(result, lost_table(result), {"lost.json": (result, None)})


def trial(map_file: str, sequence: str, seed: int) -> dict[str, dict]:
    """One trial: a kidnapping, a start from anywhere, and the recording in peace."""
    return {
        "kidnapped": kidnapping(map_file, sequence, seed),
        "start": start_anywhere(map_file, sequence, seed),
        "in peace": undisturbed(map_file, sequence, seed),
    }


def corridor_trial(data: str, seed: int) -> dict[str, dict]:
    """The same on a recording of the seed's own, carried by hand through the corridor."""
    with temporary_folder() as temporary:
        folder = temporary / "hand"
        record_seed(folder, building_of_data(data), seed, carried="hand")
        return trial(str(Path(data) / "map.ply"), str(folder), seed)


def summarize(trials: Sequence[dict[str, dict]]) -> dict[str, float | None]:
    """The numbers of the table, of some trials; `frames_to_recover` is None where no camera recovered."""
    recovered = (one["kidnapped"]["frames_to_recover"] for one in trials)
    frames_to_recover = [frames for frames in recovered if frames is not None]
    starts = [t["start"] for t in trials]
    found = [s for s in starts if s["status"] == "found"]
    return {
        "trials": len(trials),
        "kidnapped_recovered": len(frames_to_recover),
        "frames_to_recover": float(np.median(frames_to_recover)) if frames_to_recover else None,
        "started_right": sum(s["right"] for s in found),
        "started_wrong": sum(not s["right"] for s in found),
        "started_several": sum(s["status"] == "several" for s in starts),
        "frames_to_start": float(np.median([s["frames"] for s in starts])),
        "particles_to_start": float(np.median([s["particles"] for s in starts])),
        "seconds_to_start": float(np.median([s["seconds"] for s in starts])),
        "undisturbed_frames": sum(t["in peace"]["frames"] for t in trials),
        "false_alarms": sum(t["in peace"]["alarms"] for t in trials),
    }


def lost_table(s: dict) -> str:
    """Return `summarize` in words."""
    of = f"of {s['trials']}"
    median = "-" if s["frames_to_recover"] is None else f"{s['frames_to_recover']:.0f}"
    return "\n".join(
        [
            f"kidnapped           {s['kidnapped_recovered']} {of} recovered within 30 frames (median {median})",
            f"started anywhere    {s['started_right']} {of} in the right place within 20 frames, "
            f"{s['started_wrong']} in a wrong one, {s['started_several']} said: several",
            f"                    median {s['frames_to_start']:.0f} frames, {s['particles_to_start']:,.0f} particles, "
            f"{s['seconds_to_start']:.0f} s",
            f"left in peace       {s['false_alarms']} false alarms in {s['undisturbed_frames']} frames",
        ]
    )


def kidnapping(map_file: str, sequence: str, seed: int) -> dict:
    """One kidnapping, drawn with the seed: whether and after how many frames the camera was found again."""
    recording, rng = read_sequence(sequence), np.random.default_rng([seed, 11])
    first, after = _places_of_kidnapping(recording, rng)
    frames = [*range(first, first + BEFORE), *[None] * COVERED, *range(after, after + AFTER)]
    statuses, recovered = [], None
    with warnings.catch_warnings(), DepthRenderer(SceneMap.load(map_file), recording.camera()) as renderer:
        warnings.simplefilter("ignore", NoMeasurementWarning)  # the camera is covered on purpose
        localizer = RecoveringLocalizer(renderer, seed=seed)
        localizer.initialize(state_from_optical_pose(recording.camera_to_world[first]))
        for number, depth, pose in _played(recording, frames):
            found = localizer.step(depth, gravity=None if pose is None else gravity_in_camera(pose, rng))
            statuses.append(found.estimate.status)
            if number >= BEFORE + COVERED and recovered is None and found.estimate.status == "tracked":
                if _right(found.estimate.state, pose):
                    recovered = number - BEFORE - COVERED + 1
    return {"from": first, "to": after, "frames_to_recover": recovered, "last_status": statuses[-1]}


def undisturbed(map_file: str, sequence: str, seed: int) -> dict:
    """A recording in peace: in how many of its frames a search began."""
    recording, rng = read_sequence(sequence), np.random.default_rng([seed, 12])
    alarms = 0
    with DepthRenderer(SceneMap.load(map_file), recording.camera()) as renderer:
        localizer = RecoveringLocalizer(renderer, seed=seed)
        localizer.initialize(state_from_optical_pose(recording.camera_to_world[0]))
        for _, depth, pose in _played(recording, range(len(recording))):
            before = localizer.searching
            localizer.step(depth, gravity=gravity_in_camera(pose, rng))
            alarms += localizer.searching and not before
    return {"frames": len(recording), "alarms": alarms}


def start_anywhere(map_file: str, sequence: str, seed: int) -> dict:
    """A global start at a frame that the seed draws: when it was found, whether rightly, with how many particles."""
    recording, rng = read_sequence(sequence), np.random.default_rng([seed, 13])
    first = int(rng.integers(0, len(recording) - START_FRAMES))
    with DepthRenderer(SceneMap.load(map_file), recording.camera()) as renderer:
        search, begun = GlobalSearch(renderer, seed=seed), time.perf_counter()
        particles, renders, frames = 0, 0, 0
        for _, depth, pose in _played(recording, range(first, first + START_FRAMES)):
            candidates = search.step(depth, gravity_in_camera(pose, rng))
            particles, renders, frames = particles + candidates.particles, renders + candidates.renders, frames + 1
            if candidates.status == "found":
                break
    right = [_right(one.state, pose) for one in candidates.poses]
    return {
        "frame": first,
        "status": candidates.status,
        "right": any(right[:1]),
        "right_among_places": any(right),
        "frames": frames,
        "particles": particles,
        "renders": renders,
        "seconds": time.perf_counter() - begun,
    }


def gravity_in_camera(camera_to_world: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """What an accelerometer at rest says is down, `(3,)` in the optical frame, with noise."""
    return -camera_to_world[2, :3] + GRAVITY_SIGMA * rng.standard_normal(3)


def _played(
    recording: DepthSequence, frames: Iterable[int | None]
) -> Iterator[tuple[int, np.ndarray, np.ndarray | None]]:
    """Number, depth image and true pose of frames; None among them is a frame in which nothing is seen."""
    for number, index in enumerate(frames):
        if index is None:
            yield number, np.full(recording.image_shape, np.nan, dtype=np.float32), None
        else:
            yield number, recording.depth(index), recording.camera_to_world[index]


def _places_of_kidnapping(recording: DepthSequence, rng: np.random.Generator) -> tuple[int, int]:
    """The first frame before and the first after, far enough apart; `ValueError` where the recording is too short."""
    last = len(recording) - AFTER
    for _ in range(1_000):
        first, after = int(rng.integers(0, last)), int(rng.integers(0, last + 1))
        if first + BEFORE <= len(recording):
            end = recording.camera_to_world[first + BEFORE - 1]
            position, rotation = pose_errors(end, recording.camera_to_world[after])
            if position >= MIN_JUMP[0] or np.rad2deg(rotation) >= MIN_JUMP[1]:
                return first, after
    raise ValueError(f"{recording!r} has no two places {MIN_JUMP[0]} m apart with {AFTER} frames after them")


def _right(state: np.ndarray, true: np.ndarray) -> bool:
    position, rotation = pose_errors(optical_pose(state), true)
    return bool(position <= RIGHT[0] and np.rad2deg(rotation) <= RIGHT[1])
