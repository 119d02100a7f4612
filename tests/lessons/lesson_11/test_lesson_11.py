"""What lesson 11 says of panoramas and the sphere holds, and its scene computes as the library does."""

import os
import shutil

import numpy as np
import pytest

from course_lib.lessons.kit.room_photographs import room_recording, the_image
from course_lib.lessons.lesson_11.panel import sphere_panel
from course_lib.lessons.lesson_11.sphere_view import SIZE, SphereView, circle_around, circle_on_panorama
from course_lib.lessons.lesson_11.views import SCENE, all_bearings, look_up, object_at_the_seam, scene
from course_lib.lessons.lesson_11.write_sphere_scene import scene_html, write_scene
from course_lib.paths import REPOSITORY, data_path
from course_lib.spherical_stereo.panorama import direction_from_angles, direction_to_pixel, pixel_to_direction
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

WIDTH, HEIGHT = 1280, 640


def test_the_sofa_lies_across_the_seam_and_its_plain_mean_is_half_a_turn_off():
    u_min, _, u_max, _ = object_at_the_seam().visible_box
    assert u_max > WIDTH
    gap = (u_min + u_max % WIDTH) / 2 - ((u_min + u_max) / 2) % WIDTH
    assert abs(gap) == pytest.approx(WIDTH / 2)


def test_box_centres_point_at_the_maps_objects():
    error = np.abs(all_bearings(SemanticMap.load(data_path("room/semantic_map.json"))).error)
    assert len(error) > 150
    assert np.median(error) < 0.5
    assert np.mean(error < 3) > 0.9


def test_looking_up_the_pixels_own_directions_gives_the_image_back():
    image = the_image()
    rows = slice(200, 440)
    centres = np.stack(np.meshgrid(np.arange(WIDTH) + 0.5, np.arange(HEIGHT)[rows] + 0.5), axis=-1)
    again = look_up(image, pixel_to_direction(centres, WIDTH, HEIGHT))
    assert np.abs(again.astype(int) - image[rows]).max() <= 2


def test_looking_up_is_smooth_across_the_seam():
    ramp = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
    ramp[:, :640], ramp[:, 640:] = 200, 100
    columns = np.linspace(-2, 2, 9)
    colours = look_up(ramp, pixel_to_direction(np.stack([columns, np.full(9, 320.0)], axis=-1)[None], WIDTH, HEIGHT))
    assert np.all(np.diff(colours[0, :, 0].astype(int)) >= 0)
    assert colours[0, 4, 0] == pytest.approx(150, abs=3)


def test_the_drawn_sphere_shows_each_direction_in_its_place_and_is_not_mirrored():
    view = SphereView(150.0, -20.0)
    drawn = view.picture(the_image()).astype(int)
    for azimuth, elevation in ((150, -20), (170, -10), (120, -40)):
        direction = direction_from_angles(np.radians(azimuth), np.radians(elevation))
        x, y = view.on_screen(direction)
        column, row = round((x + 1) / 2 * SIZE - 0.5), round((1 - y) / 2 * SIZE - 0.5)
        u, v = direction_to_pixel(direction, WIDTH, HEIGHT)
        around = the_image()[int(v) - 4 : int(v) + 5, int(u) - 4 : int(u) + 5].astype(int)
        colour = drawn[row, column][::-1]
        assert np.abs(around - colour).sum(axis=-1).min() <= 6
    left, right = (view.on_screen(direction_from_angles(np.radians(a), 0.0))[0] for a in (160, 140))
    assert left < right, "what is farther to the left for the camera is farther left on the picture"


def test_a_circle_around_a_direction_keeps_its_distance_and_tears_at_the_seam_only():
    for uv, pieces in (([640.0, 320.0], 1), ([1275.0, 320.0], 3)):
        direction = pixel_to_direction(uv, WIDTH, HEIGHT)
        ring = circle_around(direction, 10.0)
        assert ring @ direction == pytest.approx(np.cos(np.radians(10)))
        assert np.isnan(circle_on_panorama(ring, WIDTH, HEIGHT)[:, 0]).sum() == pieces - 1


def test_the_panel_tells_one_direction_for_both_copies_of_a_column():
    panel = sphere_panel()
    one, other = (panel.draw(**(panel.defaults() | {"u": u})) for u in (120, 1400))
    assert one.summary.splitlines()[1] == other.summary.splitlines()[1]
    assert "back again: u 120 px" in other.summary


def test_the_recording_is_the_one_of_the_scene():
    assert room_recording(1).pairs[9].upper_file.name == "05_b_upper.jpg"


