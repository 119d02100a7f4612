"""Lesson 20, your own data: a reader's recording or pair of panoramas, else the course's; the ways to misread one."""

from __future__ import annotations

import dataclasses
import functools
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from course_lib.depth_mcl.camera import DepthCamera
from course_lib.depth_mcl.rendering.renderer import DepthRenderer
from course_lib.depth_mcl.scene_map import SceneMap
from course_lib.depth_mcl.sequence import DepthSequence, read_sequence, write_sequence
from course_lib.experiments.recordings import Run, run_sequence
from course_lib.geometry import rotation_exp
from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider
from course_lib.lessons.kit.paths import data_path
from course_lib.lessons.lesson_20.own_panoramas import PanoramaPair, disparity_picture, panorama_pair
from course_lib.plots import figures

__all__ = ["PanoramaPair", "disparity_picture", "panorama_pair"]  # for the notebook: the half of paper 2

STAND_IN_FRAMES = 24  # of the corridor run that was carried by hand: as many as the panel steps through (chosen)
BOUNDS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)  # that numbers are printed against
_OPENGL_TO_OPTICAL = np.diag([1.0, -1.0, -1.0, 1.0])
_DIFFERENCE_LIMIT = 0.3  # metres, end of the colour scale of differences


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
        return Recording("stand-in: the corridor, carried by hand", sequence, _corridor_map())
    maps = sorted(Path(folder).glob("map.*"))
    if Path(folder).is_dir() and not maps:
        raise MissingMapError(f"no map in {folder}: put the mesh there as map.ply (or .obj, .stl, .glb), in metres")
    sequence = read_sequence(folder)
    return Recording(Path(folder).name, sequence, SceneMap.load(maps[0]))


@functools.cache
def _corridor_map() -> SceneMap:
    return SceneMap.load(data_path("corridor/map.ply"))


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


def at_most(value: float, unit: str = "m") -> str:
    """A number as the least of `BOUNDS` that it does not pass, so that it prints alike on every machine."""
    if not np.isfinite(value):
        return "no number"
    bound = next((bound for bound in BOUNDS if value <= bound), None)
    return f"above {BOUNDS[-1]:g} {unit}" if bound is None else f"at most {bound:g} {unit}"


def _axes_of(compared: Compared, size: tuple[float, float]):
    figure, axes = figures.new_figure(1, 3, size=size)
    finite = compared.measured[np.isfinite(compared.measured)]
    limits = (0.0, float(np.ceil(np.percentile(finite, 98))) if len(finite) else 5.0)
    drawn = [
        figures.depth_image(axes[0], compared.measured, "Measured", limits),
        figures.depth_image(axes[1], compared.seen, "The map, from the given pose", limits),
        figures.depth_image(axes[2], compared.difference, "Difference", (0.0, _DIFFERENCE_LIMIT)),
    ]
    for a in axes[1:]:
        a.set_ylabel("v [pixels]")
    figures.colour_bar(figure, drawn[1], axes[:2])
    figures.colour_bar(figure, drawn[2], axes[2], "|z - z_map| [m]")
    return figure, drawn


def check_figure(compared: Compared) -> Figure:
    """A frame, the map seen from its pose, and the difference of the two."""
    return _axes_of(compared, (9.4, 2.7))[0]


def reading_panel(given: Recording | None = None) -> Panel:
    """Read a recording in one wrong way after the other: what the picture and the two numbers say."""
    checker = Checker(given or recording())
    last = min(STAND_IN_FRAMES, len(checker.given.sequence)) - 1
    figure, drawn = _axes_of(checker(0), (9.4, 2.7))
    live = LiveFigure(figure, drawn)

    def draw(reading: str, frame: float, shift: float) -> Drawing:
        compared = checker(int(frame), reading, shift)
        for image, values in zip(drawn, (compared.measured, compared.seen, compared.difference), strict=True):
            image.set_data(np.ma.masked_invalid(values))
        numbers = f"{compared.hits:.0%} of the measured pixels hit the map"
        if np.isfinite(compared.median):
            numbers = f"median |z - z_map| = {compared.median:.3f} m;  {numbers}"
        alt = f"Frame {int(frame)}, read with {reading}: the measured depth, the map, and their difference. {numbers}."
        return Drawing(live.png(), alt, f"{reading}, camera moved by {shift:.2f} m\n{numbers}")

    controls = [
        Choice("reading", "how the files are read", tuple(READINGS), next(iter(READINGS))),
        Slider("frame", "frame [-]", 0, max(1, last), 0, 1),
        Slider("shift", "camera moved to the right [m]", -0.3, 0.3, 0.0, 0.01),
    ]
    return Panel("20 read it wrongly", controls, draw)


def track_figure(given: Recording, estimated: np.ndarray) -> Figure:
    """True and estimated camera positions of the first frames, over the frames.

    estimated: `(T, 4, 4)` camera-to-world matrices.
    """
    true = given.sequence.camera_to_world[: len(estimated), :3, 3]
    moved, found = true - true[0], estimated[:, :3, 3] - true[0]
    reach = 1.1 * max(0.3, np.abs(moved).max(), np.abs(found).max())
    figure, axes = figures.new_figure(1, 3, size=(9.0, 2.5))
    for index, (a, name) in enumerate(zip(axes, "xyz", strict=True)):
        a.plot(moved[:, index], color="black", linewidth=3, alpha=0.35, label="given in poses.txt")
        a.plot(found[:, index], **(figures.line_style(0) | {"linestyle": "none"}), label="estimate")
        a.set(title=f"{name} since the first frame", xlabel="frame [-]", ylabel=f"{name} [m]", ylim=(-reach, reach))
    axes[0].legend(loc="lower left", fontsize=8, framealpha=0.9)
    return figure


def misread_run(given: Recording, reading: str, frames: int, **options: object) -> Run:
    """The filter on the first frames of a recording whose files say what `reading` makes of them: `run_sequence`.

    The misread recording is written to a folder of its own and read back, as a reader's would be.
    """
    way, sequence = READINGS[reading], given.sequence
    k = sequence.intrinsics * np.array([[way.focal_scale, 1, 1], [1, way.focal_scale, 1], [1, 1, 1]])
    depths = [sequence.depth(index) * np.float32(way.depth_scale) for index in range(frames)]
    poses = [way.pose(pose) for pose in sequence.camera_to_world[:frames]]
    with tempfile.TemporaryDirectory() as folder:
        write_sequence(Path(folder), k, sequence.frames[:frames], depths, poses, up=sequence.up)
        return run_sequence(given.scene_map, read_sequence(folder), **options)


def readings_table(checker: Checker, frames: Sequence[int]) -> str:
    """Every reading: the median of |z - z_map| over some frames, and whether most pixels hit the map."""
    lines = [f"{'read with':34} {'median |z - z_map|':20} pixels on the map"]
    for name in READINGS:
        compared = [checker(frame, name) for frame in frames]
        together = np.concatenate([one.difference.ravel() for one in compared])
        together = together[np.isfinite(together)]
        median = float(np.median(together)) if len(together) else float("nan")
        hits = float(np.mean([one.hits for one in compared]))
        lines.append(f"{name:34} {at_most(median):20} {'most' if hits >= 0.5 else 'less than half'}")
    return "\n".join(lines)


PANELS = {"20 read it wrongly": reading_panel}
