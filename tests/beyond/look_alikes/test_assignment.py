"""The assignment on class and colour alone: least total cost, one-to-one, blind to geometry."""

import numpy as np

from course_lib.beyond.look_alikes.matchers import associate_hungarian
from course_lib.spherical_stereo.semantic_map.association import Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap

MAP = SemanticMap([Landmark("sofa", 0, 0, 10, 50), Landmark("sofa", 5, 0, 30, 50), Landmark("plant", 2, 3, 120, 40)])


def test_the_total_is_least_where_the_greedy_search_pays_for_its_first_choice():
    """The first observation likes landmark 0 best, but the second has nothing else as good."""
    seen = [
        Observation("sofa", 1, 0, 19.0, 50),
        Observation("sofa", 0, 1, 1.0, 50),
        Observation("plant", 1, 1, 120, 40),
    ]
    found = associate_hungarian(seen, MAP)
    assert found.pairs == ((0, 1), (1, 0), (2, 2))
    assert found.same_class == (True, True, True)


def test_places_do_not_matter():
    seen = [Observation("sofa", 1, 0, 12, 50), Observation("sofa", 0, 1, 28, 50)]
    assert associate_hungarian(seen, MAP).pairs == ((0, 0), (1, 1))
    # The first sofa stands far from the others, as landmark 1 does: the distance term would exchange the two.
    apart = SemanticMap([Landmark("sofa", 0, 0, 10, 50), Landmark("sofa", 9, 0, 30, 50), Landmark("plant", 0, 3, 0, 0)])
    far = [seen[0]._replace(x=9.0), seen[1]._replace(x=0.0), Observation("plant", 0, 3, 0, 0)]
    assert associate_hungarian(far, apart).pairs == ((0, 0), (1, 1), (2, 2))


def test_more_observations_than_landmarks_leave_some_unassigned():
    seen = [Observation("sofa", k, 0, 10 + 5 * k, 50) for k in range(4)]
    found = associate_hungarian(seen, MAP)
    assert len(found.pairs) == 3
    assert len(found.unassigned) == 1
    assert sorted(found.same_class) == [False, True, True]
    np.testing.assert_allclose([one.object for one in found.penalties].count(100.0), 1)
