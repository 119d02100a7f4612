"""A folder of pairs is read as it was written, and a file that cannot be used is named."""

import json

import cv2
import numpy as np
import pytest

from course_lib.spherical_stereo.panorama import PanoramaError
from courseware.simulation.room.stereo_recording import read_stereo_recording

BOX = [50.0, 20.0, 70.0, 40.0]
SEEN = {"object": 7, "label": "sofa", "visible_box": BOX, "unoccluded_box": BOX, "visible_fraction": 0.9}


@pytest.fixture
def content(tmp_path):
    for side in ("upper", "lower"):
        image = np.random.default_rng(1).integers(0, 256, (64, 128, 3), dtype=np.uint8)
        cv2.imwrite(str(tmp_path / f"{side}.png"), image)
    sides = {side: {"file": f"{side}.png", "objects": [SEEN]} for side in ("upper", "lower")}
    rig = {"x": 0.5, "y": 0.25, "heading": 0.1, "upper_height": 1.32}
    pairs = [{"name": "pose_0", "rig": rig, **json.loads(json.dumps(sides))}]
    return {"version": 1, "seed": 3, "width": 128, "height": 64, "baseline": 0.3, "pairs": pairs}


def read(folder, content):
    (folder / "poses.json").write_text(json.dumps(content))
    return read_stereo_recording(folder)


def test_what_is_written_is_read_and_images_of_another_size_are_named(tmp_path, content):
    found = read(tmp_path, content)
    assert (found.width, found.height, found.seed, found.rig.baseline) == (128, 64, 3, 0.3)
    assert found.pairs[0].pose.tolist() == [0.5, 0.25, 0.1]
    assert found.pairs[0].upper_objects[0].visible_box == tuple(BOX)
    assert [image.shape for image in found.pairs[0].images()] == [(64, 128, 3)] * 2
    content |= {"width": 256, "height": 128}
    with pytest.raises(PanoramaError, match=r"upper\.png .*poses\.json"):
        read(tmp_path, content).pairs[0].images()


@pytest.mark.parametrize(
    ("place", "value"),
    [
        (("baseline",), "0.3"),
        (("baseline",), -0.3),
        (("height",), -64),
        (("pairs", 0, "lower", "file"), ""),
        (("pairs", 0, "rig", "heading"), [0.1]),
        (("pairs", 0, "upper", "objects", 0, "object"), 7.5),
        (("pairs", 0, "upper", "objects", 0, "visible_box"), BOX[:3]),
    ],
)
def test_what_is_of_another_kind_is_named_with_the_file(tmp_path, content, place, value):
    inner = content
    for key in place[:-1]:
        inner = inner[key]
    inner[place[-1]] = value
    with pytest.raises(PanoramaError, match=r"poses\.json"):
        read(tmp_path, content)
