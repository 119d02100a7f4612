"""One depth image of a tilted plane, beside its closed form: `python -m course_lib.commands.depth_image_probe vtk`.

`check` runs this in a process of its own, because a broken OpenGL driver ends the process that uses it. A plane
n . X = d seen along the pixel ray r (forward component one) has depth d / (n . r).
"""

from __future__ import annotations

import json
import sys

# Largest difference from the closed form, millimetres; the z-buffer's own steps are below 0.3 mm up to 15 m.
LARGEST_ERROR_MM = 0.5
_MARK = "depth image probe: "

# The camera's pose in the world [x, y, z, roll, pitch, yaw]: no component zero, so that none can be left out unseen.
STATE = (4.0, -2.0, 1.2, 0.1, -0.2, 2.5)
PLANE_DISTANCE_M = 3.0  # along the optical axis
PLANE_NORMAL = (0.35, 0.25, 1.0)  # in the optical frame: tilted to the right and down
HALF_SIDE_M = 12.0  # of the square that stands for the plane; it fills the view


def measure(backend: str) -> dict[str, str | float | int]:
    """Renders the plane with `backend`; the renderer's name, the largest error in millimetres, the number of pixels.

    A pixel that hit nothing has an infinite error. Raises what `DepthRenderer` raises.
    """
    import numpy as np

    from course_lib.geometry import optical_pose
    from course_lib.rendering.camera import DepthCamera
    from course_lib.rendering.renderer import DepthRenderer
    from course_lib.rendering.scene_map import SceneMap

    camera = DepthCamera.sr4000()
    normal = np.array(PLANE_NORMAL)
    point = np.array([0.0, 0.0, PLANE_DISTANCE_M])
    across = np.cross(normal, [0.0, 1.0, 0.0])
    across, along = across / np.linalg.norm(across), np.cross(normal, across) / np.linalg.norm(np.cross(normal, across))
    corners = point + HALF_SIDE_M * np.array([-across - along, across - along, across + along, -across + along])
    pose = optical_pose(np.array(STATE))
    vertices = corners @ pose[:3, :3].T + pose[:3, 3]
    closed_form = normal @ point / (camera.rays() @ normal)
    with DepthRenderer(SceneMap(vertices, np.array([[0, 1, 2], [0, 2, 3]])), camera, backend=backend) as renderer:
        image = renderer.render(np.array([STATE]))[0]
        name = renderer.describe()
    error = float(np.abs(image.astype(np.float64) - closed_form).max()) * 1000
    return {"renderer": name, "largest_error_mm": error, "pixels": image.size}


def read_result(output: str) -> dict | None:
    """The result in what this program printed, libraries' own messages around it; None when there is none."""
    for line in output.splitlines():
        if line.startswith(_MARK):
            return json.loads(line[len(_MARK) :])
    return None


if __name__ == "__main__":
    try:
        result = measure(sys.argv[1])
    except Exception as error:
        sys.exit(f"{type(error).__name__}: {error}")
    print(_MARK + json.dumps(result), flush=True)
