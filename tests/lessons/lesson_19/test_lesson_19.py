"""Lesson 19: the world, one robot's way through both methods, wrong starts, stored results, and the panel's buttons."""

import itertools
import json

import numpy as np
import pytest

from course_lib.beyond.being_lost import judge_refined
from course_lib.experiments.finale import LEVEL_SIGMA, is_known, mean_score, start_state
from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.display import require_labels
from course_lib.lessons.lesson_19 import panel as panels
from course_lib.lessons.lesson_19 import stages
from course_lib.lessons.lesson_19.figures import (
    DEVIATIONS,
    basin_figure,
    draw_room,
    ellipse,
    named_together,
    sensors_figure,
    stages_figure,
    starts_figure,
    wall_figure,
)
from course_lib.lessons.lesson_19.stages import (
    STAGES,
    is_reached,
    joined,
    journey,
    plane_error,
    start_covariance,
    state_error,
)
from course_lib.lessons.lesson_19.trials import misplaced, random_places, stored_result, turn_and_look
from course_lib.lessons.lesson_19.world import hidden, world
from course_lib.plots import figures
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D

STORY = (3.35, 3.30, 65)


@pytest.fixture(scope="module")
def here():
    return world()


@pytest.fixture(scope="module")
def place():
    return journey(*STORY)


@pytest.fixture(scope="module")
def crowded():
    return journey(*STORY, hidden_share=0.8)


@pytest.fixture(scope="module")
def panel():
    return panels.anywhere_panel()


def test_both_maps_are_of_the_room_that_the_sensors_see(here):
    assert [item.label for item in here.room.objects] == list(here.semantic_map.labels)
    low, high = here.scene_map.bounds
    assert high[:2] - low[:2] == pytest.approx(here.room.walls.max(axis=0), abs=0.1)


def test_a_place_is_described_in_words(here):
    sofa = here.room.objects[[item.label for item in here.room.objects].index("sofa")]
    assert here.where(sofa.x, sofa.y) == "inside a sofa"
    assert here.where(3.35, 3.30) == "free"
    assert here.where(3.0, 0.2) == "nearer than 0.5 m to a wall"
    beside = here.where(sofa.x - 0.75, sofa.y)
    assert beside.endswith("m from a sofa")
    assert float(beside.split()[0]) < 0.3


def test_a_share_of_the_panorama_is_hidden_about_straight_ahead():
    image = np.random.default_rng(0).integers(0, 255, (8, 100, 3), dtype=np.uint8)
    covered = hidden(image, 0.4)
    changed = np.flatnonzero((covered != image).any(axis=(0, 2)))
    assert (changed[0], changed[-1], len(changed)) == (30, 69, 40)
    assert (hidden(image, 0.0) == image).all()


def test_who_comes_back_to_a_place_finds_the_same_recording(here, place):
    again = here.photographs(place.pose)
    assert (again[0] == place.images[0]).all()
    states, depths = here.depth_images(place.pose)
    assert (states == place.states).all()
    assert np.array_equal(depths[2], place.depths[2], equal_nan=True)
    elsewhere = here.depth_images(place.pose + np.array([0.01, 0, 0]))[0]
    assert not np.allclose(elsewhere[:, 2], states[:, 2], atol=1e-6)


def joined_at_first(one):
    """Start and filter joined, at the first image: state and covariance."""
    first = one.best[0]
    return joined(
        start_state(one.found.pose), start_covariance(one.found.covariance), first.state, first.error_covariance
    )


def test_from_metres_to_centimetres_to_millimetres(place):
    assert place.found.status == "ok"
    assert place.semantic_error[0] < 0.15
    assert place.reached
    assert place.depth_error[0] < place.semantic_error[0] / 3
    assert state_error(joined_at_first(place)[0], place.states[0])[0] < 0.03


def test_in_a_crowd_the_depth_camera_chooses_and_no_image_says_which_is_wrong(crowded):
    assert crowded.found.pose is None
    assert crowded.semantic_error is None
    ends = [state_error(run[-1].state, crowded.states[-1])[0] for run in crowded.runs]
    assert len(ends) == 3
    assert crowded.reached
    assert crowded.best is max(crowded.runs, key=mean_score)
    wrong = [run for run, end in zip(crowded.runs, ends, strict=True) if end > 1]
    assert all(run[-1].status == "lost" for run in wrong), "by their covariance"
    assert any(judge_refined(run[-1].agreement) == "tracked" for run in wrong)


