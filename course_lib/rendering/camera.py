"""Describe the depth camera as a pinhole: its pixels, their rays, and its projection (paper 1, section 3.3).

Optical frame: x right, y down, z forward. A point (X, Y, Z) falls on column u = fx X / Z + cx, row v = fy Y / Z + cy.
Pixel centres are at integer coordinates, so pixel (0, 0) covers u in [-0.5, 0.5). Depth is Z, along the optical axis.
A lens is no part of this camera: undistort its images first, and give the intrinsics of the undistorted ones.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

# How far rounding may move a surface on a clip plane.
PLANE_ROUNDING = 1e-4  # metres, of float32 coordinates; at near at most 0.005 mm were measured
PLANE_ROUNDING_STEPS = 4  # steps Z^2 / (near 2^24) of a 24-bit z-buffer; at far at most 2.6 were measured
MAX_CENTRE_OFFSET = 0.2  # share of the image's size by which a file's principal point may miss the middle (chosen)


@dataclass(frozen=True)
class DepthCamera:
    """Hold the intrinsics of a pinhole depth camera.

    A preset, such as `sr4000`, is a classmethod that returns the camera of a data sheet.

    Parameters
    ----------
    width, height : int
        Size of the depth image in pixels.
    fx, fy : float
        Focal lengths in pixels.
    cx, cy : float
        Principal point in pixels, pixel centres at integers.
    near, far : float
        Clip planes in metres. A surface outside them is not hit.

    Raises
    ------
    ValueError
        If a size is not a whole number of pixels, a value is not finite, or one of fx, fy, near, far is not positive.
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    near: float = 0.1
    far: float = 30.0

    def __post_init__(self) -> None:
        for name in ("width", "height"):
            value = getattr(self, name)
            if int(value) != value or value < 1:
                raise ValueError(f"{name} must be a whole number of pixels, at least 1; got {value!r}")
            object.__setattr__(self, name, int(value))
        for name in ("fx", "fy", "near", "far", "cx", "cy"):
            value = float(getattr(self, name))
            if not np.isfinite(value) or (value <= 0 and name not in ("cx", "cy")):
                raise ValueError(f"{name} must be finite, and positive unless it is cx or cy; got {value!r}")
            object.__setattr__(self, name, value)
        if self.near >= self.far:
            raise ValueError(f"near must be below far; got near={self.near}, far={self.far}")

    @classmethod
    def from_fov(
        cls,
        width: int,
        height: int,
        horizontal_fov_deg: float,
        vertical_fov_deg: float,
        near: float = 0.1,
        far: float = 30.0,
    ) -> DepthCamera:
        """Return a centred camera whose image edges span these fields of view: fx = (width / 2) / tan(fov / 2)."""
        if not (0 < horizontal_fov_deg < 180 and 0 < vertical_fov_deg < 180):
            raise ValueError(f"fields of view must be 0 to 180 degrees; got {horizontal_fov_deg}, {vertical_fov_deg}")
        fx = 0.5 * width / np.tan(np.deg2rad(horizontal_fov_deg) / 2)
        fy = 0.5 * height / np.tan(np.deg2rad(vertical_fov_deg) / 2)
        return cls(width, height, fx, fy, (width - 1) / 2, (height - 1) / 2, near, far)

    @classmethod
    def sr4000(cls, near: float = 0.1, far: float = 30.0) -> DepthCamera:
        """Return the paper's camera (section 4), 176 x 144 pixels, 43.6 x 34.6 degrees by its maker's data sheet."""
        return cls.from_fov(176, 144, 43.6, 34.6, near, far)

    @classmethod
    def from_matrix(
        cls, matrix: np.ndarray, width: int, height: int, near: float = 0.1, far: float = 30.0
    ) -> DepthCamera:
        """Return the camera of an intrinsic matrix K = [[fx, 0, cx], [0, fy, cy], [0, 0, 1]], without skew.

        Raises `ValueError` for another form, or for a principal point far from the middle of the image.
        """
        k = np.asarray(matrix, dtype=np.float64)
        if k.shape != (3, 3) or not np.allclose([k[0, 1], k[1, 0], k[2, 0], k[2, 1], k[2, 2] - 1], 0):
            raise ValueError(f"intrinsics must read [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]; got {k.tolist()}")
        centre = np.array([(width - 1) / 2, (height - 1) / 2])
        if (np.abs(k[:2, 2] - centre) > MAX_CENTRE_OFFSET * np.array([width, height])).any():
            raise ValueError(
                f"the principal point ({k[0, 2]:g}, {k[1, 2]:g}) lies far from the middle of {width} x {height} "
                "pixels: these intrinsics are for another image size. Scale fx, cx by width, fy, cy by height"
            )
        return cls(width, height, k[0, 0], k[1, 1], k[0, 2], k[1, 2], near, far)

    @property
    def matrix(self) -> np.ndarray:
        """Return the intrinsic matrix K `(3, 3)`."""
        return np.array([[self.fx, 0.0, self.cx], [0.0, self.fy, self.cy], [0.0, 0.0, 1.0]])

    @property
    def shape(self) -> tuple[int, int]:
        """Return the shape (height, width) of its depth image."""
        return self.height, self.width

    def resized(self, width: int, height: int) -> DepthCamera:
        """Return the same view on another pixel grid: image *edges* stay where they are, so pixel centres shift."""
        scale_x, scale_y = width / self.width, height / self.height
        lens = {"fx": self.fx * scale_x, "fy": self.fy * scale_y}
        lens |= {"cx": (self.cx + 0.5) * scale_x - 0.5, "cy": (self.cy + 0.5) * scale_y - 0.5}
        return dataclasses.replace(self, width=width, height=height, **lens)

    def every(self, k: int) -> DepthCamera:
        """Return the camera of every k-th row and column of its images, from pixel (0, 0) on: u / k, v / k.

        The pixels that are left keep their rays; `resized` gives each pixel a ray of its own.
        """
        lens = {name: getattr(self, name) / k for name in ("fx", "fy", "cx", "cy")}
        return dataclasses.replace(self, width=-(-self.width // k), height=-(-self.height // k), **lens)

    @property
    def nearest(self) -> float:
        """Return the least depth in metres that counts as seen: near, less the rounding of a surface on it."""
        return max(self.near - PLANE_ROUNDING, 0.99 * self.near)

    @property
    def farthest(self) -> float:
        """Return the greatest depth in metres that counts as seen: far, plus the rounding of a surface on it."""
        step = self.far**2 / (self.near * 2**24)
        return self.far + PLANE_ROUNDING + PLANE_ROUNDING_STEPS * step

    def with_clip_planes(self, near: float, far: float) -> DepthCamera:
        """Return the same camera with other clip planes, in metres."""
        return dataclasses.replace(self, near=near, far=far)

    def rays(self) -> np.ndarray:
        """Return directions `(height, width, 3)` through the pixel centres, optical frame, forward component one."""
        u, v = np.meshgrid(np.arange(self.width), np.arange(self.height))
        return np.stack([(u - self.cx) / self.fx, (v - self.cy) / self.fy, np.ones(self.shape)], axis=-1)

    def project(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return column, row and depth of points `(..., 3)` in the optical frame; NaN pixels behind the camera."""
        points = np.asarray(points, dtype=np.float64)
        x, y, z = points[..., 0], points[..., 1], points[..., 2]
        safe = np.where(z > 0, z, np.nan)
        return self.fx * x / safe + self.cx, self.fy * y / safe + self.cy, z

    def points(self, depth: np.ndarray) -> np.ndarray:
        """Return points `(H, W, 3)` in the optical frame of a depth image `(H, W)`; NaN stays NaN."""
        depth = np.asarray(depth)
        if depth.shape != self.shape:
            raise ValueError(f"depth image must have shape {self.shape} (height, width); got {depth.shape}")
        with np.errstate(invalid="ignore"):
            return self.rays() * depth[..., None].astype(np.float64)

    def projection_matrix(self) -> np.ndarray:
        """Return OpenGL's projection `(4, 4)`, z backward, y up; depth b = far (Z - near) / (Z (far - near))."""
        w, h, n, f = self.width, self.height, self.near, self.far
        across = [2 * self.fx / w, 0.0, 1 - 2 * (self.cx + 0.5) / w, 0.0]
        up = [0.0, 2 * self.fy / h, 2 * (self.cy + 0.5) / h - 1, 0.0]
        return np.array([across, up, [0.0, 0.0, -(f + n) / (f - n), -2 * f * n / (f - n)], [0.0, 0.0, -1.0, 0.0]])
