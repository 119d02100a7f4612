"""Write notebooks/scenes/11_sphere.html: a panorama beside the unit sphere, and one point to drag on both.

    python -m courseware.lessons.lesson_11.write_sphere_scene

It is `sphere_scene.html` with the picture inside, and needs no network and no kernel. Nothing in PyVista's scenes can
be dragged, so this one is written by hand.
"""

import base64
from pathlib import Path

from course_lib.files import atomic_write
from courseware.lessons.kit.room_data import the_pair
from courseware.paths import REPOSITORY

STORED = REPOSITORY / "notebooks/scenes/11_sphere.html"


def scene_html() -> str:
    """Return the whole scene as text, its panorama inside."""
    page = Path(__file__).with_name("sphere_scene.html").read_text(encoding="utf-8")
    return page.replace("PANORAMA", base64.b64encode(the_pair().upper_file.read_bytes()).decode("ascii"))


if __name__ == "__main__":
    atomic_write(STORED, scene_html())
