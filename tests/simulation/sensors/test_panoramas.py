"""Panoramas of rooms: where things appear on them, how large, in which colour, and what the camera does to them."""

import dataclasses

import numpy as np
import pytest

from course_lib.geometry import pose_matrix
from course_lib.spherical_stereo.panorama import direction_to_pixel
from courseware.simulation.room.furnishing import make_room
from courseware.simulation.room.stereo_photographs import object_boxes
from courseware.simulation.sensors.panorama_renderer import BACKGROUND, PanoramaRenderer
from courseware.simulation.sensors.panorama_rig import (
    NEARLY_PERFECT_RIG,
    PanoramaCameraModel,
    RigModel,
    RigPose,
    photograph,
    stand_up,
)
from tests.simulation.plain_room import plain_object, plain_room

WIDTH = 640
AHEAD = plain_object("chair", 2.0, 0.0, 0.5, 1.0, (255, 0, 0))
LEFT = plain_object("table", 0.0, 2.0, 0.5, 1.0, (0, 255, 0))
BEHIND = plain_object("sofa", -2.0, 0.0, 0.5, 1.0, (0, 0, 255))
HIDDEN = plain_object("cabinet", 2.7, 0.4, 0.3, 0.9, (255, 255, 0))
EYE = np.array([0.0, 0.0, 1.2, 0.0, 0.0, 0.0])


@pytest.fixture(scope="module")
def renderer():
    with PanoramaRenderer(plain_room(AHEAD, LEFT, BEHIND, HIDDEN), WIDTH) as renderer:
        yield renderer


