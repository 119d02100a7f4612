"""Files that a reader once passed with other contents, or over which it once took minutes or gigabytes.

Each is refused by name, or read as the valid file is, in little memory.
"""

import json
from collections.abc import Callable

import numpy as np
import pytest

from course_lib.depth_mcl import SceneMap
from tests.fuzz.samples import FORMATS, write_samples
from tests.fuzz.test_damaged_files import is_read

MEMORY = 1_000_000_000
"""Bytes that a reader may take beyond what this process holds."""

Edit = Callable[[bytes], bytes]


def put(old: bytes, new: bytes) -> Edit:
    def edit(data: bytes) -> bytes:
        assert old in data
        return data.replace(old, new, 1)

    return edit


def in_json(*place: object, value: object) -> Edit:
    def edit(data: bytes) -> bytes:
        content = inner = json.loads(data)
        for key in place[:-1]:
            inner = inner[key]
        inner[place[-1]] = value
        return json.dumps(content).encode()

    return edit


def a_face_of_many_corners(data: bytes) -> bytes:
    header, _, rows = data.replace(b"uchar", b"uint").partition(b"end_header\n")
    return header + b"end_header\n" + rows[:96] + b"\xff" * 4


EXAMPLES: dict[str, tuple[str, Edit]] = {
    "a face of no corners": ("ply in text", put(b"\n4 0 1 3 2", b"\n0 0 1 3 2")),
    "a vertex of two numbers": ("ply in text", put(b" -1.5000\n", b"\n")),
    "two elements of one name": ("ply", put(b"element face", b"element vertex 8\nelement face")),
    "an element of 10^12 faces": ("ply in text", put(b"element face 6", b"element face 1000000000000")),
    "a face of 2^32 corners": ("ply", a_face_of_many_corners),
    "a loop without its end": ("stl in text", put(b"endloop", b"")),
    "2^32 triangles": ("stl", lambda data: bytes(80) + b"\xff" * 4 + bytes(100)),
    "panoramas of another width than the list says": ("stereo recording", in_json("width", value=130)),
    "a box that is a number": ("boxes", in_json("upper", 0, "box", value=5)),
    "a layer that no other takes": ("cfg", put(b"\n[yolo]", b"\n[maxpool]\nsize=2\n\n[route]\nlayers=-2\n\n[yolo]")),
    "weights cut short": ("weights", lambda data: data[:-4]),
    "weights that are no numbers": ("weights", lambda data: data[:20] + b"\xff" * (len(data) - 20)),
    "a threshold above 1": ("training", in_json("score_threshold", value=1.5)),
    "a line of 5 MB": ("poses", lambda data: b"1 " * 2_500_000),
}  # fmt: skip


@pytest.fixture
def little_memory():
    """What takes more memory than that gets a MemoryError, which is no reader's own error."""
    resource = pytest.importorskip("resource")
    before = resource.getrlimit(resource.RLIMIT_DATA)
    with open("/proc/self/statm") as statm:
        held = int(statm.read().split()[5]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_DATA, (held + MEMORY, before[1]))
    yield
    resource.setrlimit(resource.RLIMIT_DATA, before)


def same(one: object, other: object) -> bool:
    if isinstance(one, SceneMap):
        return np.array_equal(one.vertices[one.faces], other.vertices[other.faces])
    return np.array_equal(one, other) if isinstance(one, np.ndarray) else one == other


@pytest.mark.parametrize("example", EXAMPLES)
def test_it_is_refused_by_name_or_read_as_the_valid_file(example, tmp_path, little_memory):
    name, edit = EXAMPLES[example]
    one = FORMATS[name]
    write_samples(tmp_path)
    path = tmp_path / one.file
    valid = one.read(path)
    path.write_bytes(edit(path.read_bytes()))
    if is_read(one, path):
        assert same(one.read(path), valid)
