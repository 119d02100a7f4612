"""What `DepthRenderer` draws: closed forms, agreement of the three backends, near and far, distance, and bad input."""

import os
import subprocess
import sys

import numpy as np
import pytest

from course_lib.geometry import optical_pose
from course_lib.rendering import renderer as renderer_module
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.errors import OpenGLError, RendererClosedError
from course_lib.rendering.renderer import DepthRenderer, chosen_backend
from course_lib.rendering.scene_map import SceneMap
from course_lib.rendering.sensor import depth_image_from_points
from course_lib.rendering.vtk_backend import VtkBackend, depth_from_buffer
from tests.rendering.shapes import OFF_CENTRE, SMALL, random_states, random_triangles, room, room_depth, wall

HALF_MILLIMETRE = 5e-4


@pytest.fixture(params=["raster", "vtk", "ray"])
def backend(request):
    return request.param


def neighbours_agree(images):
    """Pixels `(N, H, W)` whose whole 3 x 3 neighbourhood holds the same value; image borders are left out."""
    windows = np.lib.stride_tricks.sliding_window_view(images, (3, 3), axis=(1, 2))
    same = (windows == images[:, 1:-1, 1:-1, None, None]).all(axis=(3, 4))
    return np.pad(same, ((0, 0), (1, 1), (1, 1)))


def joined(*maps):
    starts = np.cumsum([0, *(len(each.vertices) for each in maps)])
    faces = [each.faces + start for each, start in zip(maps, starts, strict=False)]
    return SceneMap(np.concatenate([each.vertices for each in maps]), np.concatenate(faces))


@pytest.mark.parametrize("camera", [SMALL, OFF_CENTRE], ids=["centred", "off-centre, fx unlike fy"])
def test_a_tilted_plane_reads_its_closed_form(backend, camera):
    """Distance d along the normal n: Z = d / (n . ray)."""
    with DepthRenderer(wall(3.0), camera, backend) as renderer:
        state = np.array([0.2, -0.4, 0.3, 0.3, -0.2, 0.35])
        images = renderer.render(state)
    assert (images.shape, images.dtype) == ((1, *camera.shape), np.float32)
    forward = (optical_pose(state)[:3, :3] @ camera.rays()[..., None])[..., 0, 0]
    assert np.abs(images[0] - 2.8 / forward).max() < HALF_MILLIMETRE


@pytest.mark.parametrize("camera", [SMALL, OFF_CENTRE], ids=["centred", "off-centre, fx unlike fy"])
@pytest.mark.parametrize("offset", [(0, 0, 0), (1000.0, -1000.0, 500.0)], ids=["at the origin", "1 km away"])
def test_a_room_corner_reads_its_closed_form(backend, camera, offset, rng):
    states = random_states(40, rng, spread=2.5)
    with DepthRenderer(room(offset=offset), camera, backend) as renderer:
        images = renderer.render(states + np.array([*offset, 0, 0, 0]))
    assert np.isfinite(images).all()
    assert np.mean(np.abs(images - room_depth(camera, states)) < HALF_MILLIMETRE) >= 0.999


@pytest.mark.parametrize("drawn", ["raster", "vtk"])
@pytest.mark.parametrize("n_triangles", [30, 4000])
@pytest.mark.parametrize("camera", [OFF_CENTRE, DepthCamera.sr4000(far=15.0)], ids=["odd", "sr4000"])
def test_random_meshes_agree_with_ray_casting_away_from_silhouettes(drawn, n_triangles, camera, rng):
    scene, states = random_triangles(n_triangles, rng), random_states(12, rng)
    with DepthRenderer(scene, camera, drawn) as ours, DepthRenderer(scene, camera, "ray") as reference:
        z_buffer, rays = ours.render(states), reference.render(states)
        # Same triangle over the whole neighbourhood.
        anchor, caster = reference._open_backend._anchor_and_caster
    ids = []
    for pose in optical_pose(states):
        directions = camera.rays().reshape(-1, 3) @ pose[:3, :3].T
        origins = pose[:3, 3] - anchor + camera.near * directions
        ids.append(caster.cast(origins, directions)[1].reshape(camera.shape))
    same = neighbours_agree(np.array(ids)) & (rays <= 10.0)
    assert same.sum() > 1000
    assert np.mean(np.abs(z_buffer[same] - rays[same]) <= HALF_MILLIMETRE) >= 0.999
    missed = neighbours_agree(np.isinf(rays)) & np.isinf(rays)
    assert np.isfinite(z_buffer[missed]).sum() <= 0.001 * missed.sum()


