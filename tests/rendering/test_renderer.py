"""The z-buffer against closed forms and against ray casting; tiles, batches, memory, and faults."""

import os
import subprocess
import sys

import numpy as np
import psutil
import pytest
import trimesh

from course_lib.geometry import optical_pose
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.chunks import MeshChunks
from course_lib.rendering.ray import EmbreeCaster
from course_lib.rendering.renderer import DepthRenderer, OpenGLError, RendererClosedError
from course_lib.rendering.scene_map import SceneMap
from course_lib.rendering.sensor import depth_image_from_points
from course_lib.rendering.vtk_backend import depth_from_buffer
from tests.rendering.shapes import (
    OFF_CENTRE,
    SMALL,
    neighbours_agree,
    random_states,
    random_triangles,
    room,
    room_depth,
    wall,
)

BACKENDS = ["raster", "vtk", "ray"]
HALF_MILLIMETRE = 5e-4


@pytest.fixture(params=BACKENDS)
def backend(request):
    return request.param


def test_a_wall_at_two_metres_reads_two_metres(backend):
    with DepthRenderer(wall(2.0), SMALL, backend) as renderer:
        image = renderer.render(np.zeros(6))
    assert image.shape == (1, 48, 64)
    assert image.dtype == np.float32
    assert np.abs(image - 2.0).max() < 1e-4


@pytest.mark.parametrize("camera", [SMALL, OFF_CENTRE], ids=["centred", "off-centre, fx unlike fy"])
def test_a_tilted_plane_reads_its_closed_form(backend, camera):
    """Distance d along the normal n: Z = d / (n . ray)."""
    with DepthRenderer(wall(3.0), camera, backend) as renderer:
        state = np.array([0.2, -0.4, 0.3, 0.3, -0.2, 0.35])
        image = renderer.render(state)[0]
    forward = (optical_pose(state)[:3, :3] @ camera.rays()[..., None])[..., 0, 0]
    expected = 2.8 / forward
    assert expected.max() < 10
    assert np.abs(image - expected).max() < HALF_MILLIMETRE


@pytest.mark.parametrize("camera", [SMALL, OFF_CENTRE], ids=["centred", "off-centre, fx unlike fy"])
@pytest.mark.parametrize("offset", [(0, 0, 0), (1000.0, -1000.0, 500.0)], ids=["at the origin", "1 km away"])
def test_a_room_corner_reads_its_closed_form(backend, camera, offset, rng):
    states = random_states(40, rng, spread=2.5)
    expected = room_depth(camera, states)
    with DepthRenderer(room(offset=offset), camera, backend) as renderer:
        images = renderer.render(states + np.array([*offset, 0, 0, 0]))
    assert np.isfinite(images).all()
    assert np.mean(np.abs(images - expected) < HALF_MILLIMETRE) >= 0.999


def test_a_sphere_reads_its_closed_form(backend):
    ball = trimesh.creation.icosphere(subdivisions=6, radius=1.0)
    ball.apply_translation([4.0, 0.0, 0.0])
    with DepthRenderer(SceneMap(ball.vertices, ball.faces), OFF_CENTRE, backend, exact=True) as renderer:
        image = renderer.render(np.zeros(6))[0]
    rays = OFF_CENTRE.rays()
    # |t ray - centre| = 1 with the centre 4 m ahead: the smaller root of a quadratic in t.
    a, b, c = (rays**2).sum(axis=-1), -8.0 * rays[..., 2], 15.0
    root = b**2 - 4 * a * c
    expected = np.where(root >= 0, (-b - np.sqrt(np.maximum(root, 0))) / (2 * a), np.inf)
    well_inside = root > 1.0  # a mesh of chords differs from the ball at its silhouette
    assert well_inside.sum() > 200
    assert np.abs(image[well_inside] - expected[well_inside]).max() < HALF_MILLIMETRE
    assert np.isinf(image[root < 0]).all()


def test_where_nothing_is_hit_depth_is_infinite(backend):
    with DepthRenderer(wall(2.0), SMALL, backend) as renderer:
        assert np.isinf(renderer.render([0, 0, 0, 0, 0, np.pi])).all()


