"""AKAZE on panoramas, epipolar pairs and nearest descriptors."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from course_lib.spherical_stereo.matching import epipolar
from course_lib.spherical_stereo.matching.alignment import camera_alignment
from course_lib.spherical_stereo.matching.epipolar import best_pairs, epipolar_pairs
from course_lib.spherical_stereo.matching.features import (
    PanoramaFeatures,
    detect_features,
    inside_box,
)
from course_lib.spherical_stereo.panorama import direction_to_pixel
from tests.spherical_stereo.stereo_scene import BASELINE, HEIGHT, WIDTH, scene

IMAGE = scene()[1]


@pytest.fixture(scope="module")
def features():
    return detect_features(IMAGE)


def test_features_on_the_seam_are_found_as_well_as_elsewhere(features):
    """Half the image away, what was at the seam is in the middle: as many features, at the same places."""
    turned = detect_features(np.roll(IMAGE, WIDTH // 2, axis=1))
    near_seam = features.keypoints[(features.keypoints[:, 0] < 20) | (features.keypoints[:, 0] > WIDTH - 20)]
    in_the_middle = turned.keypoints[np.abs(turned.keypoints[:, 0] - WIDTH / 2) < 20]
    assert len(near_seam) > 10
    assert len(in_the_middle) == pytest.approx(len(near_seam), rel=0.1)
    moved = np.column_stack([(near_seam[:, 0] + WIDTH / 2) % WIDTH, near_seam[:, 1]])
    nearest = np.linalg.norm(moved[:, None] - turned.keypoints[None], axis=-1).min(axis=1)
    assert np.mean(nearest < 0.5) > 0.9


def test_keypoints_are_in_edge_coordinates():
    """A bright square over columns 100 to 119 and rows 60 to 79 has its centre at (110, 70)."""
    image = np.full((HEIGHT, WIDTH, 3), (50, 60, 70), np.uint8)
    image[60:80, 100:120] = 200
    keypoints = detect_features(image).keypoints
    assert len(keypoints) >= 4
    np.testing.assert_allclose(keypoints.mean(axis=0), [110, 70], atol=0.3)


def test_a_box_across_the_seam_holds_points_on_both_sides_of_it():
    points = np.array([[505.0, 50], [3, 50], [20, 50], [490, 50], [3, 5], [500, 60]])
    box = (500.0, 10.0, 522.0, 60.0)
    assert inside_box(points, box, WIDTH).tolist() == [True, True, False, False, False, False]


def features_of(places, rng):
    """Features at places `(n, 2)` with random descriptors."""
    return PanoramaFeatures(places, rng.integers(0, 256, (len(places), 61), dtype=np.uint8), WIDTH, HEIGHT)


def test_epipolar_pairs_are_all_that_looking_at_every_pair_finds(rng):
    upper, lower = (features_of(rng.uniform(0, [WIDTH, HEIGHT], (n, 2)), rng) for n in (150, 170))
    residual = epipolar.epipolar_residual(*(angle[:, None] for angle in upper.angles()), *lower.angles())
    bits_u, bits_l = np.unpackbits(upper.descriptors, axis=1), np.unpackbits(lower.descriptors, axis=1)
    distance = (bits_u[:, None] != bits_l[None]).sum(axis=-1)
    expected = {(int(i), int(j)) for i, j in np.argwhere((residual <= 0.05) & (distance <= 245))}
    pairs = epipolar_pairs(upper, lower, tolerance=0.05, max_hamming=245)
    assert len(expected) > 100
    assert set(zip(pairs.upper.tolist(), pairs.lower.tolist(), strict=True)) == expected
    np.testing.assert_array_equal(pairs.distance, distance[pairs.upper, pairs.lower])


def pairs_of(*triples):
    upper, lower, distance = np.array(triples).T
    return epipolar.EpipolarPairs(upper, lower, distance, distance * 0.0, distance * 0.0)


def test_best_pairs_are_mutual_and_clear():
    pairs = pairs_of((0, 0, 10), (0, 1, 50), (1, 1, 40), (1, 0, 30), (2, 2, 20), (2, 3, 22), (3, 4, 9), (4, 4, 9))
    kept = best_pairs(pairs, ratio=0.8)
    # 1 prefers 0, which prefers 0; 2 has two that are nearly alike; 3 and 4 want the same one equally.
    assert list(zip(kept.upper.tolist(), kept.lower.tolist(), strict=True)) == [(0, 0)]
    assert len(best_pairs(pairs_of((2, 2, 20), (2, 3, 22)), ratio=1.0)) == 1


def test_nothing_is_turned_between_two_upright_cameras_and_so_descriptors_are_upright(features):
    """The image upside down has the same features; descriptors that turn along would find most of them again."""
    turned = detect_features(np.ascontiguousarray(IMAGE[::-1, ::-1]))
    assert len(turned) == pytest.approx(len(features), rel=0.05)
    back = PanoramaFeatures([WIDTH, HEIGHT] - turned.keypoints, turned.descriptors, WIDTH, HEIGHT)
    assert len(np.unique(epipolar_pairs(features, back, 0.005).upper)) < 0.2 * len(features)
    assert len(np.unique(epipolar_pairs(features, features, 0.005).upper)) == len(features)


def one_feature(azimuth, elevation, bits=0):
    """A feature at a direction (radians), whose descriptor differs from the first one's in so many bits."""
    descriptor = np.packbits(np.arange(488) < bits)
    keypoint = [(0.5 - azimuth / (2 * np.pi)) * WIDTH, (0.5 - elevation / np.pi) * HEIGHT]
    return PanoramaFeatures(np.array([keypoint]), descriptor[None], WIDTH, HEIGHT)


