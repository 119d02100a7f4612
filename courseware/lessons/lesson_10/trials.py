"""What lesson 10 measures in its hotel: kidnappings, a search where rooms look alike, the raw score over time."""

import functools
import itertools
import json
import warnings
from collections import namedtuple
from collections.abc import Iterator

import numpy as np

from course_lib.beyond.lost_and_found.global_search import CLEAR_GAP, GlobalSearch, PoseCandidates
from course_lib.beyond.lost_and_found.recovery import RecoveringLocalizer, RecoveryEstimate
from course_lib.beyond.six_dof.localizer import AnnealedLocalizer
from course_lib.depth_mcl.localizer import NoMeasurementWarning
from course_lib.rendering.renderer import DepthRenderer
from courseware.experiments.intervals import wilson_percent
from courseware.lessons.kit.progress_bar import progress
from courseware.lessons.lesson_10 import hotel_floor
from courseware.lessons.lesson_10.hotel_floor import CAMERA, Recording, hotel_map, leaving_101, record, walk
from courseware.paths import data_path

PARTICLES, SEARCH = 150, {"max_places": 3_000}  # of the filter and of the search: the hotel is small
SEARCHED, NEAR = 24, 0.2  # frames of the walk out of 101, metres

BEFORE, COVERED, AFTER = 6, 4, 8
KIDNAPPINGS = {
    "corridor to 103": (hotel_floor.IN_THE_CORRIDOR, hotel_floor.IN_103),
    "103 to corridor": (hotel_floor.IN_103, hotel_floor.TO_THE_LIFT),
    "corridor to 102": (hotel_floor.TO_THE_LIFT, hotel_floor.IN_102),
}


def follow(recording: Recording, seed: int, closed: tuple = (), until: int | None = None) -> Iterator[RecoveryEstimate]:
    """Yield what `RecoveringLocalizer` finds on a recording whose start it knows. closed: doors shut on the map."""
    with DepthRenderer(hotel_map(*closed), CAMERA) as renderer, warnings.catch_warnings():
        warnings.simplefilter("ignore", NoMeasurementWarning)  # covered on purpose
        localizer = RecoveringLocalizer(renderer, PARTICLES, seed=seed, **SEARCH)
        localizer.initialize(recording.states[0])
        for depth, down in zip(recording.depths[:until], recording.gravity[:until], strict=True):
            yield localizer.step(depth, gravity=down)


def kidnap(name: str) -> tuple[int | None, int, int]:
    """Follow a camera, cover it, carry it away, and uncover it elsewhere.

    Return the frames after the uncovering until the state was right and tracked (None if never), the frames of
    the search, and how many places the search named as equals in the last frame.
    """
    before, after = (walk(corners, n) for corners, n in zip(KIDNAPPINGS[name], (BEFORE, AFTER), strict=True))
    states = np.concatenate([before, np.repeat(before[-1:], COVERED, axis=0), after])
    recording, recovered, searched, uncovered = record(states, 10_001), None, 0, BEFORE + COVERED
    recording.depths[BEFORE:uncovered] = np.nan
    for number, found in enumerate(follow(recording, 10_001)):
        searched += found.candidates is not None
        right = np.linalg.norm(found.estimate.state[:3] - states[number, :3]) <= NEAR
        if number >= uncovered and right and found.mode != "searching" and found.estimate.status == "tracked":
            recovered = number - uncovered + 1
            break
    if found.mode != "searching":
        return recovered, searched, 1
    evidence = np.array([one.evidence for one in found.candidates.poses])
    return recovered, searched, int(np.sum(evidence > evidence.max(initial=0) - CLEAR_GAP))


@functools.cache
def search_run() -> list[PoseCandidates]:
    """Return what `GlobalSearch` says in every frame of the walk out of 101."""
    with DepthRenderer(hotel_map(), CAMERA) as renderer:
        search = GlobalSearch(renderer, seed=10_002, **SEARCH)
        frames = zip(progress(range(SEARCHED), "searching"), leaving_101().depths, leaving_101().gravity, strict=False)
        return [search.step(depth, down) for _, depth, down in frames]


# The raw score of a filter that nobody helps: a person walks by, later it is carried away. scores: `(T,)` raw scores.
# lost: `(T,)` bool, whether the refined pose cannot be right.
Trace = namedtuple("Trace", "scores lost")
PERSON, KIDNAPPED = range(10, 16), 24  # frames
GOALS = {"to 103": hotel_floor.IN_103, "to 101": hotel_floor.IN_101, "to the lift": hotel_floor.TO_THE_LIFT}


@functools.cache
def traces() -> dict[str, Trace]:
    """Return for each of `GOALS` the scores along the corridor and then there."""
    found = {}
    for k, (name, goal) in enumerate(progress(GOALS.items(), "recording scores", len(GOALS))):
        recording = record(np.concatenate([walk(hotel_floor.ALONG, KIDNAPPED), walk(goal, 8)]), 10_011 + k)
        for number in PERSON:  # 0.8 m in front of the camera, 16 columns wide
            left = 8 * (number - PERSON.start) - 8
            recording.depths[number, :, max(left, 0) : left + 16] = 0.8
        with DepthRenderer(hotel_map(), CAMERA) as renderer:
            localizer = AnnealedLocalizer(renderer, PARTICLES, seed=10_011 + k)
            localizer.initialize(recording.states[0])
            estimates = [localizer.step(depth) for depth in recording.depths]
        lost = np.array([one.status == "lost" for one in estimates])
        found[name] = Trace(np.array([one.score for one in estimates]), lost)
    return found


def running_mean(scores: np.ndarray, share: float) -> np.ndarray:
    """Return the running mean of scores `(T,)`, from the first score on. Each frame counts `share`. Eq. (10.1)."""
    return np.array(list(itertools.accumulate(scores, lambda mean, score: mean + share * (score - mean))))


def alarms(
    trace: Trace, ratio: float, short: float = 0.4, long: float = 0.03, cannot_be_right: bool = False
) -> tuple[np.ndarray, int, int | None]:
    """Return the frames `(T,)` bool with an alarm, how many alarms are false, and the right one's delay or None.

    An alarm needs a short mean below `ratio` of the long one, and an impossible pose if `cannot_be_right`.
    """
    raised = running_mean(trace.scores, short) < ratio * running_mean(trace.scores, long)
    raised &= trace.lost | (not cannot_be_right)
    late = np.flatnonzero(raised[KIDNAPPED:])
    return raised, int(raised[:KIDNAPPED].sum()), int(late[0]) if len(late) else None


def stored_table(place: str) -> str:
    """Return what `demo lost` measured in the "kitchen" or the "corridor": shares with Wilson's 95 % intervals."""
    found = json.loads(data_path(f"corridor/results/lost_{place}.json").read_text(encoding="utf-8"))
    n, false, frames = found["trials"], found["false_alarms"], found["undisturbed_frames"]
    lines = [f"{place}, {n} trials"]
    for name, key in (("kidnapped, recovered", "kidnapped_recovered"), ("started anywhere, right", "started_right")):
        low, high = wilson_percent(found[key], n)
        lines.append(f"{name:26} {found[key]:3} of {n}  (95 % interval {low:.0f} to {high:.0f} %)")
    low, high = wilson_percent(false, frames)
    lines.append(f"{'false alarms in peace':26} {false:3} of {frames} frames  ({low:.2f} to {high:.2f} %)")
    start = f"to start {found['frames_to_start']:.0f}, with {found['particles_to_start']:.0f} particles"
    return "\n".join([*lines, f"{'frames, median':26} to recover {found['frames_to_recover']:.0f}, {start}"])
