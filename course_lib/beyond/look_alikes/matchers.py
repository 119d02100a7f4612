"""The matchers by name. All are called as `associate_greedy` is, and any can stand for another."""

from collections.abc import Callable, Sequence

from scipy.optimize import linear_sum_assignment

from course_lib.beyond.look_alikes.consistent import associate_consistent
from course_lib.spherical_stereo.semantic_map import association
from course_lib.spherical_stereo.semantic_map.association import Association, Observation, PenaltyWeights
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap


def associate_hungarian(
    observations: Sequence[Observation],
    semantic_map: SemanticMap,
    weights: PenaltyWeights = PenaltyWeights(),  # noqa: B008 (it cannot change)
    distance_term: str = "absolute",
) -> Association:
    """Return one-to-one pairs with the smallest sum of the object, hue and saturation terms of eq. (1).

    Called as `associate_greedy`; distance_term serves for the table only.
    """
    table = association.penalty_table(observations, semantic_map, weights, distance_term)
    chosen = linear_sum_assignment(table.object + table.hue + table.saturation)
    pairs = [(int(i), int(j)) for i, j in zip(*chosen, strict=True)]
    return association.association_of(pairs, observations, semantic_map, table)


ASSOCIATIONS: dict[str, Callable[..., Association]] = {
    "greedy": association.associate_greedy,
    "hungarian": associate_hungarian,
    "consistent": associate_consistent,
}


def matcher(name: str) -> Callable[..., Association]:
    """Return the matcher of that name. Raises `ValueError` for a name that does not exist."""
    if name not in ASSOCIATIONS:
        raise ValueError(f"the association must be one of {', '.join(ASSOCIATIONS)}; got {name!r}")
    return ASSOCIATIONS[name]
