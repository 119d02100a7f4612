"""Which observed object is which on the map: the penalty of eq. (1) and the paper's greedy search (section 2.5).

Eq. (1) measures distances to the centroid of the *observed* objects on one side and of *all* objects of the map on the
other. They are one place only if everything on the map is seen, so the term needs no pose, but it is blunt.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from course_lib.spherical_stereo.detection.detected_object import canonical_label
from course_lib.spherical_stereo.outcomes import Reason
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap

DISTANCE_TERMS = ("absolute", "as_printed")
MIN_DISTANCE = 0.1  # metres: the smallest |dx_m| that eq. (1) divides by, or an object at the map's centroid gives 0/0
TIE = 1e-9  # Penalties nearer than this are equal, because rounding must not choose between two objects that are alike.


class AssociationError(ValueError):
    """Observations, weights or options that no penalty can be computed from."""


class Observation(NamedTuple):
    """One detected and triangulated object, Z of the paper: the map's fields, but in the body frame."""

    label: str
    x: float  # centroid, metres: forward
    y: float  # left
    hue: float  # degrees [0, 360), NaN for grey
    saturation: float  # percent [0, 100]
    covariance: np.ndarray | None = None  # `(2, 2)` of x and y, square metres; None if nothing is known


class PenaltyWeights(NamedTuple):
    """The four weights of eq. (1), "set by hand" in the paper, which gives no numbers.

    Each comparison weighs one. p_obj is above all that they can add up to, up to 9.8 m from the observed centroid.
    """

    p_obj: float = 100.0  # Cost of unlike classes.
    p_h: float = 1.0  # Weight of the hue difference over 360 degrees; at most half of it counts, because of the circle.
    p_s: float = 1.0  # Weight of the saturation difference over 100 percent.
    p_d: float = 1.0  # Weight of the relative difference of the distances to the centroids.


class Penalty(NamedTuple):
    """Eq. (1) term by term and their sum: numbers for one pair, arrays `(n_observations, n_landmarks)` in a table."""

    object: float
    hue: float
    saturation: float
    distance: float
    total: float


class Association(NamedTuple):
    """Result of a matcher: pairs of indices (observation, landmark), and how they came about."""

    pairs: tuple[tuple[int, int], ...]  # In the order in which they were chosen.
    penalties: tuple[Penalty, ...]  # Of the pairs.
    same_class: tuple[bool, ...]  # False for a pair of unlike classes, which is never used for the fit
    unassigned: tuple[int, ...]  # Observations without a partner.
    table: Penalty  # Every observation with every landmark, `(n_observations, n_landmarks)` arrays.
    hypotheses: tuple = ()  # the poses that a matcher beyond the paper weighed, best first
    confidence: float | None = None  # How sure the best of them is, 0 to 1; None from a matcher that weighs no poses.
    reason: Reason | None = None  # Why the best of them should not be given out; None if it should.
    explanation: str = ""  # The reason in a sentence.

    @property
    def usable_pairs(self) -> tuple[tuple[int, int], ...]:
        """Return the pairs of like classes: those a pose may be fitted to."""
        return tuple(pair for pair, same in zip(self.pairs, self.same_class, strict=True) if same)


def hue_difference(hue_a: np.ndarray | float, hue_b: np.ndarray | float) -> np.ndarray:
    """Return the difference of hues on the circle, degrees [0, 180]: 350 and 10 differ by 20. NaN for grey."""
    apart = np.abs(np.asarray(hue_a, dtype=np.float64) - np.asarray(hue_b, dtype=np.float64)) % 360.0
    return np.minimum(apart, 360.0 - apart)


