"""What lesson 18 looks at: the room's observations thinned out, a map that is wrong, and a room with two equal ends."""

from dataclasses import replace
from itertools import pairwise

import numpy as np

from course_lib.beyond.look_alikes.hypotheses import MAP_SIGMA
from course_lib.beyond.several_views import Motion
from course_lib.spherical_stereo.semantic_map.association import Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap
from courseware.experiments.ambiguity import stereo_covariance
from courseware.experiments.look_alikes import measured_motion
from courseware.lessons.kit.room_data import MatchingScene, in_body_frame, room_scenes

# Chosen pairs of photographs: the assignment by colour takes each sofa for another one; and four observations that are
# all matched rightly, with a place that is off by more than in any other of 200 such draws whose pose was given out.
PAIR, FEW_SEEN = "08_a", ("07_b", (2, 5, 7, 10))
# The same after half a turn: three equal sofas, two equal chairs. And with one thing that is at one of its ends only.
SYMMETRIC_ROOM = SemanticMap(
    [*(Landmark("sofa", x, y, 240.0, 60.0) for x, y in ((2.0, 1.0), (-2.0, -1.0), (0.0, 0.0))),
     *(Landmark("chair", x, y, 0.0, 60.0) for x, y in ((1.0, -2.0), (-1.0, 2.0)))],
    walls=[[-3, -3], [3, -3], [3, 3], [-3, 3]],
)  # fmt: skip
PLANT = Landmark("potted plant", -1.5, -2.0, 120.0, 50.0)
ROOM_WITH_PLANT = SemanticMap([*SYMMETRIC_ROOM.landmarks, PLANT], SYMMETRIC_ROOM.walls)


def thinned(scene: MatchingScene, kept: np.ndarray) -> MatchingScene:
    """Return the scene with these of its observations alone (indices)."""
    observations, landmarks = (tuple(values[k] for k in kept) for values in scene[:2])
    return MatchingScene(observations, landmarks, scene.pose)


def half_seen(scene: MatchingScene, rng: np.random.Generator) -> MatchingScene:
    """Return the scene with every observation left out with a probability of one half."""
    return thinned(scene, np.flatnonzero(rng.random(len(scene.observations)) < 0.5))


def drawn_scenes(draws: int, n_seen: int | None = None) -> dict[tuple[str, int], MatchingScene]:
    """Return every pair of photographs `draws` times, half seen, or with `n_seen` of its objects drawn at random."""
    rng, found = np.random.default_rng(18), {}
    for name, scene in room_scenes().items():
        for k in range(draws):
            few = n_seen and thinned(scene, np.sort(rng.permutation(len(scene.observations))[:n_seen]))
            found[name, k] = few or half_seen(scene, rng)
    return found


def mirrored(semantic_map: SemanticMap) -> SemanticMap:
    """Return the map in a mirror that stands across x: no distance between two objects changes, and no pose fits."""
    ends = semantic_map.walls[:, 0].min() + semantic_map.walls[:, 0].max()
    walls = semantic_map.walls * [-1, 1] + [ends, 0]
    return SemanticMap([replace(one, x=float(ends - one.x)) for one in semantic_map.landmarks], walls)


def surveyed(semantic_map: SemanticMap) -> SemanticMap:
    """Return the map as a tape measure gives it: no room is the same after half a turn exactly."""
    off = np.random.default_rng(18).normal(0.0, MAP_SIGMA, (len(semantic_map), 2)).tolist()
    both = zip(semantic_map.landmarks, off, strict=True)
    return SemanticMap([replace(one, x=one.x + dx, y=one.y + dy) for one, (dx, dy) in both], semantic_map.walls)


def exact_view(semantic_map: SemanticMap, pose: np.ndarray, n_seen: int) -> list[Observation]:
    """Return the first landmarks as a rig at `pose` (x, y, theta) would measure them, without noise."""
    both = zip(semantic_map.landmarks, in_body_frame(semantic_map.positions, pose), strict=True)
    seen = [Observation(one.label, *at.tolist(), one.hue, one.saturation, stereo_covariance(at)) for one, at in both]
    return seen[:n_seen]


def walk_past_the_plant(start: np.ndarray) -> tuple[np.ndarray, list[list[Observation]], list[Motion | None]]:
    """Return poses `(3, 3)`, what is seen from each in `ROOM_WITH_PLANT`, and the odometry before each (first: None).

    0.8 m ahead, then a quarter turn on the spot. The plant is hidden in the first two views.
    """
    ahead = start + 0.8 * np.array([np.cos(start[2]), np.sin(start[2]), 0.0])
    poses = np.array([start, ahead, ahead + np.array([0.0, 0.0, np.pi / 2])])
    views = [exact_view(ROOM_WITH_PLANT, pose, n_seen) for pose, n_seen in zip(poses, (5, 5, 6), strict=True)]
    rng = np.random.default_rng(18)
    return poses, views, [None, *(measured_motion(a, b, rng) for a, b in pairwise(poses))]
