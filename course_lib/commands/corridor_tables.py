"""What `demo corridor` prints: table 1 of a seed, table 1 over recordings, what the kindnesses are worth."""

from __future__ import annotations

BY_HAND_TITLE = "with calibration and mount errors, pushed by hand:"


def table_1(summary: dict) -> str:
    """The paper's table 1 with its two rows and ours, the timed error beside the nearest-path error."""
    from course_lib.depth_mcl.evaluation import PAPER_TABLE_1

    lines = [
        f"Table 1, {summary['frames']} frames, {summary['n_particles']} particles, seed {summary['seed']}",
        "",
        f"{'':36} {'nearest point of the path':^33}  {'same frame':>10}  {'particles':>9}",
        f"{'':36} {'median [m]':>10} {'sigma [m]':>10} {'<= 0.30 m':>11}  {'median [m]':>10}  {'effective':>9}",
    ]
    for name, (median, sigma, within) in PAPER_TABLE_1.items():
        sigma_text = "n/a" if sigma is None else f"{sigma:.2f}"
        lines.append(f"{'paper: ' + name:36} {median:>10.2f} {sigma_text:>10} {within:>9.0f} %  {'-':>10}  {'-':>9}")
    lines += [_row(row) for row in summary["methods"].values()]
    # Only a recording of the seed's own has a less kind one beside it.
    if "methods_by_hand" in summary:
        lines += ["", BY_HAND_TITLE, *(_row(row) for row in summary["methods_by_hand"].values())]
    lines += [
        "",
        "sigma is the root mean square about zero. Fallon-style rows use a planar simplification of the map. At full",
        "size their sum over 25,344 pixels collapses onto few particles, at 20 x 15 it hardly tells them apart (last",
        "column: median effective sample size). Their published system also had visual odometry; here no row has any.",
        f"{summary['ms_per_frame']:.0f} ms a frame (paper: 125 ms, on a graphics card)",
    ]
    return "\n".join(lines)


def _row(row: dict) -> str:
    return (
        f"{row['name']:36} {row['median_m']:>10.3f} {row['sigma_m']:>10.3f} {row['within_3sigma_percent']:>9.1f} %"
        f"  {row['median_timed_m']:>10.3f}  {row['median_effective_sample_size']:>9.1f}"
    )


def table_over_recordings(result: dict, told: str = "least to greatest") -> str:
    """Table 1 over the recordings of several seeds: medians and, in brackets, what is `told` of each."""
    seeds = result["seeds"]
    lines = [
        f"Table 1 over {len(seeds)} recordings, seeds {seeds[0]} to {seeds[-1]}, {result['frames']} frames, "
        f"{result['n_particles']} particles: median ({told})",
        "",
        f"{'':36} {'nearest median [m]':>22} {'sigma [m]':>22} {'<= 0.30 m [%]':>22} {'same frame median [m]':>22}",
    ]
    for part, title in (("methods", None), ("methods_by_hand", BY_HAND_TITLE)):
        rows = result["over_recordings"].get(part, {})
        if rows and title:
            lines += ["", title]
        lines += [f"{row['name']:36} {_spreads(row)}" for row in rows.values()]
    if any("?" in line for line in lines):
        lines += ["", "?: so few recordings leave the interval unknown; six are enough."]
    return "\n".join(lines)


def _spreads(row: dict) -> str:
    columns = (("median_m", 3), ("sigma_m", 3), ("within_3sigma_percent", 1), ("median_timed_m", 3))
    return " ".join(_spread(row[name], digits) for name, digits in columns)


def _spread(spread: dict, digits: int) -> str:
    middle, least, greatest = ("?" if value is None else f"{value:.{digits}f}" for value in spread.values())
    return f"{f'{middle} ({least} to {greatest})':>22}"


def table_of_kindnesses(result: dict) -> str:
    """Median errors of the paper's method with each hardship alone: median over seeds (least to greatest)."""
    seeds, size = result["seeds"], result["image"]
    lines = [
        f"What kindnesses are worth: {len(seeds)} recordings, seeds {seeds[0]} to {seeds[-1]}, {size[0]} x {size[1]} "
        f"pixels, {result['n_particles']} particles",
        "",
        f"{'hardship':18} {'nearest median [m]':>22} {'same frame median [m]':>22}",
    ]
    for name, row in result["hardships"].items():
        lines.append(f"{name:18} {_spread(row['median_m'], 3)} {_spread(row['median_timed_m'], 3)}")
    return "\n".join(lines)
