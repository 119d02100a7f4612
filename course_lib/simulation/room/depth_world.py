"""The furnished rooms of paper 2 as paper 1 sees them: a world for a depth camera, and its laser-scanned mesh map.

What the camera sees is cast against the room itself; the map is what a few registered scans of it gave, with noise,
holes behind furniture, and decimation. The filter never sees the room.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.random import Generator

from course_lib.simulation.corridor.surface_fusion import FusionModel, fuse, simplify
from course_lib.simulation.furniture.solids import merged
from course_lib.simulation.room.footprints import free_places
from course_lib.simulation.room.scene import Room
from course_lib.simulation.sensors.laser_survey import ScannerModel, survey
from course_lib.simulation.sensors.ray_casting import WorldCaster

STREAM = 77  # joins a seed's generators of what the depth camera meets: apart from those of the photographs
MAP, CAMERA, PLACE = 1, 2, 3  # streams of a seed: the mesh map's survey, the camera's fixed pattern, each place
REFLECTIVITY = 0.6  # of every surface, at 850 nm: textures say nothing of it (chosen: paint and cloth)


@dataclass(frozen=True)
class DepthSurveyModel:
    """How a room is scanned for a mesh map."""

    stations: int = 4  # chosen: a room is scanned from its corners
    scanner: ScannerModel = field(default_factory=lambda: ScannerModel(step_deg=0.3))  # chosen: a room is small
    fusion: FusionModel = field(default_factory=lambda: FusionModel(triangles=60_000))  # chosen


def room_triangles(room: Room) -> tuple[np.ndarray, np.ndarray]:
    """All triangles of a room: vertices `(V, 3)` metres, faces `(F, 3)`."""
    return merged([*room.shell, *(mesh for thing in room.objects for mesh in thing.meshes)])


def depth_caster(room: Room) -> WorldCaster:
    """What a depth camera's rays meet in a room."""
    return WorldCaster(*room_triangles(room), REFLECTIVITY)


def surveyed_mesh(room: Room, model: DepthSurveyModel, rng: Generator) -> tuple[np.ndarray, np.ndarray]:
    """The room's mesh map, vertices `(V, 3)` metres and faces `(F, 3)`, from scans at free places."""
    stations = tuple((float(x), float(y)) for x, y in free_places(room, model.stations, rng))
    scans = survey(depth_caster(room), model.scanner, rng, stations)
    return simplify(*fuse([scan.as_registered() for scan in scans], model.fusion), model.fusion)
