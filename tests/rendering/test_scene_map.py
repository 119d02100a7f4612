"""Maps: files that hold less than they say are refused, so is what is no geometry; and what is doubtful is said."""

import pickle
import struct
import warnings

import numpy as np
import pytest
import trimesh

from course_lib.geometry import UP_AXES, rotation_to_z_up
from course_lib.rendering.errors import SceneMapError, SceneMapWarning
from course_lib.rendering.scene_map import SceneMap
from tests.rendering.shapes import room

TRIANGLE = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
BOX = trimesh.creation.box((1, 2, 3))


def exported(kind, **options):
    data = BOX.export(file_type=kind, **options)
    return data.encode() if isinstance(data, str) else data


ASCII_PLY, BINARY_PLY, OFF, OBJ = exported("ply", encoding="ascii"), exported("ply"), exported("off"), exported("obj")
STL, ASCII_STL, GLB = exported("stl"), exported("stl_ascii"), exported("glb")
QUADS = (
    b"ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nelement face 3\n"
    b"property list uchar int vertex_indices\nend_header\n"
    + b"".join(b"%d %d %d\n" % (i & 1, i >> 1 & 1, i >> 2) for i in range(8))
    + b"4 0 1 3 2\n4 4 5 7 6\n4 0 1 5 4\n"
)


def load(tmp_path, data, kind):
    path = tmp_path / f"map.{kind}"
    path.write_bytes(data)
    return SceneMap.load(path)


@pytest.mark.parametrize(
    ("data", "kind"),
    [
        (ASCII_PLY, "ply"), (BINARY_PLY, "ply"), (OFF, "off"), (OBJ, "obj"), (STL, "stl"), (ASCII_STL, "stl"),
        (GLB, "glb"),
        (OFF.replace(b"OFF\n", b"OFF ", 1), "off"),
        (OFF.replace(b"OFF\n", b"OFF\n# by hand\n\n", 1).replace(b"\n3 ", b"\n\n3 ", 1), "off"),
        (OBJ.replace(b"\nv ", b"\nvn 0 0 1\nvt 0 0\nv  ", 1).replace(b"\nf ", b"\n# faces\ns 1\nf ", 1), "obj"),
        (b"mtllib /etc/passwd\nusemtl wall\n" + OBJ, "obj"),
        (BINARY_PLY.replace(b"element face", b"comment of a room\nobj_info 12\nelement face"), "ply"),
        (b"\xef\xbb\xbf" + ASCII_PLY, "ply"), (b"\xef\xbb\xbf" + OFF, "off"),
        (b"\xef\xbb\xbf" + OBJ[OBJ.index(b"v ") :], "obj"),  # with this mark the first vertex would be no vertex
    ],
)  # fmt: skip
def test_every_mesh_format_gives_the_same_triangles(tmp_path, data, kind):
    found = load(tmp_path, data, kind)
    assert len(found) == 12
    assert np.allclose(found.bounds, [[-0.5, -1, -1.5], [0.5, 1, 1.5]])


def with_counts(count):
    """Files that announce so many elements and hold those of a box."""
    yield ASCII_PLY.replace(b"vertex 8", b"vertex %d" % count), "ply"
    yield BINARY_PLY.replace(b"face 12", b"face %d" % count), "ply"
    yield OFF.replace(b"8 12", b"8 %d" % count), "off"
    yield STL[:80] + struct.pack("<I", min(count, 2**32 - 1)) + STL[84:], "stl"


