"""Whether a pose is known: by how its image agrees with the map, by its covariance, and by what came before.

A wrong pose that looks right is what a localizer must fear most. Three things speak against a pose that was refined.
Its image disagrees with the map, in itself (`judge_refined`) or by what is usual here. What was seen so far does not
tell where the camera is, along a bare wall, or because another place fits as well: then the covariance is wide. And
after frames that were lost, one good image is no proof: walls look alike.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from course_lib.beyond.six_dof.covariance import sigmas
from course_lib.beyond.tracking import Agreement, TrackStatus, judge_refined

Status = Literal["tracked", "doubtful", "lost", "no measurement"]

# Chosen on development recordings: the kitchen, the shipped corridor, and walks through rooms (seeds from 10,041 on).
FALLEN = 0.85  # of the usual support: a frame that agrees less is doubted
MEMORY = 0.1  # share of a new frame in the usual support
# Metres, radians: greatest standard deviations of a pose that is known; a start set by hand is, to rounding.
KNOWN = np.array([0.2, np.deg2rad(20.0)]) + 1e-9
CONFIRMED = 3  # good frames that make up for any number of lost ones


class Certainty:
    """What is usual for a recording's agreement with the map, and how many good frames are owed after lost ones."""

    def __init__(self) -> None:
        self._usual_support: float | None = None
        self._owed = 0

    def doubts(self, agreement: Agreement) -> bool:
        """Whether a frame agrees clearly less than is usual."""
        return self._usual_support is not None and agreement.support < FALLEN * self._usual_support

    def judge_image(self, agreement: Agreement) -> TrackStatus:
        """What a frame's own image says of its refined pose."""
        status = judge_refined(agreement)
        return "doubtful" if status == "tracked" and self.doubts(agreement) else status

    def judge(self, image: TrackStatus, agreement: Agreement, covariance: np.ndarray, has_rivals: bool) -> TrackStatus:
        """What a frame's pose is, once: of what its image said, its covariance `(6, 6)`, and the frames before.

        Lost: the image is, or the covariance is wider than `KNOWN` although the image is good. After as many lost
        frames as many good ones are wanted, at most `CONFIRMED`, none of them with a rival; the last is tracked again.
        """
        status = "lost" if image == "tracked" and (sigmas(covariance) > KNOWN).any() else image
        if status == "lost":
            self._owed = min(self._owed + 1, CONFIRMED)
        elif self._owed:
            self._owed -= status == "tracked" and not has_rivals
            status = "lost" if self._owed else status
        if status == "tracked" or self._usual_support is None:
            self._learn(agreement.support)
        return status

    def _learn(self, support: float) -> None:
        usual = self._usual_support
        self._usual_support = support if usual is None else (1 - MEMORY) * usual + MEMORY * support
