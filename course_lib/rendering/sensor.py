"""Turn the depth camera's points into a depth image, as the simulated views are made (paper 1, 3.3.2)."""

import numpy as np

from course_lib.rendering.camera import DepthCamera


def depth_image_from_points(points: np.ndarray, camera: DepthCamera) -> np.ndarray:
    """Return the depth image of points in the optical frame: the reference of `DepthRenderer.render_points`.

    z^j = min { Z : point on pixel j }

    A point (X, Y, Z) falls on the pixel nearest to u = fx X / Z + cx, v = fy Y / Z + cy if near <= Z <= far, each
    within rounding (`DepthCamera.nearest`, `farthest`).

    Parameters
    ----------
    points : array `(..., 3)`
        Metres. NaN points are no measurement.
    camera : DepthCamera
        Its pixels and clip planes.

    Returns
    -------
    array `(H, W)` of float32
        Metres along the optical axis; NaN on a pixel without a point.

    Raises
    ------
    ValueError
        If the last axis does not have three values.

    Source: paper 1, eq. (7).
    """
    points = measured_points(points)
    points = points[(points[:, 2] >= camera.nearest) & (points[:, 2] <= camera.farthest)]
    u, v, z = camera.project(points)
    # Pixel j covers [j - 0.5, j + 0.5): floor(u + 0.5), as a rasterizer does it, not rint, which rounds to even.
    column, row = np.floor(u + 0.5), np.floor(v + 0.5)
    on_image = (column >= 0) & (column < camera.width) & (row >= 0) & (row < camera.height)
    image = np.full(camera.shape, np.inf, dtype=np.float32)
    pixels = (row[on_image].astype(np.intp), column[on_image].astype(np.intp))
    np.minimum.at(image, pixels, z[on_image].astype(np.float32))
    image[np.isinf(image)] = np.nan
    return image


def measured_points(points: np.ndarray) -> np.ndarray:
    """Return the finite ones of points `(..., 3)`: `(M, 3)`. Raises `ValueError` for a wrong shape."""
    points = np.asarray(points, dtype=np.float64)
    if points.ndim == 0 or points.shape[-1] != 3:
        raise ValueError(f"points must have shape (..., 3); got {points.shape}")
    points = points.reshape(-1, 3)
    return points[np.isfinite(points).all(axis=1)]


def subsample_depth(depth: np.ndarray, camera: DepthCamera, coarse: DepthCamera) -> np.ndarray:
    """Return the depth image `(h, w)` of a coarser camera with the same view, each pixel from the nearest fine one.

    depth: `(H, W)` of the fine camera. Values are picked, not averaged, because the mean of the depths across an edge
    is a surface that does not exist. Raises `ValueError` for a wrong shape.
    """
    depth = np.asarray(depth)
    if depth.shape != camera.shape:
        raise ValueError(f"depth image must have shape {camera.shape} (height, width); got {depth.shape}")
    u = (np.arange(coarse.width) - coarse.cx) * camera.fx / coarse.fx + camera.cx
    v = (np.arange(coarse.height) - coarse.cy) * camera.fy / coarse.fy + camera.cy
    column = np.clip(np.floor(u + 0.5), 0, camera.width - 1).astype(int)
    row = np.clip(np.floor(v + 0.5), 0, camera.height - 1).astype(int)
    return depth[np.ix_(row, column)]
