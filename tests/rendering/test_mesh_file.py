"""Mesh files that are cut off, bombs, or no meshes at all are refused by name."""

import io
import json
import struct

import numpy as np
import pytest
import trimesh

from course_lib.rendering.mesh_file import read_mesh

BOX = trimesh.creation.box((1, 2, 3))


class AskedError(ValueError):
    """What the caller asked to be raised."""


def exported(kind, **options):
    data = BOX.export(file_type=kind, **options)
    return data.encode() if isinstance(data, str) else data


ASCII_PLY = exported("ply", encoding="ascii")
BINARY_PLY = exported("ply")
OFF = exported("off")
QUADS = (
    b"""ply
format ascii 1.0
element vertex 8
property float x
property float y
property float z
element face 3
property list uchar int vertex_indices
end_header
"""
    + b"".join(b"%d %d %d\n" % (i & 1, i >> 1 & 1, i >> 2) for i in range(8))
    + b"4 0 1 3 2\n4 4 5 7 6\n4 0 1 5 4\n"
)


def read(tmp_path, data, kind):
    path = tmp_path / f"map.{kind}"
    path.write_bytes(data)
    return read_mesh(path, AskedError)


@pytest.mark.parametrize(
    ("data", "kind"),
    [
        (ASCII_PLY, "ply"),
        (BINARY_PLY, "ply"),
        (OFF, "off"),
        (exported("obj"), "obj"),
        (exported("stl"), "stl"),
        (exported("stl_ascii"), "stl"),
        (exported("glb"), "glb"),
        (OFF.replace(b"OFF\n", b"OFF ", 1), "off"),
        (OFF.replace(b"OFF\n", b"OFF\n# by hand\n\n", 1), "off"),
    ],
)
def test_every_format_is_read_whole(tmp_path, data, kind):
    vertices, faces = read(tmp_path, data, kind)
    assert len(faces) == 12
    assert np.allclose(np.ptp(vertices, axis=0), [1, 2, 3])


