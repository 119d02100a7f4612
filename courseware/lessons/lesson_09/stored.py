"""Stored results in six degrees of freedom. data/corridor/results says which command made each."""

import json

from courseware.experiments.intervals import wilson_percent
from courseware.paths import data_path


def stored(name: str) -> dict:
    """Return `kitchen_six_degrees`, `kitchen_ablation` or `hand_1-5`: "rows", name -> numbers."""
    return json.loads(data_path(f"corridor/results/{name}.json").read_text(encoding="utf-8"))


def each_recording() -> dict[str, list[dict]]:
    """Return row name -> one row for each of the five recordings carried by hand."""
    return {name: rows for name, rows in stored("hand_1-5")["recordings"].items() if "floor" not in name}


def ablation() -> dict[str, tuple[float, list[float]]]:
    """Return name, such as "without annealing" -> share of frames within 5 cm and 5 degrees, and its 95 % interval.

    Both in percent. The kitchen, every 8th frame, one seed; "everything on" has five seeds.
    """
    rows = {"everything on": stored("kitchen_six_degrees")["rows"]["annealed and refined, every 8"]}
    for name, row in stored("kitchen_ablation")["rows"].items():
        if name.endswith("every 8"):
            rows[name.removesuffix(", every 8")] = row
    return {k: (row["within_5cm_5deg_percent"], wilson_percent(row["good"], row["frames"])) for k, row in rows.items()}


def stored_table() -> str:
    """Return the kitchen and the corridor in six degrees of freedom, a line for each filter and way of recording."""
    lines = [f"{'':52} {'median':>8} {'median':>9} {'within 5 cm':>12}"]
    lines.append(f"{'':52} {'[m]':>8} {'[degrees]':>9} {'and 5 deg':>12}")
    for place, file in (("kitchen: ", "kitchen_six_degrees"), ("corridor: ", "hand_1-5")):
        for name, row in stored(file)["rows"].items():
            if "every 2" not in name:
                errors = f"{row['median_position_m']:>8.3f} {row['median_rotation_deg']:>9.2f}"
                lines.append(f"{place + name:52} {errors} {row['within_5cm_5deg_percent']:>10.1f} %")
    return "\n".join(lines)
