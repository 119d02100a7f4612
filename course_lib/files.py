"""Read a user's files with limits and named errors, and write files so that no reader ever sees half of one.

Each reader takes `what` the file is ("depth image"), for the message, and the `error` that it raises. A missing file
raises `missing`, if that is given.
"""

import contextlib
import json
import math
import os
import re
import struct
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import accumulate
from pathlib import Path
from typing import NamedTuple, NoReturn

import numpy as np

MEGABYTE = 1_000_000

MAX_TEXT = 64 * MEGABYTE  # of a text or JSON file: 500,000 rows of poses are 40 MB
MAX_BYTES = 2_000 * MEGABYTE  # of any file: a scanned building of 40 million triangles
MAX_PIXELS = 100_000_000  # of an image: a panorama of 14,000 x 7,000
MAX_IMAGE = 3 * MAX_PIXELS  # bytes of an image in memory: that panorama in three colours
MAX_LEVELS = 50  # of lists and objects inside each other in JSON; our own formats have four

Raised = type[Exception]


def read_bytes(
    path: str | Path, what: str, error: Raised, limit: int = MAX_BYTES, missing: Raised | None = None
) -> bytes:
    """Return the content of a file of at most `limit` bytes. A pipe or device is refused, because it may never end."""
    path = Path(path)
    require_file(path, what, missing or error)
    try:
        if (size := path.stat().st_size) > limit:
            raise error(f"{what} {path} has {size / MEGABYTE:,.0f} MB; at most {limit / MEGABYTE:,.0f} MB are read")
        return path.read_bytes()
    except OSError as reason:
        raise error(f"{what} {path} cannot be read: {reason.strerror}") from reason


# Whether there is anything at a path. A broken link and a folder count, because the user meant them to be read.
is_given = os.path.lexists
is_file = os.path.isfile  # False, and no error, for a name that no system allows


def require_file(path: Path, what: str, error: Raised) -> None:
    """Raise `error` unless `path` is a file that can be read."""
    try:
        if path.is_file():
            return
        kind = "is a folder" if path.is_dir() else "is no plain file" if path.exists() else "is missing"
    except (OSError, ValueError) as reason:  # a name that is too long, or contains a zero byte
        raise error(f"{what} {str(path)!r} cannot be opened: {reason}") from reason
    raise error(f"{what} {path} {kind}: give the path of an existing file")


def read_text(path: str | Path, what: str, error: Raised, missing: Raised | None = None) -> str:
    """Return the text of a UTF-8 file, without a byte order mark, with a newline for any system's line end."""
    data = read_bytes(path, what, error, MAX_TEXT, missing)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as reason:
        line = data[: reason.start].count(b"\n") + 1
        byte = f"byte {data[reason.start]:#04x} in line {line}"
        cure = "Was another file given in its place? If not, save it as UTF-8"
        raise error(f"{what} {path} is not UTF-8 text: {byte}. {cure}") from None
    if "\0" in text:
        line = text[: text.index("\0")].count("\n") + 1
        raise error(f"{what} {path} is not text: a zero byte in line {line}")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def read_json(path: str | Path, what: str, error: Raised, missing: Raised | None = None) -> object:
    """Return the value of a JSON file. Its numbers are finite, its names unique, its levels at most `MAX_LEVELS`."""
    text = read_text(path, what, error, missing)

    def refuse(reason: str) -> NoReturn:
        raise error(f"{what} {path} {reason}")

    def constant(name: str) -> NoReturn:
        refuse(f"holds {name}, which is no JSON number; write null for an unknown value")

    def number(digits: str) -> float:
        value = float(digits)
        return value if math.isfinite(value) else refuse(f"holds the number {digits[:20]}, which is too large")

    def whole(digits: str) -> int:
        return int(digits) if math.isfinite(number(digits)) else 0

    def members(pairs: list[tuple[str, object]]) -> dict[str, object]:
        names = [name for name, _ in pairs]
        if twice := [name for name, count in Counter(names).items() if count > 1]:
            refuse(f"has {twice[0]!r} twice in one object: which one is meant?")
        return dict(pairs)

    # Brackets inside strings do not count. A match takes a whole string, or all to the end if the string is not closed.
    # Without the second, every quotation mark would start a search to the end.
    brackets = re.findall(r'"(?:[^"\\]|\\.)*+"?|[\[\]{}]', text, re.DOTALL)
    steps = [1 if bracket in "[{" else -1 if bracket in "]}" else 0 for bracket in brackets]
    if (levels := max(accumulate(steps), default=0)) > MAX_LEVELS:
        refuse(f"has {levels} levels of lists and objects inside each other; at most {MAX_LEVELS} are read")
    try:
        return json.loads(text, parse_constant=constant, parse_float=number, parse_int=whole, object_pairs_hook=members)
    except json.JSONDecodeError as reason:
        refuse(f"is not JSON: line {reason.lineno}, column {reason.colno}: {reason.msg}")