@pytest.mark.parametrize(
    ("data", "kind"),
    [
        (QUADS[: QUADS.rindex(b"4 0 1 5 4")], "ply"),  # two quads are four triangles: more than three
        (ASCII_PLY[: len(ASCII_PLY) * 3 // 4], "ply"),
        (ASCII_PLY[: ASCII_PLY.index(b"end_header")], "ply"),
        (BINARY_PLY[:-20], "ply"),
        (b"\n".join(OFF.splitlines()[:-2]), "off"),
        (STL[:-60], "stl"),
        (ASCII_STL[:-200], "stl"),
        (ASCII_STL[: ASCII_STL.rindex(b"facet normal")], "stl"),
        (GLB[:-40], "glb"),
        *with_counts(13), *with_counts(10**9), *with_counts(10**18),
    ],
)  # fmt: skip
def test_a_file_that_holds_less_than_it_announces_is_refused(tmp_path, data, kind):
    assert len(load(tmp_path, QUADS, "ply")) == 6
    with pytest.raises(SceneMapError, match=r"map .*map\.(ply|off|stl|glb) cannot be read .* complete"):
        load(tmp_path, data, kind)


@pytest.mark.parametrize(
    ("data", "kind", "old", "new"),
    [
        (QUADS, "ply", b"\n1 1 0\n", b"\n1 1\n"),
        (QUADS, "ply", b"\n1 1 0\n", b"\n1 1,5 0\n"),
        (BINARY_PLY, "ply", b"property float y", b"property float x"),
        (BINARY_PLY, "ply", b"property float y", b"property flcat y"),
        (BINARY_PLY, "ply", b"list uchar int", b"list int"),
        (OFF, "off", b"\n3 ", b"\n0 "),
        (OFF, "off", b"-1.5", b"-1,5"),
        (OBJ, "obj", b"-1.50000000\n", b"\n"),
        (OBJ, "obj", b"\nv ", b"\nw "),
        (OBJ, "obj", b"\nf ", b"\nf 1 2 x\nf "),
        (ASCII_STL, "stl", b"vertex ", b"vertex 1 "),
        (ASCII_PLY, "ply", b"-1.5", b"nan"),
    ],
)  # fmt: skip
def test_a_damaged_file_is_refused(tmp_path, data, kind, old, new):
    assert old in data
    with pytest.raises(SceneMapError, match=r"map\."):
        load(tmp_path, data.replace(old, new, 1), kind)


@pytest.mark.parametrize("kind", ["ply", "off", "stl", "obj", "glb", "zip", "txt"])
@pytest.mark.parametrize("data", [b"", b"no mesh at all\n" * 50])
def test_what_is_no_mesh_is_refused(tmp_path, kind, data):
    with pytest.raises(SceneMapError, match=rf"map\.{kind}"):
        load(tmp_path, data, kind)


def test_a_point_cloud_and_a_missing_file_are_named(tmp_path):
    trimesh.PointCloud(np.random.default_rng(0).random((10, 3))).export(tmp_path / "points.ply")
    with pytest.raises(SceneMapError, match="needs triangles"):
        SceneMap.load(tmp_path / "points.ply")
    with pytest.raises(FileNotFoundError, match=r"map .* is missing"):
        SceneMap.load(tmp_path / "nowhere.ply")


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
        (TRIANGLE + 3e7, [[0, 1, 2]], r"beyond 2e\+07 m"),
    ],
)
def test_a_mesh_that_is_no_map_is_named(vertices, faces, said):
    with pytest.raises(SceneMapError, match=said):
        SceneMap(vertices, np.asarray(faces))


