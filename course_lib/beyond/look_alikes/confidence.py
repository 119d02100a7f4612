"""How sure the best pose is: is it ahead of the others and of "none of them", and near what was seen?"""

from collections.abc import Sequence

import numpy as np
from scipy.stats import chi2

from course_lib.beyond.look_alikes.evidence import CLUTTER_DENSITY, FAR_RANGE, Evidence
from course_lib.beyond.look_alikes.hypotheses import PoseHypothesis
from course_lib.spherical_stereo.outcomes import Reason
from course_lib.spherical_stereo.pose.rigid_fit import DOUBT
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

# Share of the evidence that is believed, because errors such as a wrong baseline are in all observations at once.
TEMPER = 0.5
MIN_INLIERS = 3  # Matched observations that a pose needs, because two always fit.
MIN_CONFIDENCE = 0.8  # A pose with a smaller confidence is not given out.
MARGIN = 1.0  # Metres that a room reaches beyond its landmarks, if the map has no walls (chosen).


def score_of_nothing(semantic_map: SemanticMap) -> float:
    """Return the score of "none of these poses" for every observation, nats: 1 / area against `CLUTTER_DENSITY`."""
    return -float(np.log(CLUTTER_DENSITY * min(area(semantic_map), np.pi * FAR_RANGE**2)))


def area(semantic_map: SemanticMap) -> float:
    """Return the square metres of the box around the walls, or of a box `MARGIN` around the landmarks."""
    if semantic_map.walls is not None:
        return float(np.prod(np.ptp(semantic_map.walls, axis=0)))
    return float(np.prod(np.ptp(semantic_map.positions, axis=0) + 2 * MARGIN))


def with_shares(ranked: Sequence[PoseHypothesis], score_of_none: float | None) -> tuple[PoseHypothesis, ...]:
    """Return the same poses with their shares of the belief: exp(`TEMPER` score) over the sum of all and of none."""
    scores = [one.score for one in ranked]
    if score_of_none is not None:
        scores.append(score_of_none)
    weights = np.exp(TEMPER * (np.array(scores) - max(scores)))
    shares = weights / weights.sum()
    return tuple(one._replace(share=float(share)) for one, share in zip(ranked, shares, strict=False))


def plausibility(found: PoseHypothesis) -> float:
    """Return min(1, p / `DOUBT`), p the probability of a chi^2 as large as this pose's."""
    return min(1.0, float(chi2.sf(found.chi_square, 2 * len(found.pairs) - 3)) / DOUBT)


def confidence_of(best: PoseHypothesis, evidence: Evidence = Evidence()) -> float:  # noqa: B008
    """Return how sure the best pose is, 0 to 1: its share times its `plausibility`, or 0 below `MIN_INLIERS`."""
    if not evidence.absolute:
        return best.share
    return best.share * plausibility(best) if len(best.pairs) >= MIN_INLIERS else 0.0


def why_unable(n_poses: int, n_matches: int, confidence: float, min_confidence: float) -> Reason | None:
    """Return the reason why the best of n poses, which has n matches, is not given out; None if it is."""
    if confidence >= min_confidence and n_poses:
        return None
    if not n_poses:
        return Reason.NOTHING_AGREES
    return Reason.TOO_FEW_AGREE if n_matches < MIN_INLIERS else Reason.AMBIGUOUS
