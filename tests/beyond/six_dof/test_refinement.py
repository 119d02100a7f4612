"""Gauss-Newton on the rendered depth: the equation, its compiled form, and where it leads."""

import warnings

import numpy as np
import pytest

from course_lib.beyond.six_dof import compiled_refinement, refinement
from course_lib.beyond.six_dof.poses import lengths, local, retract
from course_lib.beyond.six_dof.refinement import (
    DAMPING,
    LONGEST_STEP,
    NormalEquations,
    normal_equations,
    refine,
    solve,
)
from course_lib.geometry import optical_pose
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from tests.rendering.shapes import OFF_CENTRE, SMALL, furnished_room, random_triangles, wall

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
    compiled = compiled_refinement.normal_equations(measured, images, camera, 0.1)
    assert plain.weights[0] > 100
    for name in plain._fields:
        assert getattr(compiled, name) == pytest.approx(getattr(plain, name), rel=1e-6, abs=1e-6), name


def test_the_jacobian_is_the_residuals_derivative(renderer):
    """Numerically, with the surface held still: every measured point moved by a small motion of the camera."""
    image = renderer.render_poses(TRUE[None])[0].astype(float)
    measured = np.where(np.isfinite(image), image + 0.01, np.nan)
    q, n = refinement.surface_normals(image[None], SMALL)
    p = SMALL.points(measured)

    def residual(motion):
        return np.nansum((n[0] * (retract(np.eye(4), motion)[:3, :3] @ p[..., None])[..., 0]).sum(-1)
                         + (n[0] * (motion[:3] - q[0])).sum(-1))  # fmt: skip

    system = normal_equations(measured, image[None], SMALL, 1e6)  # so wide that all weigh 1
    jacobian = np.nansum(np.concatenate([n[0], np.cross(np.broadcast_to(p, n[0].shape), n[0])], axis=-1), axis=(0, 1))
    step = 1e-6
    numeric = [(residual(step * e) - residual(-step * e)) / (2 * step) for e in np.eye(6)]
    assert numeric == pytest.approx(jacobian, rel=1e-3, abs=1e-2)
    assert system.weights[0] == pytest.approx(np.isfinite(n[0]).all(axis=-1).sum(), rel=1e-6)


def test_poses_near_the_right_one_come_to_it(renderer, rng):
    measured = renderer.render_poses(TRUE[None])[0]
    refined = refine(renderer, measured, near_poses(rng, 30, 0.05, 0.04), SCALES)
    off = lengths(local(TRUE, refined))
    assert np.median(off[:, 0]) < 0.002
    assert np.median(off[:, 1]) < 0.001
    assert (off[:, 0] < 0.02).mean() > 0.75


def test_a_person_in_the_way_pulls_little(renderer, rng):
    measured = renderer.render_poses(TRUE[None])[0].copy()
    measured[10:40, 20:32] = 0.8
    refined = refine(renderer, measured, near_poses(rng, 20, 0.04, 0.03), SCALES)
    assert np.median(lengths(local(TRUE, refined))[:, 0]) < 0.01


def test_along_a_bare_wall_the_pose_stays_where_it_is():
    with DepthRenderer(wall(2.0), SMALL, "ray") as renderer:
        facing = optical_pose(np.zeros(6))
        measured = renderer.render_poses(facing[None])[0]
        start = retract(facing, np.array([0.1, 0.07, 0.05, 0.0, 0.0, 0.0]))  # right, down, forward
        refined = refine(renderer, measured, start[None], SCALES)[0]
    along = local(facing, refined)
    assert along[2] == pytest.approx(0.0, abs=1e-3), "the distance from the wall is seen"
    assert along[:2] == pytest.approx([0.1, 0.07], abs=1e-3), "along it nothing is"


def test_nothing_to_compare_moves_nothing(renderer):
    nothing = np.full(SMALL.shape, np.nan)
    for measured in (nothing, np.full(SMALL.shape, 2.0)):
        images = np.full((2, *SMALL.shape), np.inf, dtype=np.float32)
        system = compiled_refinement.normal_equations(measured, images, SMALL, 0.1)
        assert not system.weights.any()
        assert solve(system) == pytest.approx(np.zeros((2, 6)))


def test_no_step_is_longer_than_first_order_reaches(renderer):
    measured = renderer.render_poses(TRUE[None])[0]
    far = retract(TRUE, np.array([0.3, 0.2, -0.8, 0.3, 0.4, 0.2]))
    images = renderer.render_poses(far[None])
    motion = lengths(solve(normal_equations(measured, images, SMALL, 10.0)))[0]
    assert (motion <= np.array(LONGEST_STEP) * (1 + 1e-9)).all()
    assert (motion / LONGEST_STEP).max() == pytest.approx(1.0)


def test_damping_is_the_only_difference_from_the_plain_solution(renderer, rng):
    measured = renderer.render_poses(TRUE[None])[0]
    images = renderer.render_poses(near_poses(rng, 1, 0.02, 0.02))
    system = normal_equations(measured, images, SMALL, 0.1)
    plain = -np.linalg.solve(system.matrices[0], system.vectors[0])
    assert solve(system, damping=0.0)[0] == pytest.approx(plain)
    assert solve(system, damping=DAMPING)[0] == pytest.approx(plain, abs=0.01)


def test_rounding_along_what_is_not_seen_moves_nothing():
    matrices = np.diag([1.0, 0.0, 1.0, 1.0, 1.0, 0.0])[None] * 500
    vectors = np.array([[0.0, 1e-7, 0.0, 0.0, 0.0, 1e-7]]) * 500
    motion = solve(NormalEquations(matrices, vectors, np.ones(1), np.full(1, 500.0)))
    assert np.abs(motion).max() < 0.01


def test_what_the_map_does_not_hold_has_no_normal_and_raises_no_warning():
    camera = DepthCamera(9, 7, 8.0, 8.0, 4.0, 3.0, 0.1, 10.0)  # the ray of its middle has zeros in it
    image = np.full((1, 7, 9), 2.0, dtype=np.float32)
    image[0, :4] = np.inf
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        points, normals = refinement.surface_normals(image, camera)
    assert np.isnan(points[0, :4]).all()
    assert np.isnan(normals[0, :5]).all()
    assert np.isfinite(normals[0, 5:-1, 1:-1]).all()