def test_ray_casting_without_embree_agrees_with_embree(monkeypatch, rng):
    scene, states, camera = random_triangles(40, rng), random_states(3, rng), SMALL.resized(16, 12)
    with DepthRenderer(scene, camera, "ray") as renderer:
        with_embree = renderer.render(states)
    monkeypatch.setattr("course_lib.rendering.ray.EmbreeScene", None)
    with DepthRenderer(scene, camera, "ray") as renderer:
        without = renderer.render(states)
        assert "trimesh" in renderer.describe()
    both = np.isfinite(with_embree) & np.isfinite(without)
    assert np.mean(np.isfinite(with_embree) == np.isfinite(without)) > 0.99
    assert np.mean(np.abs(with_embree[both] - without[both]) < HALF_MILLIMETRE) > 0.99


BOARD = np.array([[-1.5, -1.2, 1.0], [1.5, -1.2, 1.0], [1.5, 1.2, 1.0], [-1.5, 1.2, 1.0]])  # wider than the view
STATE = np.array([1.0, 2.0, 3.0, 0.1, 0.2, 0.3])


def board(depth, state=STATE):
    pose = optical_pose(state[None])[0]
    return SceneMap(depth * BOARD @ pose[:3, :3].T + pose[:3, 3], np.array([[0, 1, 2], [0, 2, 3]]))


@pytest.mark.parametrize("seed", range(3))
def test_near_and_far_mean_the_same_in_all_paths_up_to_rounding(backend, seed):
    """A surface on a plane, or within steps of float32 of it, is seen; one beyond it is not. Also by eq. (7)."""
    rng = np.random.default_rng(seed)
    near, state = 10 ** rng.uniform(-1.7, 0), rng.uniform([-80] * 3 + [-3] * 3, [80] * 3 + [3] * 3)
    camera = DepthCamera(16, 12, 9.0, 11.0, 6.7, 6.1, near, near * 10 ** rng.uniform(0.3, 2.5))
    step = camera.far**2 / (camera.near * 2**24)  # of the z-buffer
    on = [plane * (1 + rng.integers(-2, 3) * 2.0**-23) for plane in (camera.near, camera.far)]
    beyond = [camera.far + 1e-3 + 8 * step, 0.97 * camera.near]
    for depth, seen in [(depth, 1.0) for depth in on] + [(depth, 0.0) for depth in beyond]:
        points = depth * camera.rays()
        with DepthRenderer(board(depth, state), camera, backend) as renderer:
            assert np.isfinite(renderer.render(state)).mean() == seen
            assert np.isfinite(renderer.render_points(points)).mean() == seen
        assert np.isfinite(depth_image_from_points(points, camera)).mean() == seen


def test_a_surface_before_near_does_not_hide_the_one_on_far(backend):
    camera = DepthCamera(16, 12, 9.0, 11.0, 6.7, 6.1, near=0.5, far=4.0)
    with DepthRenderer(joined(board(0.49), board(4.0)), camera, backend) as renderer:
        assert np.abs(renderer.render(STATE) - 4.0).max() < 1e-3


def test_where_nothing_is_hit_depth_is_infinite_and_a_closed_renderer_says_so(backend):
    with DepthRenderer(room(), SMALL, backend) as renderer:
        assert np.isinf(renderer.render([[9.0, 0, 0, 0, 0, 0], [1e30, 0, 0, 0, 0, 0]])).all()
    renderer.close()
    for use in (lambda: renderer.render(np.zeros(6)), lambda: renderer.render_points(np.zeros((1, 3)))):
        with pytest.raises(RendererClosedError, match="closed"):
            use()


@pytest.mark.parametrize("distance", [1e4, 1.9e7], ids=["10 km", "19,000 km"])
@pytest.mark.parametrize("shape", ["stray triangle", "needle", "another room"])
def test_what_lies_far_away_moves_nothing_that_is_near(backend, distance, shape, rng):
    """The needle is a triangle of which one corner was carried away."""
    needle = np.array([[-distance + 3.5, 0, 0], [-distance + 3.5, 0.1, 0], [0, 0, 0]])
    corners = np.eye(3) if shape == "stray triangle" else needle
    offset = distance * np.array([1.0, 0, 0] if shape == "needle" else [1.0, -0.4, 0.01])
    far = room(offset=offset) if shape == "another room" else SceneMap(corners + offset, np.array([[0, 1, 2]]))
    states = random_states(6, rng, spread=2.5)
    with DepthRenderer(joined(room(), far), SMALL, backend) as renderer:
        assert np.abs(renderer.render(states) - room_depth(SMALL, states)).max() < HALF_MILLIMETRE
        if shape == "another room":
            there = renderer.render(states + np.array([*offset, 0, 0, 0]))
            assert np.abs(there - room_depth(SMALL, states)).max() < HALF_MILLIMETRE


