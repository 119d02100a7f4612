"""The 2D semantic map M of paper 2, section 2.5: for every object its class c, centroid X_w, and mean H and S.

World frame, metres. Hue in degrees [0, 360), NaN for grey, which has none; saturation in percent [0, 100].

A map is saved as JSON, which keeps everything, or as CSV, which a spreadsheet opens. JSON, version 1; `name` and
`walls` may be left out, hue is null for grey:

    {"version": 1, "name": "room",
     "landmarks": [{"label": "sofa", "x": 1.5, "y": 0.4, "hue": 210.0, "saturation": 55.0}, ...],
     "walls": [[0.0, 0.0], [6.0, 0.0], [6.0, 6.0], [0.0, 6.0]]}

CSV, version 1; hue is empty for grey. The number of landmarks may be left out; with it, a cut-off file is noticed:

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
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from course_lib.files import atomic_write, read_json, read_text
from course_lib.spherical_stereo.detection.detected_object import DetectionError, canonical_label

DUPLICATE_DISTANCE = 0.01  # Metres. Two objects of one class whose centroids are nearer are one object written twice.
VERSION = 1
_FIELDS = ("label", "x", "y", "hue", "saturation")
_CSV_FIRST_LINE = f"# semantic map, version {VERSION}"


class SemanticMapError(ValueError):
    """A semantic map, or its file, that cannot be used; the message says why and what to do."""


@dataclass(frozen=True)
class Landmark:
    """One object of the map. Raises `SemanticMapError` for values out of range. Source: paper 2, section 2.5."""

    label: str  # class, kept as its canonical label
    x: float  # centroid, world frame, metres
    y: float
    hue: float  # mean of the whole object, degrees [0, 360), NaN for grey
    saturation: float  # mean, percent [0, 100]

    def __post_init__(self):
        try:
            object.__setattr__(self, "label", canonical_label(self.label))
        except DetectionError as error:
            raise SemanticMapError(str(error)) from None
        for name in _FIELDS[1:]:
            value = getattr(self, name)
            # A bool is an int to Python, and a text such as "1.5" would pass float(): both are slips in a file.
            if isinstance(value, bool) or not isinstance(value, (int, float, np.integer, np.floating)):
                raise SemanticMapError(f"{name} of this {self.label} must be a number; got {value!r}")
            object.__setattr__(self, name, float(value))
        is_colour = (math.isnan(self.hue) or 0 <= self.hue < 360) and 0 <= self.saturation <= 100
        if not (math.isfinite(self.x) and math.isfinite(self.y) and is_colour):
            raise SemanticMapError(
                "x and y must be finite metres, hue in [0, 360) degrees (grey: null in JSON, empty in CSV), saturation "
                f"in [0, 100] percent; got {self}"
            )


class SemanticMap:
    """Landmarks, and for drawings the walls around them. It never changes once made.

    walls: `(k, 2)` corners of the room in order, world frame, metres. Raises `SemanticMapError` for no landmarks, one
    object written twice, or walls that are not at least three finite corners. Source: paper 2, section 2.5.
    """

    def __init__(self, landmarks: Sequence[Landmark], walls: np.ndarray | None = None, name: str = ""):
        self.landmarks = tuple(landmarks)
        if not self.landmarks or not all(isinstance(one, Landmark) for one in self.landmarks):
            raise SemanticMapError("the map is empty or holds others than Landmarks; it needs one, a pose needs two")
        self.walls = None if walls is None else _read_only(walls)
        if walls is not None and not (
            self.walls.shape[1:] == (2,) and len(self.walls) >= 3 and np.isfinite(walls).all()
        ):
            raise SemanticMapError("walls must be at least three finite corners [x, y] in metres, or left out")
        self.name = str(name)
        self.labels = tuple(landmark.label for landmark in self.landmarks)
        self.positions = _read_only([[landmark.x, landmark.y] for landmark in self.landmarks])  # `(n, 2)`, metres
        self.hues = _read_only([landmark.hue for landmark in self.landmarks])
        self.saturations = _read_only([landmark.saturation for landmark in self.landmarks])
        for i, first in enumerate(self.landmarks):
            for j, second in enumerate(self.landmarks[i + 1 :], start=i + 1):
                apart = math.hypot(first.x - second.x, first.y - second.y)
                if first.label == second.label and apart <= DUPLICATE_DISTANCE:
                    raise SemanticMapError(
                        f"landmarks {i} and {j} are one {first.label} written twice, at ({first.x:g}, {first.y:g}) m, "
                        f"{apart * 1000:.1f} mm apart: remove one"
                    )

    @property
    def centroid(self) -> np.ndarray:
        """Return x_G.map `(2,)`: mean of the centroids of all objects on the map, metres."""
        return self.positions.mean(axis=0)

    def __len__(self) -> int:
        return len(self.landmarks)

    def __repr__(self) -> str:
        return f"SemanticMap({len(self)} landmarks of {len(set(self.labels))} classes, name={self.name!r})"

    @classmethod
    def load(cls, path: str | Path) -> SemanticMap:
        """Read a `.json` or `.csv` file (format: see the module). Raises `SemanticMapError` with the file's name."""
        readers = {".json": (read_json, _from_json), ".csv": (read_text, _from_csv)}
        if Path(path).suffix.lower() not in readers:
            raise SemanticMapError(f"{path}: a semantic map is a .json or a .csv file")
        read, parse = readers[Path(path).suffix.lower()]
        content = read(path, "semantic map", SemanticMapError)
        try:
            return parse(content)
        except (TypeError, ValueError) as error:
            raise SemanticMapError(f"{path}: {error}") from None

    def save(self, path: str | Path) -> None:
        """Write the map as `.json` or, without walls and name, `.csv`. An old file is replaced whole or not at all.

        Raises `SemanticMapError` for another ending, `OSError` if the file cannot be written.
        """
        rows = [{name: None if x != x else x for name, x in asdict(one).items()} for one in self.landmarks]
        ending = Path(path).suffix.lower()
        if ending == ".json":
            content = {"version": VERSION, "name": self.name, "landmarks": rows}
            if self.walls is not None:
                content["walls"] = self.walls.tolist()
            atomic_write(path, json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False) + "\n")
        elif ending == ".csv":
            text = io.StringIO()
            text.write(f"{_CSV_FIRST_LINE}, {len(self)} landmarks\n")
            writer = csv.DictWriter(text, _FIELDS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
            atomic_write(path, text.getvalue())
        else:
            raise SemanticMapError(f"{path}: a semantic map is saved as .json or .csv")


def _read_only(values: list) -> np.ndarray:
    array = np.array(values, dtype=np.float64)
    array.flags.writeable = False
    return array


def _from_json(content: object) -> SemanticMap:
    if not isinstance(content, dict) or not isinstance(content.get("landmarks"), list):
        raise SemanticMapError("the file must hold a JSON object with version and a list of landmarks")
    if content.get("version") != VERSION:
        raise SemanticMapError(f"the version must be {VERSION}; got {content.get('version')!r}")
    landmarks = []
    for number, row in enumerate(content["landmarks"]):
        missing = [name for name in _FIELDS if not isinstance(row, dict) or row.get(name, "") == ""]
        try:
            if missing or row["hue"] != row["hue"]:
                lacks = ", ".join(missing) or "a hue"
                raise SemanticMapError(f"lacks {lacks} (grey has the hue null, or empty in CSV)")
            hue = math.nan if row["hue"] is None else row["hue"]
            landmarks.append(Landmark(row["label"], row["x"], row["y"], hue, row["saturation"]))
        except SemanticMapError as error:
            raise SemanticMapError(f"landmark {number}: {error}") from None
    return SemanticMap(landmarks, content.get("walls"), str(content.get("name", "")))


def _from_csv(text: str) -> SemanticMap:
    """Return the map in a CSV, by way of the same content as in JSON."""
    first, _, rest = text.partition("\n")
    # A spreadsheet fills the comment's row up with commas and may put it in quotes.
    found = re.fullmatch(r'"?#\s*semantic map,\s*version\s+([^\s,"]+)(?:,\s*(\d+) landmarks)?"?,*\s*', first)
    if found is None:
        raise SemanticMapError(f"the first line must be '{_CSV_FIRST_LINE}'; got {first[:60]!r}")
    reader = csv.DictReader(io.StringIO(rest))
    if not set(_FIELDS) <= set(reader.fieldnames or []):
        raise SemanticMapError(f"the second line must name the columns {','.join(_FIELDS)}; got {reader.fieldnames}")
    rows = []
    for row in reader:
        if None in row or None in row.values():  # the reader's mark for too many values, and for too few
            expected = len(reader.fieldnames)
            raise SemanticMapError(f"line {reader.line_num + 1} must have {expected} values, one a column")
        rows.append({name: _csv_value(name, row[name]) for name in _FIELDS})
    if found[2] is not None and (len(rows) != int(found[2]) or not text.endswith("\n")):
        raise SemanticMapError(
            f"the first line announces {found[2]} landmarks, the file holds {len(rows)} and may be cut off. Change "
            "that number, or leave it out, and end the last line"
        )
    version = int(found[1]) if found[1].isdecimal() else found[1]
    return _from_json({"version": version, "landmarks": rows})


def _csv_value(name: str, text: str) -> object:
    """Return the number that a text is, None for an empty hue, and otherwise the text, which `Landmark` names."""
    if name == "hue" and not text.strip():
        return None
    try:
        return text if name == "label" else float(text)
    except ValueError:
        return text.strip()