def test_surfaces_outside_near_and_far_are_not_hit(backend):
    camera = SMALL.with_clip_planes(1.0, 3.0)
    with DepthRenderer(wall(2.0), camera, backend) as renderer:
        images = renderer.render([[x, 0, 0, 0, 0, 0] for x in (1.5, 0.5, -0.9, -1.5)])
    assert np.isinf(images[0]).all()  # 0.5 m ahead
    assert np.isfinite(images[1]).all()
    assert np.isfinite(images[2]).all()
    assert np.isinf(images[3]).all()  # 3.5 m ahead


def test_a_wall_before_near_does_not_hide_the_wall_behind_it(backend):
    camera = SMALL.with_clip_planes(1.0, 8.0)
    walls = [wall(0.5), wall(4.0)]
    vertices = np.concatenate([w.vertices for w in walls])
    both = SceneMap(vertices, np.concatenate([walls[0].faces, walls[1].faces + 4]))
    with DepthRenderer(both, camera, backend) as renderer:
        assert np.abs(renderer.render(np.zeros(6)) - 4.0).max() < HALF_MILLIMETRE


@pytest.mark.parametrize("n_triangles", [30, 400, 4000])
@pytest.mark.parametrize("camera", [SMALL, OFF_CENTRE, DepthCamera.sr4000(far=15.0)], ids=["small", "odd", "sr4000"])
def test_random_meshes_agree_with_ray_casting_away_from_silhouettes(n_triangles, camera, rng):
    scene = random_triangles(n_triangles, rng)
    states = random_states(12, rng)
    with DepthRenderer(scene, camera, "vtk") as drawn, DepthRenderer(scene, camera, "ray") as cast:
        z_buffer, rays = drawn.render(states), cast.render(states)
    # Same triangle over the whole neighbourhood, by an independent query of the ray caster.
    same = neighbours_agree(_triangle_ids(scene, camera, states)) & (rays <= 10.0)
    difference = np.abs(np.where(same, z_buffer, 0) - np.where(same, rays, 0))
    assert same.sum() > 1000
    assert np.mean(difference[same] <= HALF_MILLIMETRE) >= 0.999
    missed = neighbours_agree(np.isinf(rays)) & np.isinf(rays)
    assert np.isfinite(z_buffer[missed]).sum() <= 0.001 * missed.sum()


def _triangle_ids(scene, camera, states):
    caster = EmbreeCaster((scene.vertices - scene.origin)[scene.faces])
    ids = []
    for pose in optical_pose(states):
        directions = camera.rays().reshape(-1, 3) @ pose[:3, :3].T
        origins = pose[:3, 3] - scene.origin + camera.near * directions
        ids.append(caster.cast(origins, directions)[1].reshape(camera.shape))
    return np.array(ids)


@pytest.mark.parametrize("max_batch_pixels", [1, 64 * 48 * 7, 64 * 48 * 64, 10**7])
@pytest.mark.parametrize("n", [1, 2, 7, 8, 33])
def test_no_tile_or_row_is_mixed_up_for_any_number_of_views_and_any_window(n, max_batch_pixels, rng):
    states = random_states(n, rng, spread=2.5)
    expected = room_depth(OFF_CENTRE, states)
    with DepthRenderer(room(), OFF_CENTRE, "vtk", max_batch_pixels=max_batch_pixels) as renderer:
        for _ in range(2):
            images = renderer.render(states)
            assert np.mean(np.abs(images - expected) < 1e-3, axis=(1, 2)).min() >= 0.98


def test_two_thousand_views_are_each_in_their_place(rng):
    states = random_states(2000, rng, spread=2.5)
    with DepthRenderer(room(), SMALL, "vtk") as renderer:
        images = renderer.render(states)
    assert np.mean(np.abs(images - room_depth(SMALL, states)) < 1e-3, axis=(1, 2)).min() >= 0.98


def test_few_views_after_many_and_many_after_few(rng):
    states = random_states(300, rng, spread=2.5)
    with DepthRenderer(room(), SMALL, "vtk") as renderer:
        full = renderer.render(states)
        # Elsewhere in the window a tile may differ by one step of the 24-bit buffer.
        assert np.mean(np.abs(renderer.render(states[5:8]) - full[5:8]) < 1e-4) > 0.999
        assert np.array_equal(renderer.render(states), full)


