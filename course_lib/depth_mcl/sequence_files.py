"""The files of a recording, each read and checked: depth images, poses, times, gravity, the upward axis.

`course_lib.depth_mcl.sequence` says what they hold and joins them. Poses are camera-to-world matrices in the optical
convention (x right, y down, z forward), metres: poses.txt as in the 7-Scenes dataset, TUM trajectories
(t tx ty tz qx qy qz qw), or one 4 x 4 matrix.
"""

import io
import re
import warnings
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from course_lib.files import atomic_write, is_file, is_given, read_image, read_text
from course_lib.geometry import UP_AXES, is_rotation, rotation_mean

UNITS_PER_METRE = 1000.0  # of depth images: millimetres (7-Scenes); files of the TUM RGB-D dataset have 5000

TUM_TIME_DIFFERENCE = 0.02  # seconds between an image and its pose, as in the dataset's tool associate.py

ACCELEROMETER_SAMPLES = 51  # whose mean is gravity; the Kinect of these recordings gives 500 a second (chosen)
ACCELEROMETER_GAP = 0.5  # seconds between an image and the nearest sample, at most (chosen)


class SequenceError(ValueError):
    """A recording that cannot be used: a missing or malformed file, or files that do not fit each other."""


def read_numbers(path: Path) -> np.ndarray:
    """Rows of numbers `(rows, columns)`, finite, from a text file; `SequenceError` for anything else in it.

    A first line such as "# x y z, metres; 214 rows" announces how many there are: a file that was cut off is noticed.
    """
    text = read_text(path, "file", SequenceError, missing=FileNotFoundError)
    lines = text.splitlines()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # of an empty file, which gets an error below
            numbers = np.loadtxt(lines, dtype=np.float64, ndmin=2)
    except ValueError as error:
        raise SequenceError(f"{path} must hold rows of numbers, all of one length: {error}") from error
    announced = re.match(r"#.*\b(\d+) rows$", lines[0]) if lines else None
    if announced and (int(announced[1]) != len(numbers) or not text.endswith("\n")):
        raise SequenceError(f"{path} announces {announced[1]} rows and holds {len(numbers)}: it is not complete")
    if numbers.size == 0 or not np.isfinite(numbers).all():
        raise SequenceError(f"{path} is empty or holds values that are not finite")
    return numbers


def _read_rows(path: Path, columns: int, what: str) -> np.ndarray:
    """`read_numbers` with so many columns; `what` they are, for the message."""
    rows = read_numbers(path)
    if rows.shape[1] != columns:
        raise SequenceError(f"{path} must hold rows of {columns} numbers ({what}); got rows of {rows.shape[1]}")
    return rows


def read_tum(path: str | Path) -> tuple[np.ndarray, np.ndarray]:
    """Times `(T,)` and poses `(T, 4, 4)` of a TUM trajectory file (t tx ty tz qx qy qz qw per row)."""
    rows = _read_rows(Path(path), 8, "t tx ty tz qx qy qz qw")
    norms = np.linalg.norm(rows[:, 4:], axis=1)
    if (np.abs(norms - 1) > 1e-2).any():
        raise SequenceError(f"{path}: quaternions must have length one; row {int(np.abs(norms - 1).argmax())} has not")
    poses = np.tile(np.eye(4), (len(rows), 1, 1))
    poses[:, :3, :3] = Rotation.from_quat(rows[:, 4:]).as_matrix()
    poses[:, :3, 3] = rows[:, 1:4]
    return rows[:, 0], poses


def write_tum(path: str | Path, times: np.ndarray, poses: np.ndarray) -> None:
    """Write poses `(T, 4, 4)` with times `(T,)` in seconds as a TUM trajectory."""
    poses = np.asarray(poses, dtype=np.float64)
    quaternions = Rotation.from_matrix(poses[:, :3, :3]).as_quat(canonical=True)
    text = io.StringIO()
    rows = np.column_stack([times, poses[:, :3, 3], quaternions])
    np.savetxt(text, rows, fmt="%.9f", header="t tx ty tz qx qy qz qw")
    atomic_write(path, text.getvalue())


