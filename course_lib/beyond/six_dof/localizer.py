"""Track a depth camera in six degrees of freedom, which paper 1 leaves for the future (section 5).

    localizer = AnnealedLocalizer(renderer, seed=0)
    localizer.initialize(state0)
    for depth in recording:
        estimate = localizer.step(depth)

A frame goes through the paper's steps several times, each time closer:

    measure    the motion since the last image, from both images (image_motion.py)
    predict    where the camera may be, and how far from there, by its motions so far (prediction.py)
    search     anneal particles on coarse images, and refine the best of them on finer ones (search.py)
    doubt      if the best pose agrees with the map less than usual, search once more in a wider cloud
    decide     keep the prediction along what the image does not show (covariance.py), or all of it where the map does
               not hold the view
    judge      say whether the pose is known (being_lost.py), and whether the intrinsics fit (calibration.py)

`step` computes all this first and then changes the filter's state once. Particles are camera-to-world matrices
`(N, 4, 4)` here, optical convention. Their noise is drawn in the tangent space, which has no gimbal lock. Estimates
are states, as `MonteCarloLocalizer` gives them.
"""

import warnings
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from course_lib.beyond.being_lost import TrackJudge, judge_refined
from course_lib.beyond.six_dof.calibration import Calibration, CalibrationCheck
from course_lib.beyond.six_dof.covariance import (
    PREDICTED,
    fused,
    in_world_and_body,
    is_near,
    pose_information,
    predicted_covariance,
    with_rivals,
)
from course_lib.beyond.six_dof.image_motion import View, image_motion, views_of
from course_lib.beyond.six_dof.poses import local, optical_increment, retract
from course_lib.beyond.six_dof.prediction import (
    MAX_SPREAD,
    START_SPREAD,
    WIDER,
    MeasuredMotion,
    MotionPrediction,
    Rival,
)
from course_lib.beyond.six_dof.schedule import LAYERS, SECOND_LOOK, STEPS, SURE_LAYERS, Layer, Step, pyramid
from course_lib.beyond.six_dof.search import Cloud, Found, search
from course_lib.depth_mcl.likelihood import checked_image, valid_pixels
from course_lib.depth_mcl.localizer import NoMeasurementWarning, checked_start
from course_lib.depth_mcl.motion import TANGENT_SPACE
from course_lib.depth_mcl.one_at_a_time import one_at_a_time
from course_lib.depth_mcl.status import NOTHING_MEASURED, Agreement, TrackStatus, agreement, is_known
from course_lib.depth_mcl.uncertainty import Tempered, temper
from course_lib.geometry import optical_pose, state_from_optical_pose
from course_lib.rendering.renderer import DepthRenderer

# Chosen on the kitchen and the shipped corridor; SEEN and IMAGE_FIRST also on walks through rooms, seeds 10,041 to
# 10,066, and on a HoloLens's rooms.
SURE = np.array([0.06, np.deg2rad(3.0)])  # metres, radians: a cloud so small needs few particles
NOTHING_BEHIND = 0.01  # share of pixels behind the map: with at most this, a pose that the motion confirms is settled
CLEAR = 0.05  # share of pixels behind the map: with more, the camera may as well be where it was predicted
SEEN = 0.06  # of raw score (alpha = 0.1 m): the most that moving along directions that no image shows may cost
IMAGE_FIRST = 4  # times the image's information moves the pose: motions' errors add up, the map's errors do not
CHECKED = 3  # every third tracked frame checks the intrinsics, which saves time


class AnnealedEstimate(NamedTuple):
    """The estimate of one frame: `Estimate`'s fields, and how it was reached."""

    state: np.ndarray  # `(6,)` the best refined pose
    covariance: np.ndarray  # `(6, 6)` of the last particles, metres in world axes, radians in body axes
    score: float  # raw score of the refined pose: eq. (8) as a mean over pixels of the finest image
    ess: float  # effective sample size of the last layer's weights
    particles: np.ndarray  # `(N, 6)` of the last layer
    weights: np.ndarray  # `(N,)` of these particles
    status: TrackStatus  # what being_lost.py says of the state
    error_covariance: np.ndarray  # `(6, 6)`, the same units and axes: of the error to expect while "tracked"
    agreement: Agreement  # how the measured image agrees with the map as seen from the state
    layers: tuple[Tempered, ...]  # weights, sharpness and effective sample size of every layer, in order
    renders: int  # how many images were rendered for this frame
    calibration: Calibration  # the camera's intrinsics by the tracked images so far


