"""What `demo trouble` prints: a line a trouble and share, of `experiments.sensor_trouble.score.summary`."""

from __future__ import annotations

TITLES = {
    "depth_xyyaw": "The paper's filter on a wagon, x, y and yaw, no odometer",
    "depth_6": "The annealed filter, carried by hand, six degrees of freedom",
    "stereo": "Pairs of panoramas along a walk, each by itself",
}


def trouble_table(result: dict) -> str:
    """The rows of one method."""
    from course_lib.experiments.sensor_trouble.placing import GOOD_FRAMES

    gate, usual, calm = result["gate"], result["usual"], result["undisturbed"]
    seeds = result["seeds"]
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
        lines.append(
            f"{row['trouble']:20} {100 * row['share']:>6.0f} {row['frames']:>7} {row['judged']:>7} "
            f"{percent(row, 'recovered'):>6} {percent(row, 'undisturbed'):>7} {row['confident_wrong']:>10}   "
            f"{told(row['outcomes'])}"
        )
    lines += [
        "",
        f"judged: frames with which {GOOD_FRAMES} good ones have come after a trouble; back: of them, within the usual "
        "error; beside: undisturbed.",
    ]
    return "\n".join(lines)


def percent(row: dict, name: str) -> str:
    """A share of the frames that were judged; "-" where none was."""
    return f"{100 * row[name] / row['judged']:.0f}" if row["judged"] else "-"


def told(outcomes: dict[str, int]) -> str:
    """Outcomes and how often each came, the commonest first."""
    ordered = sorted(outcomes.items(), key=lambda one: (-one[1], one[0]))
    return ", ".join(f"{name} {count}" for name, count in ordered)
