"""Several views over time: a few pose hypotheses, each carried on and asked again. Beyond the paper.

A robot that is not sure moves a little and looks again, because two places seldom look alike from three spots.
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
from course_lib.beyond.look_alikes.hypotheses import PoseHypothesis, scene_of
from course_lib.depth_mcl.one_at_a_time import one_at_a_time
from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.outcomes import Reason, Status
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, rotation_2d
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
    view: PoseHypothesis  # how it explains the last view
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
    reason: Reason | None  # why there is no pose
    confidence: float  # 0 to 1
    covariance: np.ndarray | None  # `(3, 3)`
    alternatives: tuple[tuple[Pose2D, float], ...]  # all poses that are believed, with their shares, best first


def carried_on(hypothesis: CarriedPose, motion: Motion) -> CarriedPose:
    """Return a hypothesis after a motion: x + R(theta) (forward, left), theta + turn, and F P F^T + G Q G^T."""
    x, y, theta = hypothesis.mean
    rotation = rotation_2d(theta)
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

    @one_at_a_time
    def step(self, observations: Sequence[Observation], motion: Motion | None = None) -> Track:
        """Return the answer with one more view. motion: since the view before; None without odometry."""
        motion = UNKNOWN_MOTION if motion is None else motion
        if not (np.isfinite(motion[:3]).all() and np.isfinite(motion.covariance).all()):
            raise ValueError(f"motion must be finite metres and radians with a finite covariance; got {motion}")
        predicted = [carried_on(one, motion) for one in self.belief.hypotheses]
        self.belief = self._joined(predicted, self._views(observations, predicted), len(observations))
        return self._answer()

    def _views(self, observations: Sequence[Observation], predicted: list[CarriedPose]) -> list[PoseHypothesis]:
        """Return the poses of a view: those of its own search, and those of the belief refitted to it."""
        views = list(rank_poses(observations, self.semantic_map, self.evidence, SHORT_LIST))
        if not (predicted and len(observations)):
            return views
        means, covariances = (np.array([getattr(one, name) for one in predicted]) for name in ("mean", "covariance"))
        views += explain(scene_of(observations, self.semantic_map), means, covariances, self.evidence)
        poses = np.array([one.pose for one in views]).reshape(-1, 3)
        return [views[k] for k in distinct(poses, np.array([v.score for v in views]), SHORT_LIST)]

    def _joined(self, predicted: list[CarriedPose], views: list[PoseHypothesis], n_observations: int) -> Belief:
        """Return the best few of all pairs of a carried hypothesis and a view's pose, and of the views' poses alone.

        A view's pose alone stands for a rig that was carried there from elsewhere.
        """
        belief = self.belief
        if not views:  # The belief is carried on, no surer than before.
            return belief._replace(hypotheses=tuple(predicted))
        log_nothing = belief.log_nothing + TEMPER * n_observations * score_of_nothing(self.semantic_map)
        prior = -np.log(2 * np.pi * area(self.semantic_map))
        new = [fused(one, view, prior) for one in predicted for view in views]
        elsewhere = 0.0
        if belief.n_views:
            logs = [belief.log_nothing, *(one.log_weight for one in belief.hypotheses)]
            elsewhere = np.log(ELSEWHERE) + np.logaddexp.reduce(logs)
        new += [
            CarriedPose(np.array(view.pose), view.covariance, elsewhere + TEMPER * view.score, view, len(view.pairs))
            for view in views
        ]
        kept = distinct(np.array([one.mean for one in new]), np.array([one.log_weight for one in new]), CARRIED)
        return Belief(tuple(new[k] for k in kept), log_nothing, belief.n_views + 1)

    def _answer(self) -> Track:
        """Return the best pose of the belief if it is sure enough, else "unable", with all alternatives."""
        hypotheses = self.belief.hypotheses
        logs = np.array([*(one.log_weight for one in hypotheses), self.belief.log_nothing])
        weights = np.exp(logs - logs.max())
        shares = weights / weights.sum()  # the last is that of "none of them"
        alternatives = tuple(
            (Pose2D(*map(float, one.mean)), float(share)) for one, share in zip(hypotheses, shares, strict=False)
        )
        n_matches, confidence = 0, 0.0
        if hypotheses:
            best, n_matches, confidence = hypotheses[0], hypotheses[0].n_matches, float(shares[0])
            if self.evidence.absolute:
                confidence *= plausibility(best.view) if n_matches >= MIN_INLIERS else 0.0
        reason = why_unable(len(alternatives), n_matches, confidence, self.min_confidence)
        if reason is not None:
            return Track(None, Status.UNABLE, reason, confidence, None, alternatives)
        return Track(alternatives[0][0], Status.OK, None, confidence, best.covariance, alternatives)
