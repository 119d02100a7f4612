"""Gauss-Newton on the rendered depth: the equation, its compiled form, and where it leads."""

import numpy as np
import pytest

from course_lib.beyond.six_dof.poses import lengths, local, retract
from course_lib.beyond.six_dof.refinement import (
    LONGEST_STEP,
    compiled_normal_equations,
    normal_equations,
    refine,
    solve,
    surface_normals,
)
from course_lib.geometry import optical_pose
from course_lib.rendering.renderer import DepthRenderer
from tests.rendering.shapes import OFF_CENTRE, SMALL, furnished_room, random_triangles

TRUE = optical_pose(np.array([-0.5, 0.2, -0.4, 0.05, 0.1, 0.6]))
SCALES = (0.2, 0.15, 0.1, 0.05, 0.05)


@pytest.fixture(scope="module")
def renderer():
    with DepthRenderer(furnished_room(), SMALL, "ray") as opened:
        yield opened


def near_poses(rng, n, position, rotation):
    return retract(TRUE, np.array([position] * 3 + [rotation] * 3) * rng.standard_normal((n, 6)))


@pytest.mark.parametrize("camera", [SMALL, OFF_CENTRE])
def test_the_compiled_sums_are_the_equations_sums(rng, camera):
    with DepthRenderer(random_triangles(60, rng), camera, "ray") as renderer:
        images = renderer.render_poses(near_poses(rng, 5, 0.05, 0.03))
    measured = images[0] + 0.02 * rng.standard_normal(images[0].shape).astype(np.float32)
    measured[rng.random(measured.shape) < 0.2] = np.nan
    measured[np.isinf(measured)] = np.nan
    plain = normal_equations(measured, images, camera, 0.1)
    compiled = compiled_normal_equations(measured, images, camera, 0.1)
    assert plain.weights[0] > 100
    for name in plain._fields:
        assert getattr(compiled, name) == pytest.approx(getattr(plain, name), rel=1e-6, abs=1e-6), name


def test_the_right_hand_side_is_the_gradient_and_no_step_is_longer_than_first_order_reaches(renderer):
    """Numerically, with the surface held still: every measured point moved by a small motion of the camera."""
    image = renderer.render_poses(TRUE[None])[0].astype(float)
    measured = np.where(np.isfinite(image), image + 0.01, np.nan)
    (q,), (n,) = surface_normals(image[None], SMALL)
    p = SMALL.points(measured)

    def cost(motion):
        small = retract(np.eye(4), motion)
        residuals = np.sum(n * (p @ small[:3, :3].T + small[:3, 3] - q), axis=-1)
        return np.nansum(residuals**2) / 2

    system = normal_equations(measured, image[None], SMALL, 1e6)  # a scale so wide that all pixels weigh 1
    numeric = [(cost(1e-5 * e) - cost(-1e-5 * e)) / 2e-5 for e in np.eye(6)]
    assert system.vectors[0] == pytest.approx(numeric, rel=1e-4, abs=1e-4)
    assert system.weights[0] == pytest.approx(np.isfinite(n).all(axis=-1).sum(), rel=1e-6)
    measured = renderer.render_poses(TRUE[None])[0]
    far = retract(TRUE, np.array([0.3, 0.2, -0.8, 0.3, 0.4, 0.2]))
    images = renderer.render_poses(far[None])
    motion = lengths(solve(normal_equations(measured, images, SMALL, 10.0)))[0]
    assert (motion <= np.array(LONGEST_STEP) * (1 + 1e-9)).all()
    assert (motion / LONGEST_STEP).max() == pytest.approx(1.0)


def test_poses_near_the_right_one_come_to_it(renderer, rng):
    measured = renderer.render_poses(TRUE[None])[0]
    off = lengths(local(TRUE, refine(renderer, measured, near_poses(rng, 30, 0.05, 0.04), SCALES)))
    assert (np.median(off, axis=0) < [0.002, 0.001]).all()
    assert (off[:, 0] < 0.02).mean() > 0.75
    measured[10:40, 20:32] = 0.8
    off = lengths(local(TRUE, refine(renderer, measured, near_poses(rng, 20, 0.04, 0.03), SCALES)))
    assert np.median(off[:, 0]) < 0.01, "a person in the way pulls little"
