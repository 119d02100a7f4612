"""Write what `bench` and `bench --lessons` print: their JSON as tables."""

SYSTEM_BYTES = 2**30  # left to the operating system
PATIENCE_S = 120.0  # that a class waits for its results when everybody runs all the cells at the same moment


def bench_table(result: dict) -> str:
    """Return the table: times of this run, and ratios with their least and greatest over the repeats."""
    machine = result["machine"]
    load = "" if machine["load_at_the_end"] is None else f", load {machine['load_at_the_end']:.1f} at the end"
    lines = [
        f"{machine['processor']}, {machine['processors']} processors{load}; OpenGL: {machine['opengl']}",
        "One step: propagate, render, likelihood, weights, estimate, resample; 200 particles, 176 x 144 pixels.",
    ]
    heads = f"{'ms (least to greatest)':>24} {'x our step':>20} {'x exact step':>20} {'pixels > 1 cm apart':>20}"
    for scene in result["scenes"]:
        lines += ["", f"{scene['name']}, {scene['triangles']:,} triangles", f"{'':46} {heads}"]
        lines += [_row(name, row) for name, row in scene["rows"].items()]
    return "\n".join(lines)


def _row(name: str, row: dict) -> str:
    if "missing" in row:
        return f"{name:46} not here: {row['missing'][:90]}"
    ratios = [f"{_spread(row[key], 1):>20}" if key in row else f"{'':20}" for key in ("times_default", "times_exact")]
    apart = f"{100 * row['pixels_apart']:>18.3f} %" if "pixels_apart" in row else ""
    return f"{name:46} {_spread(row['ms'], 0):>24} {' '.join(ratios)} {apart}".rstrip()


def _spread(told: dict[str, float], digits: int) -> str:
    middle, least, greatest = (f"{told[key]:.{digits}f}" for key in ("median", "least", "greatest"))
    return f"{middle} ({least} to {greatest})"


def lessons_rows(result: dict) -> list[str]:
    """In Markdown a row a lesson, then the greatest, the sum, and JupyterLab's server."""
    rows = result["lessons"]
    peaks, owns, seconds = ([row[key] for row in rows] for key in ("peak_mb", "own_mb", "processor_s"))
    known = None not in owns
    numbers = [(row["name"], row["peak_mb"], row["own_mb"], row["processor_s"]) for row in rows]
    numbers += [("the greatest", max(peaks), max(owns) if known else None, max(seconds))]
    numbers += [("all together", sum(peaks), sum(owns) if known else None, sum(seconds))]
    numbers += [("JupyterLab's server", *(result["server"][key] for key in ("peak_mb", "own_mb", "processor_s")))]
    lines = [
        "| lesson | memory at its peak [MB] | of it, the student's own [MB] | processor time [s] |",
        "|---|---|---|---|",
    ]
    for name, peak_mb, own_mb, processor_s in numbers:
        lines.append(f"| {name} | {peak_mb:.0f} | {'' if own_mb is None else f'{own_mb:.0f}'} | {processor_s:.0f} |")
    return lines


def capacity(result: dict, memory_gib: float, processors: float) -> tuple[int, int]:
    """Students that fit on one server, by memory and by processors, as `capacity_sentence` assumes."""
    lessons, server = result["lessons"], result["server"]

    def own(row: dict) -> float:
        return row["peak_mb"] if row["own_mb"] is None else row["own_mb"]

    files_mb = max(row["peak_mb"] - own(row) for row in [*lessons, server])
    free_mb = (memory_gib * 2**30 - SYSTEM_BYTES) / 1e6 - files_mb
    by_memory = int(max(free_mb, 0) // (max(own(row) for row in lessons) + own(server)))
    return by_memory, int(processors * PATIENCE_S // max(row["processor_s"] for row in lessons))


def capacity_sentence(result: dict, memory_gib: float, processors: float) -> str:
    """How many students one server carries, and what that assumes."""
    by_memory, by_processors = capacity(result, memory_gib, processors)
    return (
        f"One server of {memory_gib:g} GiB and {processors:g} processors carries {min(by_memory, by_processors)} "
        f"students: {by_memory} by memory (each one kernel, in the lesson that takes most, and a server of JupyterLab; "
        f"files of libraries once; {SYSTEM_BYTES / 2**30:g} GiB left to the system), {by_processors} by "
        f"processors (all run all cells of the longest lesson at the same moment and wait {PATIENCE_S:g} s at most)."
    )
