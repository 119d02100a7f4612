"""Stored results in six degrees of freedom, read back: data/corridor/results says which command made each."""

import json

from course_lib.experiments.intervals import wilson_percent
from course_lib.paths import data_path


def stored_rows(name: str) -> dict[str, dict]:
    """Row name -> numbers, of `kitchen_six_degrees`, `kitchen_ablation` or `hand_1-5`."""
    return _read(name)["rows"]


def each_recording() -> dict[str, list[dict]]:
    """Row name -> one row for each of the five recordings carried by hand."""
    return {name: rows for name, rows in _read("hand_1-5")["recordings"].items() if "floor" not in name}


def ablation() -> dict[str, tuple[float, list[float]]]:
    """What is switched off -> share of frames within 5 cm and 5 degrees, in percent, with its 95 % interval.

    The kitchen, every 8th frame, one seed; "nothing" has five seeds.
    """
    rows = {"nothing": stored_rows("kitchen_six_degrees")["annealed and refined, every 8"]}
    for name, row in stored_rows("kitchen_ablation").items():
        if name.endswith("every 8"):
            rows[name.removeprefix("without ").removesuffix(", every 8")] = row
    return {
        name: (row["within_5cm_5deg_percent"], wilson_percent(row["good"], row["frames"])) for name, row in rows.items()
    }


def stored_table() -> str:
    """The kitchen and the corridor in six degrees of freedom, a line for each filter and each way of recording."""
    kitchen, corridor = stored_rows("kitchen_six_degrees"), stored_rows("hand_1-5")
    lines = [f"{'':52} {'median':>8} {'median':>9} {'within 5 cm':>12}"]
    lines.append(f"{'':52} {'[m]':>8} {'[degrees]':>9} {'and 5 deg':>12}")
    for place, rows in (("kitchen: ", kitchen), ("corridor: ", corridor)):
        lines += [
            f"{place + name:52} {row['median_position_m']:>8.3f} {row['median_rotation_deg']:>9.2f} "
            f"{row['within_5cm_5deg_percent']:>10.1f} %"
            for name, row in rows.items()
            if "every 2" not in name
        ]
    return "\n".join(lines)


def _read(name: str) -> dict:
    return json.loads(data_path(f"corridor/results/{name}.json").read_text(encoding="utf-8"))
