"""Lines of plans and side views: where a plane cuts a mesh."""

import numpy as np
import pytest
import trimesh

from courseware.plots.corridor_figures import floor_plan, plane_cut

BOX = trimesh.creation.box(bounds=[[0.0, 0.0, 0.0], [4.0, 2.0, 1.0]])


@pytest.mark.parametrize(("axis", "kept"), [(0, (2.0, 1.0)), (1, (4.0, 1.0)), (2, (4.0, 2.0))])
def test_a_cut_through_a_box_is_its_outline_in_the_other_two_coordinates(axis, kept):
    segments = plane_cut(BOX.vertices, BOX.faces, axis, 0.4)
    length = np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1).sum()
    assert length == pytest.approx(2 * sum(kept))
    assert segments.reshape(-1, 2).max(axis=0) == pytest.approx(kept)


def test_a_floor_plan_keeps_the_vertices_near_its_height():
    assert len(floor_plan(BOX.vertices, 1.0)) == 4
    assert len(floor_plan(BOX.vertices, 0.5)) == 0
