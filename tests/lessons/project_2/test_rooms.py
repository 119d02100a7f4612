"""The rooms of projects P2 and P3: what is stored of them is what the method saw, and reads back."""

import json
from dataclasses import replace

import numpy as np
import pytest

from course_lib.lessons.project_2.rooms import SEEDS, record_room
from course_lib.lessons.project_2.rooms import project_rooms as read_rooms
from course_lib.simulation.room.look_alike_recording import RecordingModels
from course_lib.spherical_stereo.detection.detected_object import Detection

DETECTED = Detection("chair", 0.987654, (250.123456, 60.0, 262.0, 80.0), 359.99999, 40.0)
GREY = Detection("sofa", 0.9, (10.0, 60.0, 60.0, 80.0), np.nan, 4.0)


class SameEverywhere:
    """A detector that reports the same two objects on whatever image."""

    def detect(self, image_bgr):
        return [DETECTED, GREY]


@pytest.fixture(scope="module")
def record():
    return record_room(10_690, 1, replace(RecordingModels(), width=256), SameEverywhere())


def test_practice_rooms_are_for_tuning_and_hidden_ones_for_nothing_else():
    assert min(SEEDS["practice"]) >= 10_000
    assert all(1000 <= seed < 10_000 for seed in SEEDS["hidden"]), "four digits: no stored picture holds them by chance"


@pytest.mark.slow
def test_a_room_is_seen_from_both_heights_and_reads_back(record, tmp_path):
    (tmp_path / "rooms.json").write_text(json.dumps({"version": 1, "rooms": [record]}))
    (room,) = read_rooms(tmp_path / "rooms.json")
    assert room.seed == 10_690
    assert room.look_alike == room.semantic_map.labels[0]
    assert len(room.views) == 2
    assert room.views[0].pose == pytest.approx(room.views[1].pose, abs=0.05)
    view = room.views[0]
    assert view.size == (256, 128)
    assert view.rig.baseline == pytest.approx(0.3)
    chair, sofa = view.upper
    assert chair.box[0] == pytest.approx(DETECTED.box[0], abs=1e-4)
    assert chair.hue == 0.0, "359.99999 is rounded on the circle"
    assert sofa.is_grey
    assert len(view.observations) == len(view.shows)
