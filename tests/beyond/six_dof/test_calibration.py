"""Intrinsics that do not fit the images: which, by how much, and what they cost a pose; right ones are not doubted."""

from dataclasses import replace

import numpy as np
import pytest

from course_lib.beyond.six_dof.calibration import PRIOR, Calibration, CalibrationCheck
from course_lib.beyond.six_dof.localizer import CHECKED, AnnealedLocalizer
from course_lib.beyond.six_dof.poses import retract
from course_lib.beyond.six_dof.refinement import refine
from course_lib.depth_mcl.motion import TANGENT_SPACE
from course_lib.depth_mcl.uncertainty import normalized_error
from course_lib.geometry import optical_pose
from course_lib.rendering.renderer import DepthRenderer
from tests.rendering.shapes import SMALL, furnished_room

# Sways in a room, looking to and fro, up and down: 48 frames.
ANGLE = np.linspace(0, 4 * np.pi, 48, endpoint=False)
SWAY = [np.cos(ANGLE / 2), np.sin(ANGLE / 2), np.sin(ANGLE), np.cos(ANGLE), np.cos(ANGLE), np.sin(ANGLE / 2)]
STATES = np.array([-1.2, 0.0, 0.0, 0.0, 0.0, 0.0]) + np.column_stack(SWAY) * [0.6, 0.8, 0.5, 0.15, 0.3, 0.8]
# What is wrong, the camera that is given, and the c that corrects it.
WRONG = {
    "nothing": (SMALL, [0, 0, 0]),
    "f +5 %": (replace(SMALL, fx=1.05 * SMALL.fx, fy=1.05 * SMALL.fy), [-np.log(1.05), 0, 0]),
    "f -5 %": (replace(SMALL, fx=0.95 * SMALL.fx, fy=0.95 * SMALL.fy), [-np.log(0.95), 0, 0]),
    "cx +2 px": (replace(SMALL, cx=SMALL.cx + 2), [0, -2 / SMALL.width, 0]),
    "cy -2 px": (replace(SMALL, cy=SMALL.cy - 2), [0, 0, 2 / SMALL.height]),
}


@pytest.fixture(scope="module")
def images(renderer):
    """What the true camera measures."""
    noise = 0.01 * np.random.default_rng(3).standard_normal((len(STATES), *SMALL.shape))
    return (renderer.render(STATES) + noise).astype(np.float32)


@pytest.mark.parametrize("wrong", WRONG)
def test_it_names_what_is_wrong_and_nothing_else(images, wrong):
    given, correction = WRONG[wrong]
    check = CalibrationCheck()
    assert (check.estimate().sentence(given), check.estimate().images) == (None, 0)
    with DepthRenderer(furnished_room(), given) as renderer:
        for state, measured in zip(STATES, images, strict=True):
            pose = refine(renderer, measured, optical_pose(state)[None], (0.1,) * 3 + (0.05,) * 5)
            check.add(measured, renderer.render_poses(pose)[0], given)
    found = check.estimate()
    is_wrong = np.array(correction) != 0
    assert np.abs(found.correction[~is_wrong]).max() < 0.012
    share = found.correction[is_wrong] / np.array(correction)[is_wrong]
    assert ((share > 0.5) & (share < 1.1)).all(), "wrong poses hide the rest"
    assert list(found.doubted) == list(is_wrong)
    sentence = found.sentence(given)
    if wrong == "nothing":
        assert sentence is None
    elif wrong.startswith("f"):
        better, old = (float(word) for word in sentence.replace(" px", "").split() if word.isdigit())
        assert better == pytest.approx(SMALL.fx, rel=0.02)
        assert old == round(given.fx)
    else:
        assert sentence.startswith(f"the images fit {wrong[:2]} = ")
        assert " and " not in sentence


def test_small_errors_are_found_to_first_order_and_an_image_of_any_size_counts_alike(renderer):
    """Exact images, poses off by millimetres, c by half a percent; the same from images of sixteen times the pixels."""
    c, off, sigmas = np.array([0.005, -0.004, 0.003]), np.array([0.004, -0.003, 0.002, 0.003, -0.002, 0.001]), []
    for camera in (SMALL, SMALL.resized(4 * SMALL.width, 4 * SMALL.height)):
        lens = {"fx": camera.fx * np.exp(-c[0]), "fy": camera.fy * np.exp(-c[0])}
        given = replace(camera, **lens, cx=camera.cx - c[1] * camera.width, cy=camera.cy - c[2] * camera.height)
        check, poses = CalibrationCheck(), optical_pose(STATES[::4])
        with DepthRenderer(furnished_room(), camera) as true, DepthRenderer(furnished_room(), given) as assumed:
            images = true.render_poses(poses), assumed.render_poses(retract(poses, off))
            for measured, image in zip(*images, strict=True):
                check.add(measured, image, given)
        assert check.estimate().correction == pytest.approx(c, abs=0.001)
        sigmas.append(np.sqrt(np.diag(check.estimate().covariance)))
    assert sigmas[0] == pytest.approx(sigmas[1], rel=0.2)


def test_without_a_measurement_it_learns_nothing():
    check = CalibrationCheck()
    check.add(np.full(SMALL.shape, np.nan), np.full(SMALL.shape, np.inf), SMALL)
    assert check.estimate().correction == pytest.approx(0.0)
    assert np.sqrt(np.diag(check.estimate().covariance)) == pytest.approx(PRIOR, rel=0.05)


def test_two_doubts_make_one_sentence():
    found = Calibration(np.array([0.05, -0.03, 0.0]), np.diag([0.01, 0.005, 0.01]) ** 2, 20)
    camera = replace(SMALL, fx=500.0, fy=500.0, width=100, cx=50.0)
    assert found.sentence(camera) == (
        "the images fit a focal length of 526 px better than the given 500 (+5.1 +- 1.0 %) and cx = 47.0 px better "
        "than the given 50.0 (+- 0.5 px)"
    )


@pytest.mark.parametrize("wrong", ["nothing", "f +5 %", "cx +2 px"])
def test_where_the_intrinsics_are_doubted_the_filter_s_covariance_covers_what_they_cost(images, wrong):
    given, _ = WRONG[wrong]
    with DepthRenderer(furnished_room(), given) as renderer:
        localizer = AnnealedLocalizer(renderer, 100, seed=1)
        localizer.initialize(STATES[0])
        found = [localizer.step(image) for image in images]
    assert found[-1].calibration.images == len(found) // CHECKED, "all of them are tracked"
    assert found[-1].calibration.doubted.any() == (wrong != "nothing")
    deviations = [TANGENT_SPACE.deviations(s[None], one.state)[0] for one, s in zip(found, STATES, strict=True)]
    errors = [normalized_error(d, one.error_covariance) for d, one in zip(deviations, found, strict=True)]
    assert np.mean(errors[-6:]) < 3
    if wrong != "nothing":
        assert np.sqrt(np.trace(found[-1].error_covariance[:3, :3])) < 0.2
        assert errors[1] > 2 * np.mean(errors[-6:]), "before the doubt it was too sure"
