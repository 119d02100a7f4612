"""AKAZE features on panoramas, and what two whole panoramas say about each other before any object is known (2.3).

AKAZE is made for flat images, and an equirectangular one is stretched sideways by 1 / cos(elevation), so features above
about 60 degrees up or down match less often. The descriptors are the upright ones, because both cameras stand upright.
"""

from dataclasses import dataclass
from typing import NamedTuple

import cv2
import numpy as np

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.matching.epipolar import EPIPOLAR_TOLERANCE, RATIO, epipolar_residual
from course_lib.spherical_stereo.panorama import PanoramaError, View, azimuth_elevation_of_pixel, open_view

# Smallest determinant of the Hessian that counts as a feature. On eight pairs of generated rooms OpenCV's default of
# 1e-3 left 6 of 94 objects without a match, 5e-4 left one and 2e-4 none.
AKAZE_THRESHOLD = 2e-4
AKAZE_OCTAVES = 3  # Octaves of scale. A fourth adds nothing on panoramas about 1,000 pixels wide.
# Columns repeated at both sides of the image: the descriptor of AKAZE's coarsest feature in three octaves reaches
# 10 sqrt(2) x 1.6 x 2^2.75 = 152 pixels, and must not leave the image.
SEAM_MARGIN = 160
MIN_DISPARITY = 0.0025  # radians, half a row at a height of 640: a smaller one does not tell which camera is higher
MAX_TURN = EPIPOLAR_TOLERANCE  # radians: if the lower camera is turned further, true matches miss the tolerance
MAX_FEATURES = 800  # Upper features that are matched, every k-th of all: enough for a hundredth of a degree.
MIN_AGREEING = 30  # Matches that must agree on the turn; fewer tell nothing.
# Share of all matches that must agree on the turn. Chosen half way on a walk through room 10,021: pairs of one moment
# have 0.86 and more, and 0.36 at most with the lower image of the view before.
MIN_AGREEING_SHARE = 0.6
_NEAR, _STEPS = 0.1, 10


class SwappedImagesError(PanoramaError):
    """The image given as the upper one was taken below the other."""


@dataclass(frozen=True, eq=False)
class PanoramaFeatures:
    """AKAZE features of one panorama."""

    keypoints: np.ndarray  # `(n, 2)` float64, edge coordinates (u, v), pixels, u in [0, width)
    descriptors: np.ndarray  # `(n, 61)` uint8, 486 bits compared by Hamming distance
    width: int  # of the panorama, pixels
    height: int

    def __len__(self) -> int:
        return len(self.keypoints)

    def angles(self) -> tuple[np.ndarray, np.ndarray]:
        """Return azimuth and elevation `(n,)` of every feature, radians."""
        return azimuth_elevation_of_pixel(self.keypoints, self.width, self.height)


def detect_features(image: np.ndarray) -> PanoramaFeatures:
    """Return the features of an image, uint8 BGR `(H, W, 3)`."""
    return find_features(open_view(image)).features


