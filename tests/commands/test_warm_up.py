"""What a set-up compiles is what the filter then runs: a loop with other types would be compiled again, for seconds."""

import numpy as np
import pytest

from course_lib.commands.warm_up import compile_loops, simplify_corridor
from course_lib.depth_mcl import (
    DepthCamera,
    DepthRenderer,
    MonteCarloLocalizer,
    SceneMap,
    compiled_likelihood,
    simplification,
)
from course_lib.depth_mcl.rendering import rasterizer


def compiled_forms():
    """How many forms, one for each set of types, of each compiled loop there are."""
    loops = [loop for module in (rasterizer, compiled_likelihood) for loop in vars(module).values()]
    return {loop.__name__: len(loop.signatures) for loop in loops if hasattr(loop, "signatures")}


def test_the_filter_compiles_nothing_that_the_set_up_did_not():
    compile_loops()
    before = compiled_forms()
    assert before["draw_views"]
    assert before["_sums"]
    vertices = np.array([[2.0, -5, -5], [-2, 5, -5], [2, 0, 5]])
    camera = DepthCamera.from_fov(16, 12, 60.0, 45.0)
    with DepthRenderer(SceneMap(vertices, np.array([[0, 1, 2]])), camera) as renderer:
        localizer = MonteCarloLocalizer(renderer, n_particles=20, seed=1)
        localizer.initialize(np.zeros(6))
        localizer.step(np.full((12, 16), 2.0, dtype=np.float32))
    assert compiled_forms() == before


def test_the_corridors_map_is_not_simplified_again(tmp_path, monkeypatch, corridor_folder):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    simplification.simplified.cache_clear()
    simplify_corridor()
    simplification.simplified.cache_clear()
    monkeypatch.setattr(simplification, "_simplify", lambda *_: pytest.fail("it was simplified again"))
    scene_map = SceneMap.load(corridor_folder / "map.ply")
    assert len(simplification.simplified(scene_map)) < len(scene_map) / 2
    simplification.simplified.cache_clear()
