"""Set how a frame is searched: the sizes of its images, the layers of particles, and the steps of refinement."""

from typing import Literal, NamedTuple

import numpy as np

from course_lib.beyond.six_dof.refinement import gauss_newton_step
from course_lib.depth_mcl.likelihood import Weighting, paper_weighting
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.sensor import subsample_depth

# Pixels of the coarse, the middle and the fine image, if the camera has as many. Chosen: many particles need small
# images, and the last steps use all 25,344 pixels of the SR4000.
COARSE, MIDDLE, FINE = 1_200, 4_800, 25_600


class Level:
    """Hold the renderer of one image size, the measured image, and how many images were rendered since."""

    def __init__(self, renderer: DepthRenderer, camera: DepthCamera, weighting: Weighting) -> None:
        self.renderer = renderer
        self._weighting = weighting
        self._full_camera = camera
        self.renders = 0
        self.measured = np.full(renderer.camera.shape, np.nan, dtype=np.float32)

    def measure(self, depth: np.ndarray) -> None:
        """Take the camera's image `(H, W)`, NaN = no measurement: eq. (7) on this level's pixels."""
        camera, self.renders = self.renderer.camera, 0
        self.measured = self.renderer.render_points(camera.points(subsample_depth(depth, self._full_camera, camera)))

    def draw(self, poses: np.ndarray) -> np.ndarray:
        """Return images `(N, H, W)` of the map from camera-to-world poses `(N, 4, 4)`."""
        self.renders += len(poses)
        return self.renderer.render_poses(poses)

    def score(self, images: np.ndarray) -> np.ndarray:
        """Return raw scores `(N,)` of images `(N, H, W)` of the map: eq. (8) as a mean over pixels."""
        return self._weighting.score(self.measured, images)

    def step(self, poses: np.ndarray, images: np.ndarray, scale: float) -> np.ndarray:
        """Return poses `(N, 4, 4)` after a Gauss-Newton step. images: of the map from these poses. scale: metres."""
        return gauss_newton_step(self.measured, images, self.renderer.camera, poses, scale)


def pyramid(renderer: DepthRenderer) -> list[Level]:
    """Return the three levels for the renderer's map and camera, coarse first, none larger than the camera's image."""
    camera, weighting = renderer.camera, paper_weighting()
    levels = []
    for pixels in (COARSE, MIDDLE, FINE):
        factor = min(1.0, np.sqrt(pixels / (camera.width * camera.height)))
        size = max(1, round(camera.width * factor)), max(1, round(camera.height * factor))
        own = renderer
        if size != (camera.width, camera.height):
            own = DepthRenderer(renderer.scene_map, camera.resized(*size), renderer.backend, exact=renderer.exact)
        levels.append(Level(own, camera, weighting))
    return levels


class Layer(NamedTuple):
    """Settings of one round of sampling and weighing within a frame, on coarse images."""

    particles: float  # Number of particles, as a share of the filter's `n_particles`.
    spread: float  # Standard deviation of the noise, as a share of the prediction's spread.
    survivors: float  # Effective sample size that the weights leave, as a share of the layer's particles.


class Step(NamedTuple):
    """Settings of one Gauss-Newton step for the poses that are left."""

    level: Literal[0, 1, 2]  # Index into the pyramid: coarse, middle, fine.
    scale: float  # Metres: a residual of this size counts a quarter.
    hypotheses: int  # How many poses are kept, the best that differ.


# Chosen on the kitchen and the shipped corridor. Particles become fewer as the cloud shrinks. Poses become fewer, the
# images finer, and the scales smaller as the poses come closer to the right one.
LAYERS = (Layer(1.0, 1.0, 0.1), Layer(0.4, 0.35, 0.1))
SURE_LAYERS = (Layer(0.3, 1.0, 0.1),)
SECOND_LOOK = (Layer(0.45, 1.0, 0.1),)
STEPS = (
    Step(0, 0.25, 30), Step(0, 0.20, 20), Step(0, 0.15, 9), Step(0, 0.10, 5),
    Step(1, 0.10, 4), Step(1, 0.07, 3), Step(1, 0.05, 3),
    Step(2, 0.05, 3), Step(2, 0.03, 3), Step(2, 0.03, 3),
)  # fmt: skip
