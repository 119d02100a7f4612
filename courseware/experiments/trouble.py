"""Trouble the sensors of both methods at shares of the frames, and tell what becomes of every frame."""

from itertools import product
from pathlib import Path

import numpy as np

from course_lib.spherical_stereo.detection.detector import YoloDetector
from courseware.experiments import depth_trouble, stereo_trouble
from courseware.experiments.runner import Outcome, Runner
from courseware.experiments.troubled_frames import GOOD_FRAMES, summary, troubled_runs
from courseware.paths import data_path

FRAMES = 100  # of a depth recording
PAIRS = 24  # of a walk with panoramas
MAX_SHARE = 20  # percent: with more there are hardly good frames to recover in
TITLES = {
    "depth_xyyaw": "The paper's filter on a wagon, x, y and yaw, no odometer",
    "depth_6": "The annealed filter, carried by hand, six degrees of freedom",
    "stereo": "Pairs of panoramas along a walk, each by itself",
}


def run(
    runner: Runner,
    *,
    seeds: list[int],
    share: list[int],
    method: str | None,
    dof: str,
    frames: int | None,
    data: Path | None,
    detector: Path | None,
) -> Outcome:
    """Run `demo trouble`: the seeds that are missing of each method, then all of them together."""
    if max(share) > MAX_SHARE:
        raise ValueError(f"--share must be at most {MAX_SHARE} percent; got {max(share)}")
    shares = [percent / 100 for percent in share]
    experiments = {}  # Module, function, and parameters beside seed and shares
    if method != "stereo":
        common = {"data": str((data or data_path("corridor")).absolute()), "frames": frames or FRAMES, "dof": dof}
        experiments[f"depth_{dof}"] = depth_trouble, depth_trouble.corridor_trouble, common
    if method != "depth":
        common = {"detector": str((detector or data_path("detector")).absolute()), "frames": frames or PAIRS}
        YoloDetector.load(common["detector"])  # what is wrong with it is told now, not after the first room
        experiments["stereo"] = stereo_trouble, stereo_trouble.room_trouble, common
    results = {}
    for name, (module, function, common) in experiments.items():
        for length, part in product(set(module.LENGTHS.values()), shares):
            troubled_runs(common["frames"], part, length, np.random.default_rng(0))  # one that does not fit is told now
        rows = runner.rows(function, [{**common, "shares": shares, "seed": seed} for seed in seeds], name)
        results[name] = {"method": name, "seeds": seeds, "frames": common["frames"], **summary(rows, module.GATE)}
    text = "\n\n".join(trouble_table(one) for one in results.values())
    return Outcome(results, text, {f"{name}.json": (one, None) for name, one in results.items()}, "trouble", results)


def trouble_table(result: dict) -> str:
    """Return a line a trouble and share of one method."""
    gate, usual, calm, seeds = (result[name] for name in ("gate", "usual", "undisturbed", "seeds"))
    lines = [
        f"{TITLES[result['method']]}: {'seed' if len(seeds) == 1 else 'seeds'} {', '.join(map(str, seeds))}, "
        f"{result['frames']} frames each",
        f"usual error {usual['metres']:.3f} m and {usual['degrees']:.2f} degrees; wrong: beyond {gate['metres']:g} m "
        f"or {gate['degrees']:g} degrees",
        f"undisturbed: {told(calm['good_frames'])}; {calm['confident_wrong']} confident and wrong; "
        f"{calm['false_alarms']} of {calm['frames']} called troubled",
        "",
        f"{'trouble':20} {'share':>6} {'frames':>7} {'judged':>7} {'back':>6} {'beside':>7} {'confident':>10}   "
        "what became of the troubled frames",
        f"{'':20} {'[%]':>6} {'':>7} {'':>7} {'[%]':>6} {'[%]':>7} {'wrong':>10}",
    ]
    for row in result["rows"]:
        shares = [100 * row[name] / row["judged"] if row["judged"] else None for name in ("recovered", "undisturbed")]
        back, beside = ("-" if share is None else f"{share:.0f}" for share in shares)
        lines.append(
            f"{row['trouble']:20} {100 * row['share']:>6.0f} {row['frames']:>7} {row['judged']:>7} "
            f"{back:>6} {beside:>7} {row['confident_wrong']:>10}   {told(row['outcomes'])}"
        )
    lines += [
        "",
        f"judged: frames with which {GOOD_FRAMES} good ones have come after a trouble; back: of them, within the usual "
        "error; beside: undisturbed.",
    ]
    return "\n".join(lines)


def told(outcomes: dict[str, int]) -> str:
    """Return outcomes and how often each came, the commonest first."""
    ordered = sorted(outcomes.items(), key=lambda one: (-one[1], one[0]))
    return ", ".join(f"{name} {count}" for name, count in ordered)
