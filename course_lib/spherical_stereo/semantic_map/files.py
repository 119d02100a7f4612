"""Semantic maps on disk: JSON, which keeps everything, and CSV, which a spreadsheet opens.

JSON, version 1; `name` and `walls` may be left out, hue is null for grey:

    {"version": 1, "name": "room",
     "landmarks": [{"label": "sofa", "x": 1.5, "y": 0.4, "hue": 210.0, "saturation": 55.0}, ...],
     "walls": [[0.0, 0.0], [6.0, 0.0], [6.0, 6.0], [0.0, 6.0]]}

CSV, version 1: the version in a comment on the first line, a header, a row for each object, hue empty for grey. It has
no place for walls and name. The number of landmarks may be left out; where it stands, a cut-off file is noticed:

    # semantic map, version 1, 1 landmarks
    label,x,y,hue,saturation
    sofa,1.5,0.4,210.0,55.0
"""

from __future__ import annotations

import csv
import io
import json
import math
import re
from pathlib import Path

from course_lib.files import atomic_write, read_json, read_text
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap, SemanticMapError

VERSION = 1
_FIELDS = ("label", "x", "y", "hue", "saturation")
_CSV_FIRST_LINE = f"# semantic map, version {VERSION}"


def read_semantic_map(path: str | Path) -> SemanticMap:
    """The map in a `.json` or `.csv` file.

    Raises `SemanticMapError`, with the file's name, for a file that cannot be read, is not JSON or CSV, has another
    version, lacks fields, or holds values that no map may have.
    """
    path = Path(path)
    if path.suffix.lower() not in (".json", ".csv"):
        raise SemanticMapError(f"{path}: a semantic map is a .json or a .csv file")
    parse, make = (read_json, _from_json) if path.suffix.lower() == ".json" else (read_text, _from_csv)
    content = parse(path, "semantic map", SemanticMapError)
    try:
        return make(content)
    except SemanticMapError as error:
        raise SemanticMapError(f"{path}: {error}") from None


def write_semantic_map(semantic_map: SemanticMap, path: str | Path) -> None:
    """Writes `.json` (everything) or `.csv` (landmarks only).

    Nothing is ever half-written. Raises `SemanticMapError` for another ending, `OSError` where it cannot be written.
    """
    path = Path(path)
    as_text = {".json": _to_json, ".csv": _to_csv}.get(path.suffix.lower())
    if as_text is None:
        raise SemanticMapError(f"{path}: a semantic map is saved as .json or .csv")
    atomic_write(path, as_text(semantic_map))


def _to_json(semantic_map: SemanticMap) -> str:
    landmarks = [
        {name: _null_if_nan(getattr(landmark, name)) for name in _FIELDS} for landmark in semantic_map.landmarks
    ]
    content = {"version": VERSION, "name": semantic_map.name, "landmarks": landmarks}
    if semantic_map.walls is not None:
        content["walls"] = semantic_map.walls.tolist()
    return json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def _null_if_nan(value: str | float) -> str | float | None:
    return None if isinstance(value, float) and math.isnan(value) else value


def _from_json(content: object) -> SemanticMap:
    if not isinstance(content, dict):
        raise SemanticMapError(f"the file must hold a JSON object with version and landmarks; got {_kind(content)}")
    _check_version(content.get("version"))
    rows = content.get("landmarks")
    if not isinstance(rows, list):
        raise SemanticMapError(f"landmarks must be a list of objects; got {_kind(rows)}")
    name = content.get("name", "")
    if not isinstance(name, str):
        raise SemanticMapError(f"name must be a text; got {_kind(name)}")
    return SemanticMap([_landmark(row, number) for number, row in enumerate(rows)], content.get("walls"), name)


def _to_csv(semantic_map: SemanticMap) -> str:
    text = io.StringIO()
    text.write(f"{_CSV_FIRST_LINE}, {len(semantic_map.landmarks)} landmarks\n")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(_FIELDS)
    for landmark in semantic_map.landmarks:
        values = (_null_if_nan(getattr(landmark, name)) for name in _FIELDS)
        writer.writerow(["" if value is None else value for value in values])
    return text.getvalue()


def _from_csv(text: str) -> SemanticMap:
    first, _, rest = text.partition("\n")
    # A spreadsheet fills the comment's row up with commas and may put it in quotes.
    found = re.fullmatch(r'"?#\s*semantic map,\s*version\s+([^\s,"]+)(?:,\s*(\d+) landmarks)?"?,*\s*', first)
    if found is None:
        raise SemanticMapError(f"the first line must be '{_CSV_FIRST_LINE}'; got {first[:60]!r}")
    _check_version(int(found[1]) if found[1].isdecimal() else found[1])
    reader = csv.DictReader(io.StringIO(rest))
    missing = [name for name in _FIELDS if name not in (reader.fieldnames or [])]
    if missing:
        raise SemanticMapError(f"the second line must name the columns {','.join(_FIELDS)}; missing: {missing}")
    landmarks = []
    for number, row in enumerate(reader):
        if None in row:  # where the reader puts what no column is named for
            raise SemanticMapError(
                f"line {reader.line_num + 1} has {len(row[None])} values too many for {len(reader.fieldnames)} columns;"
                " write numbers with a decimal point, and a label with a comma in quotes"
            )
        landmarks.append(_landmark(_csv_row(row), number))
    if found[2] is not None and (len(landmarks) != int(found[2]) or not text.endswith("\n")):
        raise SemanticMapError(
            f"the first line announces {found[2]} landmarks, the file holds {len(landmarks)}"
            f"{'' if text.endswith(chr(10)) else ', and its last line has no end'}: was it cut off? If you took some "
            "out or added some, change that number, or leave it out"
        )
    return SemanticMap(landmarks)


def _csv_row(row: dict) -> dict:
    values = {name: row[name] for name in _FIELDS if row[name] is not None}
    for name in _FIELDS[1:]:
        text = (values.get(name) or "").strip()
        if name == "hue" and name in values and text == "":
            values[name] = None
        elif text:
            try:
                values[name] = float(text)
            except ValueError:
                values[name] = text  # Landmark names it
        else:
            values.pop(name, None)
    return values


def _landmark(row: object, number: int) -> Landmark:
    if not isinstance(row, dict):
        raise SemanticMapError(f"landmark {number} must be an object with {', '.join(_FIELDS)}; got {_kind(row)}")
    missing = [name for name in _FIELDS if name not in row]
    if missing:
        raise SemanticMapError(
            f"landmark {number} lacks {', '.join(missing)} (the hue of grey is null, or empty in CSV)"
        )
    values = {name: row[name] for name in _FIELDS}
    if isinstance(values["hue"], float) and math.isnan(values["hue"]):
        raise SemanticMapError(f"landmark {number}: hue is NaN; the hue of grey is null, or empty in CSV")
    if values["hue"] is None:
        values["hue"] = math.nan
    try:
        return Landmark(**values)
    except SemanticMapError as error:
        raise SemanticMapError(f"landmark {number}: {error}") from None


def _check_version(version: object) -> None:
    if isinstance(version, bool) or version != VERSION:
        given = "none" if version is None else repr(version)
        raise SemanticMapError(f"the version must be {VERSION}, the only one this program knows; got {given}")


def _kind(value: object) -> str:
    return {dict: "an object", list: "a list", str: "a text", type(None): "nothing"}.get(type(value), repr(value))
