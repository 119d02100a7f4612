"""Write notebooks/pictures/filter.webp: paper 1's filter at work, which a page shows without a kernel.

    python -m tools.animation

The particles begin spread over four metres of the corridor. In every frame they are moved, weighed and drawn anew, eqs
(3) to (12).
"""

import io
import sys
from argparse import ArgumentParser, Namespace

import numpy as np
from matplotlib.figure import Figure
from PIL import Image

from course_lib.depth_mcl import (
    DepthRenderer,
    SceneMap,
    likelihood,
    normalize_likelihood,
    propagate,
    read_sequence,
    resample,
    weights,
)
from course_lib.files import atomic_write
from course_lib.geometry import state_from_optical_pose
from course_lib.rendering.sensor import subsample_depth
from courseware.paths import REPOSITORY, data_path
from courseware.plots import figures
from courseware.plots.corridor_figures import floor_plan

PICTURE = REPOSITORY / "notebooks" / "pictures" / "filter.webp"
N_PARTICLES, N_FRAMES, EVERY, BETA = 800, 32, 2, 0.1
START = np.array([2.0, 0.5, 0, 0, 0, np.deg2rad(20)])  # half width of the first cloud: metres, radians
NOISE = np.array([0.2, 0.06, 0, 0, 0, np.deg2rad(2.5)])  # sigma from frame to frame; the recording is thinned
SIZE = 88, 72  # pixels of the images that are compared
MILLISECONDS = 250


def frame_picture(plan, true, measured, particles, w, best, number) -> Image.Image:
    """Return one picture: the cloud from above, the measured image, and the best particle's image.

    plan: `(M, 2)` points of the walls. true: `(6,)`. measured, best: `(H, W)` depth. particles: `(N, 6)`. w: `(N,)`.
    """
    figure = Figure(figsize=(9.6, 2.6), dpi=90, layout="constrained")
    above, seen, simulated = figure.subplots(1, 3, width_ratios=[3.2, 1, 1])
    order = np.argsort(w)
    above.plot(plan[:, 0], plan[:, 1], ".", color="0.6", markersize=1)
    above.scatter(particles[order, 0], particles[order, 1], c=w[order] / w.max(), cmap="cividis", s=9)
    above.plot(true[0], true[1], "o", color="black", markersize=11, fillstyle="none")
    above.set(title=f"Particles in frame {number}; bright ones fit", xlabel="x [m]", ylabel="y [m]")
    above.set(xlim=(-0.5, 10), ylim=(-1.7, 1.7))
    for axes, image, title in ((seen, measured, "Measured"), (simulated, best, "Best particle")):
        figures.depth_image(axes, image, title, (0, 8))
        axes.set_axis_off()
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png")
    return Image.open(buffer).convert("RGB")


def pictures() -> list[Image.Image]:
    """Return one picture a frame."""
    recording, scene_map = read_sequence(data_path("corridor/wagon")), SceneMap.load(data_path("corridor/map.ply"))
    camera, rng = recording.camera(), np.random.default_rng(3)
    small, made = camera.resized(*SIZE), []
    plan = floor_plan(scene_map.vertices, 1.0)
    first = state_from_optical_pose(recording.camera_to_world[0])
    particles = first + START * rng.uniform(-1, 1, (N_PARTICLES, 6))
    with DepthRenderer(scene_map, small, "raster") as renderer:
        for number in range(0, N_FRAMES * EVERY, EVERY):
            points = small.points(subsample_depth(recording.depth(number), camera, small))
            measured = renderer.render_points(points)
            particles = propagate(particles, NOISE, rng)
            images = renderer.render(particles)
            w = weights(normalize_likelihood(likelihood(measured, images, 0.1)), BETA)
            true = state_from_optical_pose(recording.camera_to_world[number])
            made.append(frame_picture(plan, true, measured, particles, w, images[w.argmax()], number))
            particles = particles[resample(w, rng)]
    return made


def add_arguments(parser: ArgumentParser) -> None:
    """Declare no options."""


def run(arguments: Namespace) -> int:
    """Write the animation."""
    first, *others = pictures()
    buffer = io.BytesIO()
    first.save(buffer, "WEBP", save_all=True, append_images=others, duration=MILLISECONDS, loop=0, quality=60, method=6)
    atomic_write(PICTURE, buffer.getvalue())
    print(f"{PICTURE.relative_to(REPOSITORY)}: {PICTURE.stat().st_size / 1000:.0f} kB")
    return 0


if __name__ == "__main__":
    from courseware.cli import tool

    sys.exit(tool("tools.animation"))
