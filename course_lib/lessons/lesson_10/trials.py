"""What lesson 10 measures in its hotel: kidnappings, a search where rooms look alike, the raw score over time."""

import functools
import warnings
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from course_lib.beyond.lost_and_found.global_search import CLEAR_GAP, GlobalSearch, PoseCandidates
from course_lib.beyond.lost_and_found.recovery import RecoveringLocalizer, RecoveryEstimate
from course_lib.beyond.six_dof.localizer import AnnealedLocalizer
from course_lib.depth_mcl.localizer import NoMeasurementWarning
from course_lib.lessons.kit.progress_bar import progress
from course_lib.lessons.lesson_10.hotel import (
    ALIKE,
    CAMERA,
    Recording,
    behind_a_person,
    hotel_map,
    record,
    walk,
)
from course_lib.lessons.lesson_10.narrowing import OUT_OF_101, leaving_101
from course_lib.rendering.renderer import DepthRenderer

MIN_PARTICLES, MAX_PARTICLES = 200, 2_000  # of the search: the hotel is small
PARTICLES = 150
SEARCHED = 24  # frames of the walk out of 101
NEAR = 0.2  # metres

IN_THE_CORRIDOR = ((1.2, 0.9, 5), (3.6, 0.8, -5))
IN_103 = ((8.7, 2.3, 60), (9.0, 2.5, 100), (8.9, 2.6, 120))
IN_101 = ((3.3, 4.2, 200), (3.2, 3.6, 225))
IN_102 = ((7.3, 4.2, 200), (7.2, 3.6, 225))
TO_THE_LIFT = ((6.0, 0.9, 10), (8.0, 0.7, 0))
ALONG = ((1.0, 0.9, 5), (4.0, 0.8, -5), (7.5, 0.8, 5))


def carried_away() -> Recording:
    """On a wagon along the corridor for ten frames, then in 103."""
    corridor, goal = walk(((1.2, 0.9, 5), (2.8, 0.8, -5)), 10, sway=0), walk(IN_103, 20, sway=0)
    return record(np.concatenate([corridor, goal]), 10_001)


# Kidnappings


class Kidnapping(NamedTuple):
    """One kidnapping."""

    name: str
    recovered: int | None
    """Frames after the uncovering until the state was right and tracked; None: never."""
    particles: int
    """Poses drawn from free space."""
    places: int
    """How many places the search named as equals in the last frame."""


BEFORE, COVERED, AFTER = 6, 4, 8
KIDNAPPINGS = {
    "corridor to 103": (IN_THE_CORRIDOR, IN_103),
    "103 to corridor": (IN_103, TO_THE_LIFT),
    "corridor to 102": (TO_THE_LIFT, IN_102),
}


def follow(
    recording: Recording,
    seed: int,
    covered: range = range(0),
    closed: tuple[int, ...] = (),
    until: int | None = None,
) -> Iterator[RecoveryEstimate]:
    """`RecoveringLocalizer` on a recording whose start it is given. covered: frames in which nothing is seen; closed:
    rooms whose door is shut on the map; until: the first so many frames alone."""
    with DepthRenderer(hotel_map(*closed), CAMERA) as renderer, warnings.catch_warnings():
        warnings.simplefilter("ignore", NoMeasurementWarning)  # covered on purpose
        localizer = RecoveringLocalizer(renderer, PARTICLES, seed=seed, least=MIN_PARTICLES, most=MAX_PARTICLES)
        localizer.initialize(recording.states[0])
        for number, (depth, down) in enumerate(zip(recording.depths[:until], recording.gravity[:until], strict=True)):
            dark = number in covered
            yield localizer.step(np.full_like(depth, np.nan) if dark else depth, gravity=None if dark else down)


def kidnap(name: str, seed: int = 10_001) -> Kidnapping:
    """The kidnapping of that name: followed, covered and carried, uncovered elsewhere."""
    before, after = KIDNAPPINGS[name]
    first = walk(before, BEFORE)
    states = np.concatenate([first, np.repeat(first[-1:], COVERED, axis=0), walk(after, AFTER)])
    recording, recovered, particles = record(states, seed), None, 0
    uncovered = BEFORE + COVERED
    for number, found in enumerate(follow(recording, seed, range(BEFORE, uncovered))):
        particles += found.candidates.particles if found.candidates else 0
        right = np.linalg.norm(found.estimate.state[:3] - states[number, :3]) <= NEAR
        sure = found.mode != "searching" and found.estimate.status == "tracked"
        if number >= uncovered and recovered is None and right and sure:
            recovered = number - uncovered + 1
            break
    return Kidnapping(name, recovered, particles, equals(found.candidates) if found.mode == "searching" else 1)


