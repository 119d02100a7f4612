"""A reader of what users hand over returns, or raises an error of the course's own that names the file.

Each format's small valid file is damaged at random (`damage`), and its public reader reads it. The same damage every
time.
"""

import os

import pytest
from hypothesis import HealthCheck, given, settings

from tests.fuzz.damage import damaged
from tests.fuzz.samples import FORMATS, write_samples

SLOW = {"onnx": 5}
"""How many examples of a format whose reader starts a process for each."""


@pytest.fixture(scope="module")
def samples(tmp_path_factory):
    folder = tmp_path_factory.mktemp("samples")
    write_samples(folder)
    return folder


def is_read(one, path) -> bool:
    """Whether the file is read. Fails unless a refusal is one of the course's own errors and names the file."""
    try:
        one.read(path)
    except Exception as error:
        ours = type(error).__module__.startswith("course_lib.") or isinstance(error, FileNotFoundError)
        if not ours or (path.name not in str(error) and path.parent.name not in str(error)):
            pytest.fail(f"refused by {type(error).__name__}: {error}")
        return False
    return True


@pytest.mark.parametrize("name", FORMATS)
@pytest.mark.slow
def test_a_damaged_file_is_read_or_refused_by_name(name, samples):
    one = FORMATS[name]
    path = samples / one.file
    whole = path.read_bytes()
    assert is_read(one, path)

    @settings(max_examples=SLOW.get(name, 100), database=None, suppress_health_check=list(HealthCheck))
    @given(damaged(whole, one.kind))
    def look(data):
        path.write_bytes(data)
        is_read(one, path)

    try:
        look()
    finally:
        path.write_bytes(whole)


@pytest.mark.skipif(os.name == "nt", reason="pipes and devices of POSIX")
@pytest.mark.parametrize("name", FORMATS)
def test_what_is_no_file_is_refused_by_name(name, tmp_path):
    write_samples(tmp_path)
    path = tmp_path / FORMATS[name].file
    for target in ("/dev/zero", path.name, "nowhere", "."):
        path.unlink()
        path.symlink_to(target)
        assert not is_read(FORMATS[name], path), target
    path.unlink()
    os.mkfifo(path)
    assert not is_read(FORMATS[name], path), "a pipe, which would never end"
