"""What `compare` and `demo corridor --dof 6` print: errors in six degrees of freedom, method by method."""

from __future__ import annotations

NAMES = {
    "annealed": "annealed and refined",
    "paper": "the paper's filter",
    "floor": "floor: refined from the truth",
}


def row_name(method: str) -> str:
    """What a row of the table is called."""
    return NAMES.get(method, method)


def six_degrees_table(rows: dict[str, dict]) -> str:
    """A line a row, of `experiments.six_degrees.pooled`; the keys of `rows` are what stands at the beginning."""
    lines = [
        f"{'':44} {'frames':>7} {'median':>9} {'median':>8} {'within 5 cm':>12} {'within':>8} {'wrong':>7} "
        f"{'called lost':>16} {'renders':>9}",
        f"{'':44} {'':>7} {'[m]':>9} {'[deg]':>8} {'and 5 deg [%]':>12} {'10 cm':>7} {'':>7} "
        f"{'wrong':>8} {'good':>7} {'most':>9}",
    ]
    for name, row in rows.items():
        lines.append(
            f"{name:44} {row['frames']:>7} {row['median_position_m']:>9.4f} {row['median_rotation_deg']:>8.2f} "
            f"{row['within_5cm_5deg_percent']:>12.1f} {row['within_10cm_percent']:>8.1f} {row['wrong']:>7} "
            f"{row['wrong_called_lost']:>8} {row['good_called_lost']:>7} {row['most_renders']:>9}"
        )
    lines += ["", "wrong: by more than 0.20 m or 20 degrees; good: within 5 cm and 5 degrees."]
    for name, row in rows.items():
        if "mean_normalized_error" in row:
            lines.append(
                f"{name}: squared error in units of its covariance {row['mean_normalized_error']:.2f} in the mean; "
                f"{row['within_3_sigma_percent']:.1f} % of errors within three sigma"
            )
    return "\n".join(lines)