@pytest.mark.parametrize(("azimuth", "bits", "pairs"), [(0.014, 0, 1), (0.017, 0, 0), (0.0, 119, 1), (0.0, 125, 0)])
def test_unless_told_otherwise_a_pair_is_within_three_columns_of_1280_and_120_bits(azimuth, bits, pairs):
    assert len(epipolar_pairs(one_feature(0.0, 0.0), one_feature(azimuth, 0.1, bits))) == pairs


@pytest.mark.parametrize(("horizontal_range", "allowed"), [(0.25, False), (0.35, True), (20.0, True), (-2.0, False)])
def test_no_object_is_nearer_than_30_centimetres_or_behind_infinity(horizontal_range, allowed):
    pairs = epipolar_pairs(one_feature(0.0, 0.0), one_feature(0.0, np.arctan(0.3 / horizontal_range)))
    assert epipolar.allowed_by_rig(pairs, 0.3).tolist() == [allowed]


def features_at(points, rng, turn=(0.0, 0.0, 0.0)):
    """Features at the directions of points `(n, 3)`, as a camera turned by a vector sees them; random descriptors."""
    return features_of(direction_to_pixel(Rotation.from_rotvec(turn).inv().apply(points), WIDTH, HEIGHT), rng)


def test_exact_features_give_the_turn_and_strangers_do_not_matter(rng):
    points = rng.uniform([-4, -4, -1.2], [4, 4, 1.2], (300, 3))
    points = points[np.hypot(points[:, 0], points[:, 1]) > 0.8]
    turn = np.array([0.012, -0.008, 0.02])
    upper = features_at(points, rng)
    lower = features_at(np.add(points, [0, 0, BASELINE]), rng, turn)
    strangers = rng.permutation(len(points))[: len(points) // 4]
    keypoints = lower.keypoints.copy()
    keypoints[strangers] = rng.uniform(0, [WIDTH, HEIGHT], (len(strangers), 2))
    keypoints[strangers[::2]] = (lower.keypoints[strangers[::2]] + [6.0, 0.0]) % [WIDTH, HEIGHT]  # near misses
    lower = PanoramaFeatures(keypoints, upper.descriptors, WIDTH, HEIGHT)
    found = camera_alignment(upper, lower)
    assert found.turn == pytest.approx(turn, abs=5e-4)
    assert found.agreeing == pytest.approx(0.75, abs=0.02)
    # Images with nothing in common tell no turn.
    first, second = (features_at(rng.normal(size=(400, 3)), rng) for _ in range(2))
    assert camera_alignment(first, second).turn is None
    assert camera_alignment(first, features_of(np.zeros((0, 2)), rng)).turn is None
