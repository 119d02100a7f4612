"""Are all rows of a mesh in text form whole? trimesh takes rows of other lengths together, and shifts what follows.

Found with damaged files: a face of 0 corners read as a square (OFF), a face among the vertices read as a vertex (PLY),
a vertex of two numbers completed from the next one (OBJ), a triangle whose loop was cut read with its neighbours (STL).
"""

from __future__ import annotations

import re
from collections.abc import Iterator

_NUMBER = rb"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|[-+]?(?:nan|inf|infinity)"
_NUMBERS = re.compile(rb"\s*(?:(?:%b)(?:\s+|$))*" % _NUMBER, re.I)
_CORNER = re.compile(rb"-?\d+(?:/-?\d*){0,2}")

_PLY_FORMATS = [[kind, b"1.0"] for kind in (b"ascii", b"binary_little_endian", b"binary_big_endian")]
_PLY_TYPES = frozenset(
    b"char uchar short ushort int uint float double int8 uint8 int16 uint16 int32 uint32 float32 float64".split()
)
_OBJ_WORDS = frozenset(
    b"v vt vn vp deg bmat step cstype p l f curv curv2 surf parm trim hole scrv sp end con g s mg o bevel c_interp "
    b"d_interp lod usemap maplib usemtl mtllib shadow_obj trace_obj ctech stech call csh".split()
)
"""A vertex whose word is damaged would be left out, and every face after it would take other vertices.

Source: Wavefront, Object Files (.obj), version 3.0, without what it calls superseded.
"""


def row_fault(data: bytes, kind: str) -> str | None:
    """What is wrong with the first bad row, "line 7: ...", or None. kind: "ply", "off", "obj", "stl". Of a binary
    file only the header is looked at."""
    faults = {"ply": _ply, "off": _off, "obj": _obj, "stl": _stl}.get(kind)
    return next(faults(data), None) if faults else None


def _shown(words: list[bytes]) -> str:
    return repr(b" ".join(words)[:60].decode("ascii", "replace"))


def _fields(line: bytes) -> list[bytes] | None:
    """The numbers of a row, None where something else stands in it."""
    return line.split() if _NUMBERS.fullmatch(line) else None


def _polygon_fault(fields: list[bytes] | None, more: int = 0) -> str | None:
    """more: other numbers of the row; -1: any."""
    if not fields or not fields[0].isdigit() or int(fields[0]) < 3:
        return "a face is its number of corners, 3 or more, and as many vertices"
    rest = len(fields) - 1 - int(fields[0])
    if rest < 0 or more not in (-1, rest):
        return f"a face of {int(fields[0])} corners has {len(fields) - 1} more numbers"
    return None


def _ply_header(header: bytes) -> Iterator[str]:
    """trimesh takes the second line for the format, passes over words it does not know, and of two of one name drops
    one: every row after it is then read from the wrong place."""
    elements: list[list[bytes]] = []
    names: list[bytes] = []
    for number, words in enumerate((line.split() for line in header.splitlines()), start=1):
        found = f"found {_shown(words)}"
        if (words[:1] == [b"format"]) != (number == 2) or (number == 2 and words[1:] not in _PLY_FORMATS):
            yield f"line {number}: 'format ascii 1.0', or binary, is expected on line 2; {found}"
        if words[:1] == [b"element"]:
            if len(words) != 3 or not words[2].isdigit():
                yield f"line {number}: element, a name and a whole number are expected; {found}"
            if words[1:2] in elements:
                yield f"line {number}: there are two elements {words[1].decode('ascii', 'replace')}"
            elements.append(words[1:2])
            names = []
        elif words[:1] == [b"property"]:
            kinds = words[2:4] if words[1:2] == [b"list"] else words[1:2]
            if len(words) - len(kinds) != (3 if len(kinds) == 2 else 2) or not _PLY_TYPES.issuperset(kinds):
                yield f"line {number}: property, its type (or list and two types) and a name are expected; {found}"
            if words[-1] in names:
                yield f"line {number}: the element has two properties {words[-1].decode('ascii', 'replace')}"
            names.append(words[-1])
        elif number > 1 and words and words[0] not in (b"format", b"comment", b"obj_info"):
            yield f"line {number}: element, property or comment is expected; {found}"


