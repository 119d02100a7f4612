"""What `demo rooms` prints: the shares of table 5 with their intervals, the errors of tables 3 and 4, the tilts."""

from __future__ import annotations

from course_lib.experiments.paper_tables import PAPER_TABLE_3, PAPER_TABLE_4, PAPER_TABLE_5
from course_lib.experiments.rooms_summary import KINDS, wilson_percent
from course_lib.simulation.room.measurement_places import CAMERA_HEIGHTS

PAPER = {1: PAPER_TABLE_3, 2: PAPER_TABLE_4}
PAPER_POSES = 20
WORDS = {
    "images": "images",
    "exact_boxes": "exact boxes",
    "paper": "the paper's fit",
    "as_printed": "eq. (1) as printed",
    "weighted_fit": "weighted_fit",
    "library": "implausible rejected",
}
ERRORS, WIDTHS = ("dx_m", "dy_m", "dtheta_deg"), (16, 16, 18)
ERRORS_HEAD = f"{'n':>5}{'dx [m]':>16}{'dy [m]':>16}{'dtheta [deg]':>18}"


def tables(summary: dict) -> str:
    """Everything about the rooms, the paper's numbers beside ours."""
    seeds, alike, objects = summary["seeds"], summary["look_alikes"], summary["objects_a_room"]
    kinds = ", ".join(f"{min(counts)} to {max(counts)} {label}s in {len(counts)}" for label, counts in alike.items())
    lines = [
        f"{summary['rooms']} rooms (seeds {_ranges(seeds)}), {summary['poses_a_room_and_height']} poses at each height",
        f"Objects a room: {objects['least']} to {objects['most']}, median {objects['median']:g}",
        f"Look-alikes: {kinds}",
        "",
        "Share of poses [%], with 95 % intervals: (over poses, as if independent; over rooms, by bootstrap)",
        f"{'':42}{'correct':>31}{'incorrect':>31}{'unable':>31}",
    ]
    for number, (upper, lower) in CAMERA_HEIGHTS.items():
        lines.append(f"Cameras at {upper:.2f} and {lower:.2f} m")
        lines.append(f"  {f'paper, {PAPER_POSES} poses':40}" + "".join(_paper_share(number, kind) for kind in KINDS))
        lines += [f"  {name:40}{_shares(values)}" for name, values in _rows(summary[f"experiment_{number}"])]
    lines.append("Both heights")
    lines += [f"  {name:40}{_shares(values)}" for name, values in _rows(summary["both"])]
    lines += ["", "Absolute errors: median (mean)".ljust(42) + ERRORS_HEAD]
    for number, (upper, lower) in CAMERA_HEIGHTS.items():
        for kind in ("correct", "all"):
            lines.append(f"Cameras at {upper:.2f} and {lower:.2f} m, {kind} poses")
            paper = PAPER[number][kind]
            means = [f"({paper[f'mean_{error}']:.2f})" for error in ERRORS]
            lines.append(f"  {'paper':45}" + "".join(f"{mean:>{w}}" for mean, w in zip(means, WIDTHS, strict=True)))
            lines += [f"  {name:40}{_errors(v[kind])}" for name, v in _rows(summary[f"experiment_{number}"])]
    return "\n".join([*lines, "", *_behind(summary)])


def tilt_table(tilts: dict) -> str:
    """Rates and errors over the relative tilt of the two cameras; both heights together."""
    lines = [
        "Lower camera tilted against the upper one, both heights",
        f"{'':42}{'correct [%]':>12}{'incorrect':>11}{'unable':>8}",
    ]
    for tilt, by_source in tilts.items():
        lines.append(f"{tilt} degrees")
        for name, values in _rows(by_source):
            shares = zip(KINDS, (12, 11, 8), strict=True)
            lines.append(f"  {name:40}" + "".join(f"{values[f'{kind}_percent']:{width}.1f}" for kind, width in shares))
    for kind in ("correct", "all"):
        lines.append(f"Absolute errors of {kind} poses: median (mean)".ljust(42) + ERRORS_HEAD)
        for tilt, by_source in tilts.items():
            lines.append(f"{tilt} degrees")
            lines += [f"  {name:40}{_errors(values[kind])}" for name, values in _rows(by_source)]
    return "\n".join(lines)


def _behind(summary: dict) -> list[str]:
    detector = summary["detector"]
    lines = []
    if detector["precision"] is not None and detector["recall"] is not None:
        lines.append(
            f"Detector on these photographs: precision {detector['precision']:.3f}, recall {detector['recall']:.3f} "
            f"({detector['objects']} objects)"
        )
    for source, found in summary["wrong_pairs"].items():
        lines.append(
            f"Wrong pairs from {WORDS[source]}, in {found['poses']} poses: {found['look_alikes']} between look-alikes, "
            f"{found['others']} between other objects of one class, {found['nothing']} with a detection of no object"
        )
    return [*lines, f"{summary['seconds_per_pose']:.2f} s a pose (median), from two images in memory"]


def _rows(by_source: dict) -> list[tuple[str, dict]]:
    return [
        (f"{WORDS[source]}, {WORDS.get(method, method)}", values)
        for source, by_method in by_source.items()
        for method, values in by_method.items()
    ]


def _shares(values: dict) -> str:
    return "".join(
        _share(values[f"{kind}_percent"], values[f"{kind}_wilson_percent"], values[f"{kind}_rooms_percent"])
        for kind in KINDS
    )


def _paper_share(number: int, kind: str) -> str:
    share = PAPER_TABLE_5[number][f"{kind}_percent"]
    return _share(share, wilson_percent(round(share * PAPER_POSES / 100), PAPER_POSES), None)


def _share(share: float, over_poses: list[float], over_rooms: list[float] | None) -> str:
    rooms = f"; {over_rooms[0]:.0f} to {over_rooms[1]:.0f}" if over_rooms else ""
    text = f"{share:.1f} ({over_poses[0]:.0f} to {over_poses[1]:.0f}{rooms})"
    return f"{text:>31}"


def _errors(group: dict) -> str:
    head = f"{group['n']:5d}"
    if not group["n"]:
        return head + f"{'none':>{WIDTHS[0]}}"
    pairs = [f"{group[f'median_{error}']:.3f} ({group[f'mean_{error}']:.3f})" for error in ERRORS]
    return head + "".join(f"{pair:>{width}}" for pair, width in zip(pairs, WIDTHS, strict=True))


def _ranges(seeds: list[int]) -> str:
    """Seeds with their runs joined: 1-5, 8."""
    runs: list[list[int]] = []
    for seed in seeds:
        if runs and seed == runs[-1][-1] + 1:
            runs[-1].append(seed)
        else:
            runs.append([seed])
    return ", ".join(f"{run[0]}-{run[-1]}" if len(run) > 1 else str(run[0]) for run in runs)