def read_pose(path: str | Path) -> np.ndarray:
    """A camera-to-world matrix `(4, 4)`, optical convention, from a file in any of the formats that hold poses.

    A 4 x 4 matrix, or the first row of a poses.txt (frame, then 16 numbers) or of a TUM trajectory (8 numbers).
    Raises `FileNotFoundError` for a missing file, `SequenceError` for anything else in it.
    """
    path = Path(path)
    rows = read_numbers(path)
    if rows.shape[1] == 8:
        return read_tum(path)[1][0]
    if rows.shape[1] == 17:
        return read_poses(path)[1][0]
    if rows.shape != (4, 4) or not _are_rigid(rows[None])[0]:
        raise SequenceError(
            f"{path} must hold a pose: a rigid 4 x 4 matrix, rows as in poses.txt (17 numbers), or a TUM trajectory (8 "
            f"numbers); got {rows.shape[0]} rows of {rows.shape[1]} numbers"
        )
    return _nearest_rigid(rows[None])[0]


def read_poses(path: Path) -> tuple[list[int], np.ndarray]:
    """Frame numbers and camera-to-world matrices `(T, 4, 4)` of a poses.txt (frame, then 16 numbers, per row)."""
    rows = _read_rows(path, 17, "frame, then a 4 x 4 matrix")
    if (rows[:, 0] != np.rint(rows[:, 0])).any() or (np.diff(rows[:, 0]) <= 0).any():
        raise SequenceError(f"{path}: frame numbers must be whole and ascending, each once")
    poses = rows[:, 1:].reshape(-1, 4, 4)
    good = _are_rigid(poses)
    if not good.all():
        frame = int(rows[np.argmin(good), 0])
        raise SequenceError(f"{path}: the matrix of frame {frame} is not rigid (a rotation, and 0 0 0 1 below)")
    return rows[:, 0].astype(int).tolist(), _nearest_rigid(poses)


def _are_rigid(poses: np.ndarray) -> np.ndarray:
    return is_rotation(poses[:, :3, :3], tolerance=1e-3) & (np.abs(poses[:, 3] - [0, 0, 0, 1]).max(axis=-1) < 1e-6)


def _nearest_rigid(poses: np.ndarray) -> np.ndarray:
    """Return poses with the nearest rotations, because files hold few digits."""
    rigid = poses.copy()
    rigid[:, :3, :3] = [rotation_mean(rotation[None]) for rotation in poses[:, :3, :3]]
    return rigid


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
    """Write a depth image in metres as a 16-bit PNG in mm; NaN, infinity and what 16 bits cannot hold become 0."""
    import cv2

    depth = np.asarray(depth, dtype=np.float64)
    millimetres = np.rint(np.nan_to_num(depth * 1000.0, nan=0.0, posinf=0.0, neginf=0.0))
    image = np.where((millimetres > 0) & (millimetres <= 65535), millimetres, 0).astype(np.uint16)
    atomic_write(path, cv2.imencode(".png", image, [cv2.IMWRITE_PNG_COMPRESSION, 9])[1].tobytes())


def depth_files(folder: Path) -> dict[int, Path]:
    """Depth images of a recording by frame number: the first run of digits in the name."""
    if not (folder / "depth").is_dir():
        raise FileNotFoundError(f"{folder} has no folder depth/ with 16-bit PNG images")
    files: dict[int, Path] = {}
    for path in sorted((folder / "depth").glob("*.png")):
        digits = re.search(r"\d+", path.name)
        if digits is None:
            raise SequenceError(f"{path.name} in {folder / 'depth'} has no frame number in its name")
        frame = int(digits.group())
        if frame in files:
            raise SequenceError(
                f"{files[frame].name} and {path.name} in {folder / 'depth'} are both frame {frame}, the first number"
            )
        files[frame] = path
    if not files:
        raise SequenceError(f"{folder / 'depth'} holds no PNG images")
    return files


