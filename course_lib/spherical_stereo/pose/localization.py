"""What the localizer found: a pose, or why there is none, and everything on the way that a figure or a table needs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from course_lib.spherical_stereo.pose.plausibility import Residuals
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D
from course_lib.spherical_stereo.ranging.triangulation import OK as OK
from course_lib.spherical_stereo.semantic_map.association import Association, Observation

Status = Literal["ok", "unable"]
UNABLE: Status = "unable"

# Reasons why there is no pose: all of them things that the world does. The fit's own are in `rigid_fit`.
BLANK = "blank image"
NO_DETECTIONS = "no detections"
ONE_DETECTION = "one detection"
TURNED = "cameras turned against each other"
MOMENTS = "images of different moments"
TOO_FEW_MATCHED = "fewer than two objects in both images"
SWAPPED = "images seem swapped"
TOO_FEW_PLACED = "fewer than two objects with a distance"
UNMAPPED_ONLY = "only unmapped classes"
IMPLAUSIBLE = "implausible"

# An outcome of an object beside those of `triangulation` and `vertical_disparity`.
UNMAPPED = "class not on the map"


class PlacedObject(NamedTuple):
    """One object seen in both images, and what became of it."""

    upper: int
    """Index of its detection in the upper image."""
    lower: int
    """Index of its detection in the lower image."""
    label: str
    outcome: str
    """ "ok", or why there is no place: "parallel", "diverging", "azimuth gap", "too few matches", "too far"."""
    position: np.ndarray
    """X = d x_hat `(3,)`, metres, body frame with the origin at the upper camera; NaN where there is no place."""
    observation: int | None
    """Index among the observations; None without a place, or when the map has no such class."""


@dataclass(frozen=True, eq=False)
class Localization:
    """Result of `SemanticLocalizer`. Source: paper 2, figure 2 (its sections 2.2 to 2.6 in order)."""

    pose: Pose2D | None
    """s = [x, y, theta], or None."""
    status: Status
    """ "ok" or "unable"."""
    reason: str | None = None
    """Why there is no pose, one of the names above; None when there is one."""
    explanation: str = ""
    """The reason in a sentence, with its numbers."""
    matches: Sequence = ()
    """Objects seen in both images, as given or found."""
    covariance: np.ndarray | None = None
    """`(3, 3)` of [x, y, theta], metres and radians, squared; None without a pose, or without the observations'."""
    upper_detections: Sequence = ()
    lower_detections: Sequence = ()
    unmatched: Sequence = ()
    """Detections without partner in the other image, each with its reason; empty when the matches were given."""
    objects: tuple[PlacedObject, ...] = ()
    """One for every match, in their order."""
    observations: tuple[Observation, ...] = ()
    """Objects with a place whose class is on the map: what was matched to it."""
    association: Association | None = None
    """How the observations were matched to the map; None without observations."""
    residuals: np.ndarray | None = None
    """`(n, 2)` metres, world: where the used observations land, minus their landmarks."""
    statistics: Residuals | None = None
    """How large the residuals may be under the observations' covariances; None without these."""
    rejected_pose: Pose2D | None = None
    """What was fitted, where the reason is "implausible"; None otherwise."""
    turn: np.ndarray | None = None
    """`(3,)` radians about x, y, z: of the lower camera against the upper one, as the images tell; None: not known."""

    @property
    def confidence(self) -> float | None:
        """0 to 1; None from a matcher that asks for no pose, or without observations."""
        return None if self.association is None else self.association.confidence

    @property
    def alternatives(self) -> tuple:
        """The poses that were weighed (`PoseHypothesis`), best first; () from a matcher that asks for no pose."""
        return () if self.association is None else self.association.hypotheses

    @property
    def rms_residual(self) -> float | None:
        """Root mean square of the residuals, metres; None without a fit. `statistics.expected_rms` is its measure."""
        return None if self.residuals is None else float(np.sqrt((self.residuals**2).sum(axis=1).mean()))

    @property
    def pairs(self) -> tuple[tuple[int, int], ...]:
        """All pairs (observation, landmark) of the association, in order of choice."""
        return () if self.association is None else self.association.pairs

    @property
    def used_pairs(self) -> tuple[tuple[int, int], ...]:
        """The pairs that the pose is fitted to: those of like classes."""
        return () if self.association is None else self.association.usable_pairs

    def upper_detection_of(self, observation: int) -> int | None:
        """Index of the upper image's detection behind an observation; None when observations were given directly."""
        return next((one.upper for one in self.objects if one.observation == observation), None)
