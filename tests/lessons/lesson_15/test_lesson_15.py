"""What lesson 15 says about the penalty, the repeated minimum and the sofas holds."""

import itertools

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

from course_lib.lessons.kit.exercises import find_exercise, judge
from course_lib.lessons.kit.room_observations import room_scenes
from course_lib.lessons.kit.room_photographs import room_map
from course_lib.lessons.lesson_15.exercises import centroid_shift
from course_lib.lessons.lesson_15.panel import match, next_best, weights_panel
from course_lib.lessons.lesson_15.scores import (
    SOFAS,
    fitted_pose,
    hidden_score,
    min_object_weight,
    score,
    two_searches,
)
from course_lib.lessons.lesson_16.fits import pose_error
from course_lib.spherical_stereo.semantic_map.association import (
    Observation,
    PenaltyWeights,
    associate_greedy,
    hue_difference,
    penalty_table,
)
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap


def test_no_observation_is_told_by_its_place_in_the_list():
    for scene in room_scenes().values():
        assert list(scene.true_landmarks) != sorted(scene.true_landmarks)
        assert [one.label for one in scene.observations] == [room_map().labels[j] for j in scene.true_landmarks]


def test_all_four_terms_get_nineteen_poses_right_and_no_term_alone_half_of_them():
    assert score(PenaltyWeights()).poses_right == 19
    for weights in ((100, 0, 0, 0), (100, 1, 0, 0), (100, 0, 1, 0), (100, 0, 0, 1)):
        assert score(PenaltyWeights(*weights)).poses_right < 10


def test_hue_settles_everything_but_the_sofas():
    found = score(PenaltyWeights(100, 1, 0, 0))
    assert found.pairs_right - found.sofas_right == found.pairs - found.sofas
    assert found.sofas_right < found.sofas / 2


def test_the_light_changes_the_sofas_hue_by_more_than_they_differ():
    own = [
        float(hue_difference(one.hue, room_map().hues[j]))
        for scene in room_scenes().values()
        for one, j in zip(scene.observations, scene.true_landmarks, strict=True)
        if j in SOFAS
    ]
    assert np.median(own) > np.ptp(room_map().hues[list(SOFAS)])


def test_as_printed_no_pose_is_right():
    assert score(PenaltyWeights(), "as_printed").poses_right == 0


def test_a_class_weight_of_three_is_enough_for_weights_of_one():
    assert max(min_object_weight(scene.observations, room_map()) for scene in room_scenes().values()) < 3


def test_in_06_a_two_sofas_are_swapped_by_next_to_nothing_and_the_pose_hardly_moves():
    scene = room_scenes()["06_a"]
    pairs = associate_greedy(scene.observations, room_map()).pairs
    wrong = {(scene.true_landmarks[i], j) for i, j in pairs if scene.true_landmarks[i] != j}
    assert wrong == {(0, 1), (1, 0)}
    total = penalty_table(scene.observations, room_map()).total
    a, b = scene.true_landmarks.index(0), scene.true_landmarks.index(1)
    assert abs(total[a, 0] + total[b, 1] - total[a, 1] - total[b, 0]) < 0.005
    assert pose_error(fitted_pose(list(scene.observations), pairs), scene.pose)[0] < 0.2


def test_the_least_sum_makes_the_same_mistakes_as_the_greedy_search():
    for scene in room_scenes().values():
        found = associate_greedy(scene.observations, room_map())
        rows, columns = linear_sum_assignment(found.table.total)
        assert set(found.pairs) == set(zip(rows.tolist(), columns.tolist(), strict=True))


def test_hidden_objects_make_sofas_wrong():
    rng = np.random.default_rng(3)
    all_seen, two_hidden = hidden_score(0, 1, rng), hidden_score(2, 5, rng)
    assert all_seen.percent_right == pytest.approx(95)
    assert 50 < two_hidden.percent_right < 80
    assert two_hidden.wrong_sofas > 0.9 * two_hidden.wrong


def test_one_pair_gives_no_pose():
    scene = room_scenes()["03_b"]
    assert fitted_pose(list(scene.observations), ((0, 0),)) is None


