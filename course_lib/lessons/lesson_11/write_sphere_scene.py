"""Write the interactive scene of lesson 11: a panorama beside the unit sphere, one point on both, to be dragged.

    python -m course_lib.lessons.lesson_11.write_sphere_scene

writes notebooks/scenes/11_sphere.html: `sphere_scene.html` with the picture inside, which needs no network and no
kernel. The other lessons' scenes are made with PyVista: those can be turned, but nothing in them can be dragged.
"""

import base64
from pathlib import Path

from course_lib.files import atomic_write
from course_lib.lessons.kit.room_photographs import the_pair
from course_lib.paths import REPOSITORY

STORED = REPOSITORY / "notebooks/scenes/11_sphere.html"


def scene_html() -> str:
    """Return the whole scene as text, its panorama inside."""
    page = Path(__file__).with_name("sphere_scene.html").read_text(encoding="utf-8")
    return page.replace("PANORAMA", base64.b64encode(the_pair().upper_file.read_bytes()).decode("ascii"))


if __name__ == "__main__":
    atomic_write(STORED, scene_html())