def test_with_one_sensor_covered_the_other_is_what_there_is():
    cap, dark = journey(*STORY, lens_cap=True), journey(*STORY, hidden_share=1.0)
    assert cap.semantic_error[0] < 0.15
    assert (cap.best, cap.depth_error, cap.reached) == (None, None, False)
    assert np.isnan(cap.depths).all()
    assert (dark.found.pose, dark.starts, dark.best) == (None, [], None)


def test_at_a_front_without_features_the_filter_does_not_know_its_height_and_the_robot_does():
    one = journey(1.70, 4.40, 60)
    first, last = one.best[0], one.best[-1]
    assert last.status == "lost"
    assert not is_known(last)
    state, covariance = joined_at_first(one)
    assert np.sqrt([first.error_covariance[2, 2], covariance[2, 2]]) == pytest.approx([0.15, 0.005], rel=0.5)
    assert state_error(state, one.states[0])[0] < 0.03
    error, views, knows = turn_and_look(one)
    assert knows
    assert views > 1
    assert is_reached(error)


def test_errors_are_metres_and_degrees_on_the_circle():
    metres, degrees = plane_error(Pose2D(1.0, 2.0, np.pi - 0.01), np.array([1.3, 2.4, -np.pi + 0.01]))
    assert metres == pytest.approx(0.5)
    assert degrees == pytest.approx(np.rad2deg(0.02))
    assert is_reached((0.03, 1.0))
    assert not is_reached((0.031, 0.0))
    assert not is_reached((0.0, 1.1))


def test_a_start_wrong_by_a_decimetre_arrives_and_one_that_looks_back_does_not(place):
    rng = np.random.default_rng(0)
    assert [run.reached for run in misplaced([place], 0.1, 0, 2, rng)] == [True, True]
    turned = misplaced([place], 0.0, 180, 1, rng)
    assert (turned[0].reached, turned[0].degrees) == (False, 180)


def test_random_places_are_the_experiments_and_free(here):
    places = random_places(5)
    assert places[:3] == random_places(3)
    assert all(here.where(x, y) == "free" for x, y, _ in places)


def test_stored_results_are_read_and_a_missing_file_is_named(tmp_path):
    (tmp_path / "some.json").write_text(json.dumps({"reached": 3, "places": 4}))
    assert stored_result(tmp_path / "some.json")["reached"] == 3
    with pytest.raises(FileNotFoundError, match=r"missing\.json"):
        stored_result(tmp_path / "missing.json")


def test_figures_have_titles_and_units(place, crowded):
    shares = {0.1: [True, True], 2.0: [False, True]}
    for figure in (
        sensors_figure(place),
        stages_figure(place),
        starts_figure(crowded),
        wall_figure(place),
        basin_figure(shares, shares, [(0.05, 0.5)]),
    ):
        require_labels(figure)


def test_what_stands_at_one_place_gets_one_name_with_it():
    labels = ["cabinet", "chair", "television", "chair"]
    places = np.array([[1.0, 0.2], [3.0, 0.0], [1.05, 0.25], [3.5, 0.0]])
    assert named_together(labels, places) == [(["cabinet", "television"], 0), (["chair"], 1), (["chair"], 3)]


def test_no_name_on_the_plan_covers_another(here):
    figure, axes = figures.new_figure(size=(3.3, 3.3))
    draw_room(axes, "The room")
    figure.canvas.draw()
    boxes = [words.get_window_extent() for words in axes.texts]
    assert sum(len(words.get_text().split("\n")) for words in axes.texts) == len(here.room.objects)
    assert not any(one.overlaps(other) for one, other in itertools.combinations(boxes, 2))


def test_an_ellipse_is_so_many_deviations_wide():
    ring = ellipse(np.array([[4.0, 0.0], [0.0, 1.0]]), (1.0, 2.0))
    assert np.ptp(ring, axis=1) == pytest.approx([2 * DEVIATIONS * 2.0, 2 * DEVIATIONS * 1.0], rel=1e-3)
    assert ring.mean(axis=1) == pytest.approx([1.0, 2.0], abs=0.1)


# The panel.


def test_the_panel_begins_where_the_story_was(panel, place):
    told = panel.draw(**panel.defaults()).summary
    assert f"off by {100 * place.semantic_error[0]:.0f} cm" in told
    assert f"off by {1000 * place.depth_error[0]:.0f} mm" in told


def test_dragging_never_runs_the_methods(panel, monkeypatch):
    def never(*_):
        pytest.fail("a slider that moves started the methods")

    monkeypatch.setattr(panels, "journey", never)
    assert 'press "Locate"' in panel.draw(**(panel.defaults() | {"x": 2.0})).summary