def test_the_next_best_is_never_cheaper_than_what_was_chosen():
    for scene in room_scenes().values():
        found = match(scene, room_map(), PenaltyWeights(), "as_printed", 2)
        chosen = np.array([one.total for one in found.association.penalties])
        second = next_best(found)
        assert (second[np.isfinite(second)] >= chosen[np.isfinite(second)]).all()


def test_hiding_leaves_the_near_objects():
    scene = room_scenes()["03_b"]
    found = match(scene, room_map(), PenaltyWeights(), "absolute", 8)
    ranges = np.array([np.hypot(one.x, one.y) for one in scene.observations])
    assert len(found.kept) == len(ranges) - 8
    assert ranges[list(found.kept)].max() <= np.delete(ranges, found.kept).min()


def test_the_buttons_of_the_panel_step_through_the_rounds():
    panel = weights_panel()
    panel.press("From the start")
    assert panel.values()["done_rounds"] == 0
    panel.press("Next round")
    panel.press("Next round")
    panel.press("Back")
    assert panel.values()["done_rounds"] == 1
    assert panel.draw(**panel.values()).summary.startswith("1 of 13 rounds: 1 pairs right")


def by_angles(seen, on_map, p_h):
    turn = np.deg2rad(seen - on_map)
    return np.nan_to_num(p_h * np.arccos(np.clip(np.cos(turn), -1, 1)) / (2 * np.pi))


def by_loops(x_c, x_m, p_d):
    centre_c, centre_m = sum(x_c) / len(x_c), sum(x_m) / len(x_m)
    return [
        [
            p_d * abs(np.hypot(*(c - centre_c)) - np.hypot(*(m - centre_m))) / max(np.hypot(*(m - centre_m)), 0.1)
            for m in x_m
        ]
        for c in x_c
    ]


@pytest.mark.parametrize(("number", "answer"), [("15.1", by_angles), ("15.2", by_loops)])
def test_another_way_to_the_right_values_passes(number, answer):
    assert all(judge(find_exercise(number), answer, seed).status == "right" for seed in range(8))


def test_the_least_sum_is_as_good_with_all_in_view_and_better_with_some_hidden():
    all_seen, two_hidden = (two_searches(n, 5, np.random.default_rng(7)) for n in (0, 2))
    assert all_seen.greedy_percent == all_seen.least_sum_percent == pytest.approx(95)
    assert all_seen.same_percent == 100
    assert two_hidden.least_sum_percent > two_hidden.greedy_percent
    assert two_hidden.same_percent < 100


def test_the_challenge_s_centroid_walks_as_far_as_every_choice_of_hidden_landmarks_says():
    places = room_map().positions
    seen = [np.delete(places, hidden, axis=0).mean(axis=0) for hidden in itertools.combinations(range(14), 2)]
    walked = np.sqrt(np.mean(np.sum((seen - places.mean(axis=0)) ** 2, axis=1)))
    assert centroid_shift(places, 2) == pytest.approx(walked)
    assert centroid_shift(places, 2) == pytest.approx(0.315, abs=5e-4)


def random_scene(seed):
    rng = np.random.default_rng(seed)
    labels = ["sofa", "chair", "table"]

    def draw(kind, n):
        return [
            kind(labels[rng.integers(3)], *rng.uniform(-3, 3, 2), rng.uniform(0, 360), rng.uniform(0, 100))
            for _ in range(n)
        ]  # fmt: skip

    return draw(Observation, 7), SemanticMap(draw(Landmark, 9))


@pytest.mark.parametrize("distance_term", ["absolute", "as_printed"])
@pytest.mark.parametrize("seed", range(5))
def test_above_the_least_object_weight_every_like_pair_is_cheaper_than_every_unlike_one(seed, distance_term):
    observations, semantic_map = random_scene(seed)
    bound = min_object_weight(observations, semantic_map, distance_term=distance_term)
    for p_obj, holds in ((bound * 1.001, True), (bound * 0.999, False)):
        table = penalty_table(observations, semantic_map, PenaltyWeights(p_obj=p_obj), distance_term)
        like = table.object == 0
        assert (table.total[like].max() < table.total[~like].min()) == holds
