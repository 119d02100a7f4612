"""The files of a recording, each read and checked: depth images, their list, times, gravity, the upward axis.

`course_lib.depth_mcl.sequence` says what they hold and joins them; files of poses are in `course_lib.depth_mcl.poses`.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from course_lib.depth_mcl.poses import SequenceError, read_numbers, read_tum
from course_lib.files import atomic_write, is_file, is_given, read_image, read_text
from course_lib.geometry import UP_AXES

UNITS_PER_METRE = 1000.0  # of depth images: millimetres (7-Scenes); files of the TUM RGB-D dataset have 5000

TUM_TIME_DIFFERENCE = 0.02  # seconds between an image and its pose, as in the dataset's tool associate.py


def require_units(units_per_metre: float) -> None:
    """Raises `ValueError` unless a metre has a positive, finite number of depth units."""
    if not (np.isfinite(units_per_metre) and units_per_metre > 0):
        raise ValueError(
            f"a metre must have a positive number of depth units (1000 for millimetres, 5000 in TUM files); got "
            f"{units_per_metre!r}"
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
    atomic_write(path, encoded.tobytes())


def depth_files(folder: Path) -> dict[int, Path]:
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


def require_same_frames(folder: Path, pose_frames: list[int], image_frames: list[int]) -> None:
    """Raises `SequenceError` unless poses.txt and the images have the same frame numbers, both given ascending."""
    if pose_frames == image_frames:
        return
    without_image = sorted(set(pose_frames) - set(image_frames))[:3]
    without_pose = sorted(set(image_frames) - set(pose_frames))[:3]
    raise SequenceError(
        f"{folder / 'poses.txt'} and {folder / 'depth'} name other frames: {len(pose_frames)} poses, "
        f"{len(image_frames)} images; "
        f"poses without an image start {without_image}, images without a pose {without_pose}"
    )


def read_tum_folder(folder: Path) -> tuple[dict[int, Path], np.ndarray, np.ndarray | None]:
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


def read_times(folder: Path, camera_to_world: np.ndarray) -> np.ndarray | None:
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


def read_gravity(folder: Path, frames: list[int]) -> np.ndarray | None:
    """Down in the camera's optical frame `(T, 3)`, of any length, from gravity.txt; None where it is missing."""
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


def read_up(folder: Path) -> str | None:
    """Which world axis points up, from up.txt; None where it is missing."""
    path = folder / "up.txt"
    if not is_given(path):
        return None
    up = read_text(path, "the upward axis", SequenceError).strip()
    if up not in UP_AXES:
        raise SequenceError(f"{path} must name one of {', '.join(UP_AXES)}; got {up!r}")
    return up
