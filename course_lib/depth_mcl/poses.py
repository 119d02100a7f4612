"""Files of poses: poses.txt as in the 7-Scenes dataset, TUM trajectories (t tx ty tz qx qy qz qw), one 4 x 4 matrix.

Matrices are camera-to-world in the optical convention (x right, y down, z forward), metres.
"""

from __future__ import annotations

import io
import re
import warnings
from pathlib import Path

import numpy as np

from course_lib.files import atomic_write, read_text
from course_lib.geometry import is_rotation, rotation_mean


class SequenceError(ValueError):
    """A recording that cannot be used: a missing or malformed file, or files that do not fit each other."""


def read_tum(path: str | Path) -> tuple[np.ndarray, np.ndarray]:
    """Times `(T,)` and poses `(T, 4, 4)` of a TUM trajectory file (t tx ty tz qx qy qz qw per row)."""
    from scipy.spatial.transform import Rotation

    rows = read_numbers(Path(path))
    if rows.ndim != 2 or rows.shape[1] != 8:
        raise SequenceError(f"{path} must hold rows of 8 numbers (t tx ty tz qx qy qz qw); got shape {rows.shape}")
    norms = np.linalg.norm(rows[:, 4:], axis=1)
    if (np.abs(norms - 1) > 1e-2).any():
        raise SequenceError(f"{path}: quaternions must have length one; row {int(np.abs(norms - 1).argmax())} has not")
    poses = np.tile(np.eye(4), (len(rows), 1, 1))
    poses[:, :3, :3] = Rotation.from_quat(rows[:, 4:]).as_matrix()
    poses[:, :3, 3] = rows[:, 1:4]
    return rows[:, 0], poses


def write_tum(path: str | Path, times: np.ndarray, poses: np.ndarray) -> None:
    """Writes poses `(T, 4, 4)` with times `(T,)` in seconds as a TUM trajectory."""
    from scipy.spatial.transform import Rotation

    poses = np.asarray(poses, dtype=np.float64)
    quaternions = Rotation.from_matrix(poses[:, :3, :3]).as_quat(canonical=True)
    rows = np.column_stack([times, poses[:, :3, 3], quaternions])
    text = io.StringIO()
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
    rows = read_numbers(path)
    if rows.ndim != 2 or rows.shape[1] != 17:
        raise SequenceError(f"{path} must hold rows of 17 numbers (frame, then a 4 x 4 matrix); got {rows.shape}")
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
    """Files hold few digits: the nearest rotation makes good what rounding took."""
    rigid = poses.copy()
    rigid[:, :3, :3] = [rotation_mean(rotation[None]) for rotation in poses[:, :3, :3]]
    return rigid


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
