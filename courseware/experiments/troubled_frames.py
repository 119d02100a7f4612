"""Draw which frames of a recording are troubled, and count outcomes, recovery and confident wrong poses."""

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np

from course_lib.beyond.guarded_depth import OUTCOMES
from course_lib.spherical_stereo.outcomes import Reason

STREAM = 0x7B0B1E  # joins a recording's seed
GOOD_FRAMES = 10  # after a trouble, before recovery is asked
LEFT_AT_THE_END = GOOD_FRAMES + 2  # frames, never troubled, so that most troubles can be recovered from
SECOND = 1.0
USUAL_QUANTILE = 0.95  # of the undisturbed run's errors: what is within is usual
FAULTS = frozenset(OUTCOMES) - {"tracked", "doubtful", "lost"} | {
    Reason.BLANK, Reason.SWAPPED, Reason.TURNED, Reason.MOMENTS,
}  # fmt: skip
"""Outcomes that blame the sensor: of a good frame they are false alarms."""

# (image that is due, good image before it, image that arrived before, generator) -> image that arrives
Spoil = Callable[[object, object, object, np.random.Generator], object]


class Arrival(NamedTuple):
    """What came when a frame was due."""

    image: object  # Of the sensor: a depth image, or a pair of panoramas; None: nothing came
    time: float  # Seconds, as the frame's stamp says


def troubled_runs(n_frames: int, share: float, length: int, rng: np.random.Generator) -> list[tuple[int, int]]:
    """Draw stretches (first, end) of troubled frames in a recording, ascending, none touching another.

    share: of all frames, 0 to 1. length: of each stretch. The first frame and the last `LEFT_AT_THE_END` are good.
    """
    count = max(1, round(share * n_frames / length))
    # Each stretch but the first takes a good frame before it along, so that none touch.
    spare = n_frames - 1 - LEFT_AT_THE_END - (count * (length + 1) - 1)
    if length < 1 or not 0 < share < 1 or spare < 0:
        raise ValueError(
            f"{count} stretches of {length} troubled frames do not fit into {n_frames} frames, of which the first and "
            f"the last {LEFT_AT_THE_END} stay good; take a longer recording or a smaller share"
        )
    gaps = np.sort(rng.choice(spare + count, count, replace=False)) - np.arange(count)
    firsts = 1 + gaps + np.arange(count) * (length + 1)
    return [(int(first), int(first) + length) for first in firsts]


def troubled_recording(
    trouble: str, spoils: Mapping[str, Spoil], images: Sequence, times: Sequence, share: float, rng, length: int = 1
) -> tuple[list[Arrival], list[tuple[int, int]]]:
    """Return what arrives of a recording, an `Arrival` for each frame that is due, and the troubled stretches.

    trouble: "dropped", "time backwards" (stamped up to a second before the frame before it), or one of `spoils`.
    """
    runs = troubled_runs(len(images), share, length, rng)
    arrivals = [Arrival(image, float(time)) for image, time in zip(images, times, strict=True)]
    for index in (index for first, end in runs for index in range(first, end)):
        (image, time), before = arrivals[index], arrivals[index - 1]
        if trouble == "dropped":
            image = None
        elif trouble == "time backwards":
            time = before.time - rng.uniform(0.0, SECOND)
        else:
            image = spoils[trouble](image, images[index - 1], before.image, rng)
        arrivals[index] = Arrival(image, time)
    return arrivals, runs


def troubles_of(
    run: Callable, lengths: Mapping, spoils: Mapping, images: Sequence, times: Sequence, seed: int, shares: Sequence
) -> dict:
    """Run a method on a recording undisturbed, and with every trouble, of its length, at every share (0 to 1).

    run: gives, for a list of `Arrival`, {"outcome", "confident", "position_m", "rotation_deg"} each.
    """
    calm = run([Arrival(image, float(time)) for image, time in zip(images, times, strict=True)])
    rows = []
    for trouble, share in product(lengths, shares):
        rng = generator(seed, trouble, share)
        arrivals, runs = troubled_recording(trouble, spoils, images, times, share, rng, lengths[trouble])
        rows.append({"trouble": trouble, "share": share, "runs": runs, "frames": run(arrivals)})
    return {"undisturbed": calm, "troubles": rows}