def equals(candidates: PoseCandidates) -> int:
    """How many places are named as good as the best: those that keep it from being found."""
    return sum(one.evidence > candidates.poses[0].evidence - CLEAR_GAP for one in candidates.poses)


# The search where rooms look alike


@functools.cache
def search_run(seed: int = 10_002) -> list[PoseCandidates]:
    """`GlobalSearch` over the walk out of 101: what it says in every frame."""
    recording = leaving_101()
    with DepthRenderer(hotel_map(), CAMERA) as renderer:
        search = GlobalSearch(renderer, seed=seed, least=MIN_PARTICLES, most=MAX_PARTICLES)
        frames = progress(range(SEARCHED), "searching")
        return [search.step(recording.depths[k], recording.gravity[k]) for k in frames]


def evidence_near(run: list[PoseCandidates], offset: np.ndarray) -> np.ndarray:
    """Of every frame: evidence of the best place within half a metre of the truth + offset; NaN where there is none."""
    found = []
    for candidates, state in zip(run, leaving_101().states, strict=False):
        near = [p.evidence for p in candidates.poses if np.linalg.norm(p.state[:3] - state[:3] - offset) < 0.5]
        found.append(max(near, default=np.nan))
    return np.array(found)


# The raw score over time


class Trace(NamedTuple):
    """A filter that is not helped: a person walks by, later it is carried away."""

    scores: np.ndarray
    """`(T,)` raw scores."""
    lost: np.ndarray
    """`(T,)` bool: the refined pose cannot be right (`judge_refined`)."""
    person: range
    kidnapped: int
    """First frame in the other place."""


PERSON = range(10, 16)
GOALS = {"to 103": IN_103, "to 101": IN_101, "to the lift": TO_THE_LIFT}


@functools.cache
def traces() -> tuple[Trace, ...]:
    """Three recordings along the corridor; each time it is carried somewhere else."""
    goals = enumerate(progress(GOALS.values(), "recording scores", len(GOALS)))
    return tuple(_trace(10_011 + k, goal) for k, goal in goals)


def _trace(seed: int, goal: tuple) -> Trace:
    before = walk(ALONG, 24)
    recording = record(np.concatenate([before, walk(goal, 8)]), seed)
    scores, lost = [], []
    with DepthRenderer(hotel_map(), CAMERA) as renderer:
        localizer = AnnealedLocalizer(renderer, PARTICLES, seed=seed)
        localizer.initialize(recording.states[0])
        for number, depth in enumerate(recording.depths):
            if number in PERSON:
                depth = behind_a_person(depth, 8 * (number - PERSON.start) - 8)
            estimate = localizer.step(depth)
            scores.append(estimate.score)
            lost.append(estimate.status == "lost")
    return Trace(np.array(scores), np.array(lost), PERSON, len(before))


def running_mean(scores: np.ndarray, share: float) -> np.ndarray:
    """The running mean of scores `(T,)`, from the first score on: each frame counts `share`. Eq. (10.1)."""
    means = [scores[0]]
    for score in scores[1:]:
        means.append(means[-1] + share * (score - means[-1]))
    return np.array(means)


def alarms(trace: Trace, ratio: float, short: float, long: float, cannot_be_right: bool) -> np.ndarray:
    """`(T,)` bool: the short mean lies below `ratio` of the long one; where that is asked, the pose cannot be right."""
    low = running_mean(trace.scores, short) < ratio * running_mean(trace.scores, long)
    return low & trace.lost if cannot_be_right else low


def alarm_counts(ratio: float, short: float = 0.4, long: float = 0.03, cannot_be_right: bool = False):
    """False alarms (frames before the kidnapping, in percent of these) and delays [frames] of all traces; a delay is
    None where there was no alarm."""
    raised = [alarms(trace, ratio, short, long, cannot_be_right) for trace in traces()]
    false = np.concatenate([a[: t.kidnapped] for a, t in zip(raised, traces(), strict=True)])
    delays = []
    for a, t in zip(raised, traces(), strict=True):
        late = np.flatnonzero(a[t.kidnapped :])
        delays.append(int(late[0]) if len(late) else None)
    return 100 * float(false.mean()), delays


# Carried to a room that looks alike


def carried_next_door() -> Recording:
    """The walk out of 101, but after eight frames the camera is in 102, at the same place, and nothing was covered."""
    states = walk(OUT_OF_101, 32)
    states[8:, :3] += ALIKE
    return record(states, 10_003)


def into_102() -> Recording:
    """Along the corridor to the open door of 102."""
    return record(walk(((9.5, 0.8, 170), (7.5, 0.8, 178), (6.5, 0.8, 120), (6.9, 0.9, 90), (7.0, 0.9, 90)), 20), 10_004)