def test_moving_the_world_and_the_camera_together_changes_nothing(backend, rng):
    states = random_states(6, rng, spread=2.0)
    shift = np.array([123.0, -456.0, 7.0])
    with DepthRenderer(room(), SMALL, backend) as here, DepthRenderer(room(offset=shift), SMALL, backend) as there:
        a, b = here.render(states), there.render(states + np.array([*shift, 0, 0, 0]))
    assert np.mean(np.abs(a - b) < 1e-4) > 0.999


def two_maps(first, second):
    """One map of the triangles of two."""
    return SceneMap(
        np.concatenate([first.vertices, second.vertices]),
        np.concatenate([first.faces, second.faces + len(first.vertices)]),
    )


@pytest.mark.parametrize("distance", [1e4, 1e6, 5e6, 1.9e7], ids=["10 km", "1,000 km", "5,000 km", "19,000 km"])
@pytest.mark.parametrize("direction", [(1, 0, 0), (-0.6, 0.6, 0.5)], ids=["ahead", "aslant"])
def test_a_stray_triangle_far_away_moves_nothing(backend, distance, direction, rng):
    states = random_states(10, rng, spread=2.5)
    place = distance * np.array(direction, dtype=float)
    stray = SceneMap(np.eye(3) + place, np.array([[0, 1, 2]]))
    with DepthRenderer(two_maps(room(), stray), SMALL, backend) as renderer:
        images = renderer.render(states)
    assert np.isfinite(images).all()
    assert np.abs(images - room_depth(SMALL, states)).max() < HALF_MILLIMETRE


@pytest.mark.parametrize("distance", [1e4, 5e6])
def test_one_corner_carried_far_away_moves_no_other_triangle(backend, distance, rng):
    """The triangle of that corner becomes a needle, here beyond the wall that is looked at."""
    needle = SceneMap(np.array([[3.5, 0, 0], [3.5, 0.1, 0], [distance, 0, 0]]), np.array([[0, 1, 2]]))
    states = random_states(10, rng, spread=2.5)
    with DepthRenderer(two_maps(room(), needle), SMALL, backend) as renderer:
        assert np.abs(renderer.render(states) - room_depth(SMALL, states)).max() < HALF_MILLIMETRE


@pytest.mark.parametrize("distance", [300.0, 1e4, 1e7])
def test_two_rooms_far_apart_are_each_exact_where_the_cameras_are(backend, distance, rng):
    offset = distance * np.array([1.0, -0.4, 0.01])
    states = random_states(6, rng, spread=2.5)
    there = states + np.array([*offset, 0, 0, 0])
    with DepthRenderer(two_maps(room(), room(offset=offset)), SMALL, backend) as renderer:
        here = renderer.render(states)
        assert np.abs(here - room_depth(SMALL, states)).max() < HALF_MILLIMETRE
        # Not less exact than the states themselves, whose float64 has steps of 2 nm there.
        assert np.abs(renderer.render(there) - room_depth(SMALL, states)).max() < HALF_MILLIMETRE
        assert np.array_equal(renderer.render(states), here)


def test_cameras_lost_in_space_see_nothing(backend):
    with DepthRenderer(room(), SMALL, backend) as renderer:
        assert np.isinf(renderer.render([[1e30, 0, 0, 0, 0, 0], [-1e30, 1e9, 0, 1, 1, 1]])).all()
        assert np.isfinite(renderer.render(np.zeros(6))).all()


def test_the_same_states_give_the_same_bytes(backend, rng):
    scene, states = random_triangles(500, rng), random_states(5, rng)
    with DepthRenderer(scene, SMALL, backend) as first, DepthRenderer(scene, SMALL, backend) as second:
        assert first.render(states).tobytes() == second.render(states).tobytes()


def test_leaving_out_what_no_view_can_see_changes_no_pixel(rng, monkeypatch):
    scene, states = random_triangles(3000, rng, spread=20.0), random_states(16, rng, spread=9.0)
    with DepthRenderer(scene, SMALL, "vtk") as renderer:
        culled = [renderer.render(state) for state in states]
        monkeypatch.setattr(MeshChunks, "visible", lambda self, camera, poses: np.ones(len(self.centers), dtype=bool))
        everything = [renderer.render(state) for state in states]
    assert np.array_equal(np.concatenate(culled), np.concatenate(everything))


