"""The sphere behind the image: conventions, round trips, and images that are no panoramas."""

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from course_lib.spherical_stereo import panorama

WIDTH, HEIGHT = 1280, 640


@pytest.mark.parametrize(
    ("uv", "direction"),
    [
        ((WIDTH / 2, HEIGHT / 2), (1, 0, 0)),  # the centre looks forward
        ((WIDTH / 4, HEIGHT / 2), (0, 1, 0)),  # left of it is left
        ((3 * WIDTH / 4, HEIGHT / 2), (0, -1, 0)),
        ((0, HEIGHT / 2), (-1, 0, 0)),  # the seam is behind, from both sides
        ((WIDTH, HEIGHT / 2), (-1, 0, 0)),
        ((WIDTH / 2, 0), (0, 0, 1)),  # row 0 is straight up
        ((WIDTH / 3, HEIGHT), (0, 0, -1)),
    ],
)
def test_pixels_look_where_the_conventions_say(uv, direction):
    np.testing.assert_allclose(panorama.pixel_to_direction(np.array(uv), WIDTH, HEIGHT), direction, atol=1e-15)


@settings(max_examples=60, deadline=None)
@given(u=st.floats(0, WIDTH, exclude_max=True), v=st.floats(0.01, HEIGHT - 0.01))
def test_a_pixel_comes_back_from_its_direction(u, v):
    back = panorama.direction_to_pixel(panorama.pixel_to_direction(np.array([u, v]), WIDTH, HEIGHT), WIDTH, HEIGHT)
    assert 0 <= back[0] < WIDTH
    assert abs((back[0] - u + WIDTH / 2) % WIDTH - WIDTH / 2) < 1e-6
    assert back[1] == pytest.approx(v, abs=1e-9)


@pytest.mark.parametrize("uv", [[1.0], [1.0, 2.0, 3.0], [np.nan, 1.0], [5.0, -0.1], [5.0, HEIGHT + 0.1]])
def test_a_place_that_is_not_on_the_image_is_refused(uv):
    with pytest.raises(panorama.PanoramaError):
        panorama.azimuth_elevation_of_pixel(np.array(uv), WIDTH, HEIGHT)


@pytest.mark.parametrize(
    ("baseline", "height", "says"),
    [(0, 1.3, "baseline"), (-0.3, 1.3, "swapped"), (np.nan, 1.3, "baseline"),
     (300, 1.3, "in millimetres"), (0.3, 0.2, "upper_height"), (0.3, np.inf, "upper_height")],
)  # fmt: skip
def test_a_rig_that_cannot_be_is_named(baseline, height, says):
    with pytest.raises(panorama.PanoramaError, match=says):
        panorama.StereoRig(baseline, height)


@pytest.mark.parametrize(
    ("image", "says"),
    [
        (None, "colour image"),
        (np.zeros((8, 16), np.uint8), "colour image"),
        (np.zeros((0, 0, 3), np.uint8), "0 x 0 pixels"),
        (np.repeat(np.arange(128, dtype=np.uint8).reshape(8, 16, 1), 3, axis=2), "three channels are equal"),
        (np.zeros((8, 15, 3), np.uint8), "15 x 8 pixels"),
        (np.zeros((8, 16, 4), np.uint8), "colour image"),
        (np.zeros((8, 16, 3), np.float32), "8 bits; got .* of float32"),
    ],
)
def test_an_image_that_is_no_panorama_is_named(image, says):
    with pytest.raises(panorama.PanoramaError, match=f"^left image.*{says}"):
        panorama.open_view(image, "left image")


def test_a_black_frame_is_let_in_and_known_as_one():
    image = np.zeros((8, 16, 3), np.uint8)
    for brightest, blank in ((0, True), (12, True), (13, False)):
        image[3, 5, 1] = brightest
        assert panorama.open_view(image).is_blank is blank


def test_a_panorama_file_is_read_without_its_alpha_and_another_one_named(tmp_path, rng):
    image = rng.integers(0, 255, (8, 16, 4), dtype=np.uint8)
    cv2.imwrite(str(tmp_path / "a.png"), image)
    cv2.imwrite(str(tmp_path / "square.png"), image[:, :8])
    for name, says in (("missing", "is missing"), ("square", "twice as wide")):
        with pytest.raises(panorama.PanoramaError, match=rf"{name}\.png.*{says}"):
            panorama.read_panorama(tmp_path / f"{name}.png")
    np.testing.assert_array_equal(panorama.read_panorama(tmp_path / "a.png").image, image[..., :3])
