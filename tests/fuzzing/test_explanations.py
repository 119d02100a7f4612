"""A changed result is explained where the file says so, and never where the reader made it up."""

import numpy as np
import pytest

from course_lib.fuzzing import depth_oracle, mesh_explanation
from course_lib.fuzzing.campaign import FORMATS
from course_lib.fuzzing.depth_oracle import CAMERA, VIEWS, depths_agree, ray_cast
from course_lib.fuzzing.mesh_explanation import second_reading
from course_lib.fuzzing.readings import same
from course_lib.fuzzing.samples import ROOM, room_mesh, write_samples

# Format -> an edit of the valid file that a reader must take over, as (old, new).
EDITS = {
    "ply-ascii": (b"-3.0000 -2.5000 -1.5000", b"-3.0050 -2.5000 -1.5000"),
    "obj": (b"v ", b"v 0.25 0.5 0.5\nv "),
    "stl-ascii": (b"vertex 3.0 ", b"vertex 2.5 "),
    "off": (b"-3.0000 -2.5000 -1.5000", b"-3.5000 -2.5000 -1.5000"),
    "intrinsics": (b"40.000000", b"41.500000"),
    "up": (b"z", b"-y"),
    "gravity": (b"9.7000", b"9.6000"),
    "floor": (b"0.2000", b"0.2500"),
    "tum-images": (b"100.1000", b"100.1100"),
    "stereo": (b'"x": 0.5', b'"x": 0.75'),
    "semantic-json": (b"210.0", b"211.5"),
    "semantic-csv": (b"210.0", b"211.5"),
    "boxes": (b"30.5", b"31.5"),
    "cfg": (b"leaky", b"linear"),
    "names": (b"chair", b"lamp"),
    "training": (b"0.4", b"0.45"),
    "notebook": (b"x = 1 +", b"x = 2 +"),
    "python": (b"BETA = 0.1", b"BETA = 0.2"),
}


# What follows from the rest of a reading, and stands in no file.
DERIVED = {"notebook": ("needed", "problems"), "python": ("needed", "problems")} | dict.fromkeys(
    ("cfg", "names", "training"), ("found", "boxes", "scores")
)


@pytest.fixture
def samples(tmp_path):
    write_samples(tmp_path)
    return tmp_path


@pytest.mark.parametrize("name", EDITS)
def test_an_edit_is_explained_and_a_reading_that_differs_from_the_file_is_not(name, samples):
    one = FORMATS[name]
    path = samples / one.file
    original = one.read(path)
    old, new = EDITS[name]
    edited = path.read_bytes().replace(old, new, 1)
    assert edited != path.read_bytes()
    whole = path.read_bytes()
    path.write_bytes(edited)
    found = one.read(path)
    if name != "obj":  # where the new vertex belongs to no triangle
        assert not same(found, original)
    assert one.explain(edited, found, original)
    # The same reading of another file: the valid one does not say so.
    assert name == "obj" or one.explain(whole, found, original) is None


@pytest.mark.parametrize("name", [name for name in FORMATS if name not in ("glb", "onnx", "weights")])
def test_no_changed_part_of_a_reading_is_explained_by_the_valid_file(name, samples):
    one = FORMATS[name]
    data = (samples / one.file).read_bytes()
    original = one.read(samples / one.file)
    for part, value in original.items():
        if part in DERIVED.get(name, ()):
            continue
        for other in changed(value):
            found = original | {part: other}
            assert not same(found, original)
            try:
                why = one.explain(data, found, original)
            except (ValueError, IndexError, KeyError):  # counts as none
                why = None
            assert why is None, (part, other)


def changed(value):
    """Other values of the same kind."""
    if isinstance(value, np.ndarray) and value.size:
        if value.dtype.kind == "f":
            number = value.copy()
            number.flat[0] = number.flat[0] + 0.5 if np.isfinite(number.flat[0]) else 0.5
            yield number
        elif value.dtype == np.uint8:
            yield value + np.uint8(7)
    elif isinstance(value, str):
        yield value + "x"
    elif isinstance(value, float):
        yield value + 0.125
    elif isinstance(value, list) and value:
        yield [*value, value[-1]]


