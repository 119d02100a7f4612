"""Six degrees of freedom, which paper 1 leaves for the future (section 5): its filter, annealed and refined.

    localizer = AnnealedLocalizer(renderer, seed=0)
    localizer.initialize(state0)
    for depth in recording:
        estimate = localizer.step(depth)

A frame goes through the paper's steps several times, each time closer:

    measure    the motion since the last image, from both images (image_motion.py)
    predict    draw particles about where the camera may be, as wide as it has been moving (prediction.py)
    anneal     weigh them on coarse images, gently, so that enough survive (uncertainty.py); resample; with less noise
    refine     take the best that differ (poses.py) and refine them by Gauss-Newton on finer and finer images
               (refinement.py, schedule.py)
    doubt      if the best agrees less with the map than frames did before, look once more with a wider cloud
    fuse       believe the prediction along what the image does not show (covariance.py), or all of it where the map
               does not hold the view
    judge      say whether the pose is known (being_lost.py), and whether the intrinsics fit (calibration.py)

Particles are camera-to-world matrices `(N, 4, 4)` here, optical convention, and their noise is drawn in the tangent
space, which has no gimbal lock. Estimates are states, as `MonteCarloLocalizer` gives them.
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
from course_lib.beyond.six_dof.image_motion import View, image_motion
from course_lib.beyond.six_dof.poses import distinct, local, optical_increment, retract
from course_lib.beyond.six_dof.prediction import (
    MAX_SPREAD,
    START_SPREAD,
    WIDER,
    MeasuredMotion,
    MotionPrediction,
    Rival,
)
from course_lib.beyond.six_dof.schedule import (
    COARSE,
    LAYERS,
    MIDDLE,
    SECOND_LOOK,
    STEPS,
    SURE_LAYERS,
    Layer,
    Step,
    pyramid,
)
from course_lib.depth_mcl.likelihood import checked_image, valid_pixels
from course_lib.depth_mcl.localizer import NoMeasurementWarning, checked_start
from course_lib.depth_mcl.motion import TANGENT_SPACE
from course_lib.depth_mcl.one_at_a_time import one_at_a_time
from course_lib.depth_mcl.particle_filter import resample
from course_lib.depth_mcl.status import NOTHING_MEASURED, Agreement, TrackStatus, agreement, is_known
from course_lib.depth_mcl.uncertainty import Tempered, temper
from course_lib.geometry import optical_pose, state_from_optical_pose
from course_lib.rendering.renderer import DepthRenderer

# All chosen on the kitchen and the shipped corridor; SEEN, IMAGE_FIRST and those of rivals on walks through rooms, too,
# seeds 10,041 to 10,066, and on a HoloLens's rooms.
APART = 0.2  # of the prediction's spread: two particles nearer than this are one hypothesis
DISTINCT = np.array([0.02, np.deg2rad(1.0)])  # metres, radians: the same for two refined poses
SURE = np.array([0.06, np.deg2rad(3.0)])  # metres, radians: a cloud so small needs few particles
NOTHING_BEHIND = 0.01  # the same share, up to which a pose where the measured motion leads needs no second look
CLEAR = 0.05  # share of pixels measured behind the map up to which a pose that fits little of the map may be known
SEEN = 0.06  # of raw score: what moving a pose along directions that the image does not show may cost
RIVAL_WITHIN = 0.06  # of raw score: a pose that fits less is no rival of the best
RIVAL_APART = np.array([0.15, np.deg2rad(10.0)])  # metres, radians
IMAGE_FIRST = 4  # times the image's information moves the pose: motions' errors add up, the map's errors do not
CHECKED = 3  # of so many tracked frames one tells about the intrinsics, to save time


class AnnealedEstimate(NamedTuple):
    """What one frame gave: as `Estimate`, and how it was reached."""

    state: np.ndarray  # `(6,)` the best refined pose.
    covariance: np.ndarray  # `(6, 6)` of the last particles, metres in world axes, radians in body axes
    score: float  # raw score of the refined pose: eq. (8) as a mean over pixels of the finest image
    ess: float  # Effective sample size of the last layer's weights.
    particles: np.ndarray  # `(N, 6)` of the last layer.
    weights: np.ndarray  # `(N,)` of these particles.
    status: TrackStatus  # what being_lost.py says of the state
    error_covariance: np.ndarray  # `(6, 6)`, the same units and axes: of the error to expect while "tracked"
    agreement: Agreement  # How the measured image agrees with the map as seen from the state.
    layers: tuple[Tempered, ...]  # Weights, sharpness and effective sample size of every layer, in order.
    renders: int  # How many images were drawn.
    calibration: Calibration  # What the tracked images so far tell of the camera's intrinsics.


class _Found(NamedTuple):
    """What one look at a frame gave."""

    pose: np.ndarray
    score: float
    agreement: Agreement
    particles: np.ndarray
    layers: tuple[Tempered, ...]
    rivals: tuple[Rival, ...] = ()


class AnnealedLocalizer:
    """Annealed particle filter with Gauss-Newton refinement, for a depth camera that moves freely.

    n_particles: of a layer whose share is 1. seed: of all draws. sure_layers: where the motion was measured to within
    `SURE`. second_look: layers after a doubtful look (empty: none). steps: of the refinement (empty: the best
    particle). rivals: how many other poses are kept. fuse: joins prediction and image. prediction: made from the first
    pose. image_motion: whether two images tell the motion. Raises `ValueError` for bad numbers, or no layer.
    """

    takes = frozenset({"increment"})  # what `step` can use beside the image

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
        self._pose: np.ndarray | None = None  # the last estimate, and how far off it may be
        self._covariance: np.ndarray | None = None
        self._views: list[View] | None = None  # of the last image

    @one_at_a_time
    def initialize(self, state0: np.ndarray) -> None:
        """Say where the camera `(6,)` is before the first frame, to within `START_SPREAD`."""
        self._prediction = self._new_prediction(optical_pose(checked_start(state0, self.renderer.scene_map)))
        self._judge = TrackJudge()
        self._covariance = self._views = None

    @one_at_a_time
    def step(self, depth: np.ndarray, increment: np.ndarray | None = None) -> AnnealedEstimate:
        """Return where the camera is, from a depth image `(H, W)` in metres, NaN = no measurement.

        increment: motion `(6,)` since the last frame by an odometer or an IMU, along and about the body's axes at that
        frame (x forward, y left, z up), metres and radians; `motion_between` gives it from two states. Raises
        `ValueError` for another, before anything changes. A frame without any measurement warns
        (`NoMeasurementWarning`), and its state is the prediction.
        """
        prediction = self._prediction
        if prediction is None:
            raise RuntimeError("call initialize(state0) before the first step: the filter is given its start")
        depth = checked_image(depth, self.renderer.camera)
        measured = None if increment is None else MeasuredMotion.of_odometer(optical_increment(increment))
        for level in self.levels:
            level.measure(depth)
        if not valid_pixels(self.levels[-1].measured).any():
            return self._not_measured(measured)
        measured = self._measured_motion(depth, measured)
        found, spread = self._look_twice(prediction.spread(measured), measured)
        image_says = self._judge.judge_image(found.agreement)
        found, image_says = self._fuse(found, image_says, spread, measured)
        status = self._judge.judge(image_says, found.agreement, self._covariance, bool(found.rivals))
        return self._estimate(found, status, self._calibrated(found.pose, status))

    def _calibrated(self, pose: np.ndarray, status: TrackStatus) -> np.ndarray:
        """Return the covariance `(6, 6)`, wider where the intrinsics are doubted; check them with some tracked frames.

        The wider covariance is not kept, because this error is the same in the next frame.
        """
        self._tracked += status == "tracked"
        is_checked = status == "tracked" and self._tracked % CHECKED == 0
        doubted = self._calibration.estimate().doubted.any()
        if not (is_checked or doubted):
            return self._covariance
        middle = self.levels[1]
        images = middle.measured, middle.draw(pose[None])[0], middle.renderer.camera
        if is_checked:
            self._calibration.add(*images)
        return self._covariance + self._calibration.pose_covariance(*images) if doubted else self._covariance

    def _measured_motion(self, depth: np.ndarray, told: MeasuredMotion | None) -> MeasuredMotion | None:
        """Return the motion since the last image, of both images and what an odometer told; remember this image."""
        before, self._views = self._views, [View.of(depth, self.renderer.camera, pixels) for pixels in (COARSE, MIDDLE)]
        if before is None or not self.image_motion:
            return told
        if told is not None:
            return image_motion(before, self._views, told.motion, self._prediction.spread(told)) or told
        return image_motion(before, self._views, self._prediction.motion, self._prediction.guess_spread())

    def _look_twice(self, spread: np.ndarray, measured: MeasuredMotion | None) -> tuple[_Found, np.ndarray]:
        """Return the best pose of a cloud, or of a wider one if it agrees less than usual, and its spread."""
        not_known = 0.0 if self._covariance is None else np.sqrt(np.diag(self._covariance))
        cloud = np.minimum(np.hypot(spread, not_known), np.repeat(MAX_SPREAD, 3))
        sure = measured is not None and (cloud <= np.repeat(SURE, 3)).all()
        found = self._look(self.sure_layers if sure else self.layers, cloud, measured)
        settled = found.agreement.through <= NOTHING_BEHIND and self._confirmed(found, spread, measured)
        if self.second_look and self._judge.doubts(found.agreement) and not settled:
            wider = np.maximum(WIDER * cloud, np.repeat(START_SPREAD, 3))
            again = self._look(self.second_look, wider, measured)
            if again.score > found.score:
                return again, wider
        return found, spread

    def _confirmed(self, found: _Found, spread: np.ndarray, measured: MeasuredMotion | None) -> bool:
        """Return whether a pose that fits the map is also where the measured motion leads."""
        if measured is None or self._covariance is None or judge_refined(found.agreement) != "tracked":
            return False
        before, predicted = self._prediction.origin(found.pose, spread, measured)
        covariance = self._predicted_covariance(local(before, predicted), spread, measured)
        return is_known(covariance) and is_near(local(predicted, found.pose), covariance)

    def _fuse(
        self, found: _Found, image_says: TrackStatus, spread: np.ndarray, measured: MeasuredMotion | None
    ) -> tuple[_Found, TrackStatus]:
        """Join the pose that was found and the prediction; update covariance and motion.

        Along what the image does not show, the pose moves back to the prediction. If the image does not fit the map, as
        beyond the map's edge, the pose is carried by the measured motion, as long as it is known, and doubtful.
        """
        prediction, (_, middle, fine) = self._prediction, self.levels
        before, predicted = prediction.origin(found.pose, spread, measured)
        covariance = self._predicted_covariance(local(before, predicted), spread, measured)
        information = pose_information(middle.measured, middle.draw(found.pose[None])[0], middle.renderer.camera)
        narrowed, _ = self.fuse(covariance, information)
        _, gain = self.fuse(covariance, IMAGE_FIRST * information)
        fits = judge_refined(found.agreement) == "tracked"
        apart = local(predicted, found.pose)
        if image_says == "tracked" or self._confirmed(found, spread, measured):
            pose = retract(predicted, gain @ apart)
            surprising = measured is not None and not is_near(apart, covariance)
            lost_score = float(fine.score(fine.draw(pose[None]))[0]) - found.score
            others = [*found.rivals, Rival(predicted, 0.0)] if surprising else list(found.rivals)
            if surprising or lost_score < -SEEN:
                others.append(Rival(pose, lost_score))
                pose = found.pose
            sees_all = np.linalg.matrix_rank(information, hermitian=True) == 6
            prediction.found(pose, bool(sees_all), found.rivals)
            self._covariance = with_rivals(narrowed, pose, others)
            return found._replace(pose=pose), image_says
        if measured is not None and not fits and is_known(covariance):
            pose = retract(self._pose, measured.motion)
            agrees = agreement(fine.measured, fine.draw(pose[None])[0])
            if not agrees.contradicts:
                prediction.found(pose, False)
                self._covariance = covariance
                return found._replace(pose=pose, agreement=agrees, rivals=()), "doubtful"
        prediction.not_found(found.pose, spread, found.rivals, measured)
        if fits and found.agreement.through > CLEAR:  # the camera may as well be where it was predicted
            narrowed = with_rivals(narrowed, found.pose, [Rival(predicted, 0.0)])
        self._covariance = narrowed if fits else covariance
        return found, image_says

    def _predicted_covariance(
        self, motion: np.ndarray, spread: np.ndarray, measured: MeasuredMotion | None
    ) -> np.ndarray:
        """Return the covariance after a motion `(6,)`; at the first image that of the start, as wide as the cloud."""
        if self._covariance is None:
            return np.diag(spread**2)
        noise = np.diag((PREDICTED * spread) ** 2) if measured is None else measured.covariance
        return predicted_covariance(self._covariance, motion, noise)

    def _look(self, layers: tuple[Layer, ...], spread: np.ndarray, measured: MeasuredMotion | None) -> _Found:
        """Return the best of the particles that went through the layers and the steps of refinement."""

        def merit(scores: np.ndarray, poses: np.ndarray) -> np.ndarray:
            return scores + self._prediction.preference(poses, spread, measured)

        drawn, scores, tempered = self._anneal(layers, spread, measured)
        all_poses, all_scores = np.concatenate(drawn), np.concatenate(scores)
        first = self.steps[0].hypotheses if self.steps else 1
        poses = all_poses[distinct(all_poses, merit(all_scores, all_poses), first, APART * spread[[0, 3]])]
        for k, step in enumerate(self.steps):
            level = self.levels[step.level]
            images = level.draw(poses)
            kept = distinct(poses, merit(level.score(images), poses), step.hypotheses, DISTINCT) if k else slice(None)
            poses = level.step(poses[kept], images[kept], step.scale)
        fine = self.levels[-1]
        images = fine.draw(poses)
        scores = fine.score(images)
        merits = merit(scores, poses)
        best, *others = distinct(poses, merits, 1 + self.rivals, RIVAL_APART)
        rivals = (Rival(poses[other], float(merits[other] - merits[best])) for other in others)
        return _Found(
            poses[best],
            float(scores[best]),
            agreement(fine.measured, images[best]),
            drawn[-1],
            tempered,
            tuple(rival for rival in rivals if rival.evidence >= -RIVAL_WITHIN),
        )

    def _anneal(
        self, layers: tuple[Layer, ...], spread: np.ndarray, measured: MeasuredMotion | None
    ) -> tuple[list[np.ndarray], list[np.ndarray], tuple[Tempered, ...]]:
        """Return particles, their scores and their weights, layer by layer."""
        coarse = self.levels[0]
        drawn, scores, tempered = [], [], []
        for layer in layers:
            n = max(1, round(layer.particles * self.n_particles))
            if not drawn:
                poses = self._prediction.draw(n, layer.spread * spread, self.rng, measured)
            else:
                parents = drawn[-1][resample(tempered[-1].weights, self.rng, n=n)]
                poses = retract(parents, layer.spread * spread * self.rng.standard_normal((n, 6)))
            drawn.append(poses)
            scores.append(coarse.score(coarse.draw(poses)))
            tempered.append(temper(scores[-1], layer.survivors * n))
        return drawn, scores, tuple(tempered)

    def _not_measured(self, told: MeasuredMotion | None) -> AnnealedEstimate:
        """Return the prediction alone, because nothing was seen."""
        warnings.warn(
            "this frame holds no measurement between the camera's near and far planes; the pose is predicted only",
            NoMeasurementWarning,
            stacklevel=4,
        )
        spread = self._prediction.spread(told)
        poses = self._prediction.draw(self.n_particles, spread, self.rng, told)
        before = self._prediction.pose
        pose = before if told is None else retract(before, told.motion)
        self._prediction.not_found(pose, spread, measured=told)
        self._views = None if told is not None else self._views  # else the next image shows the motion since this one
        self._covariance = self._predicted_covariance(local(before, pose), spread, told)
        found = _Found(pose, np.nan, NOTHING_MEASURED, poses, (temper(np.zeros(len(poses)), len(poses)),))
        return self._estimate(found, "no measurement", self._covariance)

    def _estimate(self, found: _Found, status: str, covariance: np.ndarray) -> AnnealedEstimate:
        self._pose = found.pose
        state, particles = state_from_optical_pose(found.pose), state_from_optical_pose(found.particles)
        w = found.layers[-1].weights
        deviations = self.motion.deviations(particles, state)
        return AnnealedEstimate(
            state,
            (w[:, None] * deviations).T @ deviations,
            found.score,
            found.layers[-1].ess,
            particles,
            w,
            status,
            in_world_and_body(covariance, found.pose),
            found.agreement,
            found.layers,
            sum(level.renders for level in self.levels),
            self._calibration.estimate(),
        )
