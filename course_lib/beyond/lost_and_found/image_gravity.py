"""Measure which way is down in a depth image, which shows that floors are level and walls are upright.

Every pixel's surface has a normal n. If d is down, n is parallel to d on floors, tables and ceilings, and at a right
angle to it on walls. So the d that most normals agree with is down (the idea of a Manhattan world: Coughlan and Yuille,
1999; here walls may stand at any angle to each other).
"""

import numpy as np

from course_lib.beyond.six_dof.refinement import surface_normals
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.scene_map import SceneMap
from course_lib.rendering.sensor import subsample_depth

# All chosen on development recordings (the kitchen, the rooms of a HoloLens, the shipped corridor).
UNKNOWN_TILT_SIGMA = np.deg2rad(15.0)  # of a tilt that is only assumed
SEEN_TILT_SIGMA = np.deg2rad(1.5)  # of a tilt that floor and walls show: 90 % of the frames are within 2 degrees
AGREES = np.deg2rad(8.0)  # a normal is parallel or at a right angle to down within this
SQUARE = 0.7  # sine of the angle between two walls' normals, at least: down is at a right angle to both
WITHIN = np.deg2rad(40.0)  # of the assumed tilt: farther off a wall could pass for the floor
MIN_SHARE = 0.5  # of all normals that must agree
MIN_GAP = 0.1  # between the two smallest mean squares: one wall alone shows no down
_PIXELS = (40, 30)
_TRIED = 60  # normals that are tried, alone and in pairs


def down_from_image(depth: np.ndarray, camera: DepthCamera, assumed: np.ndarray) -> tuple[np.ndarray, float]:
    """Return down `(3,)` in the optical frame as a depth image `(H, W)` in metres shows it, and its sigma in radians.

    assumed: `(3,)` unit vector, down as of the last frame, or of a camera held upright. It is returned with
    `UNKNOWN_TILT_SIGMA` if too few surfaces agree on one direction.
    """
    small = camera.resized(*_PIXELS)
    normals = surface_normals(subsample_depth(depth, camera, small)[None], small)[1].reshape(-1, 3)
    normals = normals[np.isfinite(normals).all(axis=1)]
    some = normals[:: max(1, len(normals) // _TRIED)]
    across = np.cross(some[:, None], some[None]).reshape(-1, 3)
    across = across[np.linalg.norm(across, axis=1) > SQUARE]
    downs = np.concatenate([some, across])
    downs /= np.linalg.norm(downs, axis=1, keepdims=True)
    downs *= np.sign(downs @ assumed)[:, None]
    downs = downs[downs @ assumed > np.cos(WITHIN)]
    if not len(downs):
        return assumed, UNKNOWN_TILT_SIGMA
    level, upright = _agreeing(normals, downs)
    best = np.argmax((level | upright).sum(axis=0))
    level, upright = normals[level[:, best]], normals[upright[:, best]]
    # The unit vector of least squares: at a right angle to walls' normals, parallel to floors'.
    squares, axes = np.linalg.eigh(upright.T @ upright - level.T @ level)
    down = axes[:, 0]
    down *= np.sign(down @ assumed)
    agree = np.mean(np.any(_agreeing(normals, down[None]), axis=0))
    certain = squares[1] - squares[0] >= MIN_GAP * len(normals)  # one wall alone leaves the turn about its normal open
    return (down, SEEN_TILT_SIGMA) if certain and agree >= MIN_SHARE else (assumed, UNKNOWN_TILT_SIGMA)


def is_upright(scene_map: SceneMap) -> bool:
    """Return whether most of a map's surface is level or upright in its own world, z up; else images cannot help."""
    corners = scene_map.vertices[scene_map.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1)
    agree = np.any(_agreeing(normals / areas[:, None], np.array([[0.0, 0.0, 1.0]])), axis=0)[:, 0]
    return bool(areas @ agree >= MIN_SHARE * areas.sum())


def _agreeing(normals: np.ndarray, downs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return which normals `(M, 3)` are parallel, and which at a right angle, to directions `(K, 3)`: `(M, K)` bool."""
    cosines = np.abs(normals @ downs.T)
    return cosines > np.cos(AGREES), cosines < np.sin(AGREES)
