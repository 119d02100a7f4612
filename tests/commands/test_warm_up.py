"""What a set-up compiles is what the filter then runs: a loop with other types would be compiled again, for seconds."""

import importlib

import numpy as np
import pytest

from course_lib.beyond import AnnealedLocalizer, GlobalSearch, warm_up
from course_lib.beyond.lost_and_found import stored_views
from course_lib.beyond.six_dof import image_motion, refinement
from course_lib.depth_mcl import DepthCamera, DepthRenderer, MonteCarloLocalizer, SceneMap
from course_lib.rendering import raster, simplification
from courseware.commands.warm_up import simplify_corridor

LIKELIHOOD = importlib.import_module("course_lib.depth_mcl.likelihood")  # the package's name for it is the function
LOOPS = ((raster, "draw_views"), (LIKELIHOOD, "_sums"), (refinement, "_sums"), (image_motion, "_sums"))
LOOPS += ((stored_views, "_scores"),)


def compiled_forms():
    """How many forms, one for each set of types, of each compiled loop there are."""
    loops = {(module.__name__, name): loop for module, _ in LOOPS for name, loop in vars(module).items()}
    return {name: len(loop.signatures) for name, loop in loops.items() if hasattr(loop, "signatures")}


def test_the_filter_compiles_nothing_that_the_set_up_did_not():
    warm_up()
    before = compiled_forms()
    for module, loop in LOOPS:
        assert before[module.__name__, loop]
    vertices = np.array([[2.0, -5, -5], [-2, 5, -5], [2, 0, 5]])
    camera = DepthCamera.from_fov(16, 12, 60.0, 45.0)
    with DepthRenderer(SceneMap(vertices, np.array([[0, 1, 2]])), camera) as renderer:
        for localizer in (MonteCarloLocalizer(renderer, 20, seed=1), AnnealedLocalizer(renderer, 20, seed=1)):
            localizer.initialize(np.zeros(6))
            for _ in range(2):  # the second image is compared with the first
                localizer.step(np.full((12, 16), 2.0, dtype=np.float32))
        GlobalSearch(renderer, max_places=5).step(np.full((12, 16), 2.0, dtype=np.float32))
    assert compiled_forms() == before


@pytest.mark.slow
def test_the_corridors_map_is_not_simplified_again(tmp_path, monkeypatch, corridor_folder):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    simplification.simplified.cache_clear()
    simplify_corridor()
    simplification.simplified.cache_clear()
    monkeypatch.setattr(simplification, "_welded", lambda *_: pytest.fail("it was simplified again"))
    scene_map = SceneMap.load(corridor_folder / "map.ply")
    assert len(simplification.simplified(scene_map)) < len(scene_map) / 2
    simplification.simplified.cache_clear()
