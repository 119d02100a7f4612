"""Run the whole filter in the order of paper 1's figure 1: propagate (A-1), weigh (A-2), estimate and resample (A-3).

    localizer = MonteCarloLocalizer(renderer, n_particles=200, sigma=sigma, seed=0)
    localizer.initialize(state0)
    for depth in recording:
        estimate = localizer.step(depth)

How particles move and how they are weighed are parts that can be exchanged: the motions are in motion.py,
the paper's weighting in likelihood.py, Fallon's in fallon.py.
"""

import warnings
from typing import NamedTuple

import numpy as np

from course_lib.depth_mcl.likelihood import (
    ALPHA,
    BETA,
    Weighting,
    checked_image,
    paper_weighting,
    valid_pixels,
)
from course_lib.depth_mcl.motion import BODY_AXES, Motion, checked_covariance, checked_sigma
from course_lib.depth_mcl.one_at_a_time import one_at_a_time
from course_lib.depth_mcl.particle_filter import Scheme, effective_sample_size, initial_particles, resample
from course_lib.depth_mcl.status import Agreement, FilterJudge, TrackStatus, agreement
from course_lib.depth_mcl.uncertainty import carried_covariance, error_covariance, positive_part
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap

# Standard deviations of the system noise a frame for the paper's experiment, metres and radians, forward and left. The
# paper found its own 「試行錯誤的に」 (by trial and error, section 4). These were chosen on tuning seeds. The forward
# noise is 1.5 times the wagon's longest step per frame. A camera that is carried sideways needs as much to the left.
SIGMA_XY_YAW = (0.15, 0.04, 0.0, 0.0, 0.0, np.deg2rad(1.5))

MAP_MARGIN = 1.0  # metres outside the map's bounding box where a start is still taken for a camera that looks at it
MAX_ANGLES = (np.pi, np.pi, 2 * np.pi)  # radians, roll, pitch and yaw of a start, beyond which they look like degrees
MAX_PIXELS = 50e6  # a frame, drawn and compared: ten times the paper's 200 images of 176 x 144, a second on two cores


class SlowFilterWarning(UserWarning):
    """The filter draws so many pixels a frame that no robot waits for it."""


class NoMeasurementWarning(UserWarning):
    """A frame has no measured pixel, so the filter moved its particles and could not weigh them."""


class Estimate(NamedTuple):
    """The result of one frame.

    `covariance` does *not* say how far off the state may be, because the paper's beta leaves about one particle;
    `error_covariance` does.
    """

    state: np.ndarray  # `(6,)` the weighted mean of the particles
    covariance: np.ndarray  # `(6, 6)` of the weighted particles, metres along the world's axes and radians
    score: float  # raw score of the best particle; unlike its weight it falls when the filter is lost
    ess: float  # effective sample size of the weights, 1 to N
    particles: np.ndarray  # `(N, 6)` before resampling, as weighed; all weigh the same if the frame measured nothing
    weights: np.ndarray  # `(N,)` of these particles
    status: TrackStatus  # how far the state can be believed; a "tracked" one may be wrong where walls look alike
    error_covariance: np.ndarray  # `(6, 6)`, the same units: of the error to expect while the filter is "tracked"
    agreement: Agreement  # how the measured image agrees with the map as seen from the state


