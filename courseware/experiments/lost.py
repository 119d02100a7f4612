"""Kidnap the camera, start it anywhere, leave it in peace, and count how often it finds itself.

A kidnapping: a recording is played to some frame, nothing is seen for a while, and it goes on in another place.
"""

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
from course_lib.files import temporary_folder
from course_lib.geometry import optical_pose, state_from_optical_pose
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from courseware.experiments.runner import Outcome, Runner
from courseware.paths import data_path
from courseware.simulation.corridor.seeded_recording import building_of_data, record_seed
from courseware.simulation.room.depth_world import record_walk

GRAVITY_SIGMA = np.deg2rad(1.0)
RIGHT = 0.20, 20.0  # metres, degrees: within both, a place is the right one
BEFORE, COVERED, AFTER = 12, 5, 30  # frames of a kidnapping: followed, nothing seen, elsewhere
MIN_JUMP = 1.0, 40.0  # metres, degrees: a kidnapping moves the camera by one of them at least
START_FRAMES = 20


def run(runner: Runner, *, seeds: list[int], recording: Path | None, data: Path | None, rooms: bool) -> Outcome:
    """Run `demo lost`: the trials that are missing, then all of them together."""
    if recording and rooms:
        raise ValueError("--recording and --rooms name different recordings; give one of them")
    if rooms:
        function, common = room_trial, {}
    elif recording:
        read_sequence(recording).require_poses()  # told now, not after the first run
        folder = recording.absolute()
        function, common = trial, {"map_file": str(folder / "map.ply"), "sequence": str(folder)}
    else:
        function, common = corridor_trial, {"data": str((data or data_path("corridor")).absolute())}
    trials = runner.rows(function, [{**common, "seed": seed} for seed in seeds], "lost", "trial")
    result = {"seeds": seeds, **summarize(trials)}
    return Outcome(result, lost_table(result), {"lost.json": (result, None)})


def trial(map_file: str, sequence: str, seed: int) -> dict[str, dict]:
    """Return one trial: a kidnapping, a start from anywhere, and the recording in peace."""
    recording = read_sequence(sequence)
    parts = {"kidnapped": kidnapping, "start": start_anywhere, "in peace": undisturbed}
    with DepthRenderer(SceneMap.load(map_file), recording.camera()) as renderer:
        return {name: part(recording, renderer, seed) for name, part in parts.items()}


def corridor_trial(data: str, seed: int) -> dict[str, dict]:
    """Return one trial on a recording of the seed's own, carried by hand through the corridor."""
    with temporary_folder() as temporary:
        record_seed(temporary / "hand", building_of_data(data), seed, carried="hand")
        return trial(str(Path(data) / "map.ply"), str(temporary / "hand"), seed)


def room_trial(seed: int) -> dict[str, dict]:
    """Return one trial on a recording of the seed's own, carried by hand through a room (that of `demo walk`)."""
    with temporary_folder() as temporary:
        record_walk(temporary / "walk", seed)
        return trial(str(temporary / "walk" / "map.ply"), str(temporary / "walk"), seed)


def summarize(trials: Sequence[dict[str, dict]]) -> dict[str, float | None]:
    """Return the numbers of the table, of some trials; `frames_to_recover` is None where no camera recovered."""
    kidnapped, starts, peace = ([one[part] for one in trials] for part in ("kidnapped", "start", "in peace"))
    recovered = [one["frames_to_recover"] for one in kidnapped if one["frames_to_recover"] is not None]
    found = [one["right"] for one in starts if one["status"] == "found"]
    return {
        "trials": len(trials),
        "kidnapped_recovered": len(recovered),
        "frames_to_recover": float(np.median(recovered)) if recovered else None,
        "started_right": sum(found),
        "started_wrong": len(found) - sum(found),
        "started_several": sum(one["status"] == "several" for one in starts),
        **{f"{key}_to_start": float(np.median([s[key] for s in starts])) for key in ("frames", "particles", "seconds")},
        "undisturbed_frames": sum(one["frames"] for one in peace),
        "false_alarms": sum(one["alarms"] for one in peace),
    }


