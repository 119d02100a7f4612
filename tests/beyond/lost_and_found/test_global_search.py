"""From anywhere in a small furnished room: the right place, several where it looks alike, found when carried off."""

import numpy as np
import pytest
from scipy.stats import chi2

from course_lib.lessons.lesson_10.adaptive_count import kld_count, occupied_bins
from course_lib.beyond.lost_and_found.free_space import FreeSpace
from course_lib.beyond.lost_and_found.global_search import GlobalSearch, upright_poses
from course_lib.beyond.lost_and_found.recovery import RecoveringLocalizer
from course_lib.geometry import optical_pose
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from tests.rendering.shapes import SMALL, room

PLACE = np.array([-1.2, 0.5, -0.6, 0.15, 0.2, -0.3])
ELSEWHERE = np.array([-1.5, -1.5, 0.5, 0.1, 0.3, 0.8])


def down(state):
    return -optical_pose(state)[2, :3]


def walk(start, n):
    return start + np.arange(n)[:, None] * np.array([0.03, 0.02, 0.01, 0.005, 0.01, 0.02])


def searched(search, renderer, states, gravity=down):
    return [search.step(renderer.render(state)[0], gravity(state)) for state in states]


@pytest.mark.slow
def test_the_camera_is_found_from_nowhere(renderer):
    states = walk(ELSEWHERE, 6)
    answers = searched(GlobalSearch(renderer, seed=1, least=200, most=1_500), renderer, states)
    assert answers[0].status == "searching", "one frame is not enough to believe"
    assert answers[-1].status == "found"
    assert answers[-1].poses[0].state[:3] == pytest.approx(states[-1][:3], abs=0.02)
    assert answers[-1].poses[0].evidence > 0.9
    assert answers[0].particles == 1_500 > answers[-1].particles, "a place that is known needs fewer"


@pytest.mark.slow
def test_in_an_empty_cube_four_places_are_as_good(renderer):
    """The cube looks the same turned by 90 degrees: four headings, and no frame can tell."""
    with DepthRenderer(room(), SMALL) as renderer:
        answer = searched(GlobalSearch(renderer, seed=2, least=300, most=1_500), renderer, walk(PLACE, 5))[-1]
    assert answer.status == "several"
    assert len(answer.poses) >= 2
    reach = [np.hypot(*place.state[:2]) for place in answer.poses[:2]]
    assert reach == pytest.approx([np.hypot(*walk(PLACE, 5)[-1][:2])] * 2, abs=0.1)


def test_what_no_place_explains_is_not_found_and_a_person_who_walks_by_raises_no_alarm(renderer, rng):
    search = GlobalSearch(renderer, seed=1, least=200, most=1_000)
    noise = rng.uniform(0.5, 6.0, (5, *SMALL.shape))
    assert {search.step(depth, np.array([0.0, 1.0, 0.0])).status for depth in noise} == {"searching"}
    localizer = RecoveringLocalizer(renderer, seed=1)
    localizer.initialize(PLACE)
    for number, state in enumerate(walk(PLACE, 12)):
        depth = renderer.render(state)[0].copy()
        if 4 <= number < 9:
            depth[:, 8 * (number - 4) : 8 * (number - 4) + 24] = 0.6
        assert localizer.step(depth, gravity=down(state)).mode == "following"


def test_drawn_poses_have_the_measured_down_and_free_places_are_inside_and_clear_of_furniture(rng):
    positions = rng.uniform(-1, 1, (500, 3))
    for state in (PLACE, ELSEWHERE, np.array([0, 0, 0, 0, np.pi / 2, 0.0]), np.array([0, 0, 0, np.pi, 0, 0.0])):
        poses = upright_poses(positions, 9.81 * down(state), 1e-6, rng)
        assert poses[:, :3, :3] @ down(state) == pytest.approx(np.tile([0.0, 0.0, -1.0], (500, 1)), abs=1e-4)
        forward = np.arctan2(poses[:, 1, 0], poses[:, 0, 0])
        assert np.abs(np.exp(1j * forward).mean()) < 0.15, "any heading"
        assert poses[:, :3, 3] == pytest.approx(positions)
    rooms = [room(6.0, (0.0, 0.0, 0.0)), room(6.0, (12.0, 12.0, 0.0))]
    corners = np.concatenate([r.vertices for r in rooms])
    space = FreeSpace(SceneMap(corners, np.concatenate([rooms[0].faces, rooms[1].faces + len(rooms[0].vertices)])))
    places = space.draw(400, rng)
    assert len(places) == 400
    inside = [(np.abs(places - centre) < 2.95).all(axis=1) for centre in ([0, 0, 0], [12, 12, 0])]
    assert (inside[0] | inside[1]).all()
    assert 0.3 < inside[0].mean() < 0.7


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:this frame holds no measurement")
def test_carried_away_in_the_dark_it_finds_itself_again(renderer):
    localizer = RecoveringLocalizer(renderer, seed=1, least=200, most=2_000)
    localizer.initialize(PLACE)
    modes = [localizer.step(renderer.render(state)[0], gravity=down(state)).mode for state in walk(PLACE, 6)]
    assert modes == ["following"] * 6
    dark = np.full(SMALL.shape, np.nan)
    for _ in range(3):
        localizer.step(dark)
    states = walk(ELSEWHERE, 7)
    found = [localizer.step(renderer.render(state)[0], gravity=down(state)) for state in states]
    assert found[0].mode == "searching", "after the dark nothing is taken for granted"
    assert "found again" in {f.mode for f in found}
    assert found[-1].mode == "following"
    assert found[-1].estimate.status == "tracked"
    assert found[-1].estimate.state[:3] == pytest.approx(states[-1][:3], abs=0.02)
    assert found[0].short < found[0].long


def test_the_count_is_the_chi_square_quantile_and_poses_are_counted_by_where_they_are_and_look():
    for bins in (2, 10, 100, 1000):
        exact = chi2.ppf(0.99, bins - 1) / (2 * 0.05)
        assert kld_count(bins, 1, 10**7) == pytest.approx(exact, rel=0.02)
    assert [kld_count(bins, 50, 5_000) for bins in (0, 1, 3_000)] == [50, 50, 5_000]
    states = np.zeros((5, 6))
    states[:, :3] = 0.1
    states[1, 0], states[2, 0], states[3, 5] = 0.2, 3.0, np.pi / 2
    assert occupied_bins(optical_pose(states), 0.5, 0.5) == 3
    assert occupied_bins(np.empty((0, 4, 4)), 0.5, 0.5) == 0
