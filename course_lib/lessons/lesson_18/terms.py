"""The score of a pose, taken apart: what each kind of evidence adds to it."""

import numpy as np

from course_lib.beyond.look_alikes.confidence import TEMPER, score_of_nothing
from course_lib.beyond.look_alikes.evidence import (
    CLUTTER_DENSITY,
    colour_costs,
    detection_probabilities,
    free_space_costs,
    place_distances,
)
from course_lib.beyond.look_alikes.hypotheses import PoseHypothesis, Scene

TERMS = ("places", "colours", "seen", "missed", "free space")


def score_terms(scene: Scene, found: PoseHypothesis) -> dict[str, float]:
    """One of `TERMS` -> nats, signed so that they add up to `found.score`; the pose counts as exact, being refitted."""
    pose = np.array(found.pose)[None]
    i, j = np.array(found.pairs).T
    squared, log_size = place_distances(scene, pose)
    places = squared[0, i, j] / 2 + log_size[0, i] / 2 + np.log(2 * np.pi) + np.log(CLUTTER_DENSITY)
    chance = detection_probabilities(scene.semantic_map, pose)[0]
    unmatched = np.setdiff1d(np.arange(len(chance)), j)
    values = (
        -places.sum(),
        -colour_costs(scene)[i, j].sum(),
        np.log(chance[j]).sum(),
        np.log(1 - chance[unmatched]).sum(),
        0.0 - free_space_costs(scene.semantic_map, pose)[0],
    )
    return {name: float(value) for name, value in zip(TERMS, values, strict=True)}


def residual_sigmas(scene: Scene, found: PoseHypothesis) -> np.ndarray:
    """How many standard deviations `(pairs,)` each matched observation lies from its landmark: the root of d^2."""
    i, j = np.array(found.pairs).T
    return np.sqrt(place_distances(scene, np.array(found.pose)[None])[0][0, i, j])


def share_of_nothing(scene: Scene, ranked: tuple[PoseHypothesis, ...]) -> float:
    """Of the belief, "none of these": exp(TEMPER score) as every pose has it. ranked: all of them, not the best few."""
    scores = np.array([one.score for one in ranked] + [len(scene.places) * score_of_nothing(scene.semantic_map)])
    weights = np.exp(TEMPER * (scores - scores.max()))
    return float(weights[-1] / weights.sum())
