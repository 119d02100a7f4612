"""Where paper 2's rig stood: table 1 and section 3 of the paper. The simulated rig stands there too."""

from typing import NamedTuple


class MeasurementPlace(NamedTuple):
    """One row of table 1: where the rig stood, and its two headings there."""

    place: int
    x: float  # metres
    y: float  # metres
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
