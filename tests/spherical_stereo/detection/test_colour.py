"""Hue and saturation: means on the circle, over the central half of a box, and none for grey."""

import math

import cv2
import numpy as np
import pytest

from course_lib.spherical_stereo.detection.colour import mean_hue_saturation
from course_lib.spherical_stereo.detection.detected_object import DetectionError


def bgr(hue, saturation_percent, value=0.8):
    hsv = np.array([[[hue, saturation_percent / 100, value]]], dtype=np.float32)
    return np.rint(255 * cv2.cvtColor(hsv, cv2.COLOR_HSV2BGR)[0, 0]).astype(np.uint8)


def plain(*colours):
    """An image of vertical bands of equal width."""
    bands = np.array(colours)[np.arange(80) * len(colours) // 80]
    return np.repeat(bands[None], 40, axis=0).astype(np.uint8)


@pytest.mark.parametrize("hue", [0, 45, 123, 210, 359])
def test_a_plain_surface_has_its_own_hue_and_saturation(hue):
    found, saturation = mean_hue_saturation(plain(bgr(hue, 60)))
    assert abs((found - hue + 180) % 360 - 180) < 1.5
    assert saturation == pytest.approx(60, abs=0.7)


@pytest.mark.parametrize("colour", [bgr(30, 0), bgr(30, 5), bgr(200, 9.5), (0, 0, 0), (255, 255, 255)])
def test_grey_has_no_hue(colour):
    hue, saturation = mean_hue_saturation(plain(colour))
    assert math.isnan(hue)
    assert 0 <= saturation < 10
    assert mean_hue_saturation(plain(bgr(30, 10.5)))[0] == pytest.approx(30, abs=3)


@pytest.mark.parametrize(("start", "share"), [(29.4, 0.9), (29.5, 0.9), (29.6, 1.0)])
@pytest.mark.parametrize("turned", [False, True])
def test_a_pixel_belongs_to_a_box_if_its_centre_does(start, share, turned):
    """Half the columns, or rows, are grey: those up to the 30th."""
    image = np.where(np.arange(80)[None, :, None] < 30, np.uint8(200), bgr(0, 80))[np.zeros(80, int)].astype(np.uint8)
    box = np.array([start - 5, 10, start + 15, 50])
    if turned:
        image, box = image.swapaxes(0, 1), box[[1, 0, 3, 2]]
    assert mean_hue_saturation(image, tuple(box))[1] == pytest.approx(share * 80, abs=0.5)


def test_hues_of_all_directions_have_no_mean_and_noise_in_the_dark_has_no_say():
    hue, saturation = mean_hue_saturation(plain(*(bgr(h, 70) for h in range(0, 360, 45))))
    assert math.isnan(hue)
    assert saturation == pytest.approx(70, abs=1)
    # The saturation of (3, 0, 0) is 100 %: weighted by it alone, near-black pixels would decide.
    assert mean_hue_saturation(plain(bgr(120, 60), (3, 0, 0), (9, 0, 0)))[0] == pytest.approx(120, abs=1)


def test_only_the_central_half_of_the_box_counts_or_the_mask():
    image = plain(bgr(0, 80))
    image[10:30, 20:60] = bgr(240, 80)
    assert mean_hue_saturation(image, box=(0, 0, 80, 40))[0] == pytest.approx(240, abs=1)
    assert mean_hue_saturation(image, box=(20.0, 10.0, 20.5, 10.5))[0] == pytest.approx(240, abs=1)  # within one pixel
    assert mean_hue_saturation(image, mask=(image == bgr(240, 80)).all(axis=-1))[0] == pytest.approx(240, abs=1)


def test_a_box_across_the_seam_is_measured_as_if_the_panorama_were_turned(rng):
    image = rng.integers(0, 256, (40, 80, 3), dtype=np.uint8)
    image[:, 30:70, 2] //= 8
    expected = mean_hue_saturation(image, box=(30, 5, 70, 35))
    turned = np.roll(image, 40, axis=1)
    assert mean_hue_saturation(turned, box=(70, 5, 110, 35)) == pytest.approx(expected, abs=1e-9)


def test_no_colour_is_made_up_where_there_is_none():
    for image in (np.ones((4, 8, 3)), np.ones((4, 8), np.uint8)):
        with pytest.raises(DetectionError, match=r"image must be uint8 BGR \(H, W, 3\)"):
            mean_hue_saturation(image)
    for arguments in ({"mask": np.zeros((40, 80), dtype=bool)}, {"box": (5, 5, 5, 9)}, {"box": (5, 50, 9, 90)}):
        with pytest.raises(DetectionError, match=r"no pixel is left|u_min < u_max"):
            mean_hue_saturation(plain((1, 2, 3)), **arguments)
