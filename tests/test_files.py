"""Input is bounded before memory is taken, and its faults are named; output is never half-written."""

import json
import struct
import zlib

import cv2
import numpy as np
import pytest

from course_lib import files
from course_lib.files import (
    atomic_write,
    image_header,
    read_bytes,
    read_image,
    read_json,
    read_text,
    staging_dir,
)
from courseware.run_folder import run_folder
from tests.fuzz import damage


class AskedError(ValueError):
    """What the caller asked to be raised."""


def png(width, height, *more):
    """A PNG that announces a size and holds one row."""
    head = (b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
    return damage.png(head, *more, (b"IDAT", zlib.compress(b"\0" * (width + 1))), (b"IEND", b""))


def read(data, reader, folder, **options):
    """Write bytes to a file, and read it."""
    (folder / "a.file").write_bytes(data)
    return reader(folder / "a.file", "what is read", AskedError, **options)


def test_text_with_any_mark_and_line_end_is_the_same_and_json_has_up_to_50_levels(tmp_path):
    for data in (b"sofa\nchair\n", b"\xef\xbb\xbfsofa\r\nchair\r\n", b"sofa\rchair\r"):
        assert read(data, read_text, tmp_path) == "sofa\nchair\n"
    assert read(b'{"a[": "]\\"[[", "b": [[1]]}', read_json, tmp_path) == {"a[": ']"[[', "b": [[1]]}
    assert len(read(b"[" * 50 + b"]" * 50, read_json, tmp_path)) == 1


@pytest.mark.parametrize(
    ("reader", "data", "said"),
    [
        (read_text, b"sofa\nch\xe4ir", "what is read .*a.file is not UTF-8 text: byte 0xe4 in line 2"),
        (read_text, b"sofa\nch\0ir", "zero byte in line 2"),
        (read_json, b"", "line 1, column 1"),
        (read_json, b'{"a": 1,\n "b" 2}', "line 2, column 6"),
        (read_json, b"[" * 100_000, "100000 levels"),
        (read_json, b"[" * 51 + b"]" * 51, "51 levels"),
        (read_json, b'{"a": NaN}', "holds NaN"),
        (read_json, b'{"a": 1e999}', "1e999, which is too large"),
        (read_json, b'{"a": 1, "a": 2}', "'a' twice"),
        (read_json, b'{"a": ' + b"9" * 401 + b"}", "99, which is too large"),
        (read_json, b'"\\' * 100_000, "line 1"),  # each quotation mark once began a search to the end: minutes
        (read_image, png(20_000, 20_000), "20000 x 20000 pixels; at most 100 million"),
        (read_image, png(4, 1, (b"acTL", struct.pack(">II", 3, 0))), r"animated .3 frames"),
        (read_image, b"", "is empty"),
        (read_image, b"BM" + b"\0" * 60, "begins with b'BM"),
        (read_image, png(4, 4)[:40], "complete"),
        (read_image, b"\x89PNG", "begins"),
    ],
)
def test_what_cannot_be_read_is_named(tmp_path, reader, data, said):
    with pytest.raises(AskedError, match=said):
        read(data, reader, tmp_path)


def test_a_file_that_is_too_large_is_refused_before_it_is_read(tmp_path, monkeypatch):
    with (tmp_path / "a").open("wb") as file:
        file.truncate(files.MAX_TEXT + 1)
    with pytest.raises(AskedError, match="has 64 MB; at most 64 MB"):
        read_text(tmp_path / "a", "names", AskedError)
    with (tmp_path / "a").open("wb") as file:
        file.truncate(5_000_000_000)  # a hole: it takes no room on the disk
    with pytest.raises(AskedError, match="has 5,000 MB; at most 2,000 MB"):
        read_bytes(tmp_path / "a", "map", AskedError)


@pytest.mark.parametrize("size", [(1, 1), (640, 320), (65, 999)])
@pytest.mark.parametrize("ending", [".png", ".jpg"])
def test_headers_say_the_size_that_is_then_unpacked(tmp_path, rng, size, ending):
    image = rng.integers(0, 255, (size[1], size[0], 3), dtype=np.uint8)
    data = cv2.imencode(ending, image)[1].tobytes()
    header = image_header(data)
    assert (header.width, header.height, header.frames) == (*size, 1)
    assert read(data, read_image, tmp_path).shape == image.shape
    if ending == ".jpg":
        with pytest.raises(AskedError, match="is a JPEG; PNG is expected"):
            read(data, read_image, tmp_path, kinds=("PNG",))


@pytest.mark.parametrize("progressive", [0, 1])
def test_a_jpeg_without_its_end_is_not_complete(tmp_path, rng, progressive):
    """OpenCV fills in what is missing, without a word."""
    image = rng.integers(0, 255, (40, 60, 3), dtype=np.uint8)
    data = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_PROGRESSIVE, progressive])[1].tobytes()
    thumbnail = b"\xff\xe1" + struct.pack(">H", 8) + b"\xff\xda\xff\xd9\xff\xd9"
    whole = data[:2] + thumbnail + data[2:]
    assert read(whole + b"what a phone appends \xff\xda", read_image, tmp_path).shape == image.shape
    for damaged, said in (
        (whole[:-1] + b"\xf6", "it has no end"),
        (whole[:-2], "it has no end"),
        (whole[: whole.rindex(b"\xff\xc4")], "a segment is expected at byte|it has no end"),
        (whole.replace(b"\xff\xc4", b"\x00\xc4", 1), "a segment is expected at .*, where the file has something else"),
    ):
        with pytest.raises(AskedError, match=f"a.file cannot be read as a JPEG: ({said}).*: is it complete"):
            read(damaged, read_image, tmp_path)


