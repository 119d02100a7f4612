"""Where a camera can be, what is stored of the views from there, and what an image shows of down."""

import numpy as np
import pytest
import trimesh

from course_lib.beyond.lost_and_found.free_space import CLEARANCE, FreeSpace
from course_lib.beyond.lost_and_found.global_search import upright_rotation
from course_lib.beyond.lost_and_found.image_gravity import (
    SEEN_TILT_SIGMA,
    UNKNOWN_TILT_SIGMA,
    down_from_image,
    is_upright,
)
from course_lib.beyond.lost_and_found.stored_views import COLUMNS, StoredViews, look_at, readable_scores
from course_lib.geometry import optical_pose
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from tests.rendering.shapes import SMALL, room, wall


def down(state):
    return -optical_pose(state)[2, :3]


def cut(scene_map, keep):
    return SceneMap(scene_map.vertices, scene_map.faces[keep])


def inside(places, half=2.0):
    return (np.abs(places) < half - CLEARANCE / 2).all(axis=1)


@pytest.mark.parametrize("side", [1, -1], ids=["as it is", "turned inside out"])
def test_an_open_room_is_free_in_front_of_its_walls_and_not_behind_them(rng, side):
    """Without ceiling and one wall; a cube's half edge is 2 m, and the camera may be in the room or before the gap."""
    whole = room(4.0, (0.0, 0.0, 0.0))
    middles = whole.vertices[whole.faces].mean(axis=1)
    open_room = cut(whole, (middles[:, 2] < 1.9) & (middles[:, 0] < 1.9))
    space = FreeSpace(SceneMap(open_room.vertices, open_room.faces[:, ::side]))
    assert space.side == -side, "the normals of a box point outwards"
    places = space.draw(500, rng)
    assert inside(places).mean() > 0.4
    behind = (places[:, 2] < -2) | (places[:, 0] < -2) | (np.abs(places[:, 1]) > 2.0)
    assert (behind & (places[:, 0] < 2) & (places[:, 2] < 2)).mean() < 0.01


def test_where_normals_tell_nothing_both_sides_are_free_unless_the_scanner_s_place_is_given(rng):
    whole = room(4.0, (0.0, 0.0, 0.0))
    flipped = whole.faces.copy()
    flipped[::2] = flipped[::2, ::-1]
    space = FreeSpace(SceneMap(whole.vertices, flipped))
    assert space.side == 0
    assert inside(space.draw(500, rng)).mean() < 0.9
    one_wall = wall(2.0, 1.0)
    assert FreeSpace(one_wall).side == 0
    sides = [FreeSpace(one_wall, seen_from=np.array([[x, 0.0, 0.0]])).side for x in (0, 4)]
    assert sorted(sides) == [-1, 1]


def test_a_map_that_can_be_seen_from_nowhere_is_refused():
    speck = SceneMap(np.array([[0, 0, 0], [1e-3, 0, 0], [0, 1e-3, 0.0]]), np.array([[0, 1, 2]]))
    with pytest.raises(ValueError, match="is it in metres"):
        FreeSpace(speck).spread_out(1)


@pytest.fixture(scope="module")
def views(renderer):
    return StoredViews(FreeSpace(renderer.scene_map), renderer.scene_map.origin)


@pytest.mark.parametrize("tilt", [(0.0, 0.0), (0.15, 0.3), (-0.4, -0.2), (3.0, 0.1)])
def test_a_stored_place_and_heading_is_among_the_best_for_its_own_image(renderer, views, tilt):
    """Rendered at a stored place, in a stored heading; pixels of six degrees leave some doubt beside edges."""
    place, heading = len(views.places) // 2, 7
    state = np.array([*views.places[place], *tilt, 0.0])
    upright = upright_rotation(down(state))
    pose = views.poses(np.array([place * COLUMNS + heading]), upright)
    image = renderer.render_poses(pose)[0]
    scores = views.scores(look_at(renderer.camera.points(np.where(np.isfinite(image), image, np.nan)), upright), 0.3)
    assert scores.shape == (len(views.places), COLUMNS)
    assert scores[place].argmax() == heading
    assert scores[place, heading] > max(0.6, scores.max() - 0.02)
    assert pose[0, :3, :3] @ down(state) == pytest.approx([0, 0, -1])


def test_compiled_scores_are_the_readable_ones_and_behind_the_map_counts_against(renderer, views, rng):
    points = renderer.camera.points(rng.uniform(0.3, 9.0, SMALL.shape))
    points[:20] = np.nan
    look = look_at(points, upright_rotation(np.array([0.1, 0.9, 0.2])))
    assert len(look.ranges) == (SMALL.height - 20) * SMALL.width
    some = views.ranges[:20].copy()
    some[:, 10:20] = 65_535
    view = StoredViews.__new__(StoredViews)
    view.ranges = some
    assert view.scores(look, 0.3) == pytest.approx(readable_scores(some, look, 0.3), abs=1e-4)
    two = np.full((1, 30, 60), 2_000, np.uint16)
    for metres, score in ((2.0, 1.0), (1.0, 0.3 / 1.3), (3.0, -0.7 / 1.3)):
        one = look._replace(ranges=np.full(len(look.ranges), metres, np.float32))
        assert readable_scores(two, one, 0.3) == pytest.approx(score, abs=1e-6)


@pytest.mark.parametrize("state", [(-1.2, 0.5, -0.6, 0.15, 0.2, -0.3), (-1.5, -1.5, 0.5, -0.2, 0.45, 0.8)])
def test_floor_and_walls_show_what_is_down(renderer, state):
    found, sigma = down_from_image(renderer.render(np.array(state))[0], SMALL, np.array([0.0, 1.0, 0.0]))
    assert sigma == SEEN_TILT_SIGMA
    assert found @ down(np.array(state)) > np.cos(np.deg2rad(1.5))
    assert is_upright(renderer.scene_map)


def test_one_wall_beside_a_board_or_noise_shows_no_down_and_a_tilted_map_has_none(rng):
    assumed = np.array([0.0, 1.0, 0.0])
    with DepthRenderer(wall(2.0), SMALL) as renderer:
        one_wall = renderer.render(np.array([0, 0, 0, 0.2, 0.1, 0.3]))[0]
    board = trimesh.creation.box((0.1, 0.5, 0.5), trimesh.transformations.euler_matrix(0.3, 0.2, 0.9))
    board.apply_translation((1.8, 0.0, 0.0))
    behind = wall(3.0)
    with DepthRenderer(SceneMap(*_joined(behind, board)), SMALL) as renderer:
        small_board = renderer.render(np.array([0, 0, 0, 0.2, 0.1, 0.3]))[0]
    for depth in (one_wall, small_board, rng.uniform(0.5, 6.0, SMALL.shape), np.full(SMALL.shape, np.nan)):
        found, sigma = down_from_image(depth, SMALL, assumed)
        assert (found == assumed).all()
        assert sigma == UNKNOWN_TILT_SIGMA
    turned = room(4.0).transformed(np.linalg.inv(optical_pose(np.array([0, 0, 0, 0.5, 0.4, 0.3]))))
    assert not is_upright(turned)


def _joined(scene_map, mesh):
    faces = np.concatenate([scene_map.faces, mesh.faces + len(scene_map.vertices)])
    return np.concatenate([scene_map.vertices, mesh.vertices]), faces