class Decision(NamedTuple):
    """The pose that one frame leads to; `AnnealedLocalizer.step` applies it to the filter's state."""

    found: Found  # With the pose that is reported.
    covariance: np.ndarray  # `(6, 6)` of its error, along and about the camera's axes.
    image_says: TrackStatus  # The status by this frame's own image.
    is_found: bool  # Whether the camera is at this pose: else it may also be elsewhere.
    shows_all: bool  # Whether the image shows all six directions.


class AnnealedLocalizer:
    """Track a depth camera that moves freely, by an annealed particle filter with Gauss-Newton refinement.

    n_particles: of a layer whose share is 1. seed: of all draws. sure_layers: where the motion was measured to within
    `SURE`. second_look: layers after a doubtful search (empty: none). steps: of the refinement (empty: the best
    particle). rivals: how many other poses are kept. fuse: joins prediction and image. prediction: called with the
    first pose. image_motion: whether two images measure the motion. Raises `ValueError` for bad numbers, or no layer.
    """

    takes = frozenset({"increment"})  # what `step` can use in addition to the image

    def __init__(
        self,
        renderer: DepthRenderer,
        n_particles: int = 200,
        *,
        seed: int = 0,
        layers: tuple[Layer, ...] = LAYERS,
        sure_layers: tuple[Layer, ...] = SURE_LAYERS,
        second_look: tuple[Layer, ...] = SECOND_LOOK,
        steps: tuple[Step, ...] = STEPS,
        rivals: int = 1,
        fuse: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]] = fused,
        prediction: Callable[[np.ndarray], MotionPrediction] = MotionPrediction,
        image_motion: bool = True,
    ) -> None:
        for name, value, least in (("n_particles", n_particles, 1), ("seed", seed, 0), ("rivals", rivals, 0)):
            if int(value) != value or value < least:
                raise ValueError(f"{name} must be a whole number, {least} or more; got {value!r}")
        if not (layers and sure_layers):
            raise ValueError("at least one layer is needed: it draws the particles")
        self.renderer = renderer
        self.n_particles = int(n_particles)
        self.levels = pyramid(renderer)
        self.layers, self.sure_layers = tuple(layers), tuple(sure_layers)
        self.second_look, self.steps = tuple(second_look), tuple(steps)
        self.rivals, self.fuse, self.image_motion = rivals, fuse, image_motion
        self.rng = np.random.default_rng(int(seed))
        self.motion = TANGENT_SPACE
        self._new_prediction = prediction
        self._prediction: MotionPrediction | None = None
        self._judge = TrackJudge()
        self._calibration, self._tracked = CalibrationCheck(), 0  # of all frames, because a camera keeps its intrinsics
        self._pose: np.ndarray | None = None  # the last estimate
        self._covariance: np.ndarray | None = None  # of its error; None before the first image
        self._views: list[View] | None = None  # of the last image

    @one_at_a_time
    def initialize(self, state0: np.ndarray) -> None:
        """Start at the state `(6,)`, which is right to within `START_SPREAD`."""
        self._pose = optical_pose(checked_start(state0, self.renderer.scene_map))
        self._prediction = self._new_prediction(self._pose)
        self._judge = TrackJudge()
        self._covariance = self._views = None

    @one_at_a_time
    def step(self, depth: np.ndarray, increment: np.ndarray | None = None) -> AnnealedEstimate:
        """Return where the camera is, from a depth image `(H, W)` in metres, NaN = no measurement.

        increment: motion `(6,)` since the last frame by an odometer or an IMU, along and about the body's axes at that
        frame (x forward, y left, z up), metres and radians; `motion_between` gives it from two states. Raises
        `ValueError` for a wrong one, before anything changes. A frame without any measurement warns
        (`NoMeasurementWarning`), and its state is the prediction.
        """
        prediction = self._prediction
        if prediction is None:
            raise RuntimeError("call initialize(state0) before the first step: the filter is given its start")
        depth = checked_image(depth, self.renderer.camera)
        measured = None if increment is None else MeasuredMotion.of_odometer(optical_increment(increment))
        for level in self.levels:
            level.measure(depth)
        if valid_pixels(self.levels[-1].measured).any():
            views = views_of(depth, self.renderer.camera)
            measured = self._measured_motion(views, measured)
            found, cloud = self._look_twice(Cloud(prediction, prediction.spread(measured), measured))
            decision = self._decide(found, cloud)
            status = self._judge.judge(
                decision.image_says, decision.found.agreement, decision.covariance, bool(decision.found.rivals)
            )
            error_covariance = self._calibrated(decision, status)
        else:
            warnings.warn(
                "this frame holds no measurement between the camera's near and far planes; the pose is predicted only",
                NoMeasurementWarning,
                stacklevel=3,
            )
            # Without an odometer the next image measures the motion since the image before this frame.
            views = self._views if measured is None else None
            cloud = Cloud(prediction, prediction.spread(measured), measured)
            decision = self._predicted_only(cloud)
            status, error_covariance = decision.image_says, decision.covariance
        found = decision.found
        if decision.is_found:
            prediction.found(found.pose, decision.shows_all, found.rivals)
        else:
            prediction.not_found(found.pose, cloud.spread, found.rivals, measured)
        self._pose, self._covariance, self._views = found.pose, decision.covariance, views
        return self._estimate(found, status, error_covariance)

    def _measured_motion(self, views: list[View], odometer: MeasuredMotion | None) -> MeasuredMotion | None:
        """Return the motion since the last image, from both images and the odometer if there is one."""
        if self._views is None or not self.image_motion:
            return odometer
        if odometer is not None:
            return image_motion(self._views, views, odometer.motion, self._prediction.spread(odometer)) or odometer
        return image_motion(self._views, views, self._prediction.motion, self._prediction.guess_spread())

    def _look_twice(self, expected: Cloud) -> tuple[Found, Cloud]:
        """Return the best pose and its cloud; search a wider cloud, too, if that pose agrees less than usual."""
        not_known = 0.0 if self._covariance is None else np.sqrt(np.diag(self._covariance))
        spread = np.minimum(np.hypot(expected.spread, not_known), np.repeat(MAX_SPREAD, 3))
        is_sure = expected.measured is not None and (spread <= np.repeat(SURE, 3)).all()
        found = self._look(expected._replace(spread=spread), self.sure_layers if is_sure else self.layers)
        is_settled = found.agreement.through <= NOTHING_BEHIND and self._is_confirmed(found, expected)
        if self.second_look and self._judge.doubts(found.agreement) and not is_settled:
            wider = expected._replace(spread=np.maximum(WIDER * spread, np.repeat(START_SPREAD, 3)))
            again = self._look(wider, self.second_look)
            if again.score > found.score:
                return again, wider
        return found, expected

    def _look(self, cloud: Cloud, layers: tuple[Layer, ...]) -> Found:
        return search(
            self.levels, cloud, layers, self.steps, self.rng, n_particles=self.n_particles, n_rivals=self.rivals
        )

    def _is_confirmed(self, found: Found, cloud: Cloud) -> bool:
        """Return whether a pose that fits the map is also where the measured motion leads."""
        if cloud.measured is None or self._covariance is None or judge_refined(found.agreement) != "tracked":
            return False
        predicted, covariance = self._predicted(found.pose, cloud)
        return is_known(covariance) and is_near(local(predicted, found.pose), covariance)

    def _predicted(self, pose: np.ndarray, cloud: Cloud) -> tuple[np.ndarray, np.ndarray]:
        """Return the predicted pose `(4, 4)` that lies nearest to `pose`, and the covariance `(6, 6)` of its error."""
        before, predicted = cloud.prediction.origin(pose, cloud.spread, cloud.measured)
        return predicted, self._predicted_covariance(local(before, predicted), cloud)

    def _predicted_covariance(self, motion: np.ndarray, cloud: Cloud) -> np.ndarray:
        """Return the covariance `(6, 6)` after a motion `(6,)`. At the first image it is as wide as the cloud."""
        if self._covariance is None:
            return np.diag(cloud.spread**2)
        measured = cloud.measured
        noise = np.diag((PREDICTED * cloud.spread) ** 2) if measured is None else measured.covariance
        return predicted_covariance(self._covariance, motion, noise)

    def _decide(self, found: Found, cloud: Cloud) -> Decision:
        """Join the pose that was found and the prediction.

        Along what the image does not show, the pose moves back to the prediction. If the image does not fit the map, as
        beyond the map's edge, the measured motion carries the pose, as long as it is known, and it is doubtful.
        """
        _, middle, fine = self.levels
        predicted, covariance = self._predicted(found.pose, cloud)
        information = pose_information(middle.measured, middle.draw(found.pose[None])[0], middle.renderer.camera)
        narrowed, _ = self.fuse(covariance, information)
        image_says = self._judge.judge_image(found.agreement)
        if image_says == "tracked" or self._is_confirmed(found, cloud):
            _, gain = self.fuse(covariance, IMAGE_FIRST * information)
            apart = local(predicted, found.pose)
            pose = retract(predicted, gain @ apart)
            is_surprising = cloud.measured is not None and not is_near(apart, covariance)
            lost_score = float(fine.score(fine.draw(pose[None]))[0]) - found.score
            others = [*found.rivals, Rival(predicted, 0.0)] if is_surprising else list(found.rivals)
            if is_surprising or lost_score < -SEEN:
                others.append(Rival(pose, lost_score))
                pose = found.pose
            shows_all = bool(np.linalg.matrix_rank(information, hermitian=True) == 6)
            covariance = with_rivals(narrowed, pose, others)
            return Decision(found._replace(pose=pose), covariance, image_says, True, shows_all)
        fits = judge_refined(found.agreement) == "tracked"
        if cloud.measured is not None and not fits and is_known(covariance):
            pose = retract(self._pose, cloud.measured.motion)
            agrees = agreement(fine.measured, fine.draw(pose[None])[0])
            if not agrees.contradicts:
                carried = found._replace(pose=pose, agreement=agrees, rivals=())
                return Decision(carried, covariance, "doubtful", True, False)
        if fits and found.agreement.through > CLEAR:
            narrowed = with_rivals(narrowed, found.pose, [Rival(predicted, 0.0)])
        return Decision(found, narrowed if fits else covariance, image_says, False, False)

    def _predicted_only(self, cloud: Cloud) -> Decision:
        """Return the prediction alone, because the image shows nothing."""
        prediction, spread, measured = cloud
        particles = prediction.draw(self.n_particles, spread, self.rng, measured)
        pose = prediction.pose if measured is None else retract(prediction.pose, measured.motion)
        covariance = self._predicted_covariance(local(prediction.pose, pose), cloud)
        layers = (temper(np.zeros(len(particles)), len(particles)),)
        found = Found(pose, np.nan, NOTHING_MEASURED, particles, layers, ())
        return Decision(found, covariance, "no measurement", False, False)

    def _calibrated(self, decision: Decision, status: TrackStatus) -> np.ndarray:
        """Return the covariance `(6, 6)`, wider where the intrinsics are doubted; check them with some tracked frames.

        The wider covariance is not kept, because this error is the same in the next frame.
        """
        self._tracked += status == "tracked"
        is_checked = status == "tracked" and self._tracked % CHECKED == 0
        is_doubted = self._calibration.estimate().doubted.any()
        if not (is_checked or is_doubted):
            return decision.covariance
        middle = self.levels[1]
        images = middle.measured, middle.draw(decision.found.pose[None])[0], middle.renderer.camera
        if is_checked:
            self._calibration.add(*images)
        if not is_doubted:
            return decision.covariance
        return decision.covariance + self._calibration.pose_covariance(*images)

    def _estimate(self, found: Found, status: TrackStatus, error_covariance: np.ndarray) -> AnnealedEstimate:
        state, particles = state_from_optical_pose(found.pose), state_from_optical_pose(found.particles)
        last = found.layers[-1]
        deviations = self.motion.deviations(particles, state)
        return AnnealedEstimate(
            state=state,
            covariance=(last.weights[:, None] * deviations).T @ deviations,
            score=found.score,
            ess=last.ess,
            particles=particles,
            weights=last.weights,
            status=status,
            error_covariance=in_world_and_body(error_covariance, found.pose),
            agreement=found.agreement,
            layers=found.layers,
            renders=sum(level.renders for level in self.levels),
            calibration=self._calibration.estimate(),
        )
