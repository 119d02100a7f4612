"""The 2D semantic map M of paper 2, section 2.5: for every object its class c, centroid X_w, and mean H and S.

World frame, metres. Hue in degrees [0, 360), NaN for grey, which has none; saturation in percent [0, 100].
`semantic_map_files` reads and writes it as JSON and CSV.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from course_lib.spherical_stereo.detection.labels import canonical_label

DUPLICATE_DISTANCE = 0.01
"""Metres: two objects of one class whose centroids are nearer than this are one object written twice."""


class SemanticMapError(ValueError):
    """A semantic map, or the file of one, that cannot be used; the message says what is wrong and what to do."""


@dataclass(frozen=True)
class Landmark:
    """One object of the map. Raises `SemanticMapError` for values out of range. Source: paper 2, section 2.5."""

    label: str
    """Class, in the words of `labels`: a "couch" is kept as "sofa"."""
    x: float
    """Centroid, world frame, metres."""
    y: float
    """Centroid, world frame, metres."""
    hue: float
    """Mean hue of the whole object, degrees [0, 360); NaN: the object is grey and has none."""
    saturation: float
    """Mean saturation of the whole object, percent [0, 100]."""

    def __post_init__(self):
        if not isinstance(self.label, str) or not self.label.strip():
            raise SemanticMapError(f"label must be the name of a class, such as 'sofa'; got {self.label!r}")
        try:
            object.__setattr__(self, "label", canonical_label(self.label))
        except ValueError:  # nothing but underscores
            raise SemanticMapError(f"label must be the name of a class, such as 'sofa'; got {self.label!r}") from None
        for name in ("x", "y", "hue", "saturation"):
            object.__setattr__(self, name, _number(getattr(self, name), f"{name} of this {self.label}"))
        if not (math.isfinite(self.x) and math.isfinite(self.y)):
            raise SemanticMapError(f"x and y of this {self.label} must be finite metres; got {self.x}, {self.y}")
        if not math.isnan(self.hue) and not 0 <= self.hue < 360:
            raise SemanticMapError(
                f"hue of this {self.label} must lie in [0, 360) degrees, or be NaN (null in a file) for grey; "
                f"got {self.hue}"
            )
        if not 0 <= self.saturation <= 100:
            raise SemanticMapError(
                f"saturation of this {self.label} must lie in [0, 100] percent; got {self.saturation}"
            )


class SemanticMap:
    """Landmarks, and for drawings the walls around them; it never changes once made.

    landmarks: at least one. walls: `(k, 2)` corners of the room in order, world frame, metres, the last joined to the
    first; no method reads them. name: what the map is called in figures and results.
    Raises `SemanticMapError` for no landmarks, one object written twice (same class, centroids within 1 cm), or
    walls that are not at least three finite corners. Source: paper 2, section 2.5.
    """

    def __init__(self, landmarks: Sequence[Landmark], walls: np.ndarray | None = None, name: str = ""):
        self.landmarks = tuple(landmarks)
        for landmark in self.landmarks:
            if not isinstance(landmark, Landmark):
                raise SemanticMapError(f"landmarks must be Landmark objects; got {type(landmark).__name__}")
        if not self.landmarks:
            raise SemanticMapError("the map is empty: it needs at least one landmark, and a pose needs two")
        self.walls = None if walls is None else _checked_walls(walls)
        self.name = str(name)
        self.labels = tuple(landmark.label for landmark in self.landmarks)
        self.positions = _read_only([[landmark.x, landmark.y] for landmark in self.landmarks])
        """`(n, 2)` centroids, world frame, metres."""
        self.hues = _read_only([landmark.hue for landmark in self.landmarks])
        self.saturations = _read_only([landmark.saturation for landmark in self.landmarks])
        _refuse_duplicates(self.landmarks)

    @property
    def centroid(self) -> np.ndarray:
        """x_G.map `(2,)`: mean of the centroids of all objects on the map, metres. Source: paper 2, section 2.5."""
        return self.positions.mean(axis=0)

    def __len__(self) -> int:
        return len(self.landmarks)

    def __repr__(self) -> str:
        return f"SemanticMap({len(self)} landmarks of {len(set(self.labels))} classes, name={self.name!r})"

    @classmethod
    def load(cls, path: str | Path) -> SemanticMap:
        """The map in a `.json` or `.csv` file; raises `SemanticMapError` for a file that holds none."""
        from course_lib.spherical_stereo.semantic_map.files import read_semantic_map

        return read_semantic_map(path)

    def save(self, path: str | Path) -> None:
        """Writes the map as `.json` or, without walls and name, `.csv`; an old file is replaced whole or not at all."""
        from course_lib.spherical_stereo.semantic_map.files import write_semantic_map

        write_semantic_map(self, path)


def _number(value: object, what: str) -> float:
    # A bool is an int to Python, and a text such as "1.5" would pass float(): both are slips in a file.
    if isinstance(value, bool) or not isinstance(value, (int, float, np.integer, np.floating)):
        raise SemanticMapError(f"{what} must be a number; got {value!r}")
    return float(value)


def _read_only(values: list) -> np.ndarray:
    array = np.array(values, dtype=np.float64)
    array.flags.writeable = False
    return array


def _checked_walls(walls: np.ndarray) -> np.ndarray:
    try:
        corners = _read_only(walls)
    except (TypeError, ValueError):
        corners = np.empty(0)
    if corners.ndim != 2 or corners.shape[1] != 2 or len(corners) < 3 or not np.isfinite(corners).all():
        raise SemanticMapError("walls must be at least three finite corners [x, y] in metres, or left out")
    return corners


def _refuse_duplicates(landmarks: tuple[Landmark, ...]) -> None:
    for i, first in enumerate(landmarks):
        for j, second in enumerate(landmarks[i + 1 :], start=i + 1):
            apart = math.hypot(first.x - second.x, first.y - second.y)
            if first.label == second.label and apart <= DUPLICATE_DISTANCE:
                raise SemanticMapError(
                    f"landmarks {i} and {j} are one {first.label} written twice, at ({first.x:g}, {first.y:g}) m, "
                    f"{apart * 1000:.1f} mm apart: remove one"
                )
