"""A reader's recording or the course's, the ways to misread one, and how far each is from the map."""

import dataclasses
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from course_lib.depth_mcl.sequence import DepthSequence, read_sequence, write_sequence
from course_lib.experiments.recordings import Run, run_sequence
from course_lib.files import temporary_folder
from course_lib.geometry import rotation_exp
from course_lib.lessons.kit.corridor_views import corridor_map
from course_lib.paths import data_path
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap, mesh_endings

STAND_IN_FRAMES = 24  # of the corridor run that was carried by hand: as many as the panel steps through (chosen)
_OPENGL_TO_OPTICAL = np.diag([1.0, -1.0, -1.0, 1.0])


class MissingMapError(FileNotFoundError):
    """A folder with a recording, but without the mesh that it is compared with."""


class Recording(NamedTuple):
    """A depth-camera sequence and the map that it is compared with."""

    name: str
    sequence: DepthSequence
    scene_map: SceneMap


def recording(folder: str | Path | None = None) -> Recording:
    """The reader's recording with `map.*` (any mesh) beside it; None: the course's stand-in, the simulated corridor.

    Raises what `read_sequence` and `SceneMap.load` raise, and `MissingMapError` where there is no map.
    """
    if folder is None:
        sequence = read_sequence(data_path("corridor/hand"))
        return Recording("stand-in: the corridor, carried by hand", sequence, corridor_map())
    maps = sorted(path for path in Path(folder).glob("map.*") if path.suffix.lower().lstrip(".") in mesh_endings())
    if Path(folder).is_dir() and len(maps) != 1:
        raise MissingMapError(
            f"no map in {folder}: put the mesh there as map.ply (or .obj, .stl, .glb), in metres"
            if not maps
            else f"{len(maps)} maps in {folder}, {maps[0].name} and {maps[1].name}: leave one of them there"
        )
    sequence = read_sequence(folder)
    return Recording(Path(folder).name, sequence, SceneMap.load(maps[0]))


class Reading(NamedTuple):
    """One way to take the numbers of a recording."""

    depth_scale: float = 1.0
    """Factor on every depth."""
    pose: Callable[[np.ndarray], np.ndarray] = lambda pose: pose
    """Camera-to-world matrix `(4, 4)` -> the one that this reading takes."""
    focal_scale: float = 1.0
    """Factor on fx and fy."""


READINGS = {
    "as the formats say": Reading(),
    "depth: 5000 units a metre": Reading(depth_scale=1000 / 5000),
    "poses: world to camera": Reading(pose=np.linalg.inv),
    "camera axes: y up, z backward": Reading(pose=lambda pose: pose @ _OPENGL_TO_OPTICAL),
    "K: focal lengths twice too long": Reading(focal_scale=2.0),
    "map: turned by 3 degrees": Reading(pose=lambda pose: _turned(pose, np.deg2rad(3.0))),
}
"""Name -> reading; the first is right, each of the others makes one mistake that people really make."""


def _turned(pose: np.ndarray, angle: float) -> np.ndarray:
    """The camera turned about its own vertical, as if recording and map were not quite in one frame."""
    turned = pose.copy()
    turned[:3, :3] = pose[:3, :3] @ rotation_exp(np.array([0.0, angle, 0.0]))
    return turned


class Compared(NamedTuple):
    """One frame under one reading, beside the map."""

    measured: np.ndarray
    """`(H, W)` metres, NaN where nothing was measured."""
    seen: np.ndarray
    """`(H, W)` metres, the map from the pose; inf where nothing is hit."""

    @property
    def difference(self) -> np.ndarray:
        """|z - z_map| `(H, W)` metres; NaN where one of the two is missing."""
        difference = np.abs(self.measured - self.seen)
        return np.where(np.isfinite(difference), difference, np.nan)

    @property
    def median(self) -> float:
        """Median of |z - z_map|, metres; NaN where no measured pixel hits the map."""
        known = self.difference[np.isfinite(self.difference)]
        return float(np.median(known)) if len(known) else float("nan")

    @property
    def hits(self) -> float:
        """Share of the measured pixels whose ray hits the map, 0 to 1."""
        measured = np.isfinite(self.measured)
        return float(np.isfinite(self.seen[measured]).mean()) if measured.any() else 0.0


class Checker:
    """Compares frames of a recording with its map, under any reading; keeps a renderer for each focal length."""

    def __init__(self, given: Recording) -> None:
        self.given = given
        self._renderers: dict[float, DepthRenderer] = {}

    def __call__(self, index: int, reading: str = "as the formats say", shift: float = 0.0) -> Compared:
        """Frame `index`, read as `reading` says; shift: the camera moved to its right, metres."""
        way, sequence = READINGS[reading], self.given.sequence
        pose = way.pose(sequence.camera_to_world[index])
        pose = pose.copy()
        pose[:3, 3] += shift * pose[:3, 0]
        seen = self._renderer(way.focal_scale).render_poses(pose[None])[0]
        return Compared(sequence.depth(index) * np.float32(way.depth_scale), seen)

    def _renderer(self, focal_scale: float) -> DepthRenderer:
        if focal_scale not in self._renderers:
            camera: DepthCamera = self.given.sequence.camera()
            camera = dataclasses.replace(camera, fx=camera.fx * focal_scale, fy=camera.fy * focal_scale)
            self._renderers[focal_scale] = DepthRenderer(self.given.scene_map, camera)
        return self._renderers[focal_scale]


def misread_run(given: Recording, reading: str, frames: int, **options: object) -> Run:
    """The filter on the first frames of a recording whose files say what `reading` makes of them: `run_sequence`.

    The misread recording is written to a folder of its own and read back, as a reader's would be.
    """
    way, sequence = READINGS[reading], given.sequence
    frames = min(frames, len(sequence))
    k = sequence.intrinsics * np.array([[way.focal_scale, 1, 1], [1, way.focal_scale, 1], [1, 1, 1]])
    depths = [sequence.depth(index) * np.float32(way.depth_scale) for index in range(frames)]
    poses = [way.pose(pose) for pose in sequence.camera_to_world[:frames]]
    with temporary_folder() as folder:
        write_sequence(folder, k, sequence.frames[:frames], depths, poses, up=sequence.up)
        return run_sequence(given.scene_map, read_sequence(folder), **options)


def compare_readings(checker: Checker, frames: Sequence[int]) -> dict[str, list[Compared]]:
    """Name of every reading, the right one first -> what it makes of each of the frames."""
    return {name: [checker(frame, name) for frame in frames] for name in READINGS}


def readings_table(readings: dict[str, list[Compared]]) -> str:
    """Of `compare_readings`: the median of |z - z_map|, least and greatest of a frame, and the hits."""
    lines = [f"{'read with':34} {'median |z - z_map|, over the frames':37} pixels on the map"]
    for name, compared in readings.items():
        medians = np.array([one.median for one in compared])
        told = "no number"
        if np.isfinite(medians).any():
            low, middle, high = np.nanmin(medians), np.nanmedian(medians), np.nanmax(medians)
            told = f"{middle:.3f} m ({low:.3f} to {high:.3f})"
        lines.append(f"{name:34} {told:37} {np.mean([one.hits for one in compared]):.0%}")
    return "\n".join(lines)
