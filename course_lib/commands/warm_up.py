"""What takes seconds once is done at the end of a set-up: `python -m course_lib.commands.warm_up`.

Compiled loops are kept beside their source (compiled.py), the simplified map in the user's cache (simplification.py).
"""


def compile_loops() -> None:
    """Renders one depth image, weighs it and refines by it, as every frame of the filters does."""
    import numpy as np

    from course_lib.beyond.six_dof.refinement import compiled_normal_equations
    from course_lib.commands.check import render_plane
    from course_lib.depth_mcl.likelihood import compiled_likelihood
    from course_lib.rendering.camera import DepthCamera

    render_plane("raster")
    compiled_likelihood(np.ones((2, 2), dtype=np.float32), np.ones((1, 2, 2), dtype=np.float32))
    small = DepthCamera.from_fov(4, 3, 60.0, 45.0)
    image = np.ones(small.shape, dtype=np.float32)
    compiled_normal_equations(image, image[np.newaxis], small, 0.1)


def simplify_corridor() -> None:
    """Simplifies the map that most lessons render."""
    from course_lib.paths import data_path
    from course_lib.rendering.scene_map import SceneMap
    from course_lib.rendering.simplification import simplified

    simplified(SceneMap.load(data_path("corridor/map.ply")))


if __name__ == "__main__":
    compile_loops()
    simplify_corridor()