class MonteCarloLocalizer:
    """Localize with a particle filter that compares a depth camera's image with renders of the map.

    renderer: draws the map for the camera. sigma: `(6,)` system noise a frame, metres and radians, along the axes that
    `motion` says: by default those of the body (forward, left, up), where 0 keeps z, roll, pitch or yaw at
    its initial value, as the paper's experiment does, which estimates x, y and yaw; `TANGENT_SPACE` for all six degrees
    of freedom, `WORLD_AXES` for eq. (5) as printed. weighting: how particles are weighed; None for the paper's rule
    with alpha (metres) and beta, which belong to that rule alone. seed: of the one generator that all draws come from.

    With all six degrees of freedom 200 particles get lost, and 1,000 often; the status says so. Take
    `beyond.AnnealedLocalizer` instead. The time of a frame grows with the particles and the pixels, and 640 x 480 take
    0.8 s on two cores. So give the renderer `camera.resized(160, 120)`, and each image through `subsample_depth`.

    Warns (`SlowFilterWarning`) above `MAX_PIXELS` a frame without a graphics card. Raises `ValueError` for zero
    particles, a bad sigma, motion, weighting, alpha, beta or resampling scheme.
    Source: paper 1, figure 1.
    """

    takes = frozenset()  # what `step` can use in addition to the image: nothing

    def __init__(
        self,
        renderer: DepthRenderer,
        n_particles: int = 200,
        sigma: np.ndarray = SIGMA_XY_YAW,
        alpha: float = ALPHA,
        beta: float = BETA,
        seed: int = 0,
        *,
        motion: Motion = BODY_AXES,
        resampling: Scheme = "systematic",
        weighting: Weighting | None = None,
    ) -> None:
        if int(n_particles) != n_particles or n_particles < 1:
            raise ValueError(f"n_particles must be a whole number, at least 1; got {n_particles!r}")
        for name, value in (("alpha", alpha), ("beta", beta)):
            if not (np.isfinite(value) and value > 0):
                raise ValueError(f"{name} must be positive; got {value!r}")
        if not all(callable(getattr(motion, part, None)) for part in Motion._fields):
            raise ValueError(f"motion must have the calls {', '.join(Motion._fields)} (motion.py); got {motion!r}")
        if weighting is not None and not all(callable(getattr(weighting, part, None)) for part in Weighting._fields):
            raise ValueError(f"weighting must have the calls {', '.join(Weighting._fields)}; got {weighting!r}")
        if weighting is not None and (alpha, beta) != (ALPHA, BETA):
            raise ValueError("alpha and beta belong to the paper's weighting; got another one: leave them out")
        resample(np.ones(1), np.random.default_rng(0), resampling)  # refuses an unknown scheme now, not at frame one
        self.renderer = renderer
        self.n_particles = int(n_particles)
        self.sigma = checked_sigma(sigma)
        self.motion = motion
        self.resampling = resampling
        self.weighting = weighting or paper_weighting(alpha, beta)
        if int(seed) != seed or seed < 0:
            raise ValueError(f"seed must be a whole number, 0 or more; got {seed!r}")
        self.rng = np.random.default_rng(int(seed))
        self.particles: np.ndarray | None = None
        self._judge = FilterJudge(np.count_nonzero(self.sigma))
        self._centre_covariance = np.zeros((6, 6))  # of the error of the particles' centre, beyond their own spread
        height, width = renderer.camera.shape
        if self.n_particles * width * height > MAX_PIXELS and renderer.backend != "vtk":
            warnings.warn(
                f"{n_particles} particles of {width} x {height} pixels take about a second a frame: give the renderer "
                "camera.resized(160, 120), and each image through subsample_depth(depth, camera, resized)",
                SlowFilterWarning,
                stacklevel=2,
            )

    @one_at_a_time
    def initialize(self, state0: np.ndarray, covariance: np.ndarray | None = None) -> None:
        """Put every particle at the initial state `(6,)`, eqs (3), (4), or draw them around it.

        covariance: `(6, 6)` of the start, as `Estimate.covariance`: metres along the world's axes and radians; a
        variance of 0 keeps a component. None, as in the paper: the start is exact. Raises `ValueError` for a state that
        is not finite, lies outside the map (by more than a metre) or is in degrees, and for what is no covariance.
        """
        start = checked_start(state0, self.renderer.scene_map)
        particles = initial_particles(start, self.n_particles)
        if covariance is not None:
            covariance = checked_covariance(covariance)
            values, axes = np.linalg.eigh(covariance)
            drawn = self.rng.standard_normal((self.n_particles, 6)) * np.sqrt(np.clip(values, 0.0, None)) @ axes.T
            particles = self.motion.scatter(start, np.where(np.diag(covariance) > 0, drawn, 0.0))
        self.particles = particles
        self._judge = FilterJudge(np.count_nonzero(self.sigma))
        self._centre_covariance = np.zeros((6, 6))

    @one_at_a_time
    def step(self, depth: np.ndarray) -> Estimate:
        """Take one round of the paper's figure 1 with a depth image `(H, W)` in metres, NaN = no measurement.

        The image holds depth along the optical axis, not the length of each ray: one image cannot show which it is.
        A frame without any measurement moves the particles (A-1) but can neither weigh nor resample them, so the cloud
        grows. It warns (`NoMeasurementWarning`), and the estimate's status says so. The arrays of the estimate are the
        caller's own. Raises `DepthImageError` for an image of another size or in another unit (`checked_image`),
        `RuntimeError` before `initialize` and while another thread is in this filter.
        """
        if self.particles is None:
            raise RuntimeError("call initialize(state0) before the first step: the paper's filter is given its start")
        camera = self.renderer.camera
        measured = self.renderer.render_points(camera.points(checked_image(depth, camera)))  # 3.3.2, eq. (7)
        particles = self.motion.propagate(self.particles, self.sigma, self.rng)  # A-1, eq. (5)
        if not valid_pixels(measured).any():
            return self._moved_only(particles, measured)
        batches = self.renderer.batches(particles)  # 3.3.1, eq. (6): as many images at a time as memory holds
        scores = np.concatenate([self.weighting.score(measured, images) for images in batches])  # A-2, eq. (8)
        w = self.weighting.weigh(measured, scores)  # A-2, eqs (9) to (11)
        estimate = self._estimate(particles, w, scores, measured)  # A-3, eq. (12)
        self.particles = particles[resample(w, self.rng, self.resampling)]  # 3.4
        return estimate

    def _moved_only(self, particles: np.ndarray, measured: np.ndarray) -> Estimate:
        """Return the estimate of a frame without measurement: the particles as they moved, equally weighted."""
        warnings.warn(
            "this frame holds no measurement between the camera's near and far planes; particles were moved only",
            NoMeasurementWarning,
            stacklevel=4,
        )
        self.particles = particles.copy()
        w, scores = np.full(self.n_particles, 1.0 / self.n_particles), np.full(self.n_particles, np.nan)
        return self._estimate(particles, w, scores, measured)

    def _estimate(self, particles: np.ndarray, w: np.ndarray, scores: np.ndarray, measured: np.ndarray) -> Estimate:
        """Return the estimate of weighted particles, eq. (12), judged by the map's image at its state."""
        state = self.motion.mean(particles, w)
        deviations = self.motion.deviations(particles, state)
        spread = (w[:, None] * deviations).T @ deviations
        frame = error_covariance(deviations, np.nan_to_num(scores))
        error = carried_covariance(frame, deviations, self._centre_covariance)
        self._centre_covariance = positive_part(error - spread)
        agrees = agreement(measured, self.renderer.render(state)[0])
        status, ess = self._judge.judge(agrees, error), effective_sample_size(w)
        return Estimate(state, spread, float(scores.max()), ess, particles, w, status, error, agrees)


def checked_start(state0: np.ndarray, scene_map: SceneMap) -> np.ndarray:
    """Return the start `(6,)` of a filter.

    Raises `ValueError` if it is not finite, lies outside the map, or has angles that look like degrees: a roll or pitch
    beyond pi, a yaw beyond 2 pi.
    """
    start = initial_particles(state0, 1)[0]
    if (np.abs(start[3:]) > MAX_ANGLES).any():
        raise ValueError(
            f"roll, pitch and yaw of the start must be radians, at most pi, pi and 2 pi; got {start[3:].tolist()}. "
            "These look like degrees: give np.deg2rad of them"
        )
    if not scene_map.contains(start[:3], MAP_MARGIN):
        raise ValueError(
            f"the initial position {start[:3].round(3).tolist()} lies outside the map, which reaches from "
            f"{scene_map.bounds[0].round(2).tolist()} to {scene_map.bounds[1].round(2).tolist()} m"
        )
    return start