def test_depths_of_a_floor_of_kilometres_are_right_to_a_millimetre(backend, rng):
    camera = DepthCamera.sr4000().resized(44, 36)
    states = rng.uniform([-2, -2, 0.5, -0.3, -0.3, -3], [2, 2, 2, 0.3, 0.3, 3], (20, 6))
    poses = optical_pose(states)
    height = (camera.rays() @ poses[:, None, :3, :3].transpose(0, 1, 3, 2))[..., 2]
    with np.errstate(divide="ignore"):
        exact = -poses[:, None, None, 2, 3] / height
    seen = (exact > camera.near) & (exact < 0.99 * camera.farthest)
    corners = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]) * 3000 + [120.123, 450.456, 0]
    with DepthRenderer(SceneMap(corners, np.array([[0, 1, 2], [0, 2, 3]])), camera, backend) as renderer:
        error = np.abs(renderer.render(states)[seen] - exact[seen])
    assert seen.sum() > 1000
    assert np.median(error) < 0.0002
    assert np.quantile(error, 0.99 if backend == "vtk" else 0.999) < 0.001  # OpenGL divides in single precision


@pytest.mark.parametrize("size", [(1, 1), (9, 17)])
@pytest.mark.parametrize("n", [0, 1, 33])
@pytest.mark.parametrize("max_batch_pixels", [1, 64 * 48 * 7])
def test_no_image_is_mixed_up_for_any_size_number_of_views_or_batch(backend, size, n, max_batch_pixels, rng):
    camera = OFF_CENTRE.resized(*size)
    states = random_states(n, rng, spread=2.5)
    with DepthRenderer(room(), camera, backend, max_batch_pixels=max_batch_pixels) as renderer:
        for _ in range(2):
            images = renderer.render(states)
            assert images.shape == (n, *camera.shape)
            assert n == 0 or np.mean(np.abs(images - room_depth(camera, states)) < 1e-3) >= 0.98


def test_few_views_after_many_and_a_stopped_render_leaves_no_tile_in_the_way_of_the_measurement(rng, monkeypatch):
    states = random_states(1200, rng, spread=2.5)  # more than one window has tiles
    with DepthRenderer(room(), SMALL, "vtk") as renderer:
        full = renderer.render(states)
        assert np.mean(np.abs(full - room_depth(SMALL, states)) < 1e-3, axis=(1, 2)).min() >= 0.98
        # Elsewhere in the window a tile may differ by one step of the 24-bit buffer.
        assert np.mean(np.abs(renderer.render(states[5:8]) - full[5:8]) < 1e-4) > 0.999
        assert np.array_equal(renderer.render(states), full)

    # Ctrl-C between drawing and reading, as in a stopped notebook cell: tile 0 and the points share their pixels.
    def stop(self, out):
        raise KeyboardInterrupt

    points = SMALL.points(np.ones(SMALL.shape))
    with DepthRenderer(room(), SMALL, "vtk") as renderer:
        with monkeypatch.context() as patched:
            patched.setattr(VtkBackend, "_read_tiles", stop)
            with pytest.raises(KeyboardInterrupt):
                renderer.render(np.zeros(6))
        assert np.abs(renderer.render_points(points) - 1.0).max() < HALF_MILLIMETRE


def test_the_same_states_give_the_same_bytes(backend, rng):
    scene, states = random_triangles(500, rng), random_states(5, rng)
    with DepthRenderer(scene, SMALL, backend) as first, DepthRenderer(scene, SMALL, backend) as second:
        assert first.render(states).tobytes() == second.render(states).tobytes()


def test_the_linearized_buffer_inverts_the_projection():
    near, far = SMALL.near, SMALL.far
    depth = np.array([0.1, 0.5, 3.0, 10.0])
    buffer = far * (depth - near) / (depth * (far - near))
    assert depth_from_buffer(buffer, SMALL, far) == pytest.approx(depth, rel=1e-6)
    assert np.isinf(depth_from_buffer(buffer, SMALL, 9.0)).tolist() == [False, False, False, True]


