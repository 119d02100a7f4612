"""The robot's way from "somewhere in this room" to millimetres, at one place: what each stage sees and says."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from course_lib.beyond.six_dof.localizer import AnnealedEstimate
from course_lib.depth_mcl.evaluation import pose_errors
from course_lib.experiments.finale import LEVEL_SIGMA, REACHED, follow, mean_score, start_state, starts_of
from course_lib.geometry import optical_pose, wrap_angle
from course_lib.lessons.lesson_19.world import hidden, world
from course_lib.spherical_stereo.pose.localization import Localization
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D

FILTER_SEED = 1
ON_THE_FLOOR = (0, 1, 5)  # of a state: x, y, yaw, what a semantic pose tells
MAX_KEPT = 64
STAGES = ("photographing two panoramas", "finding objects, places and the pose", "taking depth images", "the filter")


class Journey(NamedTuple):
    """One place, from beginning to end."""

    pose: np.ndarray
    """`(3,)` where the robot is: x, y, heading."""
    images: tuple[np.ndarray, np.ndarray]
    """Upper and lower panorama, `(H, W, 3)` BGR."""
    found: Localization
    states: np.ndarray
    """`(3, 6)` where the depth camera is at each image."""
    depths: list[np.ndarray]
    starts: list[Pose2D]
    """Of the depth filter: the semantic pose, or up to three alternatives."""
    runs: list[list[AnnealedEstimate]]
    """Of every start: an estimate for each depth image."""

    @property
    def best(self) -> list[AnnealedEstimate] | None:
        """The run that explains its images best; None where there was no start."""
        return max(self.runs, key=mean_score) if self.runs else None

    @property
    def semantic_error(self) -> tuple[float, float] | None:
        """Metres and degrees of the semantic pose; None where none was given out."""
        return None if self.found.pose is None else plane_error(self.found.pose, self.pose)

    @property
    def depth_error(self) -> tuple[float, float] | None:
        """Metres (in space) and degrees of the last estimate of the best run; None without one."""
        return None if self.best is None else state_error(self.best[-1].state, self.states[-1])

    @property
    def reached(self) -> bool:
        """Whether it ended within 3 cm and 1 degree."""
        return self.depth_error is not None and is_reached(self.depth_error)


_kept: dict[tuple, Journey] = {}


def plane_error(found: Pose2D, true_pose: np.ndarray) -> tuple[float, float]:
    """How far a pose on the floor is off: metres, degrees."""
    turned = abs(float(wrap_angle(found.theta - true_pose[2])))
    return float(np.hypot(found.x - true_pose[0], found.y - true_pose[1])), float(np.rad2deg(turned))


def state_error(state: np.ndarray, true_state: np.ndarray) -> tuple[float, float]:
    """How far a state `(6,)` is off: metres in space, degrees of the rotation between the two."""
    position, rotation = pose_errors(optical_pose(state), optical_pose(true_state))
    return float(position), float(np.rad2deg(rotation))


def is_reached(error: tuple[float, float]) -> bool:
    """Whether an error is within 3 cm and 1 degree."""
    return error[0] <= REACHED[0] and error[1] <= REACHED[1]


def journey(
    x: float,
    y: float,
    heading_deg: float,
    hidden_share: float = 0.0,
    lens_cap: bool = False,
    say: Callable[[str], None] | None = None,
) -> Journey:
    """Everything that happens at a place; metres, degrees. The last ones are kept: a second look costs nothing.

    hidden_share: of the panoramas' columns that show nothing. lens_cap: on the depth camera, which then measures
    nothing. say: told of each stage before it begins.
    """
    key = (float(x), float(y), float(heading_deg), float(hidden_share), lens_cap)
    if key not in _kept:
        if len(_kept) == MAX_KEPT:
            del _kept[next(iter(_kept))]
        _kept[key] = _travelled(*key, say or (lambda text: None))
    return _kept[key]


def _travelled(
    x: float, y: float, heading_deg: float, hidden_share: float, lens_cap: bool, say: Callable[[str], None]
) -> Journey:
    here, pose = world(), np.array([x, y, np.deg2rad(heading_deg)])
    if lens_cap:  # the panoramas know nothing of it
        seen = journey(x, y, heading_deg, hidden_share, False, say)
        return seen._replace(depths=[np.full_like(depth, np.nan) for depth in seen.depths], runs=[])
    say(f"1 of 4: {STAGES[0]}")
    images = here.photographs(pose)
    if hidden_share:
        images = tuple(hidden(image, hidden_share) for image in images)
    say(f"2 of 4: {STAGES[1]}")
    found = here.localizer.localize(*images)
    say(f"3 of 4: {STAGES[2]}")
    states, depths = here.depth_images(pose)
    say(f"4 of 4: {STAGES[3]}")
    starts = starts_of(found, here.scene_map)
    runs = [follow(here.renderer, start_state(start), depths, FILTER_SEED) for start in starts]
    return Journey(pose, images, found, states, depths, starts, runs)


def start_covariance(covariance: np.ndarray) -> np.ndarray:
    """Return the covariance `(6, 6)` of `start_state`: a semantic pose's `(3, 3)`, and how high and level it stands."""
    height, level = LEVEL_SIGMA
    known = np.diag([0.0, 0.0, height**2, level**2, level**2, 0.0])
    known[np.ix_(ON_THE_FLOOR, ON_THE_FLOOR)] = covariance
    return known


def joined(
    start: np.ndarray, covariance: np.ndarray, state: np.ndarray, state_covariance: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Join two answers, each weighed by its covariance, into a state `(6,)` and its covariance: a Kalman update.

        K = P_0 (P_0 + P_1)^-1        x = x_0 + K (x_1 - x_0)        P = (1 - K) P_0

    start, covariance: the semantic pose. state, state_covariance: what the depth filter makes of the first image.
    """
    difference = state - start
    difference[3:] = wrap_angle(difference[3:])
    gain = covariance @ np.linalg.inv(covariance + state_covariance)
    found = start + gain @ difference
    found[3:] = wrap_angle(found[3:])
    return found, (np.eye(6) - gain) @ covariance
