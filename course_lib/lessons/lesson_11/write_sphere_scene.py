"""Write the interactive scene of lesson 11: a panorama beside the unit sphere, one point on both, to be dragged.

    python -m course_lib.lessons.lesson_11.write_sphere_scene

writes notebooks/scenes/11_sphere.html: one file with its picture inside, which needs no network and no kernel. It is
not made with PyVista as the other lessons' scenes are: those can be turned, but nothing in them can be dragged. Its
script is the course's own, and computes with the same two formulas as `panorama.pixel_to_direction` and
`panorama.direction_to_pixel`.
"""

import base64
from pathlib import Path

from course_lib.files import atomic_write
from course_lib.lessons.lesson_11.views import SCENE
from course_lib.paths import REPOSITORY, data_path

PICTURE = "room/experiment_1/05_b_upper.jpg"
"""A panorama with a sofa across its seam."""

_TEMPLATE = Path(__file__).with_name("sphere_scene.html")
_PLACEHOLDER = "PANORAMA"


def scene_html() -> str:
    """The whole scene as text, its panorama inside."""
    picture = base64.b64encode(data_path(PICTURE).read_bytes()).decode("ascii")
    before, _, after = _TEMPLATE.read_text(encoding="utf-8").rpartition(_PLACEHOLDER)
    return before + picture + after


def write_scene(path: Path) -> Path:
    """Write the scene to `path` and return it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    atomic_write(path, scene_html())
    return path


if __name__ == "__main__":
    written = write_scene(REPOSITORY / "notebooks" / SCENE)
    print(f"{written.relative_to(REPOSITORY)}: {written.stat().st_size / 1000:.0f} kB")
