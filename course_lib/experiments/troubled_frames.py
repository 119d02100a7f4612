"""Which frames of a recording are troubled, and what is counted of them: outcomes, recovery, confident wrong poses."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from course_lib.beyond.guarded_depth import OUTCOMES
from course_lib.spherical_stereo.pose import localization

STREAM = 0x7B0B1E  # joins a recording's seed
GOOD_FRAMES = 10  # after a trouble, before recovery is asked
LEFT_AT_THE_END = GOOD_FRAMES + 2  # frames, never troubled, so that most troubles can be recovered from
USUAL_QUANTILE = 0.95
"""Of the undisturbed run's errors: what is within is usual."""
FAULTS = frozenset(OUTCOMES) - {"tracked", "doubtful", "lost"} | {
    localization.BLANK, localization.SWAPPED, localization.TURNED, localization.MOMENTS,
}  # fmt: skip
"""Outcomes that blame the sensor: of a good frame they are false alarms."""


class Arrival(NamedTuple):
    """What came when a frame was due."""

    image: object
    """Of the sensor: a depth image, or a pair of panoramas; None: nothing came."""
    time: float
    """Seconds, as the frame's stamp says."""


def troubled_runs(n_frames: int, share: float, length: int, rng: np.random.Generator) -> list[tuple[int, int]]:
    """Stretches (first, end) of troubled frames in a recording, ascending, none touching another.

    share: of all frames, 0 to 1: as many stretches as come nearest to it, at least one. length: frames of each. The
    first frame is good, and so are the last `LEFT_AT_THE_END`.
    Raises `ValueError` for a recording too short for them.
    """
    count = max(1, round(share * n_frames / length))
    room = n_frames - 1 - LEFT_AT_THE_END
    # Each stretch but the first takes a good frame before it along, so that none touch.
    spare = room - (count * (length + 1) - 1)
    if length < 1 or not 0 < share < 1 or spare < 0:
        raise ValueError(
            f"{count} stretches of {length} troubled frames do not fit into {n_frames} frames, of which the first and "
            f"the last {LEFT_AT_THE_END} stay good; take a longer recording or a smaller share"
        )
    gaps = np.sort(rng.choice(spare + count, count, replace=False)) - np.arange(count)
    firsts = 1 + gaps + np.arange(count) * (length + 1)
    return [(int(first), int(first) + length) for first in firsts]


def require_fits(n_frames: int, shares: Sequence[float], lengths: Sequence[int]) -> None:
    """Raises `ValueError`, before anything is run, where one of the troubles does not fit (`troubled_runs`)."""
    for length in lengths:
        for share in shares:
            troubled_runs(n_frames, share, length, np.random.default_rng(0))


def troubled_frames(runs: list[tuple[int, int]], n_frames: int) -> np.ndarray:
    """Which frames lie in a stretch, bool `(n_frames,)`."""
    mask = np.zeros(n_frames, bool)
    for first, end in runs:
        mask[first:end] = True
    return mask


def generator(seed: int, name: str, share: float) -> np.random.Generator:
    """The generator of one trouble at one share in one seed's recording: each has a stream of its own."""
    return np.random.default_rng([STREAM, seed, round(10_000 * share), *name.encode()])


class Gate(NamedTuple):
    """Beyond either a pose is wrong; given out with confidence it must not be."""

    metres: float
    degrees: float


class Usual(NamedTuple):
    """The method's usual error: the `USUAL_QUANTILE` of an undisturbed run, position and rotation each."""

    metres: float
    degrees: float


def usual_error(frames: Sequence[dict]) -> Usual:
    """Of undisturbed frames: {"position_m", "rotation_deg"}; without a pose both are None, which is not counted."""
    known = [(one["position_m"], one["rotation_deg"]) for one in frames if one["position_m"] is not None]
    return Usual(*np.quantile(known, USUAL_QUANTILE, axis=0).tolist())


def frames_to_judge(runs: Sequence[tuple[int, int]], n_frames: int) -> list[int]:
    """For each troubled stretch (first, end) the frame with which `GOOD_FRAMES` good ones have come after it.

    Good frames are counted, whatever troubles come between; each frame once, and none where the recording ends before.
    """
    good = np.flatnonzero(~troubled_frames(list(runs), n_frames))
    after = [good[good >= end][GOOD_FRAMES - 1 : GOOD_FRAMES] for _, end in runs]
    return sorted({int(one[0]) for one in after if len(one)})


def within(frame: dict, usual: Usual) -> bool:
    """Whether a pose was given for a frame, and its error is usual."""
    return (
        frame["position_m"] is not None
        and frame["position_m"] <= usual.metres
        and frame["rotation_deg"] <= usual.degrees
    )


def is_confident_wrong(frame: dict, gate: Gate) -> bool:
    """Whether a frame's pose was given out as one to go by, and lies beyond the gate."""
    return bool(frame["confident"] and (frame["position_m"] > gate.metres or frame["rotation_deg"] > gate.degrees))


def row(troubled: Sequence[dict], undisturbed: Sequence[Sequence[dict]], gate: Gate, usual: Usual) -> dict:
    """One row of the table: a trouble at a share, over all recordings.

    troubled: of each recording {"runs": stretches, "frames": as `usual_error` has them, with "outcome" and
    "confident"}. undisturbed: the frames of the same recordings without trouble.
    """
    outcomes, good_outcomes, recovered, beside, wrong, total = Counter(), Counter(), [], [], 0, 0
    for one, calm in zip(troubled, undisturbed, strict=True):
        frames = one["frames"]
        mask = troubled_frames(one["runs"], len(frames))
        outcomes.update(frame["outcome"] for frame, bad in zip(frames, mask, strict=True) if bad)
        good_outcomes.update(frame["outcome"] for frame, bad in zip(frames, mask, strict=True) if not bad)
        judged = frames_to_judge(one["runs"], len(frames))
        recovered += [within(frames[index], usual) for index in judged]
        beside += [within(calm[index], usual) for index in judged]
        wrong += sum(is_confident_wrong(frame, gate) for frame in frames)
        total += len(frames)
    return {
        "frames": total,
        "troubled": sum(outcomes.values()),
        "outcomes": dict(sorted(outcomes.items())),
        "good_frames": dict(sorted(good_outcomes.items())),
        "judged": len(recovered),
        "recovered": sum(recovered),
        "undisturbed": sum(beside),
        "confident_wrong": wrong,
    }


def summary(results: Sequence[dict], gate: Gate) -> dict:
    """The table of one method, over all recordings (`depth_run.corridor_trouble`, `stereo_run.room_trouble`)."""
    calm = [one["undisturbed"] for one in results]
    all_calm = [frame for frames in calm for frame in frames]
    usual = usual_error(all_calm)
    names = [(one["trouble"], one["share"]) for one in results[0]["troubles"]]
    rows = []
    for k, (trouble, share) in enumerate(names):
        numbers = row([one["troubles"][k] for one in results], calm, gate, usual)
        rows.append({"trouble": trouble, "share": share, **numbers})
    outcomes = Counter(frame["outcome"] for frame in all_calm)
    return {
        "gate": gate._asdict(),
        "usual": usual._asdict(),
        "undisturbed": {
            "frames": len(all_calm),
            "good_frames": dict(sorted(outcomes.items())),
            "false_alarms": sum(count for name, count in outcomes.items() if name in FAULTS),
            "confident_wrong": sum(is_confident_wrong(frame, gate) for frame in all_calm),
        },
        "rows": rows,
    }
