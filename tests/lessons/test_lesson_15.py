"""Lesson 15: what each term of the penalty settles, and what hidden objects cost."""

import numpy as np

from course_lib.spherical_stereo import Landmark, Observation, PenaltyWeights, SemanticMap, penalty_table
from courseware.lessons.lesson_15.scores import hidden_score, min_object_weight, score, two_searches


def test_hue_settles_all_but_the_sofas_and_only_the_four_terms_together_give_poses():
    alone = [score(PenaltyWeights(100, *np.eye(3)[k])) for k in range(3)]
    assert alone[0].pairs_right - alone[0].sofas_right == alone[0].pairs - alone[0].sofas
    assert max(one.poses_right for one in alone) < 10
    assert [score(PenaltyWeights(), term).poses_right for term in ("absolute", "as_printed")] == [19, 0]


def test_hidden_objects_make_sofas_wrong_and_only_then_the_least_sum_helps():
    seen, hidden = (two_searches(n, 5, np.random.default_rng(7)) for n in (0, 2))
    assert np.allclose([*seen[:2], seen.same_percent], [95, 95, 100])
    assert hidden.least_sum_percent > hidden.greedy_percent
    score = hidden_score(2, 5, np.random.default_rng(3))
    assert score.wrong_sofas > 0.9 * score.wrong


def test_above_the_least_object_weight_every_like_pair_is_cheaper_than_every_unlike_one():
    draw = np.random.default_rng(0).uniform
    things = [(("sofa", "chair")[k % 2], *draw(-3, 3, 2), draw(0, 360), draw(0, 100)) for k in range(16)]
    seen, room = [Observation(*one) for one in things[:7]], SemanticMap([Landmark(*one) for one in things[7:]])
    for term, factor in (("absolute", 0.999), ("absolute", 1.001), ("as_printed", 0.999), ("as_printed", 1.001)):
        weights = PenaltyWeights(factor * min_object_weight(seen, room, PenaltyWeights(), term))
        table = penalty_table(seen, room, weights, term)
        assert (table.total[table.object == 0].max() < table.total[table.object > 0].min()) == (factor > 1)
