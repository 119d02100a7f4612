"""What lesson 09 measures: clouds, filters on the recording carried by hand, a basin, and a bare corridor."""

import functools
from collections import namedtuple

import numpy as np
from scipy.stats import chi2

from course_lib.beyond import AnnealedLocalizer
from course_lib.beyond.six_dof.poses import motion_between, retract
from course_lib.beyond.six_dof.refinement import refine
from course_lib.beyond.six_dof.schedule import STEPS, pyramid
from course_lib.depth_mcl import DepthCamera, DepthRenderer, MonteCarloLocalizer
from course_lib.depth_mcl.evaluation import pose_errors
from course_lib.depth_mcl.motion import TANGENT_SPACE
from course_lib.depth_mcl.sequence import read_sequence
from course_lib.geometry import optical_pose, state_from_optical_pose
from courseware.lessons.kit.box_world import box_map
from courseware.lessons.kit.corridor_data import corridor_map
from courseware.lessons.kit.progress_bar import progress
from courseware.paths import data_path

FRAMES = list(range(0, 60, 4))  # every fourth: the camera moves four times as far between two images
SEED = 10_001  # a tuning seed: what is reported comes from stored results


def cloud_density(n: int, dimensions: int, rng: np.random.Generator) -> tuple[int, float, float]:
    """Return how densely normal clouds of `n` particles fill so many dimensions at their middle.

    Return the dimensions, the mean number of particles within half a sigma, n P(chi^2 <= 1/4), and the distance of the
    nearest in sigmas (median over 400 clouds).
    """
    lengths = np.linalg.norm(rng.standard_normal((400, n, dimensions)), axis=-1)
    return dimensions, n * chi2.cdf(0.25, dimensions), float(np.median(lengths.min(axis=1)))


# The recording of the camera carried by hand, and the three sizes of its images.
hand_run = functools.cache(lambda: read_sequence(data_path("corridor/hand")))
levels = functools.cache(lambda: pyramid(DepthRenderer(corridor_map(), hand_run().camera())))

# Estimates, statuses, errors [m] and [degrees] (T,), deviations from the estimate to the truth and their expected
# sigmas (T, 6): metres along the world's axes, radians about the body's.
Track = namedtuple("Track", "estimates statuses position rotation deviations error_sigmas")


def localize(
    localizer: MonteCarloLocalizer | AnnealedLocalizer, frames: list[int], name: str, start: np.ndarray | None = None
) -> Track:
    """Run a filter over frames of the recording, from the first frame's true state (or from `start`)."""
    true = hand_run().camera_to_world[frames]
    localizer.initialize(state_from_optical_pose(true[0]) if start is None else start)
    estimates = [localizer.step(hand_run().depth(frame)) for frame in progress(frames, name)]
    states = np.array([one.state for one in estimates])
    position, rotation = pose_errors(optical_pose(states), true)
    pairs = zip(state_from_optical_pose(true), states, strict=True)
    deviations = np.array([TANGENT_SPACE.deviations(t[None], s)[0] for t, s in pairs])
    sigmas = np.sqrt([np.diag(one.error_covariance) for one in estimates])
    return Track(estimates, [one.status for one in estimates], position, np.rad2deg(rotation), deviations, sigmas)


def drawn(track: Track) -> tuple[float, float]:
    """Return how many particles were drawn for a frame, and how many images of the map, medians over the frames."""
    particles = [sum(len(layer.weights) for layer in one.layers) for one in track.estimates]
    return float(np.median(particles)), float(np.median([one.renders for one in track.estimates]))


def measure_basin(rng: np.random.Generator, starts: int = 12) -> dict[float, tuple[np.ndarray, np.ndarray]]:
    """Let Gauss-Newton start around true poses, moved by so many metres and turned by 60 times as many degrees.

    Return for each offset [m] two arrays, a row for each of eight images and a column for each start: the error of the
    position after the filter's own steps on the coarse image [m], and whether it came back to 0.05 m and 2 degrees.
    """
    coarse, scales = levels()[0], [step.scale for step in STEPS]
    ends: dict[float, list] = {offset: [] for offset in (0.05, 0.1, 0.15, 0.2, 0.3, 0.4)}
    for frame in progress(range(15, 121, 15), "from how far off?"):
        coarse.measure(hand_run().depth(frame))
        poses = np.tile(hand_run().camera_to_world[frame], (starts, 1, 1))
        for offset, found in ends.items():
            directions = rng.standard_normal((starts, 2, 3))
            directions *= [[offset], [np.deg2rad(60 * offset)]] / np.linalg.norm(directions, axis=-1, keepdims=True)
            moved = retract(poses, directions.reshape(starts, 6))
            found.append(pose_errors(refine(coarse.renderer, coarse.measured, moved, scales), poses))
    errors = {offset: np.moveaxis(found, 1, 0) for offset, found in ends.items()}
    return {offset: (m, (m <= 0.05) & (np.rad2deg(rad) <= 2.0)) for offset, (m, rad) in errors.items()}


def slide(pillar: bool = False, odometer: bool = False) -> tuple[np.ndarray, np.ndarray, list[str]]:
    """Let a camera slide through a bare corridor, eight images 0.1 m apart; odometer: the filter is told each step.

    Return the errors along and across the axis `(8, 2)` [m], what the filter expects of them (one sigma), and statuses.
    """
    boxes = [  # floor, ceiling and two walls along x, 100 m long; the pillar stands 4 m ahead of the start
        ((-50, -1.2, -0.1), (50, 1.2, 0.0)), ((-50, -1.2, 2.5), (50, 1.2, 2.6)), ((-50, -1.3, 0.0), (50, -1.2, 2.5)),
        ((-50, 1.2, 0.0), (50, 1.3, 2.5)), ((4.0, 0.9, 0.0), (4.3, 1.2, 2.5)),
    ]  # fmt: skip
    rng, camera = np.random.default_rng(SEED), DepthCamera.sr4000().resized(88, 72)
    true = np.array([0.0, 0.1, 1.3, 0.0, 0.05, 0.1])
    told = motion_between(true, true + 0.1 * np.eye(6)[0])  # a step along the world's x, in the body's axes
    errors, found = [], []
    with DepthRenderer(box_map(*boxes[: 5 if pillar else 4]), camera) as renderer:
        localizer = AnnealedLocalizer(renderer, seed=SEED)
        localizer.initialize(true)
        for frame in range(8):
            true[0] = 0.1 * frame
            depth = renderer.render(true)[0] + 0.01 * rng.standard_normal(camera.shape)
            depth = np.where(np.isfinite(depth), depth, np.nan).astype(np.float32)
            found.append(localizer.step(depth, told if odometer and frame else None))
            errors.append(found[-1].state[:2] - true[:2])
    sigmas = np.sqrt([np.diag(one.error_covariance)[:2] for one in found])
    return np.array(errors), sigmas, [one.status for one in found]