def test_ahead_is_the_centre_behind_is_the_seam_and_a_hidden_object_knows_how_much_of_it_is_seen(renderer):
    image = renderer.render(EYE)
    row = int(WIDTH / 2 * (0.5 + np.arctan(0.7 / 1.75) / np.pi))
    assert image.shape == (WIDTH // 2, WIDTH, 3)
    assert np.argmax(image[row, WIDTH // 2]) == 2, "red ahead, BGR"
    assert np.argmax(image[row, WIDTH // 4]) == 1, "green on the left"
    assert np.argmax(image[row, 0]) == 0, "blue behind, on both edges"
    assert np.argmax(image[row, -1]) == 0
    numbers = renderer.render_objects(EYE)
    assert np.all(numbers[: WIDTH // 2] == BACKGROUND), "row 0 is straight up: objects stand below the horizon"
    assert np.any(numbers[WIDTH // 2 :] != BACKGROUND)
    boxes = {box.number: box for box in object_boxes(renderer, EYE)}
    assert 0 <= boxes[2].visible_box[0] < WIDTH < boxes[2].visible_box[2], "across the seam a box passes the width"
    assert boxes[0].visible_fraction == 1.0
    assert 0.0 < boxes[3].visible_fraction < 0.6
    seen, whole = np.array(boxes[3].visible_box), np.array(boxes[3].unoccluded_box)
    assert (whole[:2] <= seen[:2]).all()
    assert (whole[2:] >= seen[2:]).all()
    assert np.any(renderer.render_objects(EYE) == 0), "after the boxes everything is drawn again"


def corners_on_image(thing, state, width):
    return direction_to_pixel((thing.vertices() - state[:3]) @ pose_matrix(state)[:3, :3], width, width // 2)


@pytest.mark.parametrize("yaw", [0.0, 0.3, -1.1, 2.9])
def test_a_box_is_where_its_corners_project(renderer, yaw):
    state = EYE.copy()
    state[5] = yaw
    found = {box.number: box for box in object_boxes(renderer, state)}
    for number, thing in ((0, AHEAD), (1, LEFT), (2, BEHIND)):
        u = corners_on_image(thing, state, WIDTH)[:, 0]
        u_min, v_min, u_max, v_max = found[number].unoccluded_box
        away = (u - u_min + WIDTH / 2) % WIDTH - WIDTH / 2
        assert away.min() == pytest.approx(0.0, abs=0.6)
        assert away.max() == pytest.approx(u_max - u_min, abs=1.1)
        # The bottom edge bulges between its corners: its middle is nearest, 1.75 m away.
        assert v_max == pytest.approx(WIDTH / 2 * (0.5 + np.arctan2(1.2, 1.75) / np.pi), abs=0.6)
        assert v_min == pytest.approx(corners_on_image(thing, state, WIDTH)[:, 1].min(), abs=0.6)


def test_rig_tilts_stay_within_their_limits_and_faults_of_a_mount_do_not_change_what_is_drawn_after_it():
    model, rng = RigModel(), np.random.default_rng(3)
    rigs = [stand_up((1.0, 2.0, 0.5), 1.44, 0.3, model, rng) for _ in range(200)]
    tilts = np.rad2deg([np.hypot(*rig.tilt) for rig in rigs])
    relative = np.rad2deg([np.hypot(*rig.relative_tilt) for rig in rigs])
    yaws = np.rad2deg([rig.relative_yaw for rig in rigs])
    assert 0.8 < tilts.max() <= model.tilt_deg
    assert 0.25 < relative.max() <= model.relative_tilt_deg
    assert 0.25 < np.abs(yaws).max() <= model.relative_yaw_deg
    assert np.std([rig.baseline for rig in rigs]) == pytest.approx(model.baseline_error, rel=0.2)
    assert np.std([rig.upper_height for rig in rigs]) == pytest.approx(model.height_error, rel=0.2)
    for rig in rigs[:20]:
        upper, lower = rig.camera_states()
        assert np.linalg.norm(upper[:3] - lower[:3]) == pytest.approx(rig.baseline)
        assert np.rad2deg(np.abs(upper[3:5] - lower[3:5])).max() <= model.relative_tilt_deg + 0.01
    # So that data/room, made before rigs had a yaw and a wrong baseline, comes out as it was.
    used, reference = (np.random.default_rng(5) for _ in range(2))
    stand_up((1.0, 2.0, 0.5), 1.44, 0.3, RigModel(), used)
    reference.uniform(size=4)  # the length and the direction of two tilts
    assert used.uniform() == reference.uniform()
    perfect = stand_up((1.0, 2.0, 0.5), 1.44, 0.3, NEARLY_PERFECT_RIG, used)
    assert (perfect.baseline, perfect.upper_height) == (0.3, 1.44)
    assert "relative_yaw" not in perfect.as_dict()


def test_the_lower_cameras_yaw_and_tilt_move_what_it_sees():
    """The table is to the left: a turn to the left moves it to the right, a roll to the left side down moves it up."""
    straight = RigPose(0.0, 0.0, 0.0, 1.32, 0.3)
    turn = np.deg2rad(4.0)
    columns_a_turn, rows_a_tilt = WIDTH * 4 / 360, WIDTH / 2 * 4 / 180
    with PanoramaRenderer(plain_room(LEFT), WIDTH) as renderer:

        def centre(rig):
            u_min, v_min, u_max, v_max = object_boxes(renderer, rig.camera_states()[1])[0].visible_box
            return np.array([u_min + u_max, v_min + v_max]) / 2

        yawed = centre(dataclasses.replace(straight, relative_yaw=turn)) - centre(straight)
        rolled = centre(dataclasses.replace(straight, relative_tilt=(turn, 0.0))) - centre(straight)
    np.testing.assert_allclose(yawed, [columns_a_turn, 0.0], atol=0.6)
    assert abs(rolled[1]) == pytest.approx(rows_a_tilt, rel=0.25)
    assert rolled[1] > 0, "roll about the forward axis lifts the left side, so what is there moves down"


def test_a_photograph_has_noise_of_its_own_that_grows_with_brightness_and_blur_across_the_seam():
    light = np.full((128, 256, 3), 120.0, np.float32)
    first, again, other = (photograph(light, PanoramaCameraModel(), np.random.default_rng(seed)) for seed in (1, 1, 2))
    np.testing.assert_array_equal(first, again)
    assert abs(first.mean() - other.mean()) > 0.5, "exposures differ"
    assert (first.dtype, first.shape) == (np.uint8, light.shape)
    model = PanoramaCameraModel(exposure_stops=0.0, white_balance=0.0, blur=(8.0, 8.0))
    for level in (20.0, 180.0):
        image = photograph(np.full_like(light, level), model, np.random.default_rng(5)).astype(float)
        assert image.std() == pytest.approx(np.sqrt(model.shot_noise * level + model.read_noise**2), rel=0.05)
    light[:, 1:] = 0.0
    assert photograph(light, model, np.random.default_rng(0))[:, -1].mean() > 5.0


def test_a_view_that_once_never_ended_is_drawn():
    """A sofa seen so that the derivatives of its texture degenerate: see `_texture` in the renderer."""
    room_rng, _ = np.random.default_rng(3080).spawn(2)
    room = make_room(room_rng)
    sofa = dataclasses.replace(room, objects=tuple(thing for thing in room.objects if thing.label == "sofa"), shell=())
    state = np.array([2.78853765, 3.74055314, 1.47224283, 0.00720977, 0.01060839, 0.13424486])
    with PanoramaRenderer(sofa, 1280, number_scale=1) as renderer:
        assert np.isfinite(renderer.render(state)).all()
        assert len(object_boxes(renderer, state)) >= 1