@pytest.mark.parametrize("camera", [SMALL, OFF_CENTRE], ids=["centred", "off-centre"])
def test_the_cameras_points_through_the_z_buffer_agree_with_numpy(backend, camera, rng):
    points = rng.uniform([-3, -3, -1], [3, 3, 18], (4000, 3))
    points[::7] = np.nan
    with DepthRenderer(room(), camera, backend) as renderer:
        drawn, reference = renderer.render_points(points), depth_image_from_points(points, camera)
        assert np.isnan(renderer.render_points(np.full((5, 3), np.nan))).all()
        assert np.isfinite(renderer.render(np.zeros(6))).all()  # the map is still there
    # A point within a thousandth of a pixel of a border may fall on either side of it.
    assert np.mean(np.isnan(drawn) == np.isnan(reference)) > 0.995
    both = np.isfinite(drawn) & np.isfinite(reference)
    assert both.sum() > 300
    assert np.mean(np.abs(drawn - reference)[both] < HALF_MILLIMETRE) > 0.995


def test_what_is_no_state_no_pose_no_backend_or_too_large_is_named():
    with DepthRenderer(room(), SMALL) as renderer:
        for states in (np.zeros(5), np.zeros((2, 2, 6)), [[np.nan] * 6]):
            with pytest.raises(ValueError, match=r"states|camera_to_world"):
                renderer.render(states)
        for pose in (np.zeros((4, 4)), np.full((4, 4), np.nan), np.diag([1.0, 1.0, -1.0, 1.0])):
            with pytest.raises(ValueError, match="rigid"):
                renderer.render_poses(pose[None])
    with pytest.raises(ValueError, match="'auto', 'vtk'"):
        DepthRenderer(room(), SMALL, "opengl")
    with pytest.raises(ValueError, match="resized"):
        DepthRenderer(room(), SMALL.resized(20_000, 10), "vtk")


@pytest.fixture
def undecided():
    """No process has chosen a backend yet, and the test's choice does not stay."""
    chosen_backend.cache_clear()
    yield
    chosen_backend.cache_clear()


CARDS = ["NVIDIA H100/PCIe/SSE2", "AMD Radeon (radeonsi, navi21, LLVM 15.0.6)"]
NO_CARDS = ["llvmpipe (LLVM 15.0.6, 256 bits)", "Apple Software Renderer", OpenGLError("no EGL")]


@pytest.mark.usefixtures("undecided")
@pytest.mark.parametrize(
    ("opengl", "chosen"), [*((card, "vtk") for card in CARDS), *((name, "raster") for name in NO_CARDS)]
)
def test_auto_is_vtk_where_opengl_is_on_a_graphics_card(monkeypatch, opengl, chosen):
    def name(self):
        if isinstance(opengl, Exception):
            raise opengl
        return opengl

    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setattr(renderer_module, "CARDS", ("null",))
    monkeypatch.setattr(VtkBackend, "describe", name)
    assert chosen_backend("auto") == chosen
    with DepthRenderer(wall(2.0), SMALL) as renderer:
        assert renderer.backend == chosen
        assert np.abs(renderer.render(np.zeros(6)) - 2.0).max() < 1e-4
    # What OpenGL cannot draw is drawn all the same, as it is not asked for by name.
    with DepthRenderer(wall(2.0), SMALL.resized(20_000, 10)) as renderer:
        assert renderer.backend == "raster"


@pytest.mark.usefixtures("undecided")
def test_auto_opens_no_window_where_linux_has_no_card(monkeypatch):
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setattr(renderer_module, "CARDS", ("no such file",))
    monkeypatch.setattr(VtkBackend, "__init__", lambda *_: pytest.fail("a window was opened"))
    assert chosen_backend("auto") == "raster"
    assert [chosen_backend(name) for name in ("vtk", "raster", "ray")] == ["vtk", "raster", "ray"]


def test_opengl_that_cannot_start_names_the_cure_and_the_other_backend():
    """In a process of its own, with the libraries of EGL's vendors hidden."""
    code = (
        "import numpy as np\n"
        "from course_lib.depth_mcl import DepthCamera, DepthRenderer, OpenGLError, SceneMap\n"
        "from course_lib.rendering import renderer\n"
        "renderer.CARDS = ('null',)\n"
        "scene = SceneMap(np.array([[2., -9, -9], [2, 9, -9], [2, 0, 9]]), np.array([[0, 1, 2]]))\n"
        "camera = DepthCamera.sr4000()\n"
        "try:\n    DepthRenderer(scene, camera, 'vtk')\nexcept OpenGLError as error:\n    print('NAMED', error)\n"
        "print(np.median(DepthRenderer(scene, camera).render(np.zeros(6))))\n"
    )
    environment = os.environ | {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent", "DISPLAY": ""}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, timeout=1800)
    assert done.returncode == 0, done.stderr
    assert all(word in done.stdout for word in ("NAMED", "libegl1", 'backend="raster"'))
    assert done.stdout.strip().endswith("2.0")
