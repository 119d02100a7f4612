"""Foundation F2, rotations: Exp and Log, the adjoint, and why a mean of roll, pitch and yaw fails."""

# ruff: noqa: I001 (short lines)
from courseware.lessons.foundation_2.figures import PANELS, cloud_panel, lever_figure, mean_figure, tangent_figure
from courseware.lessons.foundation_2.figures import turn_figure
from courseware.lessons.foundation_2.clouds import cloud_about, mean_errors
