"""Read and write depth-camera recordings: a folder of depth images, intrinsics and poses, as in the 7-Scenes dataset.

depth/NNNNNN*.png   16-bit, depth along the optical axis in millimetres (or other units: read_sequence's
                    units_per_metre), 0 = no measurement
intrinsics.txt      3 x 3 matrix K in pixels, pixel centres at integer coordinates
poses.txt           optional, the truth: frame number, then a row-major 4 x 4 camera-to-world matrix (x right, y down,
                    z forward)
up.txt              optional: which world axis points up (x, -x, y, -y, z, -z); without it nothing is known
groundtruth.txt     optional: the same poses with time stamps, TUM format (t tx ty tz qx qy qz qw)
gravity.txt         optional: frame number, then down as an accelerometer has it, x y z along the camera's axes (right,
                    down, forward), of any length
accelerometer.txt   optional, where the frames have times: time, then the acceleration that is measured, x y z along the
                    same axes (as in the TUM RGB-D dataset); used where there is no gravity.txt
path_on_floor.txt   optional: the surveyed line on the floor below the camera, x y z per row (the paper's truth)

A folder of the TUM RGB-D dataset is read too: depth.txt (a time and a file name a row) then says which images there are
and when, groundtruth.txt has times of its own, and intrinsics.txt must be added. Its depth has 5000 units a metre.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from course_lib.depth_mcl import sequence_files
from course_lib.depth_mcl.sequence_files import UNITS_PER_METRE, SequenceError, read_depth_png
from course_lib.files import is_given, staging_dir
from course_lib.geometry import UP_AXES
from course_lib.rendering.camera import DepthCamera

NEAR, FAR = 0.1, 11.0  # metres, clip planes: just beyond what an SR4000 (10 m) or a Kinect (5 m) measures


@dataclass(frozen=True, eq=False, repr=False)
class DepthSequence:
    """A recording on disk; images are read when asked for."""

    folder: Path
    frames: list[int]  # frame numbers, ascending
    files: list[Path]  # one depth image a frame
    true_poses: np.ndarray | None  # `(T, 4, 4)` camera-to-world, optical convention; None where the truth is not known
    intrinsics: np.ndarray  # K `(3, 3)`, pixels
    image_shape: tuple[int, int]  # (height, width).
    up: str | None  # world axis that points up, such as "z"; None where nothing is known
    times: np.ndarray | None  # `(T,)` seconds
    path_on_floor: np.ndarray | None  # `(P, 3)` metres
    units_per_metre: float = UNITS_PER_METRE  # what the depth images count in
    gravity: np.ndarray | None = None  # `(T, 3)` down in the camera's optical frame

    @property
    def has_poses(self) -> bool:
        """Return whether the true poses are known."""
        return self.true_poses is not None

    @property
    def camera_to_world(self) -> np.ndarray:
        """Return the true poses `(T, 4, 4)`, optical convention; `SequenceError` for a recording that came without."""
        self.require_poses()
        return self.true_poses

    def require_poses(self) -> None:
        """Raise `SequenceError` for a recording that came without its true poses."""
        if not self.has_poses:
            raise SequenceError(
                f"{self.folder} holds no poses.txt: its true poses are not known. The filter must be given its start "
                "by hand (localize: --start), and errors cannot be measured"
            )

    def __len__(self) -> int:
        return len(self.frames)

    def thinned(self, every: int, offset: int = 0) -> DepthSequence:
        """Return every so many frames of the recording, from `offset` on, as if the camera moved so much faster.

        Raises `ValueError` where no frame is left.
        """
        kept = slice(offset, None, every)
        if every < 1 or offset < 0 or not self.frames[kept]:
            raise ValueError(f"every {every}-th of {len(self)} frames from {offset} on: no frame is left")
        per_frame = ("frames", "files", "true_poses", "times", "gravity")
        values = {name: getattr(self, name) for name in per_frame}
        return dataclasses.replace(
            self, **{name: None if value is None else value[kept] for name, value in values.items()}
        )

    @property
    def period(self) -> float | None:
        """Return the median seconds from frame to frame; None where the times are not known, or do not ascend."""
        steps = [] if self.times is None else np.diff(self.times)
        return float(np.median(steps)) if len(steps) and np.median(steps) > 0 else None

    def camera(self, near: float = NEAR, far: float = FAR) -> DepthCamera:
        """Return the depth camera that made the recording; near, far: its clip planes, metres."""
        height, width = self.image_shape
        return DepthCamera.from_matrix(self.intrinsics, width, height, near, far)

    def depth(self, index: int) -> np.ndarray:
        """Return the depth image `(H, W)` float32 metres of the index-th frame; NaN where nothing was measured."""
        depth = read_depth_png(self.files[index], self.units_per_metre)
        if depth.shape != self.image_shape:
            raise SequenceError(
                f"{self.files[index]} is {depth.shape[1]} x {depth.shape[0]} pixels, the first image of the sequence "
                f"{self.image_shape[1]} x {self.image_shape[0]}: a sequence has one image size"
            )
        return depth

    def __iter__(self) -> Iterator[tuple[int, np.ndarray, np.ndarray | None]]:
        """Yield (frame number, depth image, camera-to-world matrix or None where the truth is not known)."""
        for index, frame in enumerate(self.frames):
            yield frame, self.depth(index), self.true_poses[index] if self.has_poses else None

    def __repr__(self) -> str:
        return f"DepthSequence({str(self.folder)!r}, {len(self)} frames, up={self.up!r})"


def read_sequence(folder: str | Path, units_per_metre: float = UNITS_PER_METRE) -> DepthSequence:
    """Return the recording in a folder (format: top of this module), with or without its true poses.

    units_per_metre: what the depth images count in; 1000 for millimetres, 5000 for files of the TUM RGB-D dataset.
    Raises `FileNotFoundError` for a missing folder or file, `SequenceError` (a `ValueError`) for malformed ones,
    intrinsics that do not fit the images, and poses whose frame numbers are not those of the images.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise FileNotFoundError(f"no sequence at {folder}: give a folder with depth/ and intrinsics.txt")
    if not (np.isfinite(units_per_metre) and units_per_metre > 0):
        raise ValueError(
            "a metre must have a positive number of depth units (1000 for millimetres, 5000 in TUM files); got "
            f"{units_per_metre!r}"
        )
    if is_given(folder / "depth.txt"):
        images, times, camera_to_world = sequence_files.read_tum_folder(folder)
        frames = sorted(images)
    elif is_given(folder / "poses.txt"):
        images = sequence_files.depth_files(folder)
        frames, camera_to_world = sequence_files.read_poses(folder / "poses.txt")
        sequence_files.require_same_frames(folder, frames, sorted(images))
        times = sequence_files.read_times(folder, camera_to_world)
    else:
        images = sequence_files.depth_files(folder)
        frames, times, camera_to_world = sorted(images), None, None
    intrinsics = sequence_files.read_numbers(folder / "intrinsics.txt")
    if intrinsics.shape != (3, 3):
        raise SequenceError(f"{folder / 'intrinsics.txt'} must hold a 3 x 3 matrix; got {intrinsics.shape}")
    image_shape = read_depth_png(images[frames[0]]).shape
    try:
        DepthCamera.from_matrix(intrinsics, width=image_shape[1], height=image_shape[0])
    except ValueError as error:
        raise SequenceError(f"{folder / 'intrinsics.txt'}: {error}") from error
    return DepthSequence(
        folder, frames, [images[f] for f in frames], camera_to_world, intrinsics, image_shape,
        sequence_files.read_up(folder), times, sequence_files.read_path_on_floor(folder), units_per_metre,
        sequence_files.read_gravity(folder, frames, times),
    )  # fmt: skip


