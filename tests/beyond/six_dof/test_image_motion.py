"""The motion between two images: its sign, its size, its covariance, and when it is not believed."""

import numpy as np
import pytest

from course_lib.beyond.six_dof import image_motion as module
from course_lib.beyond.six_dof.image_motion import View, compiled_motion_equations, image_motion, motion_equations
from course_lib.beyond.six_dof.poses import lengths, local, retract
from course_lib.geometry import optical_pose
from course_lib.rendering.renderer import DepthRenderer
from tests.rendering.shapes import SMALL, fence, wall

START = optical_pose(np.array([-1.0, 0.3, -0.3, 0.05, 0.1, -0.4]))
SPREAD = np.repeat([0.3, 0.3], 3)
REST = np.zeros(6)


def views(image):
    return [View.of(image, SMALL, pixels) for pixels in (32 * 24, 64 * 48)]


def between(renderer, motion, rng, start=START, guess=REST, spread=SPREAD):
    """What two noisy images say, the camera having moved by `motion` `(6,)`."""
    images = renderer.render_poses(np.stack([start, retract(start, motion)]))
    images = images + 0.01 * rng.standard_normal(images.shape)
    return image_motion(*(views(image) for image in images), guess, spread)


def error(measured, motion):
    return local(retract(np.eye(4), measured.motion), retract(np.eye(4), motion))


def test_the_compiled_loop_gives_the_numbers_of_the_readable_form(renderer, rng):
    images = renderer.render_poses(retract(START, np.array([REST, [0.1, 0, 0.1, 0, 0.2, 0]])))
    images[:, 5:9, 20:30] = np.nan
    (_, before), (_, now) = (views(image) for image in images)
    points = now.points[np.isfinite(now.points[..., 2])]
    poses = retract(np.eye(4), rng.normal(0, 0.1, (5, 6)))
    (slow, slow_pairs), (fast, fast_pairs) = (
        form(before, points, poses, 0.1) for form in (motion_equations, compiled_motion_equations)
    )
    assert fast_pairs.tolist() == slow_pairs.tolist()
    assert slow_pairs.min() > 500
    for one, other in zip(slow, fast, strict=True):
        assert one == pytest.approx(other, rel=1e-6, abs=1e-6)


@pytest.mark.parametrize(
    "motion",
    [REST, [0.02, 0, 0.05, 0, 0.03, 0.01], [-0.1, 0.05, 0.25, 0.05, 0.3, 0], [0.2, 0, -0.25, 0, -0.45, 0.05],
     [0.05, -0.1, 0.1, 0.25, 0.1, -0.1]],
)  # fmt: skip
def test_a_leap_is_measured_with_its_sign_and_its_covariance(renderer, rng, motion):
    motion = np.array(motion, dtype=float)
    errors, squares = [], []
    for _ in range(5):
        measured = between(renderer, motion, rng)
        errors.append(error(measured, motion))
        squares.append(errors[-1] @ np.linalg.solve(measured.covariance, errors[-1]) / 6)
    assert (lengths(np.array(errors)) < [0.03, 0.015]).all()
    assert np.mean(squares) < 4.0
    assert np.sqrt(np.diag(measured.covariance)).max() < 0.05


def test_before_a_bare_wall_it_keeps_the_guess_along_it_and_tells_how_near_it_came(rng):
    with DepthRenderer(wall(1.5), SMALL) as bare:
        guess = np.array([0.1, -0.05, 0.0, 0.0, 0.0, 0.1])
        measured = between(bare, np.array([0.0, 0.0, 0.2, 0.1, 0, 0]), rng, optical_pose(REST), guess, SPREAD / 3)
    assert measured.motion[2:4] == pytest.approx([0.2, 0.1], abs=0.02)
    assert measured.motion[[0, 5]] == pytest.approx([0.1, 0.1], abs=0.06)
    sigma = np.sqrt(np.diag(measured.covariance))
    assert sigma[2] < 0.05
    assert sigma[[0, 1, 5]].min() > 0.04


def test_motions_that_explain_the_images_alike_widen_the_covariance(rng):
    """Before a fence, half a pitch aside: to this post, or to that one?"""
    with DepthRenderer(fence(), SMALL) as opened:
        measured = between(opened, np.array([0.2, 0, 0, 0, 0, 0]), rng, optical_pose(REST))
    assert measured is None or np.sqrt(measured.covariance[0, 0]) > 0.15


def test_it_is_not_believed_without_pixels_without_overlap_or_between_two_places(renderer, rng):
    here, elsewhere = renderer.render_poses(
        optical_pose(np.array([[-1.0, 0.3, -0.3, 0.05, 0.1, -0.4], [1.0, -1.2, 0.0, 0.5, -0.4, 2.6]]))
    )
    blank = np.full(SMALL.shape, np.nan)
    assert image_motion(views(here), views(blank), REST, SPREAD) is None
    assert image_motion(views(blank), views(here), REST, SPREAD) is None
    assert image_motion(views(here), views(elsewhere), REST, SPREAD) is None
    corner = np.full(SMALL.shape, np.nan)
    corner[:20, :14] = here[:20, :14]
    assert image_motion(views(corner), views(here), REST, SPREAD) is None, f"less than {module.MIN_PAIRED} pair"


def test_a_guess_that_was_right_so_far_makes_motions_along_a_bare_wall_unlikely(rng):
    """Slides along the wall explain the images as well. Their distance from a sure guess decides."""
    with DepthRenderer(wall(1.5), SMALL) as bare:
        surely = np.repeat([0.015, 0.017], 3)
        motion = np.array([0.05, 0.0, 0.05, 0.0, 0.0, 0.0])
        measured = between(bare, motion, rng, optical_pose(REST), motion, surely)
    assert np.sqrt(np.diag(measured.covariance)).max() < 0.02


def test_of_an_image_that_hardly_measures_more_pixels_are_taken():
    full = np.full(SMALL.shape, 2.0)
    sparse = full.copy()
    sparse[:, SMALL.width // 8 :] = np.nan
    count = [np.isfinite(View.of(depth, SMALL, 300).points[..., 2]).sum() for depth in (full, sparse)]
    assert count[1] > 0.5 * count[0]
