"""Generated rooms: what is kept of a room, how many poses are judged by what truth, and how surely."""

import json
from dataclasses import replace
from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest

from course_lib.geometry import wrap_angle
from courseware.experiments import observed_rooms
from courseware.experiments.observed_rooms import judged_poses, observe_room, stored_map, stored_observations
from courseware.experiments.room import localize_pair
from courseware.experiments.room_evaluation import NO_OBJECT
from courseware.experiments.rooms import METHODS, rooms_summary
from courseware.paths import data_path
from courseware.simulation.room.look_alike_recording import RecordingModels
from courseware.simulation.room.survey import RoomSurveyModel
from courseware.simulation.sensors.panorama_rig import RigModel

MAP = [["sofa", 0.0, 0.0, 20.0, 60.0], ["sofa", 4.0, 0.0, 21.0, 60.0], ["table", 1.0, 3.0, None, 5.0]]
NOISE = [[0.01, 0.0], [0.0, 0.01]]


def entry(shown=(0, 1, 2)):
    """A pose's record: the map's objects as a rig at (1, 1) with heading 0 sees them; `shown`: the truth told."""
    observations = [[label, x - 1.0, y - 1.0, *colour, NOISE] for label, x, y, *colour in MAP]
    source = {"observations": observations, "true_landmarks": list(shown)}
    where = {"experiment": 1, "name": "00", "pose": [1.0, 1.0, 0.0]}
    counts = {"objects": 4, "found": 3, "detections": 4, "seconds": 0.5}
    return where | {"sources": {"images": source, "exact_boxes": source}} | counts


def record(seed=7, poses=None):
    poses = poses or [entry(), entry() | {"experiment": 2}]
    return {"seed": seed, "look_alike": {"label": "sofa", "n": 2}, "map": MAP, "poses": poses}


def judged(rooms):
    return list(judged_poses(rooms, rooms, METHODS))


def test_a_record_gives_its_map_and_observations_back_grey_ones_too():
    semantic_map = stored_map(record())
    assert semantic_map.labels == ("sofa", "sofa", "table")
    assert np.isnan(semantic_map.hues[2])
    table = stored_observations(entry()["sources"]["images"])[2]
    assert np.isnan(table.hue)
    np.testing.assert_allclose((table.x, table.y), (0.0, 2.0))
    np.testing.assert_allclose(table.covariance, NOISE)


def test_poses_are_judged_by_the_truth_of_the_record():
    methods = set(METHODS) - {"as_printed"}
    right, wrong = (
        [one for one in judged([record(poses=[entry(shown=shown)])]) if one.method in methods]
        for shown in ((0, 1, 2), (1, 0, 2))
    )
    assert {one.outcome.kind for one in right} == {"correct"}
    assert {one.outcome.kind for one in wrong} == {"incorrect"}
    assert {(one.source, one.method) for one in right} == set(product(("images", "exact_boxes"), methods))
    assert right[0].outcome.dx_m == pytest.approx(0.0, abs=1e-9)


def test_as_printed_the_distance_term_prefers_what_is_too_near():
    """All stand where the map has them, and yet the cheapest pair is an object near the centroid with one far off."""
    outcomes = {one.method: one.outcome.kind for one in judged([record(poses=[entry()])])}
    assert outcomes["paper"] == "correct" != outcomes["as_printed"]


def test_the_summary_counts_rooms_look_alikes_and_what_was_confused():
    rooms = [record(7), record(8, [entry(shown=(1, 0, -1)), entry() | {"experiment": 2}])]
    found = rooms_summary(rooms, judged(rooms))
    assert (found["rooms"], found["poses_a_room_and_height"], found["look_alikes"]) == (2, 1, {"sofa": [2, 2]})
    both = found["both"]["images"]["paper"]
    assert (both["correct_percent"], both["correct_rooms_percent"]) == (75.0, [50.0, 100.0])
    assert both["incorrect_rooms_percent"] == [0.0, 50.0]
    assert both["correct_wilson_percent"] == pytest.approx([30.06, 95.44], abs=0.01)
    assert found["experiment_1"]["images"]["paper"]["correct_percent"] == 50.0
    assert found["wrong_pairs"]["images"] == {"poses": 1, "look_alikes": 2, "others": 0, "nothing": 1}
    assert (found["detector"]["precision"], found["detector"]["recall"]) == (0.75, 0.75)
    json.dumps(found, allow_nan=False)