@pytest.mark.parametrize(
    ("data", "kind"),
    [
        (QUADS[: QUADS.rindex(b"4 0 1 5 4")], "ply"),  # two quads are four triangles: more than three
        (ASCII_PLY[: len(ASCII_PLY) * 3 // 4], "ply"),
        (ASCII_PLY[: ASCII_PLY.index(b"end_header")], "ply"),
        (BINARY_PLY[:-20], "ply"),
        (b"\n".join(OFF.splitlines()[:-2]), "off"),
        (exported("stl")[:-60], "stl"),
        (exported("stl_ascii")[:-200], "stl"),
        (exported("glb")[:-40], "glb"),
    ],
)
def test_a_file_that_was_cut_off_is_refused(tmp_path, data, kind):
    assert len(read(tmp_path, QUADS, "ply")[1]) == 6
    with pytest.raises(AskedError, match=r"map .*map\.(ply|off|stl|glb) (announces|cannot be read)"):
        read(tmp_path, data, kind)


@pytest.mark.parametrize("count", [10**6, 10**9, 10**18])
def test_counts_that_the_file_cannot_hold_are_refused_before_memory_is_taken(tmp_path, count):
    for data, kind, old, new in (
        (ASCII_PLY, "ply", b"vertex 8", b"vertex %d"),
        (BINARY_PLY, "ply", b"face 12", b"face %d"),
        (OFF, "off", b"8 12", b"%d 12"),
    ):
        assert old in data
        with pytest.raises(AskedError, match="announces"):
            read(tmp_path, data.replace(old, new % count, 1), kind)
    with pytest.raises(AskedError, match="announces"):
        read(tmp_path, exported("stl")[:80] + struct.pack("<I", min(count, 2**32 - 1)) + b"\0" * 100, "stl")


def glb(accessors):
    """A GLB file with one triangle mesh whose accessors are these."""
    content = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": accessors,
        "buffers": [{"byteLength": 4}],
        "bufferViews": [{"buffer": 0, "byteLength": 4}],
    }
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    data = struct.pack("<II", 4, 0x004E4942) + b"\0" * 4
    return struct.pack("<4sIIII", b"glTF", 2, 32 + len(text), len(text), 0x4E4F534A) + text + data


def test_a_glb_bomb_is_refused_and_takes_no_memory_here(tmp_path):
    """Accessors without data are zeros, as many as are asked for: 12 GB from 500 bytes."""
    bomb = glb(
        [
            {"componentType": 5126, "type": "VEC3", "count": 10**9},
            {"componentType": 5125, "type": "SCALAR", "count": 3},
        ]
    )
    with pytest.raises(AskedError, match=r"map\.glb cannot be read as a mesh: reading it takes more than 600 MB"):
        read(tmp_path, bomb, "glb")


@pytest.mark.parametrize("kind", ["zip", "txt", "mtl", "blend1", "html"])
def test_what_is_no_mesh_by_its_ending_is_refused(tmp_path, kind):
    archive = io.BytesIO()
    np.savez(archive, a=np.zeros(10))
    with pytest.raises(AskedError, match="which is no mesh: PLY"):
        read(tmp_path, archive.getvalue(), kind)


@pytest.mark.parametrize("kind", ["ply", "off", "stl", "obj", "glb"])
@pytest.mark.parametrize("data", [b"", b"\0" * 1000, b"ply\n", b"no mesh at all\n" * 50, b"\xff" * 300])
def test_what_is_no_mesh_inside_is_refused(tmp_path, kind, data):
    with pytest.raises(AskedError, match=r"map .*map\."):
        read(tmp_path, data, kind)


def test_materials_and_what_they_name_are_left_alone(tmp_path):
    (tmp_path / "map.mtl").write_text("newmtl wall\nmap_Kd /etc/passwd\n")
    data = b"mtllib map.mtl\nusemtl wall\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
    assert len(read(tmp_path, data, "obj")[1]) == 1


def test_a_missing_file_is_the_systems_error(tmp_path):
    with pytest.raises(FileNotFoundError, match="is missing"):
        read_mesh(tmp_path / "none.ply", AskedError)


OBJ = exported("obj")
ASCII_STL = exported("stl_ascii")


@pytest.mark.parametrize(
    ("data", "kind", "old", "new", "said"),
    [
        (QUADS, "ply", b"4 4 5 7 6", b"0 4 5 7 6", "line 19, face: a face is its number of corners, 3 or more"),
        (QUADS, "ply", b"4 4 5 7 6", b"3 4 5 7 6", "line 19, face: a face of 3 corners has 4 more numbers"),
        (QUADS, "ply", b"\n1 1 0\n", b"\n1 1\n", "line 13, vertex: 3 numbers are expected"),
        (QUADS, "ply", b"\n1 1 0\n", b"\n1 1 0 7\n", "line 13, vertex: 3 numbers are expected"),
        (QUADS, "ply", b"\n1 1 0\n", b"\n1 1,5 0\n", "line 13, vertex: 3 numbers are expected"),
        (BINARY_PLY, "ply", b"property float y", b"property float x", "line 6: the element has two properties x"),
        (
            QUADS,
            "ply",
            b"format",
            b"fkrmat",
            "line 2: 'format ascii 1.0', or binary, is expected on line 2; found 'fkrmat",
        ),
        (QUADS, "ply", b"ascii 1.0", b"ascii 1.5", "line 2: 'format ascii 1.0', or binary, is expected on line 2"),
        (QUADS, "ply", b"element vertex", b"format ascii 1.0\nelement vertex", "line 3: 'format ascii 1.0', or binary"),
        (BINARY_PLY, "ply", b"property float z", b"property float z\nprpperty float w", "line 8: element, property or"),
        (
            BINARY_PLY,
            "ply",
            b"element face",
            b"element vertex 8\nelement face",
            "line 8: there are two elements vertex",
        ),
        (BINARY_PLY, "ply", b"element vertex 8", b"element vertex 8 8", "line 4: element, a name and a whole number"),
        (BINARY_PLY, "ply", b"element face", b"element", "line 8: element, a name and a whole number are expected"),
        (BINARY_PLY, "ply", b"property float y", b"property float y 1.0", "line 6: property, its type .or list and"),
        (BINARY_PLY, "ply", b"property float y", b"property flcat y", "line 6: property, its type .or list and two"),
        (BINARY_PLY, "ply", b"list uchar int", b"list int", "line 9: property, its type .or list and two types. and a"),
        (BINARY_PLY, "ply", b"list uchar int", b"list uchar list", "line 9: property, its type .or list and two"),
        (OFF, "off", b"OFF", b"<html>OFF", "line 1: OFF is expected; found b'<html>OFF'"),
        (OFF, "off", b"\n3 ", b"\n0 ", "line 11: a face is its number of corners"),
        (OFF, "off", b"\n3 ", b"\n9 ", "line 11: a face of 9 corners has 3 more numbers"),
        (OFF, "off", b"-1.5", b"-1,5", "a vertex is three numbers"),
        (OBJ, "obj", b"-1.50000000\n", b"\n", "a vertex is three numbers"),
        (OBJ, "obj", b"-1.50000000\n", b"-1.5 0 0\n", "a vertex is three numbers"),
        (OBJ, "obj", b"\nv ", b"\nw ", "line 2: 'w' is no word of OBJ's"),
        (OBJ, "obj", b"\nv ", b"\n1.5 v ", "line 2: '1.5' is no word of OBJ's"),
        (OBJ, "obj", b"\nf ", b"\nf 1 2\nf ", "a face is three vertices or more"),
        (OBJ, "obj", b"\nf ", b"\nf 1 2 x\nf ", "a face is three vertices or more"),
        (ASCII_STL, "stl", b"endloop", b"", "three vertices|a loop begins in a loop"),
        (ASCII_STL, "stl", b"outer loop", b"", "three vertices of three numbers stand in a loop"),
        (ASCII_STL, "stl", b"vertex", b"normalvertex", "a vertex begins its line"),
        (ASCII_STL, "stl", b"vertex ", b"vertex 1 ", "three vertices of three numbers"),
    ],
)
def test_a_row_that_is_not_whole_is_named_with_its_line(tmp_path, data, kind, old, new, said):
    """trimesh takes the rows together, or takes a part of a row, and reads other triangles."""
    read(tmp_path, data, kind)
    assert old in data
    with pytest.raises(AskedError, match=rf"map .*map\.{kind}, .*({said})"):
        read(tmp_path, data.replace(old, new, 1), kind)


@pytest.mark.parametrize(
    ("data", "kind"),
    [
        (OBJ.replace(b"\nv ", b"\nvn 0 0 1\nvt 0 0\nv  ", 1).replace(b"\nf ", b"\n# faces\ns 1\nf ", 1), "obj"),
        (b"\n".join(line + b" 0.5 0.5 0.5" if line[:2] == b"v " else line for line in OBJ.splitlines()), "obj"),
        (OFF.replace(b"\n3 ", b"\n\n3 ", 1), "off"),
        (ASCII_STL.replace(b"\nfacet", b"\n  FACET", 1), "stl"),
        (ASCII_PLY, "ply"),
        (BINARY_PLY.replace(b"element face", b"comment of a room\nobj_info 12\nelement face"), "ply"),
    ],
)
def test_comments_colours_and_blank_lines_are_no_faults(tmp_path, data, kind):
    vertices, faces = read(tmp_path, data, kind)
    assert len(faces) == 12
    assert np.ptp(vertices, axis=0) == pytest.approx([1, 2, 3])


@pytest.mark.parametrize(
    ("data", "kind"),
    [(ASCII_PLY, "ply"), (BINARY_PLY, "ply"), (OFF, "off"), (OBJ, "obj"), (OBJ[OBJ.index(b"v ") :], "obj"),
     (ASCII_STL, "stl")],
)  # fmt: skip
def test_a_byte_order_mark_changes_nothing(tmp_path, data, kind):
    (tmp_path / "plain").mkdir()
    plain, marked = read(tmp_path / "plain", data, kind), read(tmp_path, b"\xef\xbb\xbf" + data, kind)
    assert all(np.array_equal(one, other) for one, other in zip(plain, marked, strict=True))


def test_the_header_of_a_binary_stl_may_begin_with_any_bytes(tmp_path):
    data = exported("stl")
    assert len(read(tmp_path, b"\xef\xbb\xbf" + data[3:], "stl")[1]) == 12


def test_corners_of_two_numbers_are_no_map(tmp_path):
    data = b"\n".join(line.rpartition(b" ")[0] if line[:2] == b"v " else line for line in OBJ.splitlines())
    with pytest.raises(AskedError, match=r"map\.obj"):
        read(tmp_path, data, "obj")
