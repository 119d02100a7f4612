"""Which frames of a recording are troubled, and what is counted of them: outcomes, recovery, confident wrong poses."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from course_lib.beyond.guarded_depth import OUTCOMES
from course_lib.spherical_stereo.pose import localization

STREAM = 0x7B0B1E  # joins a recording's seed
GOOD_FRAMES = 10  # after a trouble, before recovery is asked
LEFT_AT_THE_END = GOOD_FRAMES + 2  # frames, never troubled, so that most troubles can be recovered from
SECOND = 1.0
USUAL_QUANTILE = 0.95  # of the undisturbed run's errors: what is within is usual
FAULTS = frozenset(OUTCOMES) - {"tracked", "doubtful", "lost"} | {
    localization.BLANK, localization.SWAPPED, localization.TURNED, localization.MOMENTS,
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
    Raises `ValueError` for a recording that is too short.
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


def troubled_recording(
    trouble: str,
    spoils: Mapping[str, Spoil],
    images: Sequence,
    times: Sequence[float],
    share: float,
    rng: np.random.Generator,
    length: int = 1,
) -> tuple[list[Arrival], list[tuple[int, int]]]:
    """Return what arrives of a recording, an `Arrival` for each frame that is due, and the troubled stretches.

    trouble: "dropped", "time backwards" (stamped up to a second before the frame before it), or one of `spoils`.
    """
    runs = troubled_runs(len(images), share, length, rng)
    arrivals = [Arrival(image, float(time)) for image, time in zip(images, times, strict=True)]
    for index in (index for first, end in runs for index in range(first, end)):
        image, time = arrivals[index]
        if trouble == "dropped":
            image = None
        elif trouble == "time backwards":
            time = arrivals[index - 1].time - rng.uniform(0.0, SECOND)
        else:
            image = spoils[trouble](image, images[index - 1], arrivals[index - 1].image, rng)
        arrivals[index] = Arrival(image, time)
    return arrivals, runs


def troubles_of(
    run: Callable[[list[Arrival]], list[dict]],
    lengths: Mapping[str, int],
    spoils: Mapping[str, Spoil],
    images: Sequence,
    times: Sequence[float],
    seed: int,
    shares: Sequence[float],
) -> dict:
    """Run a method on a recording undisturbed, and with every trouble at every share (0 to 1).

    run: gives, for each frame that was due, {"outcome", "confident", "position_m", "rotation_deg"}. lengths: of each
    trouble. Returns {"undisturbed": frames, "troubles": [{"trouble", "share", "runs", "frames"}]}.
    """
    calm = run([Arrival(image, float(time)) for image, time in zip(images, times, strict=True)])
    rows = []
    for trouble, length in lengths.items():
        for share in shares:
            rng = generator(seed, trouble, share)
            arrivals, runs = troubled_recording(trouble, spoils, images, times, share, rng, length)
            rows.append({"trouble": trouble, "share": share, "runs": runs, "frames": run(arrivals)})
    return {"undisturbed": calm, "troubles": rows}


def troubled_frames(runs: list[tuple[int, int]], n_frames: int) -> np.ndarray:
    """Return which frames lie in a stretch, bool `(n_frames,)`."""
    mask = np.zeros(n_frames, bool)
    for first, end in runs:
        mask[first:end] = True
    return mask


def generator(seed: int, name: str, share: float) -> np.random.Generator:
    """Return the generator of one trouble at one share in one seed's recording: each has a stream of its own."""
    return np.random.default_rng([STREAM, seed, round(10_000 * share), *name.encode()])


class Gate(NamedTuple):
    """Limits of a pose's error: what is usual, or beyond which a pose is wrong."""

    metres: float
    degrees: float


def usual_error(frames: Sequence[dict]) -> Gate:
    """Return a method's usual error: `USUAL_QUANTILE` of undisturbed frames; those without a pose are not counted."""
    known = [(one["position_m"], one["rotation_deg"]) for one in frames if one["position_m"] is not None]
    return Gate(*np.quantile(known, USUAL_QUANTILE, axis=0).tolist())


def frames_to_judge(runs: Sequence[tuple[int, int]], n_frames: int) -> list[int]:
    """Return for each troubled stretch the frame with which `GOOD_FRAMES` good ones have come after it, if any."""
    good = np.flatnonzero(~troubled_frames(list(runs), n_frames))
    after = [good[good >= end][GOOD_FRAMES - 1 : GOOD_FRAMES] for _, end in runs]
    return sorted({int(one[0]) for one in after if len(one)})


def within(frame: dict, usual: Gate) -> bool:
    """Whether a pose was given for a frame, and its error is usual."""
    return (
        frame["position_m"] is not None
        and frame["position_m"] <= usual.metres
        and frame["rotation_deg"] <= usual.degrees
    )


def is_confident_wrong(frame: dict, gate: Gate) -> bool:
    """Whether a frame's pose was given out as one to go by, and lies beyond the gate."""
    return bool(frame["confident"] and (frame["position_m"] > gate.metres or frame["rotation_deg"] > gate.degrees))


def row(troubled: Sequence[dict], undisturbed: Sequence[Sequence[dict]], gate: Gate, usual: Gate) -> dict:
    """Return one row of the table: a trouble at a share, over all recordings with (`troubled`) and without trouble."""
    outcomes, good_outcomes, recovered, beside, wrong = Counter(), Counter(), [], [], 0
    for one, calm in zip(troubled, undisturbed, strict=True):
        frames = one["frames"]
        for frame, bad in zip(frames, troubled_frames(one["runs"], len(frames)), strict=True):
            (outcomes if bad else good_outcomes)[frame["outcome"]] += 1
        judged = frames_to_judge(one["runs"], len(frames))
        recovered += [within(frames[index], usual) for index in judged]
        beside += [within(calm[index], usual) for index in judged]
        wrong += sum(is_confident_wrong(frame, gate) for frame in frames)
    return {
        "frames": outcomes.total() + good_outcomes.total(),
        "troubled": outcomes.total(),
        "outcomes": dict(sorted(outcomes.items())),
        "good_frames": dict(sorted(good_outcomes.items())),
        "judged": len(recovered),
        "recovered": sum(recovered),
        "undisturbed": sum(beside),
        "confident_wrong": wrong,
    }


def summary(results: Sequence[dict], gate: Gate) -> dict:
    """Return the table of one method, over the `troubles_of` all recordings."""
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
