"""Several views over time: a few pose hypotheses, each carried on and asked again. Beyond the paper.

A robot that is not sure moves a little and looks again. Two places that look alike from one spot seldom look alike from
three, and with odometry a wrong hypothesis must be wrong in the same way every time.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from filterpy.kalman import KalmanFilter

from course_lib.beyond.look_alikes.confidence import (
    MIN_CONFIDENCE,
    MIN_INLIERS,
    TEMPER,
    area,
    plausibility,
    score_of_nothing,
    why_unable,
)
from course_lib.beyond.look_alikes.consistent import SHORT_LIST, distinct, explain, rank_poses
from course_lib.beyond.look_alikes.evidence import Evidence
from course_lib.beyond.look_alikes.hypotheses import PoseHypothesis, rotations, scene_of
from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.pose.localization import OK, UNABLE, Status
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D
from course_lib.spherical_stereo.semantic_map.association import Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

CARRIED = 10  # Hypotheses that a belief keeps.
ELSEWHERE = 1e-3  # probability that between two views the rig was carried anywhere, so that a belief can be given up
REACH_M, REACH_RAD = 0.5, np.deg2rad(20.0)  # standard deviations of a step in each direction, and of a turn, if unknown


class Motion(NamedTuple):
    """How the rig moved since the view before, in the body frame it had then: metres and radians, counterclockwise."""

    forward: float
    left: float
    turn: float
    covariance: np.ndarray  # `(3, 3)` of the three


UNKNOWN_MOTION = Motion(0.0, 0.0, 0.0, np.diag([REACH_M, REACH_M, REACH_RAD]) ** 2)  # no odometry


class CarriedPose(NamedTuple):
    """One hypothesis of the belief."""

    mean: np.ndarray  # `(3,)` [x, y, theta]
    covariance: np.ndarray  # `(3, 3)`
    log_weight: float  # nats
    view: PoseHypothesis  # what it makes of the last view
    n_matches: int = 0  # in all the views that it has explained


class Belief(NamedTuple):
    """What is believed after some views: hypotheses, best first, and log_nothing, nats, that none of them is right."""

    hypotheses: tuple[CarriedPose, ...] = ()
    log_nothing: float = 0.0
    n_views: int = 0


class Track(NamedTuple):
    """The answer after a view."""

    pose: Pose2D | None  # of the last view; None if unable
    status: Status
    reason: str | None
    confidence: float  # 0 to 1
    covariance: np.ndarray | None  # `(3, 3)`
    alternatives: tuple[tuple[Pose2D, float], ...]  # all poses that are believed, with their shares, best first


def carried_on(hypothesis: CarriedPose, motion: Motion) -> CarriedPose:
    """Return a hypothesis after a motion: x + R(theta) (forward, left), theta + turn, and F P F^T + G Q G^T."""
    x, y, theta = hypothesis.mean
    rotation = rotations(np.array(theta))
    step = rotation @ np.array([motion.forward, motion.left])
    by_state, by_motion = np.eye(3), np.eye(3)
    by_state[:2, 2] = -step[1], step[0]
    by_motion[:2, :2] = rotation
    covariance = by_state @ hypothesis.covariance @ by_state.T + by_motion @ motion.covariance @ by_motion.T
    mean = np.array([x + step[0], y + step[1], wrap_angle(theta + motion.turn)])
    return hypothesis._replace(mean=mean, covariance=covariance)


def fused(carried: CarriedPose, view: PoseHypothesis, prior_log_density: float) -> CarriedPose:
    """Join a carried hypothesis and a pose of the new view by a Kalman update with the view's pose as measurement.

    The weight grows by the view's score and by log N(view - carried; 0, P + P_view) against an unknown pose's density.
    """
    kalman = KalmanFilter(dim_x=3, dim_z=3)
    kalman.x, kalman.P = carried.mean.reshape(3, 1).copy(), carried.covariance.copy()
    kalman.H, kalman.R = np.eye(3), view.covariance
    measured = np.array(view.pose, dtype=np.float64)
    measured[2] = carried.mean[2] + wrap_angle(measured[2] - carried.mean[2])  # on the branch of the carried angle
    kalman.update(measured)
    mean = kalman.x.ravel()
    mean[2] = wrap_angle(mean[2])
    agreement = float(kalman.log_likelihood) - prior_log_density
    return CarriedPose(
        mean, kalman.P, carried.log_weight + TEMPER * view.score + agreement, view, carried.n_matches + len(view.pairs)
    )


class SemanticTracker:
    """Poses of a moving rig on a semantic map, from one view after another; the state is `belief`.

    evidence: what counts. min_confidence: below it the answer is "unable" with the alternatives.
    """

    def __init__(
        self,
        semantic_map: SemanticMap,
        evidence: Evidence = Evidence(),  # noqa: B008 (it cannot change)
        min_confidence: float = MIN_CONFIDENCE,
    ):
        self.semantic_map, self.evidence, self.min_confidence = semantic_map, evidence, min_confidence
        self.belief = Belief()

    def step(self, observations: Sequence[Observation], motion: Motion | None = None) -> Track:
        """Return the answer with one more view. motion: since the view before; None without odometry."""
        self.belief = updated(
            self.belief, observations, self.semantic_map, UNKNOWN_MOTION if motion is None else motion, self.evidence
        )
        return answer(self.belief, self.evidence, self.min_confidence)


def updated(
    belief: Belief,
    observations: Sequence[Observation],
    semantic_map: SemanticMap,
    motion: Motion,
    evidence: Evidence = Evidence(),  # noqa: B008
) -> Belief:
    """Return the belief after one more view: predicted, joined with the view's own poses, and cut to the best few.

    Each pose of the view also stands for itself, as one that the rig was carried to from elsewhere.
    """
    if not (np.isfinite(motion[:3]).all() and np.isfinite(motion.covariance).all()):
        raise ValueError(f"motion must be finite metres and radians with a finite covariance; got {motion}")
    predicted = [carried_on(one, motion) for one in belief.hypotheses]
    views = list(rank_poses(observations, semantic_map, evidence, SHORT_LIST))
    if predicted and len(observations):
        # Where the belief is, the view is asked too, though its own search found other places better.
        means, covariances = (np.array([getattr(one, name) for one in predicted]) for name in ("mean", "covariance"))
        views += explain(scene_of(observations, semantic_map), means, covariances, evidence)
        kept = distinct(
            np.array([one.pose for one in views]).reshape(-1, 3), np.array([v.score for v in views]), SHORT_LIST
        )
        views = [views[k] for k in kept]
    log_nothing = belief.log_nothing + TEMPER * len(observations) * score_of_nothing(semantic_map)
    prior = -np.log(2 * np.pi * area(semantic_map))
    new = [fused(one, view, prior) for one in predicted for view in views]
    elsewhere = 0.0
    if belief.n_views:
        elsewhere = np.log(ELSEWHERE) + np.logaddexp.reduce(
            [belief.log_nothing, *(one.log_weight for one in belief.hypotheses)]
        )
    new += [
        CarriedPose(np.array(view.pose), view.covariance, elsewhere + TEMPER * view.score, view, len(view.pairs))
        for view in views
    ]
    if not new:
        # Nothing could be made of this view: what was believed is carried on, no surer than before.
        return Belief(tuple(predicted), belief.log_nothing, belief.n_views)
    kept = distinct(np.array([one.mean for one in new]), np.array([one.log_weight for one in new]), CARRIED)
    return Belief(tuple(new[k] for k in kept), log_nothing, belief.n_views + 1)


def shares(belief: Belief) -> np.ndarray:
    """Return the share `(k,)` of every hypothesis in the belief. The rest to 1 is "none of them"."""
    logs = np.array([*(one.log_weight for one in belief.hypotheses), belief.log_nothing])
    weights = np.exp(logs - logs.max())
    return (weights / weights.sum())[:-1]


def answer(belief: Belief, evidence: Evidence = Evidence(), min_confidence: float = MIN_CONFIDENCE) -> Track:  # noqa: B008
    """Return the best pose of a belief if it is sure enough, else "unable", with all alternatives."""
    share = shares(belief)
    alternatives = tuple(
        (Pose2D(*map(float, one.mean)), float(s)) for one, s in zip(belief.hypotheses, share, strict=True)
    )
    n_matches, confidence = 0, 0.0
    if alternatives:
        best, n_matches, confidence = belief.hypotheses[0], belief.hypotheses[0].n_matches, float(share[0])
        if evidence.absolute:
            confidence *= plausibility(best.view) if n_matches >= MIN_INLIERS else 0.0
    reason = why_unable(len(alternatives), n_matches, confidence, min_confidence)
    if reason is not None:
        return Track(None, UNABLE, reason, confidence, None, alternatives)
    return Track(alternatives[0][0], OK, None, confidence, best.covariance, alternatives)