def lost_table(s: dict) -> str:
    """Return `summarize` in words."""
    median = "-" if s["frames_to_recover"] is None else f"{s['frames_to_recover']:.0f}"
    return (
        "kidnapped           {kidnapped_recovered} of {trials} recovered within 30 frames (median {median})\n"
        "started anywhere    {started_right} of {trials} in the right place within 20 frames, {started_wrong} in a "
        "wrong one, {started_several} said: several\n"
        "                    median {frames_to_start:.0f} frames, {particles_to_start:,.0f} particles, "
        "{seconds_to_start:.0f} s\n"
        "left in peace       {false_alarms} false alarms in {undisturbed_frames} frames"
    ).format(median=median, **s)


def kidnapping(recording: DepthSequence, renderer: DepthRenderer, seed: int) -> dict:
    """Return whether and after how many frames the camera was found again after a kidnapping that the seed draws."""
    rng = np.random.default_rng([seed, 11])
    first, after = _places_of_kidnapping(recording, rng)
    frames = [*range(first, first + BEFORE), *[None] * COVERED, *range(after, after + AFTER)]
    localizer, recovered = RecoveringLocalizer(renderer, seed=seed), None
    localizer.initialize(state_from_optical_pose(recording.camera_to_world[first]))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", NoMeasurementWarning)  # the camera is covered on purpose
        for number, (depth, gravity, pose) in enumerate(_played(recording, frames, rng)):
            estimate = localizer.step(depth, gravity=gravity).estimate
            back = number >= BEFORE + COVERED and estimate.status == "tracked" and _right(estimate.state, pose)
            if back and recovered is None:
                recovered = number - BEFORE - COVERED + 1
    return {"from": first, "to": after, "frames_to_recover": recovered, "last_status": estimate.status}


def undisturbed(recording: DepthSequence, renderer: DepthRenderer, seed: int) -> dict:
    """Return in how many frames of a recording in peace a search began."""
    localizer, alarms = RecoveringLocalizer(renderer, seed=seed), 0
    localizer.initialize(state_from_optical_pose(recording.camera_to_world[0]))
    for depth, gravity, _ in _played(recording, range(len(recording)), np.random.default_rng([seed, 12])):
        before = localizer.searching
        localizer.step(depth, gravity=gravity)
        alarms += localizer.searching and not before
    return {"frames": len(recording), "alarms": alarms}


def start_anywhere(recording: DepthSequence, renderer: DepthRenderer, seed: int) -> dict:
    """Return when a global start at a frame that the seed draws was found, whether rightly, and the particles."""
    rng = np.random.default_rng([seed, 13])
    first = int(rng.integers(0, len(recording) - START_FRAMES))
    search, begun, answers = GlobalSearch(renderer, seed=seed), time.perf_counter(), []
    for depth, gravity, pose in _played(recording, range(first, first + START_FRAMES), rng):
        answers.append(search.step(depth, gravity))
        right = [_right(one.state, pose) for one in answers[-1].poses]
        if answers[-1].status == "found":
            break
    return {
        "frame": first,
        "status": answers[-1].status,
        "right": any(right[:1]),
        "right_among_places": any(right),
        "frames": len(answers),
        "particles": sum(one.particles for one in answers),
        "renders": sum(one.renders for one in answers),
        "seconds": time.perf_counter() - begun,
    }


def _played(
    recording: DepthSequence, frames: Iterable[int | None], rng: np.random.Generator
) -> Iterator[tuple[np.ndarray, np.ndarray | None, np.ndarray | None]]:
    """Yield depth image, gravity `(3,)` in the optical frame, and true pose of frames; nothing is seen in None."""
    for index in frames:
        if index is None:
            yield np.full(recording.image_shape, np.nan, dtype=np.float32), None, None
        else:
            pose = recording.camera_to_world[index]
            yield recording.depth(index), -pose[2, :3] + GRAVITY_SIGMA * rng.standard_normal(3), pose


def _places_of_kidnapping(recording: DepthSequence, rng: np.random.Generator) -> tuple[int, int]:
    """Return the first frame before and the first after, far enough apart; `ValueError` if there are none."""
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