class ImageHeader(NamedTuple):
    """The header of an image file, read before the image is unpacked."""

    kind: str  # "PNG" or "JPEG".
    width: int
    height: int
    frames: int  # 2 or more if animated.
    pixel_bytes: int  # Bytes of one pixel in memory.


def read_image(
    path: str | Path, what: str, error: Raised, kinds: Sequence[str] = ("PNG", "JPEG"), missing: Raised | None = None
) -> np.ndarray:
    """Return the pixels of a PNG or JPEG, at most `MAX_PIXELS`, with the file's channels (in OpenCV's order, BGR)."""
    import cv2

    data = read_bytes(path, what, error, missing=missing)
    header = image_header(data)
    expected = " or ".join(kinds)
    if header is None or header.kind not in kinds:
        found = f"is a {header.kind}" if header else f"begins with {data[:8]!r}" if data else "is empty, not complete"
        raise error(f"{what} {path} {found}; {expected} is expected")
    if (pixels := header.width * header.height) > MAX_PIXELS:
        size = f"{header.width} x {header.height} pixels"
        raise error(f"{what} {path} has {size}; at most {MAX_PIXELS / 1e6:.0f} million are read")
    if (size := pixels * header.pixel_bytes) > MAX_IMAGE:
        taken = f"would take {size / MEGABYTE:,.0f} MB ({header.pixel_bytes} bytes a pixel)"
        raise error(f"{what} {path} {taken}; at most {MAX_IMAGE / MEGABYTE:,.0f} MB are read")
    if header.frames > 1:
        raise error(f"{what} {path} is animated ({header.frames} frames); one picture is expected")
    image, fault = None, (_chunk_fault if header.kind == "PNG" else _segment_fault)(data)
    if fault is None:
        try:
            image, fault = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED), "OpenCV gives up"
        except cv2.error as reason:
            fault = reason.err
    if image is None:
        raise error(f"{what} {path} cannot be read as a {header.kind}: {fault}: is it complete?")
    return image


def _chunk_fault(data: bytes) -> str | None:
    """Return why a PNG is not whole, or None. OpenCV would allocate the length that a chunk announces."""
    # Source: PNG specification, section 5.3 (length, type, content, checksum).
    at = 8
    while at + 8 <= len(data):
        length, kind = int.from_bytes(data[at : at + 4], "big"), data[at + 4 : at + 8]
        if at + 12 + length > len(data):
            return f"its part {kind!r} at byte {at} has {length:,} bytes, the file {len(data) - at - 8:,} more"
        if kind == b"IEND":
            return None
        at += 12 + length
    return "it has no end"


def _segment_fault(data: bytes) -> str | None:
    """Return why a JPEG is not whole, or None. OpenCV would fill in what is missing, without an error."""
    # Source: ITU-T T.81, section B.1.1 (segments), B.2.1 (a scan, then the end-of-image marker).
    at = 2
    while data[at : at + 1] == b"\xff":
        marker = data[at + 1 : at + 2]
        if marker == b"\xda":  # In a scan only the end has this marker, because 0 follows every 0xFF of the data.
            return None if data.find(b"\xff\xd9", at) > 0 else "it has no end"
        at += 1 if marker == b"\xff" else 2 + int.from_bytes(data[at + 2 : at + 4], "big")
    return f"a segment is expected at byte {at}, where the file {'ends' if at >= len(data) else 'has something else'}"


