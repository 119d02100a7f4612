"""A localization as a scene: landmarks, rays, ellipses and pose stand where the answer says."""

import numpy as np
import pytest

from course_lib.spherical_stereo import SemanticLocalizer, StereoRig
from course_lib.spherical_stereo.drawn_boxes import StereoBoxes
from course_lib.spherical_stereo.pose.rigid_fit import rotation_2d
from courseware.plots.location_scene import location_scene
from courseware.plots.panorama_drawing import class_style
from courseware.plots.scene_page import page_html
from tests.plots.test_track_scene import of_colour
from tests.spherical_stereo.stereo_scene import BASELINE, boxes_of, mapped_scene

UPPER, LOWER, MAP = mapped_scene()


@pytest.fixture(scope="module")
def found():
    return SemanticLocalizer(StereoRig(BASELINE), MAP).localize(UPPER, LOWER, boxes_of(UPPER, LOWER))


def test_every_landmark_has_a_post_and_its_class(found):
    plotter, _ = location_scene(MAP, found)
    for label in set(MAP.labels):
        chosen = MAP.positions[[one == label for one in MAP.labels]]
        posts = [mesh for mesh in of_colour(plotter, class_style(label)[0]) if mesh.n_points == 8]
        middles = np.array([np.asarray(mesh.center)[:2] for mesh in posts])
        assert np.allclose(np.sort(middles, axis=0), np.sort(chosen, axis=0), atol=1e-4)


def test_rays_go_from_the_pose_to_the_places_and_ellipses_lie_there(found):
    plotter, words = location_scene(MAP, found)
    rays = of_colour(plotter, "#696969")
    assert len(rays) == len(found.observations) == 5
    places = found.pose.apply([[one.x, one.y] for one in found.observations])
    ends = np.array([mesh.points for mesh in rays])
    assert np.allclose(ends[:, 0, :2], [found.pose.x, found.pose.y], atol=1e-4)
    assert np.allclose(ends[:, 1, :2], places[[one.observation for one in found.objects]], atol=1e-4)
    discs = [m for mesh in plotter.actors.values() if (m := mesh.mapper.dataset).n_cells == 320]
    assert len(discs) == 6, "five places and the pose"
    first = found.objects[0].observation
    turn = rotation_2d(found.pose.theta)
    world = turn @ found.observations[first].covariance @ turn.T
    offsets = np.asarray(discs[0].points, float)[:, :2] - places[first]
    assert np.einsum("ni,ij,nj->n", offsets, np.linalg.inv(world), offsets).max() == pytest.approx(9, rel=0.02)
    assert "rejected" not in words


def test_a_rejected_pose_is_called_so_and_no_pose_is_said():
    rejected = SemanticLocalizer(StereoRig(1.0), MAP).localize(UPPER, LOWER, boxes_of(UPPER, LOWER))
    assert rejected.pose is None
    assert "rejected pose: coloured axes" in location_scene(MAP, rejected)[1]
    empty = StereoBoxes(UPPER.size, [], LOWER.detections)
    nothing = SemanticLocalizer(StereoRig(BASELINE), MAP).localize(UPPER, LOWER, empty)
    plotter, words = location_scene(MAP, nothing)
    assert "no pose, no detections" in words
    assert len(page_html(plotter, "A map", words)) < 1_300_000
