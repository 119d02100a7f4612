"""--detector, --input-size and --score-threshold: what reaches the detector, and what is refused."""

import argparse

import pytest

from course_lib.commands.arguments import add_detector_arguments, chosen_detector
from course_lib.paths import data_path
from course_lib.spherical_stereo.detection.detector import YoloDetector


def options(*words):
    parser = argparse.ArgumentParser()
    add_detector_arguments(parser)
    return parser.parse_args(words)


@pytest.fixture(autouse=True)
def loaded(monkeypatch):
    """YoloDetector.load gives back what it was asked for."""
    monkeypatch.setattr(YoloDetector, "load", lambda folder, **options: (folder, options))


def test_what_is_given_reaches_the_detector_and_the_rest_is_left_to_its_folder(tmp_path):
    assert chosen_detector(options()) == (data_path("detector"), {})
    words = ["--detector", str(tmp_path), "--input-size", "1280", "512", "--score-threshold", "0.7"]
    assert chosen_detector(options(*words)) == (tmp_path, {"input_size": (1280, 512), "score_threshold": 0.7})


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--input-size", "1280", "500"], "--input-size must be two multiples of 32 above 0; got 1280 500"),
        (["--score-threshold", "1.5"], "--score-threshold must be between 0 and 1; got 1.5"),
    ],
)
def test_an_option_that_does_not_fit_is_named(words, message):
    with pytest.raises(ValueError, match=message):
        chosen_detector(options(*words))
