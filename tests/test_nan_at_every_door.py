"""NaN at every door: each number that a public function takes is made NaN in turn, and refused by name.

Only where NaN is the word for "nothing was measured" (depth images, points, hue) does it pass, and then it counts for
nothing, as the tests of the equations say. No door gives an answer made of NaN without a word. The doors are the
packages' public names.
"""

from pathlib import Path

import numpy as np
import pytest

import course_lib.geometry as geometry
from course_lib import beyond, depth_mcl, spherical_stereo
from course_lib.depth_mcl import DepthCamera, DepthRenderer, MonteCarloLocalizer, SceneMap
from course_lib.spherical_stereo import Detection, Landmark, Observation, SemanticMap, StereoRig
from tests.rendering.shapes import room

PACKAGE = Path(geometry.__file__).parent
CAMERA = DepthCamera.from_fov(16, 12, 60.0, 45.0)
STATES = np.array([[0.0, 0, 0, 0, 0, 0], [0.3, 0.2, 0, 0, 0, 0.5], [-0.2, 0.1, 0, 0, 0, 1.0]])
SIGMA = np.full(6, 0.01)
WEIGHTS = np.array([0.5, 0.3, 0.2])
UP, DOWN = np.array([0.9, 0.1, -0.4]), np.array([0.9, 0.1, -0.3])
UP, DOWN = UP / np.linalg.norm(UP), DOWN / np.linalg.norm(DOWN)
PLACES = np.array([[0.0, 0.0], [2.0, 0.0], [1.0, 3.0]])
MAP = SemanticMap([Landmark("sofa", x, y, 10.0, 50.0) for x, y in PLACES])
POSE = spherical_stereo.fit_rigid_2d(PLACES, PLACES + 1.0)
SEEN = [Observation("sofa", x, y, 10.0, 50.0) for x, y in PLACES]


def rendered(states):
    """One image of each state."""
    with DepthRenderer(room(), CAMERA) as renderer:
        return renderer.render(states)


def started(state):
    """A filter that begins at a state."""
    with DepthRenderer(room(), CAMERA) as renderer:
        localizer = MonteCarloLocalizer(renderer, 5, SIGMA)
        localizer.initialize(state)
        return localizer.particles


def filter_with(sigma, alpha, beta):
    """One step of a filter with these settings."""
    with DepthRenderer(room(), CAMERA) as renderer:
        localizer = MonteCarloLocalizer(renderer, 5, sigma=sigma, alpha=alpha, beta=beta)
        localizer.initialize(np.zeros(6))
        return localizer.step(np.full(CAMERA.shape, 2.0)).state


def matched(x, y, saturation):
    """Three objects that are seen, one of them so, among those of the map."""
    return spherical_stereo.associate_greedy([*SEEN[:2], Observation("sofa", x, y, 10.0, saturation)], MAP)


def tracked(forward, left, turn, covariance):
    """Two views, and odometry from one to the other."""
    tracker = beyond.SemanticTracker(MAP)
    tracker.step(SEEN)
    return tracker.step(SEEN, beyond.Motion(forward, left, turn, covariance))


