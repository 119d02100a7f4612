"""Maps and cameras: what they accept, what they refuse, and the projection."""

import pickle
import warnings

import numpy as np
import pytest
import trimesh

from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.scene_map import SceneMap, SceneMapError, SceneMapWarning
from course_lib.rendering.sensor import depth_image_from_points, subsample_depth
from tests.rendering.shapes import OFF_CENTRE, SMALL, room

TRIANGLE = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])


@pytest.mark.parametrize("suffix", ["ply", "obj", "stl", "glb"])
def test_every_mesh_format_gives_the_same_triangles(suffix, tmp_path):
    box = trimesh.creation.box((1, 2, 3))
    box.export(tmp_path / f"box.{suffix}")
    scene = SceneMap.load(tmp_path / f"box.{suffix}")
    assert len(scene) == 12
    assert np.allclose(scene.bounds, [[-0.5, -1, -1.5], [0.5, 1, 1.5]])


@pytest.mark.parametrize(
    ("vertices", "faces", "said"),
    [
        (np.empty((0, 3)), np.empty((0, 3), int), "vertices"),
        (TRIANGLE, np.empty((0, 3), int), "triangles"),
        (TRIANGLE * [1, np.nan, 1], [[0, 1, 2]], "NaN"),
        (TRIANGLE, [[0, 1, 3]], "faces"),
        (TRIANGLE, [[0, 1, -1]], "faces"),
        (TRIANGLE, [[0.0, 1.0, 2.0]], "whole numbers"),
        (TRIANGLE[:, :2], [[0, 1, 2]], "vertices"),
        (TRIANGLE, [[0, 0, 1]], "area"),
    ],
)
def test_a_mesh_that_is_no_map_is_named(vertices, faces, said):
    with pytest.raises(SceneMapError, match=said):
        SceneMap(vertices, np.asarray(faces))


def test_a_truncated_file_is_named(tmp_path):
    path = tmp_path / "map.ply"
    trimesh.creation.icosphere().export(path)
    path.write_bytes(path.read_bytes()[:900])
    with pytest.raises(SceneMapError, match=r"map\.ply"):
        SceneMap.load(path)


@pytest.mark.parametrize("share", [0.8, 0.95, 0.999])
@pytest.mark.parametrize("suffix", ["ply", "off"])
def test_a_truncated_text_file_is_named(suffix, share, tmp_path):
    """trimesh reads what is there; the header tells what should be."""
    path = tmp_path / f"map.{suffix}"
    ball = trimesh.creation.icosphere()
    text = ball.export(file_type="ply", encoding="ascii") if suffix == "ply" else ball.export(file_type="off").encode()
    path.write_bytes(text)
    assert len(SceneMap.load(path)) == len(ball.faces)
    path.write_bytes(path.read_bytes()[: int(share * path.stat().st_size)])
    with pytest.raises(SceneMapError, match=rf"map\.{suffix}"):
        SceneMap.load(path)


def test_a_file_that_is_no_mesh_is_named(tmp_path):
    path = tmp_path / "map.ply"
    path.write_text("hello")
    with pytest.raises(SceneMapError, match=r"map\.ply"):
        SceneMap.load(path)


def test_a_point_cloud_is_named(tmp_path):
    path = tmp_path / "points.ply"
    trimesh.PointCloud(np.random.default_rng(0).random((10, 3))).export(path)
    with pytest.raises(SceneMapError, match="no triangles"):
        SceneMap.load(path)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"map .* is missing"):
        SceneMap.load(tmp_path / "nowhere.ply")


def test_a_map_cannot_be_changed_behind_the_renderer():
    given = np.array(TRIANGLE)
    scene = SceneMap(given, np.array([[0, 1, 2]]))
    with pytest.raises(ValueError, match="read-only"):
        scene.vertices[0] = 0
    given[0] = 7.0
    assert (scene.vertices[0] == 0).all()


def test_a_map_is_only_moved_rigidly():
    assert np.allclose(room(2.0).transformed(np.eye(4)).vertices, room(2.0).vertices)
    with pytest.raises(ValueError, match="rigid"):
        room().transformed(np.diag([2.0, 2, 2, 1]))


@pytest.mark.parametrize("distance", [1e4, 1e6, 5e6])
def test_the_origin_is_where_most_of_the_map_is(distance):
    here = room()
    vertices = np.concatenate([here.vertices, TRIANGLE + distance])
    scene = SceneMap(vertices, np.concatenate([here.faces, [[8, 9, 10]]]))
    assert (np.abs(scene.origin) <= 3.0).all()
    assert scene.bounds[1].max() > distance


