"""Triangulation: against rays that meet, against noise drawn by hand, and where there is no distance."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from course_lib.spherical_stereo.panorama import PanoramaError, azimuth_elevation, direction_from_angles
from course_lib.spherical_stereo.ranging import triangulation
from course_lib.spherical_stereo.ranging.triangulation import object_position, triangulate, triangulation_outcome

BASELINE = 0.3
points = st.tuples(st.floats(0.4, 20), st.floats(-np.pi, np.pi), st.floats(-3, 2)).map(
    lambda p: np.array([p[0] * np.cos(p[1]), p[0] * np.sin(p[1]), p[2]])
)


def seen(point, baseline=BASELINE):
    """Unit directions from the upper camera (the origin) and from the lower one."""
    lower = np.add(point, [0, 0, baseline])
    return point / np.linalg.norm(point, axis=-1, keepdims=True), lower / np.linalg.norm(lower, axis=-1, keepdims=True)


@settings(max_examples=60, deadline=None)
@given(point=points, baseline=st.floats(0.05, 1.0))
def test_a_point_comes_back_from_the_two_directions_that_see_it(point, baseline):
    upper, lower = seen(point, baseline)
    assume(triangulation_outcome(upper, lower) == "ok")
    assert triangulate(upper, lower, baseline) == pytest.approx(np.linalg.norm(point), rel=1e-9)
    np.testing.assert_allclose(object_position(upper, lower, baseline), point, rtol=1e-8, atol=1e-8)


def test_skew_rays_give_the_distance_of_their_elevations(rng):
    upper, lower = seen(np.array([2.0, 1.0, -0.8]))
    azimuth, elevation = azimuth_elevation(lower)
    turned = direction_from_angles(azimuth + rng.uniform(-0.08, 0.08, 5), elevation)
    assert triangulate(upper, turned, BASELINE) == pytest.approx(triangulate(upper, lower, BASELINE), rel=1e-12)


@pytest.mark.parametrize(
    ("upper", "lower", "name"),
    [
        ((0.3, -0.2), (0.3, -0.2 + 0.0009), "parallel"),
        ((0.3, -0.2), (0.3, -0.2 - 0.0009), "parallel"),
        ((0.0, -np.pi / 2), (0.0, -1.5), "parallel"),
        ((0.0, 1.2), (0.0, np.pi / 2), "parallel"),
        ((0.3, -0.2), (0.3, -0.25), "diverging"),
        ((0.0, -0.2), (0.15, -0.1), "azimuth gap"),
        ((3.1, -0.2), (-0.04, -0.1), "azimuth gap"),
        ((3.13, -0.2), (-3.13, -0.1), "ok"),  # across the seam
    ],
)
def test_directions_without_a_distance_have_a_named_outcome(upper, lower, name):
    upper, lower = direction_from_angles(*upper), direction_from_angles(*lower)
    assert triangulation_outcome(upper, lower) == name
    if name == "ok":
        assert np.isfinite(triangulate(upper, lower, BASELINE))
    else:
        with pytest.raises(triangulation.TriangulationError) as caught:
            triangulate(upper, lower, BASELINE)
        assert caught.value.outcome == name


def test_the_covariance_is_that_of_noise_drawn_by_hand(rng):
    sigma_azimuth, sigma_elevation = 8 * np.pi / 1280, 0.3 * np.pi / 640
    for point in ([2.5, 1.0, -0.8], [-1.5, 0.3, -1.2], [0.2, -3.5, 0.4]):
        (azimuth, e_u), (_, e_l) = (azimuth_elevation(d) for d in seen(np.array(point)))
        noise = rng.normal(size=(3, 60_000)) * np.array([[sigma_azimuth], [sigma_elevation], [sigma_elevation]])
        upper = direction_from_angles(azimuth + noise[0], e_u + noise[1])
        drawn = object_position(upper, direction_from_angles(azimuth, e_l + noise[2]), BASELINE)
        sigmas = sigma_azimuth, sigma_elevation
        predicted = triangulation.triangulation_covariance(*seen(np.array(point)), BASELINE, *sigmas)
        np.testing.assert_allclose(np.cov(drawn.T), predicted, atol=0.05 * np.abs(predicted).max())


def test_noise_that_is_none_and_directions_that_are_none_are_refused():
    upper, lower = seen(np.array([2.0, 0, 0]))
    with pytest.raises(PanoramaError, match="baseline"):
        triangulate(upper, lower, 0.0)
    with pytest.raises(PanoramaError, match="a sigma must be"):
        triangulation.triangulation_covariance(upper, lower, BASELINE, 0.001, -0.001)
    with pytest.raises(PanoramaError, match="direction"):
        triangulate(np.full(3, np.nan), lower, BASELINE)
