"""AKAZE features on panoramas: where they are, their descriptors, and which of them lie in a box (paper 2, 2.3).

AKAZE is made for flat images. An equirectangular image stretches everything sideways by 1 / cos(elevation): twice at 60
degrees, without limit at the poles. Between two cameras of one vertical rig a point moves along its column, from one
stretch to another, so features above about 60 degrees up or down match less often; furniture rarely stands there.

The descriptors are the upright ones: the cameras of a rig stand upright side by side, so nothing is turned between
their images, and leaving rotation out tells more features apart (a fifth more matches on a real pair).
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from course_lib.spherical_stereo.panorama import PanoramaError, View, azimuth_elevation_of_pixel, open_view

# Smallest determinant of the Hessian that counts as a feature. On eight pairs of generated rooms OpenCV's default of
# 1e-3 left 6 of 94 objects without a match, 5e-4 left one and 2e-4 none, for half as much time again; on a real pair as
# large a share of the weaker features obeys the epipolar constraint.
AKAZE_THRESHOLD = 2e-4
# Octaves of scale. A fourth adds nothing on panoramas about 1,000 pixels wide.
AKAZE_OCTAVES = 3
# Columns repeated at both sides of the image, pixels: the descriptor of AKAZE's coarsest feature in three octaves
# reaches 10 sqrt(2) x 1.6 x 2^2.75 = 152 pixels, and a feature whose descriptor would leave the image is not found.
SEAM_MARGIN = 160


@dataclass(frozen=True, eq=False)
class PanoramaFeatures:
    """AKAZE features of one panorama.

    keypoints: `(n, 2)` float64, edge coordinates (u, v), pixels, u in [0, width). descriptors: `(n, 61)` uint8, 486
    bits compared by Hamming distance. width, height: the panorama's size, pixels.
    """

    keypoints: np.ndarray
    descriptors: np.ndarray
    width: int
    height: int

    def __len__(self) -> int:
        return len(self.keypoints)

    def angles(self) -> tuple[np.ndarray, np.ndarray]:
        """Azimuth and elevation `(n,)` of every feature, radians."""
        return azimuth_elevation_of_pixel(self.keypoints, self.width, self.height)


def detect_features(
    image: np.ndarray, threshold: float = AKAZE_THRESHOLD, octaves: int = AKAZE_OCTAVES
) -> PanoramaFeatures:
    """`find_features` of an image, uint8 BGR `(H, W, 3)`, W = 2 H. Raises `PanoramaError` as it and `open_view` do."""
    return find_features(open_view(image), threshold, octaves).features


def find_features(view: View, threshold: float = AKAZE_THRESHOLD, octaves: int = AKAZE_OCTAVES) -> View:
    """The panorama with its AKAZE features, found unless they are there already; those on the seam too, each once.

    threshold: smallest response, lower means more and weaker features. The image is extended by its own other end on
    both sides, and only features whose place is in the image proper are kept: a feature on the seam is found whole, and
    its copy in the extension is left out.
    Raises `PanoramaError` for a threshold that is not positive or octaves below one. Source: paper 2, section 2.3.
    """
    if view.features is not None:
        return view
    if not threshold > 0 or int(octaves) != octaves or octaves < 1:
        raise PanoramaError(f"threshold must be positive and octaves at least 1; got {threshold!r} and {octaves!r}")
    image, height, width = view.image, view.height, view.width
    margin = min(SEAM_MARGIN, width // 2)
    grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
    extended = np.concatenate([grey[:, -margin:], grey, grey[:, :margin]], axis=1)
    akaze = cv2.AKAZE_create(
        descriptor_type=cv2.AKAZE_DESCRIPTOR_MLDB_UPRIGHT, threshold=float(threshold), nOctaves=int(octaves)
    )
    keypoints, descriptors = akaze.detectAndCompute(extended, None)
    if not keypoints:
        nothing = PanoramaFeatures(np.zeros((0, 2)), np.zeros((0, 61), np.uint8), width, height)
        return view.having(features=nothing)
    # OpenCV's keypoints have pixel centres at integers; edge coordinates have them half a pixel on.
    places = np.array([keypoint.pt for keypoint in keypoints], dtype=np.float64) + 0.5 - [margin, 0]
    proper = (places[:, 0] >= 0) & (places[:, 0] < width)
    places[:, 1] = np.clip(places[:, 1], 0, height)
    return view.having(features=PanoramaFeatures(places[proper], descriptors[proper], width, height))


def inside_box(points: np.ndarray, box: np.ndarray, width: int) -> np.ndarray:
    """Which of the points `(n, 2)` lie in a box (u_min, v_min, u_max, v_max), on the circle of columns; bool `(n,)`.

    A point is inside when (u - u_min) mod W < u_max - u_min and v_min <= v < v_max, so a box may cross the seam.
    """
    points = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    u_min, v_min, u_max, v_max = np.asarray(box, dtype=np.float64)
    across = (points[:, 0] - u_min) % width < u_max - u_min
    return across & (points[:, 1] >= v_min) & (points[:, 1] < v_max)
