"""The shipped room: as large as promised, and an honest experiment."""

from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.drawn_boxes import read_stereo_boxes
from course_lib.spherical_stereo.semantic_map.association import hue_difference
from courseware.simulation.room.experiment_room import make_experiment_room
from courseware.simulation.room.measurement_places import CAMERA_HEIGHTS, MEASUREMENT_PLACES

DATA = Path(__file__).resolve().parents[2] / "data" / "room"


def test_twenty_pairs_stand_at_the_papers_places_at_both_heights(recordings):
    for number, recording in recordings.items():
        upper, lower = CAMERA_HEIGHTS[number]
        assert recording.rig.upper_height == upper
        assert recording.rig.upper_height - recording.rig.baseline == pytest.approx(lower)
        expected = [(p.x, p.y, h) for p in MEASUREMENT_PLACES for h in p.headings_deg]
        assert len(recording.pairs) == len(expected) == 20
        for pair, (x, y, heading) in zip(recording.pairs, expected, strict=True):
            assert tuple(pair.pose[:2]) == (x, y)
            assert wrap_angle(pair.pose[2] - np.deg2rad(heading)) == pytest.approx(0, abs=1e-12)


def test_three_sofas_look_alike_and_all_other_pairs_of_a_class_do_not(semantic_map):
    labels, hues = np.array(semantic_map.labels), semantic_map.hues
    assert 12 <= len(labels) <= 16
    assert len(set(labels)) >= 6
    sofas = np.flatnonzero(labels == "sofa")
    assert len(sofas) == 3
    assert max(float(hue_difference(hues[a], hues[b])) for a, b in combinations(sofas, 2)) < 10
    for label in set(labels) - {"sofa"}:
        for a, b in combinations(np.flatnonzero(labels == label), 2):
            assert hue_difference(hues[a], hues[b]) >= 60
            assert min(semantic_map.saturations[[a, b]]) >= 40


def test_the_map_was_surveyed_not_copied(semantic_map):
    true = np.array([[thing.x, thing.y] for thing in make_experiment_room().objects])
    errors = np.linalg.norm(semantic_map.positions - true, axis=1)
    assert 0.002 < np.median(errors) < 0.03


def test_the_example_boxes_are_the_whole_objects_of_one_pair(recordings):
    """The README's `stereo` reads them; they stand in data/room/README.md."""
    boxes = read_stereo_boxes(DATA / "example_boxes.json")
    pair = next(pair for pair in recordings[2].pairs if pair.name == "03_b")
    assert boxes.size == pair.size
    for listed, seen in ((boxes.upper, pair.upper_objects), (boxes.lower, pair.lower_objects)):
        whole = {(one.label, *one.visible_box) for one in seen if one.visible_fraction > 0.9}
        assert len(listed) == 12
        assert {(one.label, *one.box) for one in listed} <= whole
