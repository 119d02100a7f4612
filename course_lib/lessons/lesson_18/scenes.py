"""What lesson 18 looks at: the room's observations thinned out, a map that is wrong, and a room with two equal ends."""

from dataclasses import replace
from itertools import pairwise

import numpy as np

from course_lib.beyond.look_alikes.hypotheses import MAP_SIGMA
from course_lib.beyond.several_views import Motion
from course_lib.experiments.ambiguity import stereo_covariance
from course_lib.experiments.look_alikes import measured_motion
from course_lib.lessons.kit.room_observations import MatchingScene, in_body_frame
from course_lib.spherical_stereo.semantic_map.association import Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap

PAIR = "08_a"
"""The pair of photographs of the lesson: the assignment by colour takes each sofa for another one (chosen for that)."""
FEW_SEEN = ("07_b", (2, 5, 7, 10))
"""A pair of photographs and four of its observations: all are matched rightly, and the place is off by more than in any
other of 200 such draws whose pose was given out (chosen for that)."""
_BLUE, _RED = (240.0, 60.0), (0.0, 60.0)
SYMMETRIC_ROOM = SemanticMap(
    [
        Landmark("sofa", 2.0, 1.0, *_BLUE),
        Landmark("sofa", -2.0, -1.0, *_BLUE),
        Landmark("sofa", 0.0, 0.0, *_BLUE),
        Landmark("chair", 1.0, -2.0, *_RED),
        Landmark("chair", -1.0, 2.0, *_RED),
    ],
    walls=[[-3, -3], [3, -3], [3, 3], [-3, 3]],
)
"""The same after half a turn: three equal sofas, two equal chairs."""
PLANT = Landmark("potted plant", -1.5, -2.0, 120.0, 50.0)
ROOM_WITH_PLANT = SemanticMap([*SYMMETRIC_ROOM.landmarks, PLANT], SYMMETRIC_ROOM.walls)
"""The same room, and one thing that is at one of its ends only."""


def thinned(scene: MatchingScene, kept: np.ndarray) -> MatchingScene:
    """The scene with these of its observations alone: indices, or a mask."""
    indices = np.arange(len(scene.observations))[kept]
    seen = tuple(scene.observations[i] for i in indices)
    return MatchingScene(seen, tuple(scene.true_landmarks[i] for i in indices), scene.pose)


def half_seen(scene: MatchingScene, rng: np.random.Generator) -> MatchingScene:
    """The scene with every observation left out with a probability of one half."""
    return thinned(scene, rng.random(len(scene.observations)) < 0.5)


def mirrored(semantic_map: SemanticMap) -> SemanticMap:
    """The map in a mirror that stands across x: no distance between two objects changes, and no pose fits."""
    low, high = semantic_map.walls[:, 0].min(), semantic_map.walls[:, 0].max()
    landmarks = [replace(one, x=low + high - one.x) for one in semantic_map.landmarks]
    return SemanticMap(landmarks, np.column_stack([low + high - semantic_map.walls[:, 0], semantic_map.walls[:, 1]]))


def surveyed(semantic_map: SemanticMap, rng: np.random.Generator) -> SemanticMap:
    """The map as a tape measure gives it, `MAP_SIGMA` off in x and y: no room is the same after half a turn exactly."""
    moved = semantic_map.positions + rng.normal(0.0, MAP_SIGMA, (len(semantic_map), 2))
    landmarks = [
        replace(one, x=float(x), y=float(y)) for one, (x, y) in zip(semantic_map.landmarks, moved, strict=True)
    ]
    return SemanticMap(landmarks, semantic_map.walls)


def exact_view(semantic_map: SemanticMap, pose: np.ndarray, which: list[int]) -> list[Observation]:
    """These landmarks as a rig at `pose` (x, y, theta) would measure them, without noise: what is left is the room."""
    landmarks = [semantic_map.landmarks[j] for j in which]
    places = in_body_frame(semantic_map.positions[which], pose)
    return [
        Observation(one.label, float(x), float(y), one.hue, one.saturation, stereo_covariance(np.array([x, y])))
        for one, (x, y) in zip(landmarks, places, strict=True)
    ]


def walk_past_the_plant(start: np.ndarray) -> tuple[np.ndarray, list[list[Observation]], list[Motion | None]]:
    """Poses `(3, 3)`, what is seen from each in `ROOM_WITH_PLANT`, and the odometry before each (None: the first).

    0.8 m ahead, then a quarter turn on the spot. The plant is hidden in the first two views.
    """
    x, y, theta = start
    ahead = (x + 0.8 * np.cos(theta), y + 0.8 * np.sin(theta))
    poses = np.array([start, [*ahead, theta], [*ahead, theta + np.pi / 2]])
    everything = list(range(len(ROOM_WITH_PLANT)))
    shown = [everything[:-1], everything[:-1], everything]
    views = [exact_view(ROOM_WITH_PLANT, pose, which) for pose, which in zip(poses, shown, strict=True)]
    rng = np.random.default_rng(18)
    return poses, views, [None, *(measured_motion(a, b, rng) for a, b in pairwise(poses))]
