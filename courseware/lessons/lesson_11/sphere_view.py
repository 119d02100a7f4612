"""The unit sphere with a panorama on it, drawn for a figure with one look-up per screen pixel.

We see the sphere from afar (orthographic), with its near half taken away. So you look into the far half from inside, as
the camera does, and nothing is mirrored. A screen pixel is a direction, and a direction is a pixel of the panorama.
"""

import cv2
import numpy as np
from matplotlib.axes import Axes

from course_lib.spherical_stereo.panorama import azimuth_elevation, direction_from_angles, direction_to_pixel
from courseware.plots.figures import BLACK, BLUE, VERMILION

LOOK = 150.0  # degrees: azimuth in which one looks at first
_ACROSS = (np.arange(300) + 0.5) / 150 - 1
_X, _Y = np.meshgrid(_ACROSS, -_ACROSS)  # of the pixels of the drawn sphere, in radii
_AROUND = np.linspace(-np.pi, np.pi, 121)
_LINES = (  # the horizon and the seam
    (direction_from_angles(_AROUND, 0.0), {"color": BLUE, "linestyle": "--"}),
    (direction_from_angles(np.pi, _AROUND / 2), {"color": VERMILION}),
)


def look_up(image_bgr: np.ndarray, directions: np.ndarray, how: int = cv2.INTER_LINEAR) -> np.ndarray:
    """Return the panorama's colours in directions `(H, W, 3)`, also across the seam, `(H, W, 3)` uint8 BGR."""
    height, width = image_bgr.shape[:2]
    uv = (direction_to_pixel(directions, width, height) - 0.5).astype(np.float32)  # cv2 counts from pixel centres
    wrapped = np.concatenate([image_bgr, image_bgr[:, :1]], axis=1)  # one more column, to interpolate across the seam
    return cv2.remap(wrapped, uv[..., 0] % width, uv[..., 1], how, borderMode=cv2.BORDER_REPLICATE)


class DrawnSphere:
    """A sphere on its axes. `view` has the rows right, up, forward `(3, 3)`; `artists` change when the sphere turns."""

    def __init__(self, axes: Axes, image_bgr: np.ndarray) -> None:
        self.image = image_bgr
        axes.grid(False)
        axes.set(title="Unit sphere, looked into", xlabel="right [radii]", ylabel="up [radii]", xticks=[], yticks=[])
        axes.set(xlim=(-1.35, 1.35), ylim=(-1.35, 1.35), aspect="equal")
        self.picture = axes.imshow(np.zeros((*_X.shape, 3), np.uint8), extent=(-1, 1, -1, 1))
        halves = {"linewidth": 2.2}, {"linewidth": 0.9, "alpha": 0.5}  # the far half and the near half
        self.lines = [[axes.plot([], [], **style, **half)[0] for half in halves] for _, style in _LINES]
        self.rays = [axes.plot([], [], color=BLACK, linewidth=1.2)[0] for _ in "xyz"]
        self.names = [axes.text(0, 0, name, fontsize=10, weight="bold", ha="center", va="center") for name in "xyz"]
        self.artists = [self.picture, *self.lines[0], *self.lines[1], *self.rays, *self.names]
        self.turn(LOOK)

    def turn(self, azimuth_deg: float) -> None:
        """Look at the sphere towards this azimuth, 20 degrees downwards."""
        forward = direction_from_angles(np.radians(azimuth_deg), np.radians(-20))
        right = direction_from_angles(np.radians(azimuth_deg - 90), 0.0)
        self.view = np.stack([right, np.cross(right, forward), forward])
        rest = 1 - _X**2 - _Y**2
        seen = look_up(self.image, np.stack([_X, _Y, np.sqrt(np.maximum(rest, 0))], -1) @ self.view, cv2.INTER_NEAREST)
        self.picture.set_data(np.where(rest[..., None] > 0, seen, np.uint8(255))[..., ::-1])
        for (directions, _), (far, near) in zip(_LINES, self.lines, strict=True):
            is_near, line = self.is_near(directions)[:, None], self.on_screen(directions)
            far.set_data(*np.where(is_near, np.nan, line).T)
            near.set_data(*np.where(is_near, line, np.nan).T)
        for ray, name, end in zip(self.rays, self.names, self.on_screen(np.eye(3)), strict=True):
            ray.set_data([0, end[0]], [0, end[1]])
            name.set_position(end + 0.22 * end / max(np.linalg.norm(end), 1e-9))  # beside a marker there

    def on_screen(self, directions: np.ndarray) -> np.ndarray:
        """Return where directions `(..., 3)` are drawn, `(..., 2)`: right and up, in the circle of radius 1."""
        return directions @ self.view[:2].T

    def is_near(self, directions: np.ndarray) -> np.ndarray:
        """Return which directions `(..., 3)` lie on the near half, which is taken away."""
        return directions @ self.view[2] < 0


def circle_around(direction: np.ndarray) -> np.ndarray:
    """Return directions `(73, 3)` of a circle of 10 degrees around a direction: round on the sphere."""
    left = direction_from_angles(azimuth_elevation(direction)[0] + np.pi / 2, 0.0)
    t, radius = np.linspace(0, 2 * np.pi, 73)[:, None], np.radians(10)
    return np.cos(radius) * direction + np.sin(radius) * (np.cos(t) * left + np.sin(t) * np.cross(direction, left))
