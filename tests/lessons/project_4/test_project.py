"""Project P4: an unknown camera's raw numbers, and what a calibrated depth is worth."""

import numpy as np
import pytest

from course_lib.lessons.kit.projects import AnswerError
from course_lib.lessons.project_4.project import measure, prepare
from course_lib.lessons.project_4.rivals import calibrated, in_metres, without_flying
from course_lib.lessons.project_4.sessions import CODES, MAX_RANGE, ROOM_FRAMES, UNITS, VIEWS, session

SEED = 10_001


def test_a_session_is_raw_numbers_with_a_code(monkeypatch):
    given, secrets = session(SEED)
    assert given.walls.dtype == given.frames.dtype == np.uint16
    assert given.frames.shape[:2] == (VIEWS, ROOM_FRAMES)
    share = (given.frames == secrets.invalid).mean()
    assert 0.01 < share < 0.2
    wall = given.walls[3][given.walls[3] != secrets.invalid] / secrets.units
    assert np.abs(np.median(wall) - given.distances[3]) < 0.3


def test_seeds_differ_in_what_is_secret():
    secrets = [session(seed)[1] for seed in range(10_001, 10_013)]
    assert len({s.units for s in secrets}) > 2
    assert {s.units for s in secrets} <= set(UNITS)
    assert len({s.invalid for s in secrets}) > 2
    assert {s.invalid for s in secrets} <= set(CODES)
    assert min(s.model.offset for s in secrets) < 0 < max(s.model.offset for s in secrets)
    for seed, s in zip(range(10_001, 10_013), secrets, strict=True):
        told = session(seed)[0].intrinsics[0, 0]
        assert 0.04 < abs(told / s.focal - 1) < 0.13


def test_what_is_given_is_a_copy():
    task = prepare(SEED)
    task.arguments[3][:] = 7
    assert prepare(SEED).arguments[3].std() > 0


@pytest.fixture
def task():
    return prepare(SEED)


def test_the_truth_costs_nothing_and_refusing_costs_50_mm(task):
    true, measured = task.truth
    exact = np.where(measured & np.isfinite(true), true, np.nan)
    assert measure(task, exact).value == pytest.approx(0, abs=1e-9)
    assert measure(task, np.full(true.shape, np.nan)).value == pytest.approx(50)
    assert measure(task, exact + 0.03).value == pytest.approx(30)
    assert measure(task, exact - 5.0).value == pytest.approx(200)


def test_a_depth_where_nothing_was_measured_is_invented(task):
    true, measured = task.truth
    invented = np.where(np.isfinite(true), true, 1.0)
    lost = ~measured & (true < MAX_RANGE)
    assert lost.any()
    share = lost.sum() / (true < MAX_RANGE).sum()
    assert measure(task, invented).value == pytest.approx(200 * share)


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (None, "one depth a pixel"),
        (np.zeros((3, 4)), "one depth a pixel"),
        ("deep", "no array of numbers"),
        (np.full((VIEWS, 52, 64), np.inf), "refuse a pixel with NaN"),
    ],
)
def test_an_answer_that_does_not_fit_is_named(task, answer, words):
    with pytest.raises(AnswerError, match=words):
        measure(task, answer)


@pytest.mark.parametrize("seed", range(10_001, 10_006))
def test_unit_and_code_are_found(seed):
    given, secrets = session(seed)
    ranges, _ = in_metres(given.walls, given.distances, given.frames)
    assert (np.isnan(ranges) == (given.frames == secrets.invalid)).all()
    assert np.nanmax(np.abs(ranges - given.frames / secrets.units)) == 0


def test_a_slanted_floor_does_not_fly_and_a_pixel_between_two_surfaces_does():
    floor = 1.2 * 20 / (np.arange(12)[:, None] + 3.0 + np.zeros((1, 9)))
    assert np.isfinite(without_flying(floor)).all()
    edge = np.array([[1.0, 1.0, 1.0, 1.0, 2.0, 3.0, 3.0, 3.0, 3.0]])
    assert np.flatnonzero(np.isnan(without_flying(edge))).tolist() == [4]


def test_our_calibration_leaves_less_than_the_cameras_own_errors():
    outcome = measure(prepare(SEED), calibrated(*prepare(SEED).arguments))
    assert outcome.value < 20
