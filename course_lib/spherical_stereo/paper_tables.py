"""Tables 1 and 3 to 5 of paper 2, as printed, to stand beside ours."""

from __future__ import annotations

from typing import NamedTuple


class MeasurementPlace(NamedTuple):
    """One row of table 1: where the rig stood, and its two headings there."""

    place: int
    x: float
    """Metres."""
    y: float
    """Metres."""
    headings_deg: tuple[float, float]


# Table 1: ten places, two headings each: 20 poses, taken at each of the two heights.
MEASUREMENT_PLACES = (
    MeasurementPlace(1, 1.00, 0.50, (180, -90)),
    MeasurementPlace(2, 2.50, 1.50, (180, 90)),
    MeasurementPlace(3, 3.00, 2.50, (180, -90)),
    MeasurementPlace(4, 2.50, 3.50, (180, -90)),
    MeasurementPlace(5, 1.50, 4.50, (90, 0)),
    MeasurementPlace(6, 1.00, 3.50, (90, 0)),
    MeasurementPlace(7, 3.50, 4.50, (180, 90)),
    MeasurementPlace(8, 4.50, 4.50, (180, 90)),
    MeasurementPlace(9, 4.00, 1.50, (-90, 0)),
    MeasurementPlace(10, 4.50, 0.50, (-90, 180)),
)

# Section 3: metres above the floor, upper (the paper's left) and lower (right) camera.
CAMERA_HEIGHTS = {1: (1.32, 1.02), 2: (1.44, 1.14)}

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
