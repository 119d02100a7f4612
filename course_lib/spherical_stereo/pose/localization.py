"""The localizer's answer: a pose, or why there is none, and everything on the way that a figure or a table needs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from course_lib.spherical_stereo.outcomes import ObjectOutcome, Reason, Status
from course_lib.spherical_stereo.panorama import View
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, Residuals
from course_lib.spherical_stereo.semantic_map.association import Association, Observation


class PlacedObject(NamedTuple):
    """One object seen in both images."""

    upper: int  # index of its detection
    lower: int
    label: str
    outcome: ObjectOutcome
    position: np.ndarray  # X = d x_hat `(3,)`, metres, body frame, origin at the upper camera; NaN without a position
    observation: int | None  # its index among the observations, if it is one


@dataclass(frozen=True, eq=False)
class Localization:
    """Result of `SemanticLocalizer`: the record that walks through its steps, each of which fills in a part."""

    pose: Pose2D | None = None  # s = [x, y, theta], or None.
    status: Status = Status.UNABLE
    reason: Reason | None = None  # Why there is no pose; None if there is one.
    explanation: str = ""  # The reason in a sentence, with its numbers.
    matches: Sequence = ()  # 2.3: objects seen in both images, as given or found.
    covariance: np.ndarray | None = None  # 2.6: `(3, 3)` of [x, y, theta], metres and radians, squared
    upper: View | None = None  # With its detections (2.2). At the end its image and features are left out.
    lower: View | None = None
    unmatched: Sequence = ()  # 2.3: detections without partner in the other image, each with its reason
    objects: tuple[PlacedObject, ...] = ()  # 2.4: one for every match, in their order.
    observations: tuple[Observation, ...] = ()  # 2.4: objects with a position whose class is on the map.
    association: Association | None = None  # 2.5: how the observations were matched to the map
    residuals: np.ndarray | None = None  # 2.6: `(n, 2)` metres, world: the used observations minus their landmarks
    statistics: Residuals | None = None  # how large the residuals may be under the observations' covariances
    rejected_pose: Pose2D | None = None  # The pose that was fitted, if the reason is "implausible"; None otherwise.
    turn: np.ndarray | None = None  # `(3,)` radians about x, y, z: of the lower camera against the upper one

    def unable(self, reason: Reason, explanation: str, **found: Any) -> Localization:
        """Return the same with a reason why there is no pose, unless an earlier step found one."""
        if self.reason is not None:
            return replace(self, **found)
        return replace(self, reason=reason, explanation=explanation, **found)

    @property
    def upper_detections(self) -> tuple:
        """Return what was seen in the upper image; () if observations were given directly."""
        return () if self.upper is None else self.upper.detections

    @property
    def lower_detections(self) -> tuple:
        """Return what was seen in the lower image."""
        return () if self.lower is None else self.lower.detections

    @property
    def confidence(self) -> float | None:
        """Return the confidence, 0 to 1; None from a matcher that weighs no poses, or without observations."""
        return None if self.association is None else self.association.confidence

    @property
    def alternatives(self) -> tuple:
        """Return the poses that were weighed, best first; () from a matcher that weighs none."""
        return () if self.association is None else self.association.hypotheses

    @property
    def rms_residual(self) -> float | None:
        """Return the residuals' root mean square, metres; None without a fit. Compare `statistics.expected_rms`."""
        return None if self.residuals is None else float(np.sqrt((self.residuals**2).sum(axis=1).mean()))

    @property
    def pairs(self) -> tuple[tuple[int, int], ...]:
        """Return all pairs (observation, landmark) of the association, in order of choice."""
        return () if self.association is None else self.association.pairs

    @property
    def used_pairs(self) -> tuple[tuple[int, int], ...]:
        """Return the pairs that the pose is fitted to: those of like classes."""
        return () if self.association is None else self.association.usable_pairs