def require_same_frames(folder: Path, pose_frames: list[int], image_frames: list[int]) -> None:
    """Raise `SequenceError` unless poses.txt and the images have the same frame numbers, both given ascending."""
    if pose_frames != image_frames:
        without_image = sorted(set(pose_frames) - set(image_frames))[:3]
        without_pose = sorted(set(image_frames) - set(pose_frames))[:3]
        raise SequenceError(
            f"{folder / 'poses.txt'} and {folder / 'depth'} name other frames: poses without an image {without_image}, "
            f"images without a pose {without_pose} first"
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


def read_path_on_floor(folder: Path) -> np.ndarray | None:
    """The surveyed path `(P, 3)` in metres from path_on_floor.txt; None where it is missing."""
    path = folder / "path_on_floor.txt"
    return _read_rows(path, 3, "x y z") if is_given(path) else None


def read_gravity(folder: Path, frames: list[int], times: np.ndarray | None) -> np.ndarray | None:
    """Down in the camera's optical frame `(T, 3)`, of any length, from gravity.txt, else from accelerometer.txt.

    times: `(T,)` seconds, of the frames. None where both files are missing, or no frame has a time.
    """
    path = folder / "gravity.txt"
    if not is_given(path):
        return None if times is None else _read_accelerometer(folder, times)
    rows = _read_rows(path, 4, "frame number, then x y z")
    if not (rows[:, 1:] != 0).any(axis=1).all():
        raise SequenceError(f"{path} must hold a frame number and x y z, not all zero, per row")
    by_frame = {int(row[0]): row[1:] for row in rows}
    missing = [frame for frame in frames if frame not in by_frame]
    if missing:
        raise SequenceError(f"{path} has no row for frame {missing[0]} (and {len(missing) - 1} others)")
    return np.array([by_frame[frame] for frame in frames])


def _read_accelerometer(folder: Path, times: np.ndarray) -> np.ndarray | None:
    """Down `(T, 3)` at times `(T,)` from accelerometer.txt of a TUM RGB-D recording: rows t ax ay az, m/s^2.

    The mean of the samples nearest in time, `ACCELEROMETER_SAMPLES` of them, leaves out most of the hand's own
    acceleration. Some drivers give the force that holds the camera up, others its opposite. We take a camera to be held
    upright for most of a recording, which tells the sign (gravity.txt is for others). None where the file is missing.
    """
    path = folder / "accelerometer.txt"
    if not is_given(path):
        return None
    rows = _read_rows(path, 4, "t ax ay az")
    rows = rows[np.argsort(rows[:, 0], kind="stable")]
    half = ACCELEROMETER_SAMPLES // 2
    nearest = np.clip(np.searchsorted(rows[:, 0], times), half, max(half, len(rows) - 1 - half))
    sums = np.concatenate([np.zeros((1, 3)), np.cumsum(rows[:, 1:], axis=0)])
    down = sums[np.minimum(nearest + half + 1, len(rows))] - sums[np.maximum(nearest - half, 0)]
    down *= 1.0 if down[:, 1].sum() >= 0 else -1.0
    gap = np.abs(rows[np.clip(nearest, 0, len(rows) - 1), 0] - times).max()
    if gap > ACCELEROMETER_GAP or not (down != 0).any(axis=1).all():
        raise SequenceError(
            f"{path} must hold an acceleration, not zero, within {ACCELEROMETER_GAP} s of every image; the largest gap "
            f"is {gap:.1f} s"
        )
    return down


def read_up(folder: Path) -> str | None:
    """Which world axis points up, from up.txt; None where it is missing."""
    path = folder / "up.txt"
    if not is_given(path):
        return None
    up = read_text(path, "the upward axis", SequenceError).strip()
    if up not in UP_AXES:
        raise SequenceError(f"{path} must name one of {', '.join(UP_AXES)}; got {up!r}")
    return up