def test_a_stopped_render_leaves_no_tile_in_the_way_of_the_measurement(monkeypatch):
    """Ctrl-C between drawing and reading, as in a stopped notebook cell: tile 0 and the points share their pixels."""
    points = SMALL.points(np.ones(SMALL.shape))
    with DepthRenderer(room(), SMALL, "vtk") as renderer:
        read = type(renderer._open_backend)._read_tiles

        def stop(self, out):
            monkeypatch.setattr(type(renderer._open_backend), "_read_tiles", read)
            raise KeyboardInterrupt

        monkeypatch.setattr(type(renderer._open_backend), "_read_tiles", stop)
        with pytest.raises(KeyboardInterrupt):
            renderer.render(np.zeros(6))
        assert np.abs(renderer.render_points(points) - 1.0).max() < HALF_MILLIMETRE


def test_ray_casting_without_embree_agrees_with_embree(monkeypatch, rng):
    scene, states = random_triangles(40, rng), random_states(3, rng)
    camera = SMALL.resized(16, 12)
    with DepthRenderer(scene, camera, "ray") as renderer:
        with_embree = renderer.render(states)
    monkeypatch.setattr("course_lib.rendering.embree.EmbreeScene", None)
    with DepthRenderer(scene, camera, "ray") as renderer:
        without = renderer.render(states)
        assert "trimesh" in renderer.describe()
    hit = np.isfinite(with_embree) & np.isfinite(without)
    assert np.mean(np.isfinite(with_embree) == np.isfinite(without)) > 0.99
    assert np.mean(np.abs(with_embree[hit] - without[hit]) < HALF_MILLIMETRE) > 0.99


@pytest.mark.parametrize("pose", [np.zeros((4, 4)), np.full((4, 4), np.nan), np.diag([1.0, 1.0, -1.0, 1.0])])
def test_a_pose_that_is_no_pose_is_refused(pose, backend):
    with DepthRenderer(room(), SMALL, backend) as renderer, pytest.raises(ValueError, match="rigid"):
        renderer.render_poses(pose[None])


def test_a_chunk_that_a_view_can_see_is_never_left_out(rng):
    scene = random_triangles(2000, rng, spread=20.0)
    chunks = MeshChunks(scene.vertices, scene.faces)
    poses = optical_pose(random_states(5, rng, spread=9.0))
    visible = np.zeros(len(scene.faces), dtype=bool)
    visible[chunks.order[chunks.faces_of(chunks.visible(OFF_CENTRE, poses))]] = True
    for pose in poses:
        corners = (scene.vertices[scene.faces] - pose[:3, 3]) @ pose[:3, :3]
        u, v, z = OFF_CENTRE.project(corners)
        inside = (z > 0) & (z < OFF_CENTRE.far) & (np.abs(u - 30) < 30.5) & (np.abs(v - 23) < 23.5)
        assert visible[inside.any(axis=1)].all()
    assert 0 < visible.sum() < len(visible)


def test_the_linearized_buffer_inverts_the_projection():
    near, far = SMALL.near, SMALL.far
    depth = np.array([0.1, 0.5, 3.0, 10.0])
    buffer = far * (depth - near) / (depth * (far - near))
    assert depth_from_buffer(buffer, SMALL, far) == pytest.approx(depth, rel=1e-6)
    assert np.isinf(depth_from_buffer(buffer, SMALL, 9.0)).tolist() == [False, False, False, True]
    assert np.isinf(depth_from_buffer(np.array([1.0], dtype=np.float32), SMALL, 0.99 * far)).all()


@pytest.mark.parametrize("camera", [SMALL, OFF_CENTRE], ids=["centred", "off-centre"])
def test_the_cameras_points_through_the_z_buffer_agree_with_numpy(backend, camera, rng):
    points = rng.uniform([-3, -3, -1], [3, 3, 18], (4000, 3))
    points[::7] = np.nan
    with DepthRenderer(room(), camera, backend) as renderer:
        drawn, reference = renderer.render_points(points), depth_image_from_points(points, camera)
        # A point within a thousandth of a pixel of a border may fall on either side of it.
        assert np.mean(np.isnan(drawn) == np.isnan(reference)) > 0.995
        both = np.isfinite(drawn) & np.isfinite(reference)
        assert both.sum() > 300
        assert np.mean(np.abs(drawn - reference)[both] < HALF_MILLIMETRE) > 0.995


