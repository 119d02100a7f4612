"""AKAZE features on one panorama (2.3).

AKAZE is made for flat images, and an equirectangular one is stretched sideways by 1 / cos(elevation), so features above
about 60 degrees up or down match less often. The descriptors are the upright ones, because both cameras stand upright.
"""

from dataclasses import dataclass

import cv2
import numpy as np

from course_lib.spherical_stereo.panorama import View, azimuth_elevation_of_pixel, open_view

# Smallest determinant of the Hessian that counts as a feature. On eight pairs of generated rooms OpenCV's default of
# 1e-3 left 6 of 94 objects without a match, 5e-4 left one and 2e-4 none.
AKAZE_THRESHOLD = 2e-4
AKAZE_OCTAVES = 3  # Octaves of scale. A fourth adds nothing on panoramas about 1,000 pixels wide.
# Columns repeated at both sides of the image: the descriptor of AKAZE's coarsest feature in three octaves reaches
# 10 sqrt(2) x 1.6 x 2^2.75 = 152 pixels, and must not leave the image.
SEAM_MARGIN = 160


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
