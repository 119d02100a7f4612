"""What `bench` prints: its JSON as a table."""

from __future__ import annotations


def table(result: dict) -> str:
    """Every row with today's number: times of this run, and ratios with their least and greatest over the repeats."""
    machine = result["machine"]
    load = "" if machine["load_at_the_end"] is None else f", load {machine['load_at_the_end']:.1f} at the end"
    lines = [
        f"{machine['processor']}, {machine['processors']} processors{load}; OpenGL: {machine['opengl']}",
        "One step: propagate, render, likelihood, weights, estimate, resample; 200 particles, 176 x 144 pixels.",
    ]
    for scene in result["scenes"]:
        lines += ["", f"{scene['name']}, {scene['triangles']:,} triangles", _heading()]
        lines += [_row(name, row) for name, row in scene["rows"].items()]
    particles, maps, true = result["particles"], result["maps"], result["against_the_true_world"]
    waiting, memory, pictures = result["waiting"], result["memory"], result["picture_ms"]
    if "missing" in pictures:
        keys = f"from a key to its picture: not measured ({pictures['missing'][:80]})"
    else:
        milliseconds = sorted(pictures.values())
        keys = (
            f"from a key on a panel to its picture: {milliseconds[0]:.0f} to {milliseconds[-1]:.0f} ms, the medians of "
            f"{len(milliseconds)} lessons' first panels (wanted: 150 ms)"
        )
    lines += [
        "",
        f"one of {particles['particles'][1]} particles costs {particles['growth']:.2f} of one of "
        f"{particles['particles'][0]}; memory grew by {particles['peak_memory_grew_mb']:.0f} MB",
        f"a map of {maps['triangles'][1]:,} triangles costs {maps['growth']:.2f} of one of {maps['triangles'][0]:,} "
        f"({maps['drawn'][1]:,} and {maps['drawn'][0]:,} drawn), after {maps['preprocessing_s']:.0f} s once",
        *(
            f"depth error against the true world, {name}: median {row['median_mm']:.2f} mm, "
            f"99 % below {row['percentile_99_mm']:.0f} mm"
            for name, row in true.items()
        ),
        f"import course_lib {waiting['import_s']:.2f} s, course.py --help {waiting['help_s']:.2f} s (wanted: 0.3 s)",
        f"lesson 00 from its kernel's start to its last cell {waiting['lesson_00_s']:.1f} s (wanted: 20 s)",
        f"a pose of paper 2 {waiting['pose_s']:.2f} s (wanted: 0.5 s); its models were loaded in "
        f"{waiting['loading_s']:.1f} s",
        keys,
        f"memory over the second half of {memory['steps']:,} steps: {memory['steps_grew_mb']:+.1f} MB; over the second "
        f"half of {memory['renderers']} renderers: {memory['renderers_grew_mb']:+.1f} MB",
    ]
    return "\n".join(lines)


def _heading() -> str:
    return f"{'':46} {'ms (least to greatest)':>24} {'x our step':>20} {'x exact step':>20} {'pixels > 1 cm apart':>20}"


def _row(name: str, row: dict) -> str:
    if "missing" in row:
        return f"{name:46} not here: {row['missing'][:90]}"
    ratios = [f"{_spread(row[key], 1):>20}" if key in row else f"{'':20}" for key in ("times_default", "times_exact")]
    apart = f"{100 * row['pixels_apart']:>18.3f} %" if "pixels_apart" in row else ""
    return f"{name:46} {_spread(row['ms'], 0):>24} {' '.join(ratios)} {apart}".rstrip()


def _spread(told: dict[str, float], digits: int) -> str:
    middle, least, greatest = (f"{told[key]:.{digits}f}" for key in ("median", "least", "greatest"))
    return f"{middle} ({least} to {greatest})"