def image_header(data: bytes) -> ImageHeader | None:
    """Return the header of a PNG or JPEG from its first bytes; None for any other file."""
    # Sources: PNG specification, section 11.2.2 (IHDR); ITU-T T.81, section B.2.2 (frame header).
    if data[:8] == b"\x89PNG\r\n\x1a\n" and data[12:16] == b"IHDR" and len(data) >= 33:
        width, height = struct.unpack(">II", data[16:24])
        control = data.find(b"acTL", 33, 1 << 16)  # of an animated PNG
        frames = struct.unpack(">I", data[control + 4 : control + 8])[0] if 0 < control <= len(data) - 8 else 1
        channels = {0: 1, 2: 3, 3: 4, 4: 4, 6: 4}.get(data[25], 4)  # as OpenCV unpacks them
        return ImageHeader("PNG", width, height, frames, channels * (2 if data[24] == 16 else 1))
    if data[:3] != b"\xff\xd8\xff":
        return None
    at = 2
    while at + 9 <= len(data) and data[at] == 0xFF:
        marker, length = data[at + 1], int.from_bytes(data[at + 2 : at + 4], "big")
        if 0xC0 <= marker <= 0xCF and marker not in (0xC4, 0xC8, 0xCC):
            height, width = struct.unpack(">HH", data[at + 5 : at + 9])
            return ImageHeader("JPEG", width, height, 1, 3)
        at += 1 if marker == 0xFF else 2 + length
    return None


def atomic_write(path: str | Path, content: bytes | str) -> None:
    """Write a file, or replace it, in one step. If it raises `OSError`, with the path, the old file is still whole."""
    path = Path(os.path.realpath(path))
    data = content.encode("utf-8") if isinstance(content, str) else content
    mode = path.stat().st_mode & 0o777 if path.exists() else 0o644
    try:
        handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            os.chmod(temporary, mode)
            os.replace(temporary, path)
        except BaseException:
            os.unlink(temporary)
            raise
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(path)) from error


@contextlib.contextmanager
def staging_dir(out: str | Path, products: Sequence[str] = ()) -> Iterator[Path]:
    """Yield an empty folder. When the body ends, move the folder's files into `out`, each in one step.

    products: files and folders in `out` that the body makes again, so those that it did not make are removed. All else
    in `out` stays. If the body raises, nothing in `out` changes.
    """
    out = Path(os.path.realpath(out))
    out.parent.mkdir(parents=True, exist_ok=True)
    inside = out if out.is_dir() else out.parent  # on the same disk as `out`
    with tempfile.TemporaryDirectory(dir=inside, prefix=f".{out.name}.") as stage:
        new = Path(stage) / "new"
        new.mkdir()
        yield new
        if not out.exists():
            os.rename(new, out)
            return
        earlier = [p for name in products for p in (out / name, *(out / name).rglob("*")) if p.is_file()]
        made = [path.relative_to(new) for path in sorted(new.rglob("*")) if not path.is_dir()]
        for name in made:
            (out / name).parent.mkdir(parents=True, exist_ok=True)
            os.replace(new / name, out / name)
        for path in earlier:
            if path.relative_to(out) not in made:
                path.unlink()


def require_writable(folder: str | Path) -> None:
    """Raise `OSError` unless `folder` can be written into, or made. Call it before long work, not after."""
    folder = Path(os.path.realpath(folder))
    nearest = next(path for path in (folder, *folder.parents) if path.exists())
    with tempfile.TemporaryFile(dir=nearest) as file:
        file.write(bytes(1 << 16))


@contextlib.contextmanager
def temporary_folder() -> Iterator[Path]:
    """Yield an empty folder in the system's temporary folder, and remove it when the body ends."""
    with tempfile.TemporaryDirectory(prefix="course-", ignore_cleanup_errors=True) as folder:
        yield Path(folder)
