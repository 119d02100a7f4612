"""Compiles the depth filter's loops once: `python -m course_lib.commands.compile_loops`.

`course.py` runs this at the end of a set-up, so that no lesson waits for it. What is compiled is kept
(course_lib/depth_mcl/compiled.py).
"""

from __future__ import annotations


def compile_loops() -> None:
    """Renders one depth image and weighs it, as every frame of the filter does."""
    import numpy as np

    from course_lib.commands.depth_image_probe import measure
    from course_lib.depth_mcl.compiled_likelihood import likelihood

    measure("raster")
    likelihood(np.ones((2, 2), dtype=np.float32), np.ones((1, 2, 2), dtype=np.float32))


if __name__ == "__main__":
    compile_loops()