@pytest.mark.parametrize(("bits", "colour", "taken"), [(8, 2, 3), (16, 6, 8), (16, 0, 2), (8, 3, 4), (1, 0, 1)])
def test_an_image_is_bounded_by_the_bytes_it_takes(tmp_path, monkeypatch, bits, colour, taken):
    data = bytearray(png(100, 100))
    data[24:26] = bits, colour
    assert image_header(bytes(data)).pixel_bytes == taken
    monkeypatch.setattr(files, "MAX_IMAGE", 100 * 100 * taken - 1)
    with pytest.raises(AskedError, match=rf"would take .* \({taken} bytes a pixel\)"):
        read(data, read_image, tmp_path)


@pytest.mark.parametrize("length", [2**31 + 11, 2**32 - 1, 200])
def test_a_part_of_a_png_longer_than_the_file_is_refused_before_memory_is_taken(tmp_path, length):
    """OpenCV takes what the part says: 2.3 GB for a file of 70 bytes."""
    data = png(30, 1)
    assert read(data, read_image, tmp_path).shape == (1, 30)
    with pytest.raises(AskedError, match="its part b'IDAT' at byte 33 has"):
        read(data[:33] + struct.pack(">I", length) + data[37:], read_image, tmp_path)


def test_a_file_is_replaced_whole_or_not_at_all(tmp_path, monkeypatch):
    path = tmp_path / "results.json"
    atomic_write(path, "old")
    monkeypatch.setattr(files.os, "fsync", lambda handle: (_ for _ in ()).throw(OSError(28, "No space left on device")))
    with pytest.raises(OSError, match=r"No space left on device.*results\.json"):
        atomic_write(path, "new")
    assert path.read_text() == "old"
    monkeypatch.undo()
    atomic_write(path, "new")
    assert path.read_text() == "new"
    assert list(tmp_path.iterdir()) == [path]


def test_a_folder_takes_its_files_at_the_end_and_keeps_what_is_not_the_callers(tmp_path):
    before = {"mine.txt": "old", "a.csv": "old", "b.csv": "old"}
    for name, text in before.items():
        (tmp_path / name).write_text(text)

    def found():
        return {path.name: path.read_text() for path in tmp_path.iterdir()}

    def write(fails):
        with staging_dir(tmp_path, ["a.csv", "b.csv"]) as new:
            (new / "a.csv").write_text("new")
            if fails:
                raise RuntimeError

    with pytest.raises(RuntimeError):
        write(fails=True)
    assert found() == before
    write(fails=False)
    assert found() == {"mine.txt": "old", "a.csv": "new"}


def test_the_record_of_a_run_is_written_last(tmp_path):
    with run_folder(tmp_path / "out", "try it") as new:
        (new / "a.csv").write_text("1")
        assert not (tmp_path / "out").exists()
    assert json.loads((tmp_path / "out" / "run.json").read_text()) == {"command": "try it", "files": ["a.csv"]}


def test_what_is_no_file_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"map .*none is missing"):
        read_bytes(tmp_path / "none", "map", AskedError, missing=FileNotFoundError)
    with pytest.raises(AskedError, match="is a folder"):
        read_bytes(tmp_path, "map", AskedError)
    for name in ("a" * 5000, "a\0b"):
        with pytest.raises(AskedError, match="map"):
            read_bytes(tmp_path / name, "map", AskedError)