PERFECT = RecordingModels(
    rig=RigModel(relative_tilt_deg=0.0, relative_yaw_deg=0.0, baseline_error=0.0, height_error=0.0),
    survey=RoomSurveyModel(places=4, width=640, fewest_pixels=40),
)
TINY = replace(PERFECT, width=320, survey=RoomSurveyModel(places=3, width=320, fewest_pixels=10))


@pytest.fixture(scope="module")
def seen():
    """What is seen in a room that is really made, by source: observation, landmark, the landmark's true place.

    One pose at each height, a perfect rig, the course's detector; places `(2,)` in the rig's frame.
    """
    room = observe_room(10_210, 1, (str(data_path("detector")), "", None, None), None, PERFECT)
    semantic_map, many = stored_map(room), {"exact_boxes": [], "images": []}
    for pose in room["poses"]:
        x, y, heading = pose["pose"]
        turn = np.array([[np.cos(heading), np.sin(heading)], [-np.sin(heading), np.cos(heading)]])
        for source, entry in pose["sources"].items():
            for one, k in zip(stored_observations(entry), entry["true_landmarks"], strict=True):
                if k != NO_OBJECT:
                    place = turn @ (semantic_map.positions[k] - (x, y))
                    many[source].append((one, semantic_map.landmarks[k], place))
    return many


@pytest.mark.slow
@pytest.mark.parametrize(("source", "least", "limit"), [("exact_boxes", 16, 0.08), ("images", 12, 0.12)])
def test_in_a_made_room_observations_lie_where_their_landmarks_are_and_have_about_their_colours(
    seen, source, least, limit
):
    """Other light, another part of the object; but a colour from elsewhere in the image would miss by 90 degrees."""
    assert len(seen[source]) >= least, "objects seen at two heights"
    found = np.array([(one.x, one.y, one.hue, one.saturation) for one, _, _ in seen[source]])
    true = np.array([(*place, landmark.hue, landmark.saturation) for _, landmark, place in seen[source]])
    off = np.hypot(*(found - true)[:, :2].T) / np.hypot(*true[:, :2].T)
    assert np.median(off) < limit
    azimuths = [np.arctan2(places[:, 1], places[:, 0]) for places in (found, true)]
    assert np.median(np.abs(wrap_angle(azimuths[0] - azimuths[1]))) < np.deg2rad(2.0)
    assert np.nanmedian(np.abs((found[:, 2] - true[:, 2] + 180) % 360 - 180)) < 15
    assert np.median(np.abs(found[:, 3] - true[:, 3])) < 15


@pytest.mark.slow
def test_judged_from_its_record_a_pose_is_what_the_localizer_said(monkeypatch):
    direct = {}

    def note(pair, localizer, source):
        direct[pair.pose[0], localizer.rig.upper_height, source] = result = localize_pair(pair, localizer, source)
        return result

    monkeypatch.setattr(observed_rooms, "localize_pair", note)
    monkeypatch.setattr(observed_rooms, "loaded", lambda network: SimpleNamespace(detect=lambda image: []))
    small = observe_room(10_211, 1, (), None, TINY)
    found = [one for one in judged([json.loads(json.dumps(small))]) if one.method == "paper"]
    assert len(found) == len(direct) == 4
    for one, said in zip(found, direct.values(), strict=True):
        assert one.outcome.kind == said.outcome.kind
        if said.localization.pose is not None:
            np.testing.assert_allclose(one.localization.pose, said.localization.pose, atol=1e-9)
            np.testing.assert_allclose(one.localization.covariance, said.localization.covariance)
    assert {one.outcome.kind for one in found if one.source == "images"} == {"unable"}
    assert any(one.localization.pose is not None for one in found if one.source == "exact_boxes")
