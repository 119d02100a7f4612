"""Tables 3 to 5 of paper 2, as printed, to stand beside ours."""

from __future__ import annotations

_COLUMNS = ("mean_dx_m", "mean_dy_m", "mean_dtheta_deg", "std_dx_m", "std_dy_m", "std_dtheta_deg")


def _rows(**rows: tuple[float, ...]) -> dict[str, dict[str, float]]:
    return {kind: dict(zip(_COLUMNS, values, strict=True)) for kind, values in rows.items()}


# Table 3, experiment 1. The text gives the mean heading error of the correct ones as 11.92 degrees, the table 11.94;
# only the table's fits the row "All": (13 * 11.94 + 5 * 69.70) / 18 = 27.98, against 27.99 printed.
PAPER_TABLE_3 = _rows(
    all=(0.53, 0.62, 27.99, 0.81, 0.60, 41.85),
    correct=(0.23, 0.44, 11.94, 0.19, 0.41, 25.42),
    incorrect=(1.31, 1.10, 69.70, 1.19, 0.74, 47.09),
)
# Table 4, experiment 2.
PAPER_TABLE_4 = _rows(
    all=(0.59, 0.31, 14.75, 0.98, 0.29, 25.34),
    correct=(0.19, 0.20, 2.79, 0.19, 0.21, 1.82),
    incorrect=(1.65, 0.59, 45.85, 1.34, 0.29, 31.05),
)
# Table 5, percent of 20 poses, experiment by experiment: 13 correct, 5 incorrect, 2 unable.
PAPER_TABLE_5 = {
    1: {"correct_percent": 65.0, "incorrect_percent": 25.0, "unable_percent": 10.0},
    2: {"correct_percent": 65.0, "incorrect_percent": 25.0, "unable_percent": 10.0},
}
