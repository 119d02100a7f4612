"""The same view in three sizes: most particles are compared on few pixels, the last few on many."""

from __future__ import annotations

import numpy as np

from course_lib.depth_mcl.likelihood import ALPHA, Weighting, paper_weighting
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.sensor import subsample_depth

# Pixels of the coarse and the middle image; the finest is the camera's own, up to so many (all chosen).
COARSE, MIDDLE, FINE = 1_200, 4_800, 25_600


class Level:
    """One size of image: its renderer, and the measured image once `measure` has seen it."""

    def __init__(self, renderer: DepthRenderer, camera: DepthCamera, weighting: Weighting) -> None:
        self.renderer = renderer
        self._weighting = weighting
        self._full_camera = camera
        self.measured = np.full(renderer.camera.shape, np.nan, dtype=np.float32)

    def measure(self, depth: np.ndarray) -> None:
        """Takes the camera's image `(H, W)`; eq. (7) on this level's pixels."""
        camera = self.renderer.camera
        self.measured = self.renderer.render_points(camera.points(subsample_depth(depth, self._full_camera, camera)))

    def score(self, images: np.ndarray) -> np.ndarray:
        """Raw scores `(N,)` of images `(N, H, W)` of the map: eq. (8) as a mean over pixels."""
        return self._weighting.score(self.measured, images)


def image_sizes(camera: DepthCamera) -> list[tuple[int, int]]:
    """Width and height of the levels for a camera, coarsest first; each is the camera's own where that is smaller."""
    sizes = []
    for pixels in (COARSE, MIDDLE, FINE):
        factor = min(1.0, np.sqrt(pixels / (camera.width * camera.height)))
        sizes.append((max(1, round(camera.width * factor)), max(1, round(camera.height * factor))))
    return sizes


def pyramid(renderer: DepthRenderer, alpha: float = ALPHA) -> list[Level]:
    """Levels for the renderer's map and camera, coarsest first. The renderer itself serves where sizes are equal."""
    camera, weighting = renderer.camera, paper_weighting(alpha)
    levels = []
    for width, height in image_sizes(camera):
        if (width, height) == (camera.width, camera.height):
            own = renderer
        else:
            own = DepthRenderer(
                renderer.scene_map, camera.resized(width, height), renderer.backend, exact=renderer.exact
            )
        levels.append(Level(own, camera, weighting))
    return levels