def test_a_file_that_may_be_missing_explains_its_absence_and_no_other_does(samples):
    path = samples / FORMATS["gravity"].file
    original = FORMATS["gravity"].read(path)
    found = original | {"gravity": None}
    assert "missing" in FORMATS["gravity"].explain(None, found, original)
    with pytest.raises((TypeError, AttributeError)):
        FORMATS["intrinsics"].explain(None, found, original)


@pytest.mark.parametrize("name", ["ply", "ply-ascii", "obj", "stl", "stl-ascii", "off", "glb"])
def test_the_second_reading_of_a_valid_mesh_has_its_corners_and_triangles(name, samples):
    path = samples / FORMATS[name].file
    points, most = second_reading(path.read_bytes(), path.suffix[1:])
    assert most == 192 + (12 if "ascii.ply" not in path.name and "off" not in path.name else 0)
    if name not in ("glb", "ply", "stl"):
        assert np.array_equal(second_reading(b"\xef\xbb\xbf" + path.read_bytes(), path.suffix[1:])[0], points)
    if name != "glb":
        assert np.abs(points).max(axis=0) == pytest.approx(np.array(ROOM) / 2)


def test_the_oracle_sees_a_wall_where_it_is():
    mesh = room_mesh()
    state = np.zeros(6)
    depth = ray_cast(mesh.triangles, state)
    assert depth[int(CAMERA.cy), int(CAMERA.cx)] == pytest.approx(ROOM[0] / 2, abs=1e-12)
    assert ray_cast(mesh.triangles[:0], state).min() == np.inf


def test_between_a_plane_and_its_rounding_a_surface_may_be_seen_or_not_and_nothing_else():
    """Damaged file 238 of seed 6 had a triangle 0.07 mm before the near plane."""
    wall = np.array([[[CAMERA.near - 5e-5, y, z] for y, z in ((-9, -9), (9, -9), (0, 9))]])
    far_wall = wall + np.array([2.0, 0, 0])
    state, corners = np.zeros(6), np.concatenate([wall, far_wall])
    seen, cut = (ray_cast(corners, state, planes=planes) for planes in ((CAMERA.nearest, 12.0), (CAMERA.near, 12.0)))
    middle = int(CAMERA.cy), int(CAMERA.cx)
    assert (seen[middle], cut[middle]) == pytest.approx((CAMERA.near - 5e-5, 2.1 - 5e-5))
    assert depth_oracle._agree(seen, corners, state)
    assert depth_oracle._agree(cut, corners, state)
    assert not depth_oracle._agree((seen + cut) / 2, corners, state)
    assert not depth_oracle._agree(ray_cast(corners, state, planes=(0.05, 12.0)) - 0.01, corners, state)


def test_depths_of_the_room_agree_with_the_oracle_and_two_millimetres_do_not(monkeypatch):
    mesh = room_mesh()
    assert depths_agree(mesh.vertices, mesh.faces)
    exact = depth_oracle.ray_cast
    assert len(VIEWS) == 2
    monkeypatch.setattr(depth_oracle, "ray_cast", lambda *given: exact(*given) + 2e-3)
    assert not depths_agree(mesh.vertices, mesh.faces)


def test_a_map_with_other_depths_or_other_corners_is_not_explained(samples, monkeypatch):
    one, path = FORMATS["ply"], samples / FORMATS["ply"].file
    data, found = path.read_bytes(), one.read(path)
    assert one.explain(data, found, found)
    shifted = found | {"vertices": found["vertices"] + [1e-4, 0, 0]}
    assert one.explain(data, shifted, found) is None
    monkeypatch.setattr(mesh_explanation, "depths_agree", lambda vertices, faces: False)
    assert one.explain(data, found, found) is None
