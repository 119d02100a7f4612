"""What takes seconds once is done at the end of a set-up: `python -m courseware.commands.warm_up`.

Compiled loops are kept beside their source (compiled.py), the simplified map in the user's cache (simplification.py).
"""


def simplify_corridor() -> None:
    """Simplifies the map that most lessons render."""
    from course_lib.rendering.scene_map import SceneMap
    from course_lib.rendering.simplification import simplified
    from courseware.paths import data_path

    simplified(SceneMap.load(data_path("corridor/map.ply")))


if __name__ == "__main__":
    from course_lib.beyond import warm_up

    warm_up()
    simplify_corridor()
