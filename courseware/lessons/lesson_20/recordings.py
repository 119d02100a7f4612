"""A reader's recording or the course's, the ways to misread one, and how far each is from the map."""

import dataclasses
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from course_lib.depth_mcl.sequence import DepthSequence, read_sequence, write_sequence
from course_lib.files import temporary_folder
from course_lib.geometry import pose_matrix
from course_lib.recordings import Run, run_sequence
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap, mesh_endings
from courseware.lessons.kit.corridor_data import corridor_map
from courseware.paths import data_path

STAND_IN_FRAMES = 24  # of the corridor run that was carried by hand: as many as the panel steps through (chosen)


class Recording(NamedTuple):
    """A depth-camera sequence and the map that it is compared with."""

    name: str
    sequence: DepthSequence
    scene_map: SceneMap


def recording(folder: str | Path | None = None) -> Recording:
    """Read the reader's recording with `map.*` (any mesh) beside it. None: the stand-in, the simulated corridor.

    Raises what `read_sequence` and `SceneMap.load` raise, and FileNotFoundError unless there is one map.
    """
    if folder is None:
        sequence = read_sequence(data_path("corridor/hand"))
        return Recording("stand-in: the corridor, carried by hand", sequence, corridor_map())
    folder = Path(folder)
    maps = sorted(path for path in folder.glob("map.*") if path.suffix.lower().lstrip(".") in mesh_endings())
    if folder.is_dir() and not maps:
        raise FileNotFoundError(f"no map in {folder}: put the mesh there as map.ply (or .obj, .stl, .glb), in metres")
    if len(maps) > 1:
        names = f"{maps[0].name} and {maps[1].name}"
        raise FileNotFoundError(f"{len(maps)} maps in {folder}, {names}: leave one of them there")
    return Recording(folder.name, read_sequence(folder), SceneMap.load(maps[0]))


# Name -> factor on depths, function of the camera-to-world matrix (4, 4), factor on fx and fy. The first reading is
# right. Each of the others makes one mistake that people really make.
READINGS = {
    "as the formats say": (1.0, np.array, 1.0),
    "depth: 5000 units a metre": (1000 / 5000, np.array, 1.0),
    "poses: world to camera": (1.0, np.linalg.inv, 1.0),
    "camera axes: y up, z backward": (1.0, lambda pose: pose @ np.diag([1.0, -1.0, -1.0, 1.0]), 1.0),
    "K: focal lengths twice too long": (1.0, np.array, 2.0),
    "map: turned by 3 degrees": (1.0, lambda pose: pose @ pose_matrix(np.deg2rad([0, 0, 0, 0, 3.0, 0])), 1.0),
}


class Compared(NamedTuple):
    """One frame under one reading, beside the map: images `(H, W)` in metres."""

    measured: np.ndarray  # NaN where nothing was measured
    seen: np.ndarray  # the map from the pose, inf where nothing is hit

    @property
    def images(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the measured depth, the depth of the map, and |z - z_map|, which is NaN where one is missing."""
        difference = np.abs(self.measured - self.seen)
        return self.measured, self.seen, np.where(np.isfinite(difference), difference, np.nan)

    @property
    def median(self) -> float:
        """Return the median of |z - z_map| [m], or NaN if no measured pixel hits the map."""
        known = self.images[2][np.isfinite(self.images[2])]
        return float(np.median(known)) if len(known) else float("nan")

    @property
    def hits(self) -> float:
        """Return the share of the measured pixels whose ray hits the map, 0 to 1."""
        measured = np.isfinite(self.measured)
        return float(np.isfinite(self.seen[measured]).mean()) if measured.any() else 0.0


class Checker:
    """Compares frames of a recording with its map, under any reading. It keeps a renderer for each focal length."""

    def __init__(self, given: Recording) -> None:
        self.given = given
        self._renderers: dict[float, DepthRenderer] = {}

    def __call__(self, index: int, reading: str = "as the formats say", shift: float = 0.0) -> Compared:
        """Return frame `index`, read as `reading` says. shift: moves the camera to its right, metres."""
        (depth_scale, pose_of, focal_scale), sequence = READINGS[reading], self.given.sequence
        pose = pose_of(sequence.camera_to_world[index])
        pose[:3, 3] += shift * pose[:3, 0]
        if focal_scale not in self._renderers:
            camera = sequence.camera()
            camera = dataclasses.replace(camera, fx=camera.fx * focal_scale, fy=camera.fy * focal_scale)
            self._renderers[focal_scale] = DepthRenderer(self.given.scene_map, camera)
        seen = self._renderers[focal_scale].render_poses(pose[None])[0]
        return Compared(sequence.depth(index) * np.float32(depth_scale), seen)


def misread_run(given: Recording, reading: str, frames: int, **options: object) -> Run:
    """Run the filter on the first frames of a misread recording. options: of `run_sequence`.

    The misread recording is written to a folder of its own and read back, as a reader's would be.
    """
    (depth_scale, pose_of, focal_scale), sequence = READINGS[reading], given.sequence
    frames = min(frames, len(sequence))
    k = sequence.intrinsics * np.array([[focal_scale, 1, 1], [1, focal_scale, 1], [1, 1, 1]])
    depths = [sequence.depth(index) * np.float32(depth_scale) for index in range(frames)]
    poses = [pose_of(pose) for pose in sequence.camera_to_world[:frames]]
    with temporary_folder() as folder:
        write_sequence(folder, k, sequence.frames[:frames], depths, poses, up=sequence.up)
        return run_sequence(given.scene_map, read_sequence(folder), **options)


def compare_readings(checker: Checker, frames: Sequence[int]) -> dict[str, list[Compared]]:
    """Return for every reading, the right one first, each of the frames compared with the map."""
    return {name: [checker(frame, name) for frame in frames] for name in READINGS}


def readings_table(readings: dict[str, list[Compared]]) -> str:
    """Return a table of `compare_readings`: the medians of |z - z_map| over the frames, and the hits."""
    lines = [f"{'read with':34} {'median |z - z_map|, over the frames':37} pixels on the map"]
    for name, compared in readings.items():
        medians, told = np.array([one.median for one in compared]), "no number"
        if np.isfinite(medians).any():
            low, middle, high = np.nanmin(medians), np.nanmedian(medians), np.nanmax(medians)
            told = f"{middle:.3f} m ({low:.3f} to {high:.3f})"
        lines.append(f"{name:34} {told:37} {np.mean([one.hits for one in compared]):.0%}")
    return "\n".join(lines)