def test_a_depth_image_comes_back_from_its_own_points(backend, rng):
    camera = DepthCamera.sr4000(far=15.0)
    depth = rng.uniform(0.5, 10, camera.shape).astype(np.float32)
    depth[rng.random(camera.shape) < 0.2] = np.nan
    with DepthRenderer(room(), camera, backend) as renderer:
        again = renderer.render_points(camera.points(depth))
        assert np.array_equal(np.isnan(again), np.isnan(depth))
        assert np.nanmax(np.abs(again - depth)) < HALF_MILLIMETRE
        # And the map is still there afterwards.
        assert np.isfinite(renderer.render(np.zeros(6))).all()


def test_no_points_give_an_image_without_measurement(backend):
    with DepthRenderer(room(), SMALL, backend) as renderer:
        assert np.isnan(renderer.render_points(np.full((5, 3), np.nan))).all()


def test_two_thousand_renders_keep_memory_flat(rng):
    scene, states = random_triangles(2000, rng), random_states(20, rng)
    process = psutil.Process()
    with DepthRenderer(scene, SMALL, "vtk") as renderer:
        for _ in range(20):
            renderer.render(states)
        before = process.memory_info().rss
        for _ in range(100):
            renderer.render(states + 0.01 * rng.standard_normal(6))
            renderer.render_points(rng.uniform([-1, -1, 1], [1, 1, 3], (3000, 3)))
        # Keeping every one of these 2,000 images would take 25 MB.
        assert process.memory_info().rss - before < 8e6


def test_a_closed_renderer_says_so(backend):
    renderer = DepthRenderer(room(), SMALL, backend)
    renderer.close()
    renderer.close()
    for use in (lambda: renderer.render(np.zeros(6)), lambda: renderer.render_points(np.zeros((1, 3)))):
        with pytest.raises(RendererClosedError, match="closed"):
            use()
    assert "closed" in repr(renderer)


@pytest.mark.parametrize("states", [np.zeros(5), np.zeros((2, 2, 6)), [[np.nan] * 6]])
def test_bad_states_are_refused(states, backend):
    with DepthRenderer(room(), SMALL, backend) as renderer, pytest.raises(ValueError, match="states"):
        renderer.render(states)


def test_no_states_give_no_images(backend):
    with DepthRenderer(room(), SMALL, backend) as renderer:
        assert renderer.render(np.zeros((0, 6))).shape == (0, 48, 64)


def test_an_unknown_backend_and_too_large_an_image_are_named():
    with pytest.raises(ValueError, match="ray"):
        DepthRenderer(room(), SMALL, "opengl")
    with pytest.raises(ValueError, match="resized"):
        DepthRenderer(room(), SMALL.resized(20_000, 10), "vtk")


def test_opengl_that_cannot_start_names_the_cure_and_the_other_backend():
    """In a process of its own, with the libraries of EGL's vendors hidden."""
    code = (
        "import numpy as np\n"
        "from course_lib.depth_mcl import DepthCamera, DepthRenderer, OpenGLError, SceneMap\n"
        "scene = SceneMap(np.array([[2., -9, -9], [2, 9, -9], [2, 0, 9]]), np.array([[0, 1, 2]]))\n"
        "camera = DepthCamera.sr4000()\n"
        "try:\n    DepthRenderer(scene, camera, 'vtk')\nexcept OpenGLError as error:\n    print('NAMED', error)\n"
        "print(np.median(DepthRenderer(scene, camera).render(np.zeros(6))))\n"
    )
    environment = os.environ | {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent", "DISPLAY": ""}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, timeout=1800)
    assert done.returncode == 0, done.stderr
    assert "NAMED" in done.stdout
    assert "libegl1" in done.stdout
    assert 'backend="raster"' in done.stdout
    assert done.stdout.strip().endswith("2.0")
    assert "Traceback" not in done.stderr
    assert issubclass(OpenGLError, RuntimeError)