def test_a_map_cannot_be_changed_behind_the_renderer_and_is_only_moved_rigidly():
    given = np.array(TRIANGLE)
    scene = SceneMap(given, np.array([[0, 1, 2]]))
    given[0] = 7.0
    for each in (scene, pickle.loads(pickle.dumps(scene))):
        assert np.array_equal(each.vertices, TRIANGLE)
        with pytest.raises(ValueError, match="read-only"):
            each.vertices[0] = 0
    turn = np.array([[0.0, -1, 0, 5], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    assert np.allclose(SceneMap(TRIANGLE, [[0, 1, 2]]).transformed(turn).vertices, [[5, 0, 0], [5, 1, 0], [4, 0, 0]])
    with pytest.raises(ValueError, match="rigid"):
        room().transformed(np.diag([2.0, 2, 2, 1]))


def test_the_anchor_is_where_most_of_the_map_is_and_follows_the_cameras_by_whole_steps():
    here, offset = room(), np.array([1e6, 0, 0])
    scene = SceneMap(
        np.concatenate([here.vertices, here.vertices[::-1] + offset, TRIANGLE]),
        np.concatenate([here.faces, here.faces + 8, [[16, 17, 18]]]),
    )
    assert np.array_equal(scene.anchor(scene.origin + np.full((3, 3), 40.0)), scene.origin)
    there = scene.anchor(np.array([[1e6, 1, 2], [1e6 + 5, 0, 0], [0, 0, 0]]))
    assert np.abs(there - offset).max() <= 87
    assert np.array_equal(there, scene.anchor(np.array([[1e6 + 1, 0, 0]])))
    # Cameras that have left the map draw its anchor no farther than its edge.
    assert np.abs(scene.anchor(np.array([[1e30, 0, 0]]))).max() < 1e6 + 100
    assert room(2.0).contains([[0, 0, 0], [1.5, 0, 0]], margin=0.0).tolist() == [True, False]
    assert room(2.0).contains([1.5, 0, 0], margin=1.0)


def test_a_map_in_memory_is_that_of_its_file_and_up_becomes_z(tmp_path):
    box = trimesh.creation.box((1, 2, 3), trimesh.transformations.translation_matrix((5, 0, 7)))
    box.export(tmp_path / "map.ply")
    for made in (
        SceneMap.from_trimesh(box),
        SceneMap.from_trimesh(trimesh.Scene(box)),
        SceneMap(box.vertices, box.faces),
    ):
        assert np.allclose(made.bounds, [[4.5, -1, 5.5], [5.5, 1, 8.5]])
    for up in UP_AXES:
        turned = SceneMap.load(tmp_path / "map.ply", up=up)
        for made in (
            SceneMap.from_trimesh(box, up=up),
            SceneMap.load(tmp_path / "map.ply").transformed(rotation_to_z_up(up)),
        ):
            assert np.allclose(made.bounds, turned.bounds)
        assert np.allclose(turned.bounds.mean(axis=0)[2], np.dot((5, 0, 7), UP_AXES[up]))
    with pytest.raises(ValueError, match="up must be one of"):
        SceneMap.from_trimesh(box, up="up")
    with pytest.raises(SceneMapError, match=r"must be a trimesh\.Trimesh or a trimesh\.Scene; got list"):
        SceneMap.from_trimesh([box])
    with pytest.raises(SceneMapError, match="needs triangles"):
        SceneMap.from_trimesh(trimesh.PointCloud(np.eye(3)))


def test_arrays_in_millimetres_are_doubted_like_a_file():
    box = trimesh.creation.box((8, 8, 3)).subdivide()
    with pytest.warns(SceneMapWarning, match=r"triangles lie over 5000 m .* Are these millimetres\? .* drop_far=True"):
        SceneMap(box.vertices * 1000, box.faces)


@pytest.mark.parametrize("coordinate", [6e3, 1e6, 3e7, -1e20])
def test_a_triangle_that_cannot_belong_to_a_building_is_named_and_can_be_dropped(coordinate, tmp_path):
    box, path = room(), tmp_path / "map.ply"
    vertices = np.concatenate([box.vertices, TRIANGLE])
    vertices[-1, 1] = coordinate
    trimesh.Trimesh(vertices, np.concatenate([box.faces, [[8, 9, 10]]]), process=False).export(path)
    with pytest.raises(SceneMapError, match=r"map\.ply: 1 of 13 triangles .* triangle 12 has a corner at .*drop_far"):
        SceneMap.load(path)
    assert np.allclose(SceneMap.load(path, drop_far=True).bounds, box.bounds)


@pytest.mark.parametrize("scale", [[400, 400, 34], [34, 34, 34]])
def test_a_map_that_looks_like_millimetres_is_used_with_a_warning(tmp_path, scale):
    mesh = trimesh.Trimesh(room().vertices * scale, room().faces, process=False)
    mesh.export(tmp_path / "map.ply")
    with pytest.warns(SceneMapWarning, match=r"map\.ply: the map is .* are these millimetres") as told:
        SceneMap.load(tmp_path / "map.ply")
    with pytest.warns(SceneMapWarning, match="the map is .* are these millimetres") as also_told:
        SceneMap(mesh.vertices, mesh.faces)
    assert {one.filename for one in (*told, *also_told)} == {__file__}
    trimesh.Trimesh(room().vertices * [400, 400, 33], room().faces, process=False).export(tmp_path / "map.ply")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        SceneMap.load(tmp_path / "map.ply")
