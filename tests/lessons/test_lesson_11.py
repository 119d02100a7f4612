"""What lesson 11 draws: its sphere is in place and not mirrored, its scene computes as the library does."""

import numpy as np
import pytest

from course_lib.spherical_stereo.panorama import direction_from_angles, direction_to_pixel, pixel_to_direction
from courseware.lessons.kit.room_data import the_image
from courseware.lessons.lesson_11.sphere_view import DrawnSphere
from courseware.lessons.lesson_11.write_sphere_scene import STORED, scene_html
from courseware.plots.figures import new_figure
from tests.notebooks.driven_lab import require_chromium


def test_the_drawn_sphere_shows_each_direction_in_its_place_and_is_not_mirrored():
    sphere = DrawnSphere(new_figure()[1], the_image())
    directions = direction_from_angles(np.radians([170, 150, 120]), np.radians([-10, -20, -40]))
    for direction, (x, y) in zip(directions, sphere.on_screen(directions), strict=True):
        colour = sphere.picture.get_array()[round(149.5 - 150 * y), round(149.5 + 150 * x)]
        u, v = direction_to_pixel(direction, 1280, 640).astype(int)
        around = the_image()[v - 4 : v + 5, u - 4 : u + 5, ::-1].astype(int)
        assert np.abs(around - colour).sum(axis=-1).min() <= 6
    assert (np.diff(sphere.on_screen(directions)[:, 0]) > 0).all()


def test_the_scene_computes_as_the_library_and_a_point_dragged_past_an_edge_comes_in_at_the_other():
    assert STORED.read_text() == scene_html(), "run write_sphere_scene"
    uv = np.random.default_rng(11).uniform([0, 1], [1280, 639], size=(50, 2))
    with pytest.importorskip("playwright.sync_api").sync_playwright() as driver:
        page = driver.chromium.launch(executable_path=require_chromium(), args=["--no-sandbox"]).new_page()
        page.goto(STORED.as_uri())
        page.wait_for_function("() => document.getElementById('numbers').textContent")
        directions = page.evaluate("pixels => pixels.map(([u, v]) => scene.pixelToDirection(u, v))", uv.tolist())
        assert np.allclose(directions, pixel_to_direction(uv, 1280, 640))
        assert np.allclose(page.evaluate("d => d.map(scene.directionToPixel)", directions), uv)
        box = page.locator("#panorama").bounding_box()
        page.mouse.move(box["x"] + 0.9 * box["width"], box["y"] + 0.6 * box["height"])
        page.mouse.down()
        page.mouse.move(box["x"] + 1.05 * box["width"], box["y"] + 0.6 * box["height"], steps=4)
        assert page.evaluate("() => [scene.state.u, scene.state.v]") == pytest.approx([64, 384], abs=10)
