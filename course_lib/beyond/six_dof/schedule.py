"""How a frame is searched: in which layers particles are drawn and weighed, by which steps the best are refined."""

from __future__ import annotations

from typing import Literal, NamedTuple


class Layer(NamedTuple):
    """One round of drawing, weighing and resampling within a frame, on coarse images."""

    particles: float
    """How many, as a share of the filter's `n_particles`."""
    spread: float
    """Of the noise, as a share of the prediction's spread."""
    survivors: float
    """Effective sample size that the weights leave, as a share of the particles."""


class Step(NamedTuple):
    """One Gauss-Newton step for the hypotheses that are left."""

    level: Literal[0, 1, 2]
    """Of the pyramid: coarse, middle, fine."""
    scale: float
    """Metres: a residual as large counts a quarter."""
    hypotheses: int
    """How many are taken along, the best that differ."""


# All chosen on development recordings: the kitchen and the shipped corridor, with every frame to every 12th.
LAYERS = (Layer(1.0, 1.0, 0.1), Layer(0.4, 0.35, 0.1))
SECOND_LOOK = (Layer(0.45, 1.0, 0.1),)
STEPS = (
    Step(0, 0.25, 30), Step(0, 0.20, 20), Step(0, 0.15, 9), Step(0, 0.10, 5),
    Step(1, 0.10, 4), Step(1, 0.07, 3), Step(1, 0.05, 3),
    Step(2, 0.05, 3), Step(2, 0.03, 3), Step(2, 0.03, 3),
)  # fmt: skip