def test_locate_tells_each_stage_keeps_the_old_picture_and_then_shows_the_new_one(panel, monkeypatch):
    panel.set(x=4.5, y=3.2, heading=-115.0)
    before, said = panel._picture.value, []

    def say(text):
        said.append(text)
        assert panel._picture.value == before

    monkeypatch.setattr(panel, "say", say)
    assert panel.actions["Locate"](panel.values()) == {}
    assert said == [f"{k} of 4: {stage}" for k, stage in enumerate(STAGES, start=1)]
    panel.redraw()
    assert panel._picture.value != before
    one = journey(4.5, 3.2, -115.0)
    assert f"off by {1000 * one.depth_error[0]:.0f} mm" in panel._summary.value
    panel.press("Reset")


def test_inside_furniture_nobody_looks(panel, monkeypatch):
    monkeypatch.setattr(panels, "journey", lambda *_: pytest.fail("looked from inside a sofa"))
    values = panel.defaults() | {"x": 5.6, "y": 1.2}
    assert panel.actions["Locate"](values) == {}
    assert "Nobody can stand inside a sofa" in panel.draw(**values).summary


def test_somewhere_is_free_and_another_place_each_time_something_was_located(panel, here):
    values = panel.actions["Somewhere"](panel.values())
    assert here.where(values["x"], values["y"]) in ("free",) or "m from" in here.where(values["x"], values["y"])
    assert -180 <= values["heading"] <= 180


def test_several_poses_and_covered_sensors_are_told_in_words(panel, crowded):
    panel.actions["Locate"](panel.defaults() | {"hidden": 80})
    told = panel.draw(**(panel.defaults() | {"hidden": 80})).summary
    assert "unable (ambiguous); 3 poses are left" in told
    assert told.count("depth filter from pose") == 3
    panel.actions["Locate"](panel.defaults() | {"cap": True})
    assert "the semantic pose stays" in panel.draw(**(panel.defaults() | {"cap": True})).summary
    panel.actions["Locate"](panel.defaults() | {"hidden": 100})
    assert "nobody knows where" in panel.draw(**(panel.defaults() | {"hidden": 100})).summary


def test_places_are_kept_but_not_for_ever(monkeypatch):
    monkeypatch.setattr(stages, "_kept", {})
    monkeypatch.setattr(stages, "MAX_KEPT", 2)
    monkeypatch.setattr(stages, "_travelled", lambda *key: key[:5])
    first = journey(1, 2, 3)
    assert journey(1.0, 2.0, 3.0) is first
    journey(2, 2, 3)
    journey(3, 2, 3)
    assert list(stages._kept) == [(2.0, 2.0, 3.0, 0.0, False), (3.0, 2.0, 3.0, 0.0, False)]


SEMANTIC = np.array([[0.0025, 0.0005, 0.0002], [0.0005, 0.0036, -0.0001], [0.0002, -0.0001, 0.0004]])


def some_covariance(rng):
    mixing = rng.standard_normal((6, 6))
    return mixing @ mixing.T + np.eye(6)


def test_the_start_knows_the_semantic_pose_and_how_a_robot_stands():
    known = start_covariance(SEMANTIC)
    for a, i in enumerate((0, 1, 5)):
        for b, j in enumerate((0, 1, 5)):
            assert known[i, j] == SEMANTIC[a, b]
    assert np.diag(known)[2:5] == pytest.approx([LEVEL_SIGMA[0] ** 2, LEVEL_SIGMA[1] ** 2, LEVEL_SIGMA[1] ** 2])
    assert np.count_nonzero(known) == 9 + 3


def test_information_adds_up(rng):
    """P^-1 = P_0^-1 + P_1^-1, and the state is the mean weighed by these."""
    a, b, x, y = some_covariance(rng), some_covariance(rng), rng.uniform(-1, 1, 6), rng.uniform(-1, 1, 6)
    state, covariance = joined(x, a, y, b)
    information = np.linalg.inv(a) + np.linalg.inv(b)
    assert covariance == pytest.approx(np.linalg.inv(information), rel=1e-6, abs=1e-9)
    assert state == pytest.approx(np.linalg.solve(information, np.linalg.solve(a, x) + np.linalg.solve(b, y)))


def test_angles_are_joined_across_the_half_turn():
    start, state = np.zeros(6), np.zeros(6)
    start[5], state[5] = np.pi - 0.1, -np.pi + 0.3
    found, _ = joined(start, np.eye(6), state, np.eye(6))
    assert found[5] == pytest.approx(wrap_angle(np.pi + 0.1))
    assert start[5] == np.pi - 0.1, "what is given stays as it is"