def write_sequence(
    folder: str | Path,
    intrinsics: np.ndarray,
    frames: list[int],
    depths: list[np.ndarray],
    camera_to_world: np.ndarray,
    times: np.ndarray | None = None,
    up: str | None = None,
    path_on_floor: np.ndarray | None = None,
) -> None:
    """Write a recording as `read_sequence` reads it.

    depths: one `(H, W)` float array a frame, metres, NaN = no measurement. camera_to_world: `(T, 4, 4)`, optical.
    times: `(T,)` seconds; with them the poses are also written as a TUM trajectory. Raises `ValueError`, before any
    file is written, where the lengths differ or the folder already holds a recording.
    """
    folder = Path(folder)
    camera_to_world = np.asarray(camera_to_world, dtype=np.float64)
    if not len(frames) == len(depths) == len(camera_to_world):
        raise ValueError(f"{len(frames)} frame numbers, {len(depths)} images, {len(camera_to_world)} poses: must agree")
    if times is not None and len(times) != len(frames):
        raise ValueError(f"{len(times)} times for {len(frames)} frames: must agree")
    if up is not None and up not in UP_AXES:
        raise ValueError(f"up must be one of {', '.join(UP_AXES)} or None; got {up!r}")
    if list(frames) != sorted(set(frames)):
        raise ValueError("frame numbers must ascend, each once")
    if len({np.shape(depth) for depth in depths}) > 1:
        raise ValueError(f"images must have one size; got {sorted({np.shape(depth) for depth in depths})}")
    with staging_dir(folder) as new:  # as a whole: without its last files it would pass for another one
        if (folder / "poses.txt").exists() or any((folder / "depth").glob("*.png")):
            raise ValueError(
                f"{folder} already holds a recording, or part of one: give a new folder, or delete it first"
            )
        (new / "depth").mkdir()
        for frame, depth in zip(frames, depths, strict=True):
            sequence_files.write_depth_png(new / "depth" / f"{frame:06d}.png", depth)
        np.savetxt(new / "intrinsics.txt", intrinsics, fmt="%.6f", header="K, pixel centres at integer coordinates")
        if up is not None:
            (new / "up.txt").write_text(up + "\n")
        if times is not None:
            sequence_files.write_tum(new / "groundtruth.txt", times, camera_to_world)
        if path_on_floor is not None:
            told = f"x y z, metres; {len(path_on_floor)} rows"
            np.savetxt(new / "path_on_floor.txt", path_on_floor, fmt="%.4f", header=told)
        np.savetxt(
            new / "poses.txt",
            np.column_stack([frames, camera_to_world.reshape(-1, 16)]),
            fmt=["%d"] + ["%.9g"] * 16,
            header="frame  T_world_cam row-major 4x4 (camera-to-world, metres)",
        )
