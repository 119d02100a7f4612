"""The assignment of least total cost on class and colour alone: a comparison for the paper's greedy search.

It is the best that can be done without geometry, and worse than the greedy search with its blunt distance term: where
objects look alike, colour is noise, and the assignment obeys it exactly. Geometry must come first (`pose.consistent`).
"""

from __future__ import annotations

from collections.abc import Sequence

from scipy.optimize import linear_sum_assignment

from course_lib.spherical_stereo.semantic_map.association import (
    Association,
    Observation,
    Penalty,
    PenaltyWeights,
    penalty_table,
)
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap


def associate_hungarian(
    observations: Sequence[Observation],
    semantic_map: SemanticMap,
    weights: PenaltyWeights = PenaltyWeights(),  # noqa: B008 (it cannot change)
    distance_term: str = "absolute",
) -> Association:
    """One-to-one pairs that make the sum of the object, hue and saturation terms of eq. (1) least.

    The interface of `associate_greedy`; distance_term is looked at in the table only. Raises `AssociationError` as
    `penalty_table` does.
    """
    table = penalty_table(observations, semantic_map, weights, distance_term)
    chosen = linear_sum_assignment(table.object + table.hue + table.saturation)
    return association_of(((int(i), int(j)) for i, j in zip(*chosen, strict=True)), observations, table)


def association_of(pairs, observations: Sequence[Observation], table: Penalty) -> Association:
    """The `Association` of pairs that a matcher without rounds has chosen: (observation, landmark), in their order."""
    pairs = tuple(pairs)
    return Association(
        pairs,
        tuple(Penalty(*(float(term[pair]) for term in table)) for pair in pairs),
        tuple(bool(table.object[pair] == 0) for pair in pairs),
        tuple(sorted(set(range(len(observations))) - {i for i, _ in pairs})),
        table,
    )
