"""One picture of the whole idea: what the camera measured, and what the map says it should see from two poses."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from course_lib.depth_mcl.likelihood import likelihood, valid_pixels
from course_lib.depth_mcl.sequence import DepthSequence
from course_lib.experiments.corridor import Run
from course_lib.plots.figures import depth_images
from course_lib.rendering.renderer import Backend, DepthRenderer
from course_lib.rendering.scene_map import SceneMap

BESIDE = np.array([-0.5, 0.0, 0.0, 0.0, 0.0, np.deg2rad(4.0)])  # from the estimate: half a metre back, four degrees


def overview_figure(scene_map: SceneMap, sequence: DepthSequence, run: Run, backend: Backend = "raster") -> Figure:
    """The middle frame of a run in x, y, yaw: the measured image, the map from the estimate, the map from beside it.

    Agreement is eq. (8) divided by the number of measured pixels, 0 to 1.
    """
    index = len(run.frames) // 2
    camera = sequence.camera()
    with DepthRenderer(scene_map, camera, backend) as renderer:
        measured = renderer.render_points(camera.points(sequence.depth(index)))
        simulated = renderer.render(np.stack([run.states[index], run.states[index] + BESIDE]))
    agreement = likelihood(measured, simulated) / max(1, valid_pixels(measured).sum())
    titles = (
        "Measured by the depth camera",
        f"Map from the estimate: agreement {agreement[0]:.2f}",
        f"Map from 0.5 m, 4 degrees beside it: {agreement[1]:.2f}",
    )
    return depth_images((measured, *simulated), titles, (0.0, 10.0), size=(10.5, 3.2))