def find_features(view: View) -> View:
    """Return the panorama with its AKAZE features, those on the seam too. If it has some already, they stay."""
    if view.features is not None:
        return view
    image, height, width = view.image, view.height, view.width
    margin = min(SEAM_MARGIN, width // 2)
    grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
    extended = np.concatenate([grey[:, -margin:], grey, grey[:, :margin]], axis=1)
    akaze = cv2.AKAZE_create(
        descriptor_type=cv2.AKAZE_DESCRIPTOR_MLDB_UPRIGHT, threshold=AKAZE_THRESHOLD, nOctaves=AKAZE_OCTAVES
    )
    keypoints, descriptors = akaze.detectAndCompute(extended, None)
    if not keypoints:
        return view.replace(features=PanoramaFeatures(np.zeros((0, 2)), np.zeros((0, 61), np.uint8), width, height))
    # OpenCV's keypoints have pixel centres at integers; edge coordinates have them half a pixel on.
    places = np.array([keypoint.pt for keypoint in keypoints], dtype=np.float64) + 0.5 - [margin, 0]
    proper = (places[:, 0] >= 0) & (places[:, 0] < width)
    places[:, 1] = np.clip(places[:, 1], 0, height)
    return view.replace(features=PanoramaFeatures(places[proper], descriptors[proper], width, height))


def inside_box(points: np.ndarray, box: np.ndarray, width: int) -> np.ndarray:
    """Return bool `(n,)`: does a point `(n, 2)` lie in a box (u_min, v_min, u_max, v_max), which may cross the seam?"""
    points = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    u_min, v_min, u_max, v_max = np.asarray(box, dtype=np.float64)
    across = (points[:, 0] - u_min) % width < u_max - u_min
    return across & (points[:, 1] >= v_min) & (points[:, 1] < v_max)


@dataclass(frozen=True, eq=False)
class FeatureMatches:
    """Matches of features over two whole panoramas, one row a match, before the epipolar constraint is applied."""

    keypoints_upper: np.ndarray  # `(n, 2)` edge coordinates, pixels
    keypoints_lower: np.ndarray
    azimuth_difference: np.ndarray  # a_lower - a_upper `(n,)`, radians
    vertical_disparity: np.ndarray  # e_lower - e_upper `(n,)`, radians, positive for a true match
    epipolar: np.ndarray  # bool `(n,)`: which obey the epipolar constraint within `EPIPOLAR_TOLERANCE`

    def __len__(self) -> int:
        return len(self.epipolar)

    @property
    def epipolar_share(self) -> float:
        """Return the share of the matches that obey the epipolar constraint, in [0, 1]; nan without matches."""
        return float(self.epipolar.mean()) if len(self) else float("nan")


def match_features(upper: PanoramaFeatures, lower: PanoramaFeatures, may_be_swapped: bool = False) -> FeatureMatches:
    """Match whole panoramas without the epipolar constraint. Raises `SwappedImagesError` unless `may_be_swapped`."""
    first, second = _mutual_matches(upper.descriptors, lower.descriptors)
    azimuth_u, elevation_u = (angle[first] for angle in upper.angles())
    azimuth_l, elevation_l = (angle[second] for angle in lower.angles())
    disparity = elevation_l - elevation_u
    epipolar = epipolar_residual(azimuth_u, elevation_u, azimuth_l, elevation_l) <= EPIPOLAR_TOLERANCE
    if not may_be_swapped:
        check_not_swapped(disparity[epipolar])
    gap = np.atleast_1d(wrap_angle(azimuth_l - azimuth_u))
    return FeatureMatches(upper.keypoints[first], lower.keypoints[second], gap, disparity, epipolar)


def _mutual_matches(first: np.ndarray, second: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return index arrays of descriptors that are each other's nearest and pass the ratio test."""
    if len(first) < 2 or len(second) < 2:
        return np.zeros(0, int), np.zeros(0, int)
    matcher = cv2.BFMatcher(cv2.NORM_HAMMING)
    back = np.array([match.trainIdx for match in matcher.match(second, first)])
    kept = [
        (best.queryIdx, best.trainIdx)
        for best, runner_up in matcher.knnMatch(first, second, k=2)
        if best.distance <= RATIO * runner_up.distance and back[best.trainIdx] == best.queryIdx
    ]
    rows, columns = np.array(kept, dtype=int).reshape(-1, 2).T
    return rows, columns


def check_not_swapped(disparity: np.ndarray) -> None:
    """Raise `SwappedImagesError` if negative disparities `(n,)` lead by 3 sqrt(n), three sigmas of a coin."""
    told = disparity[np.abs(disparity) > MIN_DISPARITY]
    negative = int((told < 0).sum())
    if 2 * negative - len(told) > 3 * np.sqrt(len(told)):
        raise SwappedImagesError(
            f"upper and lower image seem to be swapped: {negative} of {len(told)} matched features lie lower in the "
            "image given as the lower one, but a camera further down sees them higher. Swap the two images"
        )


class Alignment(NamedTuple):
    """How the features of two images say that the cameras stand to each other."""

    turn: np.ndarray | None  # `(3,)` of the lower camera about x, y, z, radians; None if too few matches agree
    agreeing: float | None  # share of all matches that agree on it; None if there are too few to tell

    @property
    def of_one_moment(self) -> bool:
        """Return False if the matches cannot be those of two cameras at one place."""
        return self.agreeing is None or self.agreeing >= MIN_AGREEING_SHARE

    @property
    def is_upright(self) -> bool:
        """Return False if the lower camera is turned by more than `MAX_TURN`."""
        return self.turn is None or float(np.linalg.norm(self.turn)) <= MAX_TURN


def camera_alignment(upper: PanoramaFeatures, lower: PanoramaFeatures) -> Alignment:
    """Return the turn w of the lower camera against the upper one, and how many matches agree on it.

    a_l - a_u = -w_z + tan e_l (w_x cos a_l + w_y sin a_l)  for small angles w about x, y and z

    Least squares of the matches within 0.1 radian of the commonest azimuth difference, weighted by Cauchy's function.
    The paper takes the cameras as aligned. A tilt is added to every parallax: at 3 m a degree is a sixth of it.
    """
    every = slice(None, None, max(1, len(upper) // MAX_FEATURES))
    thinned = PanoramaFeatures(upper.keypoints[every], upper.descriptors[every], upper.width, upper.height)
    matches = match_features(thinned, lower, may_be_swapped=True)
    gap = matches.azimuth_difference
    if len(gap) < MIN_AGREEING:
        return Alignment(None, None)
    counts, edges = np.histogram(gap, bins=90, range=(-np.pi, np.pi))
    peak = int(np.argmax(np.roll(counts, 1) + counts + np.roll(counts, -1)))
    middle = (edges[peak] + edges[peak + 1]) / 2
    azimuth, elevation = azimuth_elevation_of_pixel(matches.keypoints_lower, lower.width, lower.height)
    # On the sphere an azimuth difference is as long as the cosine of the elevation.
    sine, cosine = np.sin(elevation), np.cos(elevation)
    rows = np.column_stack([sine * np.cos(azimuth), sine * np.sin(azimuth), -cosine])
    beyond = cosine * wrap_angle(gap - middle)
    near = np.abs(beyond) < _NEAR
    if near.sum() < MIN_AGREEING:
        return Alignment(None, float(near.mean()))
    rows, beyond, turn = rows[near], beyond[near], np.zeros(3)
    for _ in range(_STEPS):
        residual = beyond - rows @ turn
        scale = max(1.4826 * float(np.median(np.abs(residual))), 1e-4)
        weight = 1 / (1 + (residual / scale) ** 2)
        turn = np.linalg.lstsq(np.sqrt(weight)[:, None] * rows, np.sqrt(weight) * beyond, rcond=None)[0]
    agreeing = int((np.abs(beyond - rows @ turn) < EPIPOLAR_TOLERANCE).sum())
    share = agreeing / len(gap)
    if agreeing < MIN_AGREEING:
        return Alignment(None, share)
    return Alignment(np.array([turn[0], turn[1], wrap_angle(turn[2] - middle)]), share)
