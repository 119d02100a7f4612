"""One pose from a matching by colour, one from two matches alone, and how many of all such pairs are right."""

import numpy as np

from course_lib.beyond.look_alikes.consistent import assign, match_costs
from course_lib.beyond.look_alikes.evidence import Evidence
from course_lib.beyond.look_alikes.hypotheses import PairPoses, pair_poses, scene_of
from course_lib.beyond.look_alikes.matchers import associate_hungarian
from course_lib.lessons.kit.room_observations import MatchingScene
from course_lib.lessons.kit.room_photographs import room_map
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.panorama import StereoRig
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D

Pairs = tuple[tuple[int, int], ...]


def matched_by_colour(scene: MatchingScene) -> tuple[Pose2D, Pairs]:
    """The pose after the assignment of least cost on class and colour, and its pairs (observation, landmark)."""
    localizer = SemanticLocalizer(StereoRig(0.3), room_map(), association=associate_hungarian, reject_implausible=False)
    found = localizer.localize_observations(scene.observations)
    return found.pose, tuple(found.used_pairs)


def matched_by_two(scene: MatchingScene, landmarks: tuple[int, int]) -> tuple[Pose2D, Pairs, tuple[int, int]]:
    """The pose of the right matches of two landmarks, all the pairs that it then finds, and the two observations."""
    arrays = scene_of(scene.observations, room_map())
    two, right = pair_poses(arrays), None
    for k, its in enumerate(two.landmarks):
        if set(its) == set(landmarks) and both_right(two, scene)[k]:
            right = k
    pose = two.poses[right]
    cost = match_costs(arrays, pose[None], two.covariances[right][None], Evidence())[0][0]
    return Pose2D(*map(float, pose)), assign(cost), tuple(map(int, two.observations[right]))


def both_right(two: PairPoses, scene: MatchingScene) -> np.ndarray:
    """Whether both matches of every pair are right: `(h,)` bool."""
    return (np.array(scene.true_landmarks)[two.observations] == two.landmarks).all(axis=1)