def troubled_frames(runs: Iterable[tuple[int, int]], n_frames: int) -> np.ndarray:
    """Return which frames lie in a stretch, bool `(n_frames,)`."""
    return np.array([any(first <= index < end for first, end in runs) for index in range(n_frames)])


def generator(seed: int, name: str, share: float) -> np.random.Generator:
    """Return the generator of one trouble at one share in one seed's recording: each has a stream of its own."""
    return np.random.default_rng([STREAM, seed, round(10_000 * share), *name.encode()])


class Gate(NamedTuple):
    """Limits of a pose's error: what is usual, or beyond which a pose is wrong."""

    metres: float
    degrees: float

    def holds(self, frame: dict) -> bool:
        """Return whether there is a pose for a frame, and it lies within the limits."""
        known = frame["position_m"] is not None
        return known and frame["position_m"] <= self.metres and frame["rotation_deg"] <= self.degrees


def frames_to_judge(runs: Sequence[tuple[int, int]], n_frames: int) -> list[int]:
    """Return for each troubled stretch the frame with which `GOOD_FRAMES` good ones have come after it, if any."""
    good = np.flatnonzero(~troubled_frames(runs, n_frames))
    after = [good[good >= end][GOOD_FRAMES - 1 : GOOD_FRAMES] for _, end in runs]
    return sorted({int(one[0]) for one in after if len(one)})


def confident_wrong(frames: Iterable[dict], gate: Gate) -> int:
    """Return how many frames' poses were called reliable, and lie beyond the gate."""
    return sum(bool(frame["confident"]) and not gate.holds(frame) for frame in frames)


def summary(results: Sequence[dict], gate: Gate) -> dict:
    """Return the table of one method over the `troubles_of` all recordings: a row a trouble and share."""
    calm = [frame for one in results for frame in one["undisturbed"]]
    known = [(one["position_m"], one["rotation_deg"]) for one in calm if one["position_m"] is not None]
    usual = Gate(*np.quantile(known, USUAL_QUANTILE, axis=0).tolist())
    outcomes = _counts(calm)
    return {
        "gate": gate._asdict(),
        "usual": usual._asdict(),
        "undisturbed": {
            "frames": len(calm),
            "good_frames": outcomes,
            "false_alarms": sum(count for name, count in outcomes.items() if name in FAULTS),
            "confident_wrong": confident_wrong(calm, gate),
        },
        "rows": [_row(results, k, gate, usual) for k in range(len(results[0]["troubles"]))],
    }


def _row(results: Sequence[dict], k: int, gate: Gate, usual: Gate) -> dict:
    """Return the row of the k-th trouble and share, over all recordings, next to the undisturbed runs."""
    bad, good, judged, beside = [], [], [], []
    for one in results:
        frames, runs = one["troubles"][k]["frames"], one["troubles"][k]["runs"]
        for frame, is_bad in zip(frames, troubled_frames(runs, len(frames)), strict=True):
            (bad if is_bad else good).append(frame)
        indices = frames_to_judge(runs, len(frames))
        judged += [frames[index] for index in indices]
        beside += [one["undisturbed"][index] for index in indices]
    return {
        **{name: results[0]["troubles"][k][name] for name in ("trouble", "share")},
        "frames": len(bad) + len(good),
        "troubled": len(bad),
        "outcomes": _counts(bad),
        "good_frames": _counts(good),
        "judged": len(judged),
        "recovered": sum(map(usual.holds, judged)),
        "undisturbed": sum(map(usual.holds, beside)),
        "confident_wrong": confident_wrong([*bad, *good], gate),
    }


def _counts(frames: Iterable[dict]) -> dict[str, int]:
    return dict(sorted(Counter(frame["outcome"] for frame in frames).items()))