# Door -> (function, arguments that are right). Every argument that is a number or an array of them is tried.
DOORS = {
    "pose_matrix": (geometry.pose_matrix, (STATES,)),
    "circular_mean": (lambda a, w: geometry.circular_mean(a, w), (np.array([0.1, 0.2, 0.3]), WEIGHTS)),
    "DepthCamera": (lambda *k: DepthCamera(16, 12, *k), (14.0, 14.0, 7.5, 5.5, 0.1, 10.0)),
    "DepthCamera.from_fov": (lambda *k: DepthCamera.from_fov(16, 12, *k), (60.0, 45.0)),
    "SceneMap": (lambda v: SceneMap(v, np.array([[0, 1, 2]])), (np.eye(3),)),
    "render": (rendered, (STATES,)),
    "initial_particles": (lambda s: depth_mcl.initial_particles(s, 4), (STATES[0],)),
    "propagate": (lambda p, s: depth_mcl.propagate(p, s, np.random.default_rng(3)), (STATES, SIGMA)),
    "likelihood, what is simulated": (
        lambda z, alpha: depth_mcl.likelihood(np.full((2, 2), 2.0), z, alpha),
        (np.full((3, 2, 2), 2.1), 0.1),
    ),
    "normalize_likelihood": (depth_mcl.normalize_likelihood, (np.array([1.0, 2.0, 4.0]),)),
    "weights": (depth_mcl.weights, (np.array([0.0, 0.5, 1.0]), 0.01)),
    "weighted_mean_state": (depth_mcl.weighted_mean_state, (STATES, WEIGHTS)),
    "effective_sample_size": (depth_mcl.effective_sample_size, (WEIGHTS,)),
    "resample": (lambda w: depth_mcl.resample(w, np.random.default_rng(3)), (WEIGHTS,)),
    "MonteCarloLocalizer.initialize": (started, (STATES[0],)),
    "MonteCarloLocalizer": (filter_with, (SIGMA, 0.1, 0.01)),
    "nearest_path_error": (depth_mcl.nearest_path_error, (STATES[:, :3], STATES[:, :3] + 0.1)),
    "timed_error": (depth_mcl.timed_error, (STATES[:, :3], STATES[:, :3] + 0.1)),
    "pixel_to_direction": (lambda uv: spherical_stereo.pixel_to_direction(uv, 100, 50), (np.array([10.0, 20.0]),)),
    "direction_to_pixel": (lambda d: spherical_stereo.direction_to_pixel(d, 100, 50), (UP,)),
    "StereoRig": (StereoRig, (0.2,)),
    "Detection": (
        lambda score, box, saturation: Detection("sofa", score, tuple(box), 10.0, saturation),
        (0.9, np.array([1.0, 2.0, 5.0, 6.0]), 50.0),
    ),
    "triangulate": (spherical_stereo.triangulate, (UP, DOWN, 0.2)),
    "Landmark": (lambda x, y, saturation: SemanticMap([Landmark("sofa", x, y, 10.0, saturation)]), (1.0, 2.0, 50.0)),
    "Observation": (matched, (1.0, 2.0, 50.0)),
    "centroids": (
        lambda seen, known: spherical_stereo.penalty(SEEN[0], MAP.landmarks[0], seen, known),
        (np.zeros(2), np.ones(2)),
    ),
    "fit_rigid_2d": (spherical_stereo.fit_rigid_2d, (PLACES, PLACES + 1.0, WEIGHTS)),
    "fit_covariance": (
        lambda source, target, noise: spherical_stereo.fit_covariance(POSE, source, target, noise=noise),
        (PLACES, PLACES + 1.0, np.tile(0.01 * np.eye(2), (3, 1, 1))),
    ),
    "triangulation_covariance": (spherical_stereo.triangulation_covariance, (UP, DOWN, 0.2, 0.01, 0.01)),
    "odometry": (tracked, (0.3, 0.1, 0.2, 0.01 * np.eye(3))),
}
TRIALS = [(door, k) for door, (_, arguments) in DOORS.items() for k in range(len(arguments))]
MEANT = {("likelihood, what is simulated", 0, np.inf)}  # where nothing is hit


@pytest.mark.parametrize("door", DOORS)
def test_what_is_right_passes(door):
    function, arguments = DOORS[door]
    function(*arguments)


@pytest.mark.filterwarnings("error::RuntimeWarning")
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf], ids=["nan", "inf", "-inf"])
@pytest.mark.parametrize(("door", "k"), TRIALS)
def test_a_number_that_is_none_is_refused_by_name(door, k, bad):
    if (door, k, bad) in MEANT:
        return
    function, arguments = DOORS[door]
    spoiled = list(arguments)
    spoiled[k] = np.array(arguments[k], dtype=float)
    spoiled[k].flat[-1] = bad
    spoiled[k] = spoiled[k] if np.ndim(arguments[k]) else bad
    with pytest.raises(ValueError, match=r"\w+") as told:
        function(*spoiled)
    # Said by the door, not by whatever came upon it further in.
    assert Path(told.traceback[-1].path).is_relative_to(PACKAGE), told.traceback[-1]