def test_the_stored_scene_is_what_the_command_writes(tmp_path):
    stored = REPOSITORY / "notebooks" / SCENE
    assert write_scene(tmp_path / "scene.html").read_text() == stored.read_text()
    assert stored.stat().st_size <= 2_000_000
    assert "http" not in scene_html().replace("http-equiv", ""), "the scene loads nothing"


HEIGHT_OF_FRAME = scene().height


@pytest.fixture(scope="module")
def page():
    sync_api = pytest.importorskip("playwright.sync_api")
    names = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
    path = next((found for name in names if (found := shutil.which(name))), None)
    if path is None:
        message = "no Chromium or Chrome found: the scene was not driven in a browser"
        if os.environ.get("CI", "").lower() == "true":
            pytest.fail(message)
        pytest.skip(message)
    with sync_api.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=path, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 900, "height": 480})
        page.set_default_timeout(1_800_000)  # only what hangs takes so long
        page.errors = []
        page.on("pageerror", lambda error: page.errors.append(str(error)))
        page.goto((REPOSITORY / "notebooks" / SCENE).as_uri())
        page.wait_for_function("() => document.getElementById('numbers').textContent")
        yield page
        browser.close()


def test_the_scene_computes_as_the_library_does(page):
    uv = np.random.default_rng(11).uniform([0, 1], [WIDTH, HEIGHT - 1], size=(50, 2))
    directions = page.evaluate("pixels => pixels.map(([u, v]) => scene.pixelToDirection(u, v))", uv.tolist())
    assert np.allclose(directions, pixel_to_direction(uv, WIDTH, HEIGHT))
    assert np.allclose(page.evaluate("d => d.map(scene.directionToPixel)", directions), uv)


@pytest.mark.parametrize("width", [530, 720, 1000])
def test_the_scene_fits_its_frame_in_a_narrow_window_too(page, width):
    page.set_viewport_size({"width": width, "height": HEIGHT_OF_FRAME})
    try:
        page_size = "() => [document.documentElement.scrollWidth, document.documentElement.scrollHeight]"
        needed = page.evaluate(page_size)
        assert needed[0] <= width
        assert needed[1] <= HEIGHT_OF_FRAME
    finally:
        page.set_viewport_size({"width": 900, "height": 480})


def test_dragging_past_the_edge_comes_in_at_the_other_and_the_sphere_follows(page):
    box = page.locator("#panorama").bounding_box()
    sphere = "() => document.getElementById('sphere').toDataURL().length"
    before = page.evaluate(sphere)
    page.mouse.move(box["x"] + 0.9 * box["width"], box["y"] + 0.6 * box["height"])
    page.mouse.down()
    page.mouse.move(box["x"] + 1.05 * box["width"], box["y"] + 0.6 * box["height"], steps=4)
    page.mouse.up()
    u, v = page.evaluate("() => [scene.state.u, scene.state.v]")
    assert u == pytest.approx(0.05 * WIDTH, abs=0.01 * WIDTH)
    assert v == pytest.approx(0.6 * HEIGHT, abs=0.01 * HEIGHT)
    assert page.evaluate(sphere) != before
    assert f"u = {u:.1f} px" in page.locator("#numbers").inner_text()
    assert page.errors == []


def test_dragging_the_point_on_the_sphere_moves_it_on_the_panorama(page):
    page.evaluate("() => { scene.setPoint(1200, 400); }")
    page.locator("#sphere").scroll_into_view_if_needed()
    box, before = page.locator("#sphere").bounding_box(), page.evaluate("() => [scene.state.u, scene.state.v]")
    x, y = SphereView(140, -20).on_screen(pixel_to_direction(before, WIDTH, HEIGHT)) * 270 / 640
    start = (box["x"] + (0.5 + x) * box["width"], box["y"] + (0.5 - y) * box["height"])
    page.mouse.move(*start)
    page.mouse.down()
    page.mouse.move(start[0] + 40, start[1], steps=4)
    page.mouse.up()
    u, _ = page.evaluate("() => [scene.state.u, scene.state.v]")
    assert 5 < (u - before[0]) % WIDTH < 320, "to the right on the sphere is to the right on the panorama"


def test_arrow_keys_move_the_point(page):
    page.evaluate("() => scene.setPoint(0, 320)")
    page.locator("#panorama").focus()
    page.keyboard.press("ArrowLeft")
    assert page.evaluate("() => scene.state.u") == WIDTH - 1