def _ply(data: bytes) -> Iterator[str]:
    header, _, body = data.partition(b"end_header")
    yield from _ply_header(header)
    if not re.search(rb"^\s*format\s+ascii", header, re.M):
        return
    rows = iter(enumerate(body.splitlines()[1:], start=header.count(b"\n") + 2))
    elements: list[tuple[bytes, int, list[bytes]]] = []
    for words in (line.split() for line in header.splitlines()):
        if words[:1] == [b"element"] and len(words) == 3 and words[2].isdigit():
            elements.append((words[1], int(words[2]), []))
        elif words[:1] == [b"property"] and len(words) > 1 and elements:
            elements[-1][2].append(words[1])
    for name, count, kinds in elements:
        lists = kinds.count(b"list")
        for _ in range(count):
            number, line = next(rows, (0, b""))
            fields, fault = _fields(line), None
            if name == b"face" and kinds == [b"list"]:
                fault = _polygon_fault(fields)
            elif fields is None or (len(fields) != len(kinds) if not lists else len(fields) < len(kinds)):
                fault = f"{len(kinds)} numbers are expected"
            if fault:
                yield f"line {number}, {name.decode('ascii', 'replace')}: {fault}; found {line[:60]!r}"


def _off(data: bytes) -> Iterator[str]:
    lines = [(number, line.partition(b"#")[0].strip()) for number, line in enumerate(data.splitlines(), start=1)]
    rows = [(number, line) for number, line in lines if line]
    if rows and not re.match(rb"(?:ST)?C?N?OFF\b", rows[0][1]):  # trimesh leaves out what is before it
        yield f"line {rows[0][0]}: OFF is expected; found {rows[0][1][:60]!r}"
    if rows and re.fullmatch(rb"C?OFF", rows[0][1]):
        rows = rows[1:]
    elif rows:
        rows[0] = rows[0][0], re.sub(rb"^C?OFF\s*", b"", rows[0][1])
    counts = _fields(rows[0][1]) if rows else None
    if not counts or len(counts) < 2 or not (counts[0].isdigit() and counts[1].isdigit()):
        return  # trimesh says what is wrong with it
    vertices, faces = int(counts[0]), int(counts[1])
    for number, line in rows[1 : 1 + vertices]:
        if len(_fields(line) or ()) < 3:
            yield f"line {number}: a vertex is three numbers; found {line[:60]!r}"
    for number, line in rows[1 + vertices : 1 + vertices + faces]:
        if fault := _polygon_fault(_fields(line), more=-1):
            yield f"line {number}: {fault}; found {line[:60]!r}"


def _obj(data: bytes) -> Iterator[str]:
    for number, line in enumerate(data.replace(b"\\\r\n", b"   ").replace(b"\\\n", b"  ").splitlines(), start=1):
        words = line.partition(b"#")[0].split()
        if words[:1] == [b"v"]:
            # Three, with a weight or a colour, or both.
            if len(words) - 1 not in (3, 4, 6, 7) or not _NUMBERS.fullmatch(b" ".join(words[1:])):
                yield f"line {number}: a vertex is three numbers; found {line[:60]!r}"
        elif words and words[0] not in _OBJ_WORDS:
            yield f"line {number}: {_shown(words[:1])} is no word of OBJ's; found {line[:60]!r}"
        elif words[:1] == [b"f"] and (len(words) < 4 or not all(map(_CORNER.fullmatch, words[1:]))):
            yield f"line {number}: a face is three vertices or more; found {line[:60]!r}"


def _stl(data: bytes) -> Iterator[str]:
    if not (data[:5] == b"solid" and b"facet" in data[:1000]):
        return
    after_vertex, outside = 0, True
    for number, line in enumerate(data.lower().splitlines(), start=1):
        words = line.split()
        if words[:1] == [b"vertex"]:
            after_vertex += 1
            if outside or after_vertex > 3 or len(words) != 4 or not _NUMBERS.fullmatch(b" ".join(words[1:])):
                yield f"line {number}: three vertices of three numbers stand in a loop; found {line[:60]!r}"
        elif words == [b"outer", b"loop"]:
            if not outside:
                yield f"line {number}: a loop begins in a loop"
            after_vertex, outside = 0, False
        elif words == [b"endloop"]:
            if outside or after_vertex != 3:
                yield f"line {number}: a loop ends after {after_vertex} vertices; 3 are expected"
            outside = True
        elif b"vertex" in line and words[:1] != [b"solid"]:
            yield f"line {number}: a vertex begins its line; found {line[:60]!r}"
    if not outside:
        yield f"line {number}: a loop is not closed"
