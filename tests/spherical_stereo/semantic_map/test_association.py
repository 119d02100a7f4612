"""The penalty of eq. (1), term by term, and the greedy search."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from course_lib.spherical_stereo.pose.rigid_fit import rotation_2d
from course_lib.spherical_stereo.semantic_map import association
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap
from tests.spherical_stereo.stereo_scene import ROOM

WEIGHTS = association.PenaltyWeights(p_obj=7.0, p_h=2.0, p_s=3.0, p_d=4.0)
ORIGIN = np.zeros(2)


def seen(label="sofa", x=3.0, y=4.0, hue=20.0, saturation=50.0):
    return association.Observation(label, x, y, hue, saturation)


def mapped(label="sofa", x=0.0, y=4.0, hue=20.0, saturation=50.0):
    return Landmark(label, x, y, hue, saturation)


def cost(observation, landmark, **options):
    return association.penalty(observation, landmark, ORIGIN, ORIGIN, WEIGHTS, **options)


def test_every_term_of_equation_1_by_hand():
    terms = cost(seen("chair", hue=350, saturation=80), mapped(hue=20, saturation=50))
    assert terms.object == 7.0
    assert terms.hue == pytest.approx(2.0 * 30 / 360)
    assert terms.saturation == pytest.approx(3.0 * 30 / 100)
    assert terms.distance == pytest.approx(4.0 * (5 - 4) / 4)
    assert terms.total == pytest.approx(sum(terms[:4]))
    # Two names of one class cost nothing, and grey on either side has no hue term.
    several = association.Observation(np.array([["couch"], ["TV"]]), 3.0, 4.0, 20.0, 50.0)
    landmarks = association.Observation(np.array([["sofa", "television"]]), 0.0, 4.0, 20.0, 50.0)
    assert cost(several, landmarks).object.tolist() == [[0.0, 7.0], [7.0, 0.0]]
    for hue_seen, hue_mapped in ((math.nan, 200), (200, math.nan), (math.nan, math.nan)):
        terms = cost(seen(hue=hue_seen), mapped(hue=hue_mapped))
        assert terms.hue == 0.0
        assert math.isfinite(terms.total)


@given(st.floats(0, 359.999), st.floats(0, 359.999), st.floats(0, 359.999))
def test_the_hue_difference_is_symmetric_and_turns_with_the_circle(a, b, turn):
    apart = association.hue_difference(a, b)
    assert 0 <= apart <= 180
    assert association.hue_difference(350, 10) == pytest.approx(20)
    assert association.hue_difference(b, a) == pytest.approx(apart)
    assert association.hue_difference((a + turn) % 360, (b + turn) % 360) == pytest.approx(apart, abs=1e-9)


def test_the_distance_term_as_printed_rewards_objects_that_look_too_near():
    too_near = seen(x=0.0, y=1.0)
    assert cost(too_near, mapped(), distance_term="as_printed").total == pytest.approx(4.0 * (1 - 4) / 4)
    assert cost(too_near, mapped()).total == pytest.approx(4.0 * 3 / 4)
    # An object at the centroid of the map costs a finite amount.
    assert cost(seen(x=0.3, y=0.4), mapped(x=0.0, y=0.0)).distance == pytest.approx(4.0 * 0.5 / 0.1)


def observed_from(semantic_map, chosen, x=2.0, y=3.0, theta=0.6):
    body = (semantic_map.positions[list(chosen)] - [x, y]) @ rotation_2d(theta)
    return [
        association.Observation(semantic_map.labels[j], *place, semantic_map.hues[j], semantic_map.saturations[j])
        for j, place in zip(chosen, body, strict=True)
    ]


def test_the_table_holds_the_penalty_of_every_combination():
    observations = observed_from(ROOM, [3, 0, 2])
    table = association.penalty_table(observations, ROOM, WEIGHTS)
    centroid = np.mean([one[1:3] for one in observations], axis=0)
    for i, one in enumerate(observations):
        for j, landmark in enumerate(ROOM.landmarks):
            alone = association.penalty(one, landmark, centroid, ROOM.centroid, WEIGHTS)
            assert [float(term[i, j]) for term in table] == pytest.approx(list(alone))


@given(st.floats(-20, 20), st.floats(-20, 20), st.floats(-7, 7), st.permutations(range(5)))
@settings(max_examples=50)
def test_a_fully_seen_room_is_matched_from_every_pose(x, y, theta, order):
    found = association.associate_greedy(observed_from(ROOM, order, x, y, theta), ROOM)
    assert sorted(found.pairs) == [(i, j) for i, j in enumerate(order)]
    assert (found.unassigned, found.usable_pairs) == ((), found.pairs)


def test_pairs_come_in_the_order_of_choice_cheapest_open_combination_first():
    found = association.associate_greedy(observed_from(ROOM, [4, 2, 0], x=1.0), ROOM)
    free_rows, free_columns = {0, 1, 2}, set(range(5))
    for (i, j), cost_of_pair in zip(found.pairs, found.penalties, strict=True):
        cheapest = min(found.table.total[a, b] for a in free_rows for b in free_columns)
        assert cost_of_pair.total == found.table.total[i, j] == cheapest
        free_rows.remove(i)
        free_columns.remove(j)


@given(st.floats(-7, 7))
def test_rounding_does_not_choose_between_objects_that_are_alike(theta):
    corners = [(1, 1), (1, -1), (-1, -1), (-1, 1)]
    semantic_map = SemanticMap([Landmark("chair", *corner, 10, 50) for corner in corners])
    found = association.associate_greedy(observed_from(semantic_map, [2, 0, 3, 1], theta=theta), semantic_map)
    assert found.pairs == ((0, 0), (1, 1), (2, 2), (3, 3))


def test_a_pair_of_unlike_classes_is_made_at_the_end_but_never_usable():
    semantic_map = SemanticMap([Landmark("sofa", 0, 0, 10, 50), Landmark("chair", 2, 0, 10, 50)])
    found = association.associate_greedy([seen("sofa"), seen("sofa", x=1.0)], semantic_map)
    assert sorted(found.same_class) == [False, True]
    assert found.usable_pairs == (found.pairs[0],)
    nothing = association.associate_greedy([], ROOM)
    assert (nothing.pairs, nothing.unassigned, nothing.table.total.shape) == ((), (), (0, 5))


BAD = {"x": [math.inf], "y": [math.nan], "hue": [360.0, -1.0, np.array([10.0, 400.0])], "saturation": [101.0, -1.0]}


@pytest.mark.parametrize(("field", "values"), BAD.items())
def test_values_that_cannot_be_are_refused_on_either_side(field, values):
    for bad in (seen()._replace(**{field: value}) for value in values):
        with pytest.raises(association.AssociationError, match="observation: x and y"):
            cost(bad, mapped())
        with pytest.raises(association.AssociationError, match="landmark: x and y"):
            cost(seen(), bad)


def test_each_comparison_weighs_one_and_options_that_do_not_exist_are_named():
    assert association.PenaltyWeights() == (100, 1, 1, 1)
    with pytest.raises(association.AssociationError, match=r"distance_term must be one of.*'squared'"):
        association.associate_greedy([seen()], ROOM, distance_term="squared")
    with pytest.raises(association.AssociationError, match="weights must be finite and not negative"):
        association.associate_greedy([seen()], ROOM, association.PenaltyWeights(p_h=-1))
    with pytest.raises(association.AssociationError, match="map centroid"):
        association.penalty(seen(), mapped(), [0, 0], [0, 0, 0])