def penalty(
    observed: Observation,
    landmark: Landmark,
    observed_centroid: np.ndarray,
    map_centroid: np.ndarray,
    weights: PenaltyWeights = PenaltyWeights(),  # noqa: B008 (it cannot change)
    distance_term: str = "absolute",
) -> Penalty:
    """Return how unlike an observed object and one of the map are.

    penalty = p_obj + p_h dh / 360 + p_s ds / 100 + p_d (|dx_c| - |dx_m|) / |dx_m|

    p_obj counts only if the classes differ. dh: degrees on the circle, at most 180, so its term is at most half of p_h;
    0 if either side is grey. ds: percent. dx_c, dx_m: horizontal, metres, from the centroids; the divisor is at least
    `MIN_DISTANCE`. distance_term: "absolute" takes the absolute value of the distance term; "as_printed" falls below
    zero for an object that looks too near the centroid. Fields may be arrays that broadcast, and then so do the terms.
    Raises `AssociationError` for values that cannot be. Source: paper 2, eq. (1).
    """
    if distance_term not in DISTANCE_TERMS:
        raise AssociationError(f"distance_term must be one of {DISTANCE_TERMS}; got {distance_term!r}")
    if not (np.isfinite(weights).all() and min(weights) >= 0):
        raise AssociationError(f"weights must be finite and not negative; got {weights}")
    _check_values("observation", observed)
    _check_values("landmark", landmark)
    for name, centroid in (("observed", observed_centroid), ("map", map_centroid)):
        if np.shape(centroid) != (2,) or not np.isfinite(centroid).all():
            raise AssociationError(f"the {name} centroid must be two finite numbers in metres; got {centroid!r}")
    canonical = np.vectorize(canonical_label, otypes=[object])
    unlike = canonical(observed.label) != canonical(landmark.label)
    d_hue = hue_difference(observed.hue, landmark.hue)
    d_saturation = np.abs(np.asarray(observed.saturation) - np.asarray(landmark.saturation))
    from_centroid_c = np.hypot(observed.x - observed_centroid[0], observed.y - observed_centroid[1])
    from_centroid_m = np.hypot(landmark.x - map_centroid[0], landmark.y - map_centroid[1])
    d_distance = (from_centroid_c - from_centroid_m) / np.maximum(from_centroid_m, MIN_DISTANCE)
    terms = np.broadcast_arrays(
        np.where(unlike, weights.p_obj, 0.0),
        weights.p_h * np.where(np.isnan(d_hue), 0.0, d_hue) / 360.0,
        weights.p_s * d_saturation / 100.0,
        weights.p_d * (np.abs(d_distance) if distance_term == "absolute" else d_distance),
    )
    return Penalty(*(float(term) if term.ndim == 0 else term.copy() for term in (*terms, sum(terms))))


def penalty_table(
    observations: Sequence[Observation],
    semantic_map: SemanticMap,
    weights: PenaltyWeights = PenaltyWeights(),  # noqa: B008
    distance_term: str = "absolute",
) -> Penalty:
    """Return every term for every observation with every landmark: arrays `(n_observations, n_landmarks)`."""
    if len(observations) == 0:
        return Penalty(*(np.empty((0, len(semantic_map))) for _ in Penalty._fields))
    labels, *numbers = zip(*(tuple(one)[:5] for one in observations), strict=True)
    x, y, hue, saturation = np.array(numbers, dtype=np.float64)[..., None]
    rows = Observation(np.array(labels, dtype=object)[:, None], x, y, hue, saturation)
    map_x, map_y = semantic_map.positions.T[:, None]
    map_colours = semantic_map.hues[None], semantic_map.saturations[None]
    columns = Observation(np.array(semantic_map.labels)[None], map_x, map_y, *map_colours)
    centroid = np.array([x.mean(), y.mean()])
    return penalty(rows, columns, centroid, semantic_map.centroid, weights, distance_term)


def associate_greedy(
    observations: Sequence[Observation],
    semantic_map: SemanticMap,
    weights: PenaltyWeights = PenaltyWeights(),  # noqa: B008
    distance_term: str = "absolute",
) -> Association:
    """Pair observations with landmarks as the paper does: take the cheapest open combination until a side is used up.

    Among equal penalties (within `TIE`) the first observation is taken, then the first landmark. Raises
    `AssociationError` as `penalty_table` does. Source: paper 2, section 2.5.
    """
    table = penalty_table(observations, semantic_map, weights, distance_term)
    open_cost = table.total.copy()
    pairs = []
    for _ in range(min(open_cost.shape)):
        chosen = np.argmax(open_cost <= open_cost.min() + TIE)  # the first True, row by row
        i, j = (int(index) for index in np.unravel_index(chosen, open_cost.shape))
        pairs.append((i, j))
        open_cost[i, :] = open_cost[:, j] = np.inf
    return association_of(pairs, observations, semantic_map, table)


def association_of(
    pairs: Sequence[tuple[int, int]], observations: Sequence[Observation], semantic_map: SemanticMap, table: Penalty
) -> Association:
    """Return the `Association` of the pairs (observation, landmark) that a matcher has chosen, in their order."""
    pairs = tuple(pairs)
    return Association(
        pairs,
        tuple(Penalty(*(float(term[pair]) for term in table)) for pair in pairs),
        tuple(canonical_label(observations[i].label) == semantic_map.labels[j] for i, j in pairs),
        tuple(sorted(set(range(len(observations))) - {i for i, _ in pairs})),
        table,
    )


def _check_values(name: str, side: Observation | Landmark) -> None:
    """Raise `AssociationError` for values that no observation or landmark may have; numbers or arrays."""
    hue, saturation = np.asarray(side.hue, dtype=np.float64), np.asarray(side.saturation, dtype=np.float64)
    are_colours = (np.isnan(hue) | ((hue >= 0) & (hue < 360))).all() and ((saturation >= 0) & (saturation <= 100)).all()
    if not (are_colours and np.isfinite(side.x).all() and np.isfinite(side.y).all()):
        raise AssociationError(
            f"{name}: x and y must be finite metres, hue in [0, 360) degrees or NaN for grey, saturation in [0, 100] "
            f"percent; got {side}"
        )
