"""The unit sphere with a panorama on it, drawn for a figure: one look-up per screen pixel.

The sphere is seen from afar (orthographic), with its near half taken away: you look into the far half from inside, as
the camera does, so nothing is mirrored. A screen pixel is a direction, and a direction is a pixel of the panorama.
"""

import cv2
import numpy as np
from matplotlib.axes import Axes

from course_lib.plots.figures import BLACK, BLUE, VERMILION
from course_lib.spherical_stereo.panorama import direction_from_angles, direction_to_pixel

SIZE = 300  # pixels of the drawn sphere, each way
LOOK = 150.0  # degrees: azimuth in which one looks at first
DOWN = np.radians(20)
_AROUND = np.linspace(-np.pi, np.pi, 121)
_HORIZON, _SEAM = direction_from_angles(_AROUND, 0.0), direction_from_angles(np.pi, _AROUND / 2)
_FAR, _NEAR = {"linewidth": 2.2}, {"linewidth": 0.9, "alpha": 0.5}


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
        self.picture = axes.imshow(np.zeros((SIZE, SIZE, 3), np.uint8), extent=(-1, 1, -1, 1))
        self.lines = [
            axes.plot([], [], dashes, color=colour, **half)[0]
            for colour, dashes in ((BLUE, "--"), (VERMILION, "-"))
            for half in (_FAR, _NEAR)
        ]
        self.rays = [axes.plot([], [], color=BLACK, linewidth=1.2)[0] for _ in "xyz"]
        letters = {"fontsize": 10, "fontweight": "bold", "ha": "center", "va": "center"}
        self.names = [axes.text(0, 0, name, **letters) for name in "xyz"]
        self.artists = [self.picture, *self.lines, *self.rays, *self.names]
        self.turn(LOOK)

    def turn(self, azimuth_deg: float) -> None:
        """Look at the sphere towards this azimuth, a little downwards."""
        forward = direction_from_angles(np.radians(azimuth_deg), -DOWN)
        right = direction_from_angles(np.radians(azimuth_deg - 90), 0.0)
        self.view = np.stack([right, np.cross(right, forward), forward])
        self.picture.set_data(self.far_half())
        for line, (far, near) in ((_HORIZON, self.lines[:2]), (_SEAM, self.lines[2:])):
            is_near = self.is_near(line)[:, None]
            far.set_data(*np.where(is_near, np.nan, self.on_screen(line)).T)
            near.set_data(*np.where(is_near, self.on_screen(line), np.nan).T)
        for ray, name, end in zip(self.rays, self.names, self.on_screen(np.eye(3)), strict=True):
            ray.set_data([0, end[0]], [0, end[1]])
            name.set_position(end + 0.22 * end / max(np.linalg.norm(end), 1e-9))  # beside a marker there

    def on_screen(self, directions: np.ndarray) -> np.ndarray:
        """Return where directions `(..., 3)` are drawn, `(..., 2)`: right and up, in the circle of radius 1."""
        return directions @ self.view[:2].T

    def is_near(self, directions: np.ndarray) -> np.ndarray:
        """Return which directions `(..., 3)` lie on the near half, the one that is taken away."""
        return directions @ self.view[2] < 0

    def far_half(self) -> np.ndarray:
        """Return the far half with the panorama on it, `(SIZE, SIZE, 3)` uint8 RGB, white around it."""
        across = (np.arange(SIZE) + 0.5) / SIZE * 2 - 1
        x, y = np.meshgrid(across, -across)
        rest = 1 - x**2 - y**2
        directions = np.stack([x, y, np.sqrt(np.maximum(rest, 0))], axis=-1) @ self.view
        drawn = look_up(self.image, directions, cv2.INTER_NEAREST)
        return np.where(rest[..., None] > 0, drawn, np.uint8(255))[..., ::-1]
