"""Depth-camera recordings: a folder of depth images with intrinsics and poses, as in the 7-Scenes dataset.

depth/NNNNNN*.png   16-bit, depth along the optical axis in millimetres (or other units: read_sequence's
                    units_per_metre), 0 = no measurement
intrinsics.txt      3 x 3 matrix K in pixels, pixel centres at integer coordinates
poses.txt           optional, the truth: frame number, then a row-major 4 x 4 camera-to-world matrix (x right, y down,
                    z forward)
up.txt              optional: which world axis points up (x, -x, y, -y, z, -z); without it nothing is known
groundtruth.txt     optional: the same poses with time stamps, TUM format (t tx ty tz qx qy qz qw)
gravity.txt         optional: frame number, then down as an accelerometer has it, x y z along the camera's axes (right,
                    down, forward), of any length
path_on_floor.txt   optional: the surveyed line on the floor below the camera, x y z per row (the paper's truth)

A folder of the TUM RGB-D dataset is read too: depth.txt (a time and a file name a row) then says which images there are
and when, groundtruth.txt has times of its own, and intrinsics.txt must be added. Its depth has 5000 units a metre.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from course_lib.depth_mcl.camera import DepthCamera
from course_lib.depth_mcl.poses import SequenceError, read_numbers, read_poses, read_tum, write_tum
from course_lib.geometry import UP_AXES
from course_lib.output_folder import replaced_outputs
from course_lib.reading import is_file, is_given, read_image, read_text
from course_lib.writing import write_at_once

NEAR, FAR = 0.1, 11.0  # metres, clip planes: just beyond what an SR4000 (10 m) or a Kinect (5 m) measures

UNITS_PER_METRE = 1000.0  # of depth images: millimetres (7-Scenes); files of the TUM RGB-D dataset have 5000

TUM_TIME_DIFFERENCE = 0.02  # seconds between an image and its pose, as in the dataset's tool associate.py


class DepthSequence:
    """A recording on disk; images are read when asked for.

    frames: frame numbers, ascending. camera_to_world: `(T, 4, 4)` float64, optical convention; None where the truth is
    not known, and asking for it is then a `SequenceError`. intrinsics: `(3, 3)`. image_shape: (height, width). up: "z"
    and the like, or None where nothing is known. times: `(T,)` seconds or None. path_on_floor: `(P, 3)` metres or None.
    units_per_metre: of the depth images. gravity: `(T, 3)` down in the camera's optical frame, or None.
    """

    def __init__(
        self,
        folder: Path,
        frames: list[int],
        files: list[Path],
        camera_to_world: np.ndarray | None,
        intrinsics: np.ndarray,
        image_shape: tuple[int, int],
        up: str | None,
        times: np.ndarray | None,
        path_on_floor: np.ndarray | None,
        units_per_metre: float = UNITS_PER_METRE,
        gravity: np.ndarray | None = None,
    ) -> None:
        self.folder = folder
        self.frames = frames
        self.files = files
        self._camera_to_world = camera_to_world
        self.intrinsics = intrinsics
        self.image_shape = image_shape
        self.up = up
        self.times = times
        self.path_on_floor = path_on_floor
        self.units_per_metre = units_per_metre
        self.gravity = gravity

    @property
    def has_poses(self) -> bool:
        """Whether the true poses are known."""
        return self._camera_to_world is not None

    @property
    def camera_to_world(self) -> np.ndarray:
        """The true poses `(T, 4, 4)`, optical convention; `SequenceError` for a recording that came without."""
        self.require_poses()
        return self._camera_to_world

    def require_poses(self) -> None:
        """Raises `SequenceError` for a recording that came without its true poses."""
        if not self.has_poses:
            raise SequenceError(
                f"{self.folder} holds no poses.txt: its true poses are not known. The filter must be given its start "
                "by hand (localize: --start), and errors cannot be measured"
            )

    def __len__(self) -> int:
        return len(self.frames)

    def thinned(self, every: int, offset: int = 0) -> DepthSequence:
        """Every so many frames of the recording, from `offset` on: as if the camera had been moved so much faster.

        Raises `ValueError` where no frame is left.
        """
        kept = slice(offset, None, every)
        if every < 1 or offset < 0 or not self.frames[kept]:
            raise ValueError(f"every {every}-th of {len(self)} frames from {offset} on: no frame is left")
        return DepthSequence(
            self.folder,
            self.frames[kept],
            self.files[kept],
            None if self._camera_to_world is None else self._camera_to_world[kept],
            self.intrinsics,
            self.image_shape,
            self.up,
            None if self.times is None else self.times[kept],
            self.path_on_floor,
            self.units_per_metre,
            None if self.gravity is None else self.gravity[kept],
        )

    def camera(self, near: float = NEAR, far: float = FAR) -> DepthCamera:
        """The depth camera that made the recording; near, far: its clip planes, metres."""
        height, width = self.image_shape
        return DepthCamera.from_matrix(self.intrinsics, width, height, near, far)

    def depth(self, index: int) -> np.ndarray:
        """Depth image `(H, W)` float32 metres of the index-th frame; NaN where nothing was measured."""
        depth = read_depth_png(self.files[index], self.units_per_metre)
        if depth.shape != self.image_shape:
            raise SequenceError(
                f"{self.files[index]} is {depth.shape[1]} x {depth.shape[0]} pixels, the first image of the sequence "
                f"{self.image_shape[1]} x {self.image_shape[0]}: a sequence has one image size"
            )
        return depth

    def __iter__(self) -> Iterator[tuple[int, np.ndarray, np.ndarray | None]]:
        """Yields (frame number, depth image, camera-to-world matrix or None where the truth is not known)."""
        for index, frame in enumerate(self.frames):
            yield frame, self.depth(index), self._camera_to_world[index] if self.has_poses else None

    def __repr__(self) -> str:
        return f"DepthSequence({str(self.folder)!r}, {len(self)} frames, up={self.up!r})"


def read_sequence(folder: str | Path, units_per_metre: float = UNITS_PER_METRE) -> DepthSequence:
    """The recording in a folder (format: top of this module), with or without its true poses.

    units_per_metre: what the depth images count in; 1000 for millimetres, 5000 for files of the TUM RGB-D dataset.
    Raises `FileNotFoundError` for a missing folder or file, `SequenceError` (a `ValueError`) for malformed ones,
    intrinsics that do not fit the images, and poses whose frame numbers are not those of the images.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise FileNotFoundError(f"no sequence at {folder}: give a folder with depth/ and intrinsics.txt")
    require_units(units_per_metre)
    if is_given(folder / "depth.txt"):
        images, times, camera_to_world = _read_tum_folder(folder)
        frames = sorted(images)
    elif is_given(folder / "poses.txt"):
        images = _depth_files(folder)
        frames, camera_to_world = read_poses(folder / "poses.txt")
        _require_same_frames(folder, frames, sorted(images))
        times = _read_times(folder, camera_to_world)
    else:
        images = _depth_files(folder)
        frames, times, camera_to_world = sorted(images), None, None
    intrinsics = read_numbers(folder / "intrinsics.txt")
    if intrinsics.shape != (3, 3):
        raise SequenceError(f"{folder / 'intrinsics.txt'} must hold a 3 x 3 matrix; got {intrinsics.shape}")
    image_shape = read_depth_png(images[frames[0]]).shape
    try:
        DepthCamera.from_matrix(intrinsics, width=image_shape[1], height=image_shape[0])
    except ValueError as error:
        raise SequenceError(f"{folder / 'intrinsics.txt'}: {error}") from error
    path_file = folder / "path_on_floor.txt"
    path_on_floor = read_numbers(path_file) if is_given(path_file) else None
    if path_on_floor is not None and (path_on_floor.ndim != 2 or path_on_floor.shape[1] != 3):
        raise SequenceError(f"{path_file} must hold x y z per row; got shape {path_on_floor.shape}")
    return DepthSequence(
        folder, frames, [images[f] for f in frames], camera_to_world, intrinsics, image_shape, _read_up(folder),
        times, path_on_floor, units_per_metre, _read_gravity(folder, frames),
    )  # fmt: skip


