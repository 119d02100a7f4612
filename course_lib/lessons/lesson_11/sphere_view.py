"""The unit sphere with a panorama on it, drawn for a figure: one look-up per screen pixel.

The sphere is seen from afar (orthographic), with its near half taken away: you look into the far half from inside, as
the camera does, so nothing is mirrored. A screen pixel is a direction, and a direction is a pixel of the panorama.
"""

import cv2
import numpy as np
from matplotlib.axes import Axes

from course_lib.plots.figures import BLACK, BLUE, VERMILION, YELLOW
from course_lib.spherical_stereo.panorama import direction_from_angles, direction_to_pixel

SIZE = 300  # pixels of the drawn sphere, each way
RING_DEG = 10.0  # radius of the circle around the point


class SphereView:
    """Which way one looks at the sphere: from outside towards its centre.

    azimuth, elevation: degrees, of the direction in which one looks.
    """

    def __init__(self, azimuth_deg: float, elevation_deg: float) -> None:
        self.forward = direction_from_angles(np.radians(azimuth_deg), np.radians(elevation_deg))
        self.right = np.array([np.sin(np.radians(azimuth_deg)), -np.cos(np.radians(azimuth_deg)), 0.0])
        self.up = np.cross(self.right, self.forward)

    def on_screen(self, directions: np.ndarray) -> np.ndarray:
        """Where directions `(..., 3)` are drawn, `(..., 2)`: right and up, within the circle of radius 1."""
        return np.stack([directions @ self.right, directions @ self.up], axis=-1)

    def is_near(self, directions: np.ndarray) -> np.ndarray:
        """Which directions `(..., 3)` lie on the near half, the one that is taken away."""
        return directions @ self.forward < 0

    def picture(self, image_bgr: np.ndarray) -> np.ndarray:
        """The far half of the sphere with the panorama on it, `(SIZE, SIZE, 3)` uint8 RGB, white around it."""
        across = (np.arange(SIZE) + 0.5) / SIZE * 2 - 1
        x, y = np.meshgrid(across, -across)
        inside = x**2 + y**2 < 1
        z = np.sqrt(np.where(inside, 1 - x**2 - y**2, 0.0))
        directions = x[..., None] * self.right + y[..., None] * self.up + z[..., None] * self.forward
        height, width = image_bgr.shape[:2]
        uv = direction_to_pixel(directions, width, height).astype(np.float32) - 0.5  # cv2 counts from pixel centres
        drawn = cv2.remap(image_bgr, uv[..., 0], uv[..., 1], cv2.INTER_NEAREST, borderMode=cv2.BORDER_REPLICATE)
        return np.where(inside[..., None], drawn, 255)[..., ::-1].astype(np.uint8)


def circle_around(direction: np.ndarray, radius_deg: float = RING_DEG, n: int = 73) -> np.ndarray:
    """Directions `(n, 3)` of a circle of `radius_deg` degrees around a direction: round on the sphere."""
    pole = np.array([0.0, 0, 1]) if abs(direction[2]) < 0.9 else np.array([1.0, 0, 0])
    side = np.cross(direction, pole)
    side = side / np.linalg.norm(side)
    up = np.cross(side, direction)
    t, r = np.linspace(0, 2 * np.pi, n)[:, None], np.radians(radius_deg)
    return np.cos(r) * direction + np.sin(r) * (np.cos(t) * side + np.sin(t) * up)


def circle_on_panorama(ring: np.ndarray, width: int, height: int) -> np.ndarray:
    """Edge coordinates `(n, 2)` of a line of directions, with NaN where it jumps across the seam: a gap in the line."""
    uv = direction_to_pixel(ring, width, height)
    uv[1:][np.abs(np.diff(uv[:, 0])) > width / 2] = np.nan
    return uv


def sphere_axes(axes: Axes, title: str) -> None:
    """Axes for a sphere: no ticks, room for the names of its axes. Units: the sphere's radius."""
    axes.grid(False)
    axes.set(title=title, xlim=(-1.35, 1.35), ylim=(-1.35, 1.35), aspect="equal", xticks=[], yticks=[])
    axes.set(xlabel="right [radii]", ylabel="up [radii]")


def draw_lines(axes: Axes, view: SphereView) -> list:
    """Horizon, seam and the three axes; returns the artists, so that `move_lines` can follow another view."""
    artists = [
        axes.plot([], [], color=colour, linewidth=2.2 if near == 0 else 0.9, linestyle=style, alpha=1 - 0.5 * near)[0]
        for colour, style in ((BLUE, "--"), (VERMILION, "-"))
        for near in (0, 1)
    ]
    for name in "xyz":
        artists += axes.plot([], [], color=BLACK, linewidth=1.2)
        artists.append(axes.text(0, 0, name, fontsize=10, fontweight="bold", ha="center", va="center"))
    move_lines(artists, view)
    return artists


def move_lines(artists: list, view: SphereView) -> None:
    """Set the lines of `draw_lines` as they look from another side."""
    around = np.linspace(-np.pi, np.pi, 121)
    horizon, seam = direction_from_angles(around, 0.0), direction_from_angles(np.pi, around / 2)
    for k, line in enumerate((horizon, seam)):
        near = view.is_near(line)
        for is_near in (0, 1):
            points = np.where((near == is_near)[:, None], view.on_screen(line), np.nan)
            artists[2 * k + is_near].set_data(*points.T)
    for k, axis in enumerate(np.eye(3)):
        end = view.on_screen(axis)
        artists[4 + 2 * k].set_data([0, end[0]], [0, end[1]])
        artists[5 + 2 * k].set_position(end + 0.22 * end / max(np.linalg.norm(end), 1e-9))  # beside a marker there


def point_artists(panorama: Axes, sphere: Axes) -> dict:
    """The moving parts: point and circle on both, the ray from the centre of the sphere."""
    dot = {"marker": "o", "markersize": 8, "markerfacecolor": YELLOW, "markeredgecolor": BLACK, "linestyle": "none"}
    ring = {"color": BLACK, "linewidth": 2.0}
    (ray,) = sphere.plot([], [], color=BLACK, linewidth=2.4)
    return {
        "flat ring": panorama.plot([], [], **ring)[0],
        "flat": panorama.plot([], [], **dot)[0],
        "ray": ray,
        "ring": sphere.plot([], [], **ring)[0],
        "point": sphere.plot([], [], **dot)[0],
    }
