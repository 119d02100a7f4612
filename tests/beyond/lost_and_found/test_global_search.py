"""From anywhere in a small furnished room: the right place, several where it looks alike, found when carried off."""

import pickle

import numpy as np
import pytest

from course_lib.beyond.being_lost import CONFIRMED
from course_lib.beyond.lost_and_found.global_search import ELSEWHERE, GlobalSearch
from course_lib.beyond.lost_and_found.recovery import LOST, RecoveringLocalizer
from course_lib.beyond.lost_and_found.stored_views import COLUMNS
from course_lib.geometry import optical_pose
from course_lib.rendering.renderer import DepthRenderer
from tests.rendering.shapes import SMALL, room

PLACE = np.array([-1.2, 0.5, -0.6, 0.15, 0.2, -0.3])
OTHER = np.array([-1.5, -1.5, 0.5, 0.1, 0.3, 0.8])
NOWHERE = np.array([1.5, -1.0, 0.8, 0.0, 0.0, 2.5])  # a wrong start for a camera at PLACE


def down(state):
    return -optical_pose(state)[2, :3]


def walk(start, n):
    return start + np.arange(n)[:, None] * np.array([0.03, 0.02, 0.01, 0.005, 0.01, 0.02])


def searched(search, renderer, states, gravity=down):
    return [search.step(renderer.render(state)[0], gravity(state)) for state in states]


@pytest.mark.parametrize("gravity", [down, lambda state: None], ids=["an accelerometer", "the image"])
def test_the_camera_is_found_from_nowhere_whoever_says_what_is_down(renderer, gravity):
    states = walk(OTHER + np.array([0, 0, 0, 0.1, 0.3, 0]), 6)  # looking down by 34 degrees: nobody would assume it
    search = GlobalSearch(renderer, seed=1, max_places=1_000)
    answers = searched(search, renderer, states, gravity)
    assert answers[0].particles == len(search.views.places) * COLUMNS, "down is known, so no other tilt is tried"
    assert answers[0].status == "searching", "one frame is not enough to believe"
    assert answers[-1].status == "found"
    assert answers[-1].poses[0].state[:3] == pytest.approx(states[-1][:3], abs=0.02)
    assert answers[-1].poses[0].evidence > 0.9


@pytest.mark.slow
def test_in_an_empty_cube_four_places_are_as_good(renderer):
    """The cube looks the same turned by 90 degrees: four headings, and no frame can tell."""
    with DepthRenderer(room(), SMALL) as renderer:
        answer = searched(GlobalSearch(renderer, seed=2, max_places=1_000), renderer, walk(PLACE, 5))[-1]
    assert answer.status == "several"
    assert len(answer.poses) >= 2
    reach = [np.hypot(*place.state[:2]) for place in answer.poses[:2]]
    assert reach == pytest.approx([np.hypot(*walk(PLACE, 5)[-1][:2])] * 2, abs=0.1)


def test_what_no_place_explains_is_not_found_and_a_person_who_walks_by_raises_no_alarm(renderer, rng):
    search = GlobalSearch(renderer, seed=1, max_places=1_000)
    noise = rng.uniform(0.5, 6.0, (4, *SMALL.shape))
    assert {search.step(depth, np.array([0.0, 1.0, 0.0])).status for depth in noise} == {"searching"}
    localizer = RecoveringLocalizer(renderer, seed=1, max_places=1_000)
    localizer.initialize(PLACE)
    for number, state in enumerate(walk(PLACE, 12)):
        depth = renderer.render(state)[0].copy()
        if 4 <= number < 9:
            depth[:, 8 * (number - 4) : 8 * (number - 4) + 24] = 0.6
        found = localizer.step(depth, gravity=down(state))
        assert (found.mode, found.candidates) == ("following", None)


@pytest.mark.parametrize("wrong", [np.zeros(3), [0.0, 0.0, np.nan], [0.0, 1.0]])
def test_a_gravity_that_is_no_direction_is_refused(renderer, wrong):
    with pytest.raises(ValueError, match="gravity must be three finite numbers"):
        GlobalSearch(renderer, max_places=10).step(renderer.render(PLACE)[0], np.array(wrong))


def test_after_a_wrong_start_it_is_not_tracked_until_it_is_right_and_a_search_finds_it(renderer):
    localizer = RecoveringLocalizer(renderer, seed=1, max_places=1_000)
    localizer.initialize(NOWHERE)
    states = walk(PLACE, LOST + 6)
    found = [localizer.step(renderer.render(state)[0], gravity=down(state)) for state in states]
    off = np.array([np.linalg.norm(f.estimate.state[:3] - s[:3]) for f, s in zip(found, states, strict=True)])
    told = np.array([f.estimate.status for f in found])
    assert off[0] > ELSEWHERE[0], "this start would not test anything"
    assert not (told[off > 0.1] == "tracked").any()
    assert not (told[:CONFIRMED] == "tracked").any()
    assert "searching" in {f.mode for f in found[: LOST + 1]}
    assert (told[-1], found[-1].mode) == ("tracked", "following")
    assert off[-1] < 0.02
    assert all(f.estimate.status != "tracked" for f in found if f.mode == "searching")


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:this frame holds no measurement")
def test_carried_away_in_the_dark_it_finds_itself_again_and_goes_on_from_a_pickle(renderer):
    localizer = RecoveringLocalizer(renderer, seed=1, max_places=1_000)
    localizer.initialize(PLACE)
    modes = [localizer.step(renderer.render(state)[0], gravity=down(state)).mode for state in walk(PLACE, 6)]
    assert modes == ["following"] * 6
    dark = np.full(SMALL.shape, np.nan)
    for _ in range(3):
        localizer.step(dark)
    states = walk(OTHER, 7)
    first = localizer.step(renderer.render(states[0])[0], gravity=down(states[0]))
    assert first.mode == "searching", "after the dark nothing is taken for granted"
    copy = pickle.loads(pickle.dumps(localizer))
    found = [localizer.step(renderer.render(state)[0], gravity=down(state)) for state in states[1:]]
    again = [copy.step(renderer.render(state)[0], gravity=down(state)) for state in states[1:]]
    assert np.array_equal([f.estimate.state for f in found], [f.estimate.state for f in again])
    assert "found again" in {f.mode for f in found}
    assert (found[-1].mode, found[-1].estimate.status) == ("following", "tracked")
    assert found[-1].estimate.state[:3] == pytest.approx(states[-1][:3], abs=0.02)