def test_the_anchor_is_the_origin_near_it_and_follows_the_cameras_by_whole_steps():
    here, offset = room(), np.array([1e6, 0, 0])
    scene = SceneMap(
        np.concatenate([here.vertices, here.vertices[::-1] + offset, TRIANGLE]),
        np.concatenate([here.faces, here.faces + 8, [[16, 17, 18]]]),
    )
    assert np.array_equal(scene.anchor(scene.origin + np.full((3, 3), 40.0)), scene.origin)
    there = scene.anchor(np.array([[1e6, 1, 2], [1e6 + 5, 0, 0], [0, 0, 0]]))
    assert np.abs(there - offset).max() <= 87
    assert np.array_equal(there, scene.anchor(np.array([[1e6 + 1, 0, 0]])))
    assert np.array_equal(scene.anchor(np.zeros((0, 3))), scene.origin)
    # Cameras that have left the map draw its anchor no farther than its edge.
    assert np.abs(scene.anchor(np.array([[1e30, 0, 0]]))).max() < 1e6 + 100


@pytest.mark.parametrize("coordinate", [6e3, 1e4, 1e6, 3e7, -1e20, 7.7e37])
def test_a_triangle_that_cannot_belong_to_a_building_is_named_and_can_be_dropped(coordinate, tmp_path):
    box = room()
    vertices = np.concatenate([box.vertices, TRIANGLE])
    vertices[-1, 1] = coordinate
    trimesh.Trimesh(vertices, np.concatenate([box.faces, [[8, 9, 10]]]), process=False).export(tmp_path / "map.ply")
    with pytest.raises(SceneMapError, match=r"map\.ply: 1 of 13 triangles .* triangle 12 has a corner at") as raised:
        SceneMap.load(tmp_path / "map.ply")
    assert f"{np.float32(coordinate):g}" in str(raised.value)
    cure = str(raised.value).split("such triangles out: ")[1].split(", or ")[0]
    found = eval(cure, {"SceneMap": SceneMap, "path": tmp_path / "map.ply"})
    assert np.allclose(found.bounds, box.bounds)


def test_no_map_lies_beyond_the_earth():
    with pytest.raises(SceneMapError, match=r"1 of 1 triangles lie beyond 2e\+07 m"):
        SceneMap(TRIANGLE + np.array([3e7, 0, 0]), [[0, 1, 2]])


def saved(path, vertices, faces):
    trimesh.Trimesh(vertices, faces, process=False).export(path)
    return path


@pytest.mark.parametrize(
    ("vertices", "faces", "doubt"),
    [
        (room().vertices * 400, room().faces, "are these millimetres"),
        (
            np.concatenate([room().vertices, TRIANGLE + np.array([900.0, 0, 0])]),
            np.concatenate([np.tile(room().faces, (20, 1)), [[8, 9, 10]]]),
            "triangle 240 at .* from the middle. Does it belong",
        ),
        (room().vertices + np.array([500_000, 5_300_000, 0]), room().faces, "steps of 500 mm"),
    ],
)
def test_a_map_that_looks_as_if_it_were_not_meant_is_used_with_a_warning(vertices, faces, doubt, tmp_path):
    with pytest.warns(SceneMapWarning, match=doubt) as told:
        SceneMap.load(saved(tmp_path / "map.ply", vertices, faces))
    assert len(told) == 1