def require_units(units_per_metre: float) -> None:
    """Raises `ValueError` unless a metre has a positive, finite number of depth units."""
    if not (np.isfinite(units_per_metre) and units_per_metre > 0):
        raise ValueError(
            f"a metre must have a positive number of depth units (1000 for millimetres, 5000 in TUM files); got "
            f"{units_per_metre!r}"
        )


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
    """Writes a recording as `read_sequence` reads it.

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
    with replaced_outputs(folder, None) as new:  # as a whole: without its last files it would pass for another one
        if (folder / "poses.txt").exists() or any((folder / "depth").glob("*.png")):
            raise ValueError(
                f"{folder} already holds a recording, or part of one: give a new folder, or delete it first"
            )
        (new / "depth").mkdir()
        for frame, depth in zip(frames, depths, strict=True):
            write_depth_png(new / "depth" / f"{frame:06d}.png", depth)
        np.savetxt(new / "intrinsics.txt", intrinsics, fmt="%.6f", header="K, pixel centres at integer coordinates")
        if up is not None:
            (new / "up.txt").write_text(up + "\n")
        if times is not None:
            write_tum(new / "groundtruth.txt", times, camera_to_world)
        if path_on_floor is not None:
            told = f"x y z, metres; {len(path_on_floor)} rows"
            np.savetxt(new / "path_on_floor.txt", path_on_floor, fmt="%.4f", header=told)
        np.savetxt(
            new / "poses.txt",
            np.column_stack([frames, camera_to_world.reshape(-1, 16)]),
            fmt=["%d"] + ["%.9g"] * 16,
            header="frame  T_world_cam row-major 4x4 (camera-to-world, metres)",
        )


def read_depth_png(path: str | Path, units_per_metre: float = UNITS_PER_METRE) -> np.ndarray:
    """Depth image `(H, W)` float32 metres from a 16-bit PNG, in millimetres or as told; 0 becomes NaN (unmeasured)."""
    image = read_image(path, "depth image", SequenceError, kinds=("PNG",), missing=FileNotFoundError)
    if image.dtype != np.uint16 or image.ndim != 2:
        raise SequenceError(f"{path} must be a 16-bit single-channel PNG; got {image.dtype} with shape {image.shape}")
    depth = image.astype(np.float32)
    depth *= np.float32(1 / units_per_metre)
    depth[image == 0] = np.nan
    return depth


def write_depth_png(path: str | Path, depth: np.ndarray) -> None:
    """Writes a depth image in metres as a 16-bit PNG in mm; NaN, infinity and what 16 bits cannot hold as 0."""
    import cv2

    depth = np.asarray(depth, dtype=np.float64)
    millimetres = np.rint(np.nan_to_num(depth * 1000.0, nan=0.0, posinf=0.0, neginf=0.0))
    image = np.where((millimetres > 0) & (millimetres <= 65535), millimetres, 0).astype(np.uint16)
    ok, encoded = cv2.imencode(".png", image, [cv2.IMWRITE_PNG_COMPRESSION, 9])
    if not ok:
        raise SequenceError(f"{path}: the image of shape {depth.shape} could not be encoded as PNG")
    write_at_once(path, encoded.tobytes())


def _depth_files(folder: Path) -> dict[int, Path]:
    """Depth images of a recording by frame number: the first run of digits in the name."""
    if not (folder / "depth").is_dir():
        raise FileNotFoundError(f"{folder} has no folder depth/ with 16-bit PNG images")
    files: dict[int, Path] = {}
    for path in sorted((folder / "depth").glob("*.png")):
        digits = re.search(r"\d+", path.name)
        if digits is None:
            raise SequenceError(f"{path.name} in {folder / 'depth'} has no frame number in its name")
        if int(digits.group()) in files:
            raise SequenceError(
                f"{files[int(digits.group())].name} and {path.name} in {folder / 'depth'} would both be frame "
                f"{int(digits.group())}: the frame number must be the first number in the name"
            )
        files[int(digits.group())] = path
    if not files:
        raise SequenceError(f"{folder / 'depth'} holds no PNG images")
    return files


def _require_same_frames(folder: Path, pose_frames: list[int], image_frames: list[int]) -> None:
    if pose_frames == image_frames:
        return
    without_image = sorted(set(pose_frames) - set(image_frames))[:3]
    without_pose = sorted(set(image_frames) - set(pose_frames))[:3]
    raise SequenceError(
        f"{folder / 'poses.txt'} and {folder / 'depth'} name other frames: {len(pose_frames)} poses, "
        f"{len(image_frames)} images; "
        f"poses without an image start {without_image}, images without a pose {without_pose}"
    )


def _read_tum_folder(folder: Path) -> tuple[dict[int, Path], np.ndarray, np.ndarray | None]:
    """Images by their row in depth.txt (1, 2, ...), times `(T,)` in seconds, and poses `(T, 4, 4)` where there are any.

    With groundtruth.txt an image's pose is the one nearest in time, and an image without one within
    `TUM_TIME_DIFFERENCE` is left out, as the dataset's own tool associate.py does it.
    """
    text = read_text(folder / "depth.txt", "list of images", SequenceError)
    rows = [line.split() for line in text.splitlines() if line.strip()[:1] not in ("", "#")]
    try:
        times = np.array([float(time) for time, _ in rows])
    except ValueError as error:
        raise SequenceError(f"{folder / 'depth.txt'} must hold a time and a file name a row: {error}") from error
    images = {row: folder / name for row, (_, name) in enumerate(rows, start=1)}
    if not images:
        raise SequenceError(f"{folder / 'depth.txt'} names no image")
    missing = [(row, name) for row, name in images.items() if not is_file(name)]
    if missing:
        row, image = missing[0][0], str(missing[0][1].relative_to(folder))[:80]
        raise SequenceError(
            f"{folder / 'depth.txt'} names {len(missing)} images that are no files, {image} in row {row} first"
        )
    if not is_given(folder / "groundtruth.txt"):
        return images, times, None
    true_times, true_poses = read_tum(folder / "groundtruth.txt")
    nearest = np.abs(times[:, None] - true_times).argmin(axis=1)
    timed = np.abs(times - true_times[nearest]) <= TUM_TIME_DIFFERENCE
    if not timed.any():
        raise SequenceError(f"no time in depth.txt of {folder} is within {TUM_TIME_DIFFERENCE} s of groundtruth.txt")
    kept = {row: path for (row, path), good in zip(images.items(), timed, strict=True) if good}
    return kept, times[timed], true_poses[nearest[timed]]


def _read_times(folder: Path, camera_to_world: np.ndarray) -> np.ndarray | None:
    """Times of groundtruth.txt, which must hold the poses of poses.txt; None where it is missing."""
    path = folder / "groundtruth.txt"
    if not is_given(path):
        return None
    times, timed_poses = read_tum(path)
    if len(times) != len(camera_to_world) or not np.allclose(timed_poses, camera_to_world, atol=1e-3):
        raise SequenceError(
            f"groundtruth.txt and poses.txt in {folder} do not hold the same {len(camera_to_world)} poses"
        )
    return times


def _read_gravity(folder: Path, frames: list[int]) -> np.ndarray | None:
    path = folder / "gravity.txt"
    if not is_given(path):
        return None
    rows = read_numbers(path)
    if rows.shape[1] != 4 or not (rows[:, 1:] != 0).any(axis=1).all():
        raise SequenceError(
            f"{path} must hold a frame number and x y z, not all zero, per row; got {rows.shape[1]} columns"
        )
    by_frame = {int(row[0]): row[1:] for row in rows}
    missing = [frame for frame in frames if frame not in by_frame]
    if missing:
        raise SequenceError(f"{path} has no row for frame {missing[0]} (and {len(missing) - 1} others)")
    return np.array([by_frame[frame] for frame in frames])


def _read_up(folder: Path) -> str | None:
    path = folder / "up.txt"
    if not is_given(path):
        return None
    up = read_text(path, "the upward axis", SequenceError).strip()
    if up not in UP_AXES:
        raise SequenceError(f"{path} must name one of {', '.join(UP_AXES)}; got {up!r}")
    return up
