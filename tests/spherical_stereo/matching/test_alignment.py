"""How the lower camera is turned: from rendered images, and from features made by hand."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from course_lib.spherical_stereo.matching.features import PanoramaFeatures, camera_alignment
from course_lib.spherical_stereo.panorama import direction_to_pixel
from tests.spherical_stereo.vertical_pair import BASELINE

SIZE = (1280, 640)


def camera_turn(upper, lower):
    return camera_alignment(upper, lower).turn


def features(points, rng, turn=(0.0, 0.0, 0.0)):
    """Features at the directions of points `(n, 3)`, as a camera turned by a vector sees them; random descriptors."""
    seen = Rotation.from_rotvec(turn).inv().apply(points)
    places = direction_to_pixel(seen, *SIZE)
    return PanoramaFeatures(places, rng.integers(0, 256, (len(points), 61), dtype=np.uint8), *SIZE)


def test_exact_features_give_the_turn_and_strangers_do_not_matter(rng):
    points = rng.uniform([-4, -4, -1.2], [4, 4, 1.2], (300, 3))
    points = points[np.hypot(points[:, 0], points[:, 1]) > 0.8]
    turn = np.array([0.012, -0.008, 0.02])
    upper = features(points, rng)
    lower = features(np.add(points, [0, 0, BASELINE]), rng, turn)
    strangers = rng.permutation(len(points))[: len(points) // 4]
    keypoints = lower.keypoints.copy()
    keypoints[strangers] = rng.uniform(0, SIZE, (len(strangers), 2))
    lower = PanoramaFeatures(keypoints, upper.descriptors, *SIZE)
    assert camera_turn(upper, lower) == pytest.approx(turn, abs=5e-4)


def test_images_with_nothing_in_common_tell_no_turn(rng):
    first, second = (features(rng.normal(size=(400, 3)), rng) for _ in range(2))
    assert camera_turn(first, second) is None
    assert camera_turn(first, PanoramaFeatures(np.zeros((0, 2)), np.zeros((0, 61), np.uint8), *SIZE)) is None