def test_maps_of_buildings_are_not_doubted(tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        SceneMap.load(saved(tmp_path / "room.ply", room().vertices, room().faces))
        SceneMap.load(saved(tmp_path / "tunnel.ply", room().vertices * [400, 1, 1], room().faces))
        SceneMap.load(saved(tmp_path / "city.ply", room().vertices + np.array([3000, 2000, 100]), room().faces))


def test_a_map_that_travelled_is_the_same_and_as_frozen():
    scene = room(2.0)
    again = pickle.loads(pickle.dumps(scene))
    assert np.array_equal(again.vertices, scene.vertices)
    assert np.array_equal(again.faces, scene.faces)
    assert np.array_equal(again.origin, scene.origin)
    with pytest.raises(ValueError, match="read-only"):
        again.vertices[0] = 0


def test_contains_has_a_margin():
    assert room(2.0).contains([[0, 0, 0], [1.5, 0, 0]], margin=0.0).tolist() == [True, False]
    assert room(2.0).contains([1.5, 0, 0], margin=1.0)


def test_the_sr4000_has_the_papers_pixels_and_the_data_sheets_view():
    camera = DepthCamera.sr4000()
    assert camera.shape == (144, 176)
    assert (round(camera.fx, 1), round(camera.fy, 1)) == (220.0, 231.2)
    assert (camera.cx, camera.cy) == (87.5, 71.5)


def test_points_project_back_onto_their_pixels(rng):
    depth = rng.uniform(0.5, 5, OFF_CENTRE.shape)
    u, v, z = OFF_CENTRE.project(OFF_CENTRE.points(depth))
    assert np.allclose(u, np.arange(61)[None, :])
    assert np.allclose(v, np.arange(47)[:, None])
    assert np.allclose(z, depth)


def test_resizing_keeps_the_image_edges():
    half = OFF_CENTRE.resized(30, 20)
    for pixel, size, focal, c in ((-0.5, 61, "fx", "cx"), (60.5, 61, "fx", "cx")):
        edge = (pixel - getattr(OFF_CENTRE, c)) / getattr(OFF_CENTRE, focal)
        small_pixel = -0.5 if pixel < 0 else 29.5
        assert (small_pixel - getattr(half, c)) / getattr(half, focal) == pytest.approx(edge)
        assert size == OFF_CENTRE.width


def test_the_projection_matrix_puts_pixel_centres_and_planes_where_opengl_looks_for_them():
    camera = OFF_CENTRE
    for u, v, z in ((0, 0, camera.near), (camera.width - 1, camera.height - 1, camera.far)):
        x, y = (u - camera.cx) * z / camera.fx, (v - camera.cy) * z / camera.fy
        clip = camera.projection_matrix() @ [x, -y, -z, 1]
        ndc = clip[:3] / clip[3]
        assert (ndc[0] + 1) / 2 * camera.width == pytest.approx(u + 0.5)
        assert (1 - ndc[1]) / 2 * camera.height == pytest.approx(v + 0.5)
        assert ndc[2] == pytest.approx(-1 if z == camera.near else 1)


@pytest.mark.parametrize(
    "change",
    [
        {"width": 0},
        {"height": 2.5},
        {"fx": 0},
        {"fy": -1.0},
        {"near": 0},
        {"near": 20.0},
        {"far": np.inf},
        {"cx": np.nan},
    ],
)
def test_a_camera_that_cannot_be_is_named(change):
    values = {"width": 64, "height": 48, "fx": 50.0, "fy": 50.0, "cx": 31.5, "cy": 23.5, "near": 0.1, "far": 15.0}
    with pytest.raises(ValueError, match=next(iter(change))):
        DepthCamera(**values | change)


def test_intrinsics_for_another_image_size_are_named():
    matrix = np.array([[585.0, 0, 319.5], [0, 585, 239.5], [0, 0, 1]])
    assert DepthCamera.from_matrix(matrix, 640, 480).cx == 319.5
    for width, height in ((160, 120), (320, 240), (1280, 960), (2560, 1920)):
        with pytest.raises(ValueError, match="another image size"):
            DepthCamera.from_matrix(matrix, width, height)


@pytest.mark.parametrize("matrix", [np.eye(4), np.full((3, 3), np.nan), [[500, 3, 80], [0, 500, 60], [0, 0, 1]]])
def test_a_matrix_that_is_no_k_is_named(matrix):
    with pytest.raises(ValueError, match="intrinsics"):
        DepthCamera.from_matrix(matrix, 160, 120)


def test_of_several_points_on_a_pixel_the_nearest_counts():
    points = np.array([[0.0, 0, 4], [0, 0, 2], [0, 0, 3]]) * [[1, 1, 1]]
    camera = DepthCamera(3, 3, 10, 10, 1, 1)
    image = depth_image_from_points(points, camera)
    assert image[1, 1] == 2
    assert np.isnan(image).sum() == 8


def test_points_outside_the_planes_or_the_image_are_not_seen():
    points = np.array([[0, 0, 0.05], [0, 0, 99.0], [50.0, 0, 1], [0, 0, -2]])
    assert np.isnan(depth_image_from_points(points, SMALL)).all()


def test_subsampling_picks_the_pixel_nearest_to_the_coarse_centre():
    camera = DepthCamera.sr4000()
    coarse = camera.resized(20, 15)
    columns = np.tile(np.arange(176.0), (144, 1))
    picked = subsample_depth(columns, camera, coarse)
    centres = (np.arange(20) - coarse.cx) * camera.fx / coarse.fx + camera.cx
    assert picked.shape == (15, 20)
    assert np.abs(picked - centres).max() <= 0.5


def test_a_depth_image_of_the_wrong_size_is_named():
    with pytest.raises(ValueError, match="shape"):
        SMALL.points(np.ones((64, 48)))
    with pytest.raises(ValueError, match="shape"):
        subsample_depth(np.ones((3, 3)), SMALL, SMALL.resized(4, 3))
