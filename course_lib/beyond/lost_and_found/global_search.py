"""Find the camera when nobody says where it is: compare its image with stored views of all free space.

    search = GlobalSearch(renderer, seed=0)
    for depth, gravity in recording:
        candidates = search.step(depth, gravity)
        if candidates.status == "found": ...

The answer is one pose only if no other pose explains the frames as well; where a building repeats itself, it is
several. Gravity is known (an accelerometer measures it), so only four degrees of freedom have to be searched.
"""

from typing import Literal, NamedTuple

import numpy as np

from course_lib.beyond.being_lost import REFINED_LOST
from course_lib.beyond.lost_and_found.free_space import FreeSpace
from course_lib.beyond.lost_and_found.image_gravity import UNKNOWN_TILT_SIGMA, down_from_image, is_upright
from course_lib.beyond.lost_and_found.stored_views import MAX_PLACES, StoredViews, look_at
from course_lib.beyond.six_dof.poses import distinct, lengths, local
from course_lib.beyond.six_dof.prediction import MAX_SPREAD, MotionPrediction
from course_lib.beyond.six_dof.schedule import pyramid
from course_lib.depth_mcl.one_at_a_time import one_at_a_time
from course_lib.depth_mcl.status import agreement
from course_lib.geometry import optical_pose, rotation_exp, state_from_optical_pose
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.sensor import subsample_depth

# All chosen on development recordings (the kitchen, the rooms of a HoloLens, the shipped corridor, corridor and room
# seeds from 10,001 on).
COARSEST = (20, 15)  # pixels of the image that is compared with all stored views
WIDE_ALPHA = 0.3  # metres, as in eq. (8), for them: the nearest of thousands is still decimetres off
TILT_SIGMA = np.deg2rad(1.0)  # of the measured gravity
SURE_TILT = np.deg2rad(4.0)  # with a larger sigma, tilts about the given one are tried too
UPRIGHT = np.array([0.0, 1.0, 0.0])  # down in the optical frame of a camera that is held upright
APART = np.array([0.25, np.deg2rad(10.0)])  # metres, radians: nearer places are one start
DISTINCT = np.array([0.05, np.deg2rad(3.0)])  # nearer refined poses are one
ELSEWHERE = np.array([0.3, np.deg2rad(15.0)])  # poses farther apart are two places
LOOKED_AT = 2_000  # of the best stored views, from which the starts are taken
STARTS = (150, 80, 50, 30, 20, 12)  # how many starts each step on the coarse image takes along
START_SCALES = (0.4, 0.3, 0.25, 0.2, 0.15, 0.1)
FINISH_SCALES = (0.1, 0.05, 0.05)  # on the middle image
FOLLOWERS = 16  # particles of each candidate that is followed
FOLLOW_SCALES = (0.25, 0.15, 0.1)
FOLLOWERS_KEPT = (6, 4, 2)
MAX_CANDIDATES = 12
MEMORY = 0.4  # share of a new frame in a candidate's evidence
FRAMES_TO_BELIEVE = 3  # that a candidate must have explained
CLEAR_GAP = 0.08  # of evidence, between the best candidate and the next elsewhere


class PoseCandidate(NamedTuple):
    """A pose that the camera may have."""

    state: np.ndarray  # `(6,)`
    evidence: float  # running mean of agreeing - 3 through over its frames: 1 at best
    frames: int  # how many frames it has explained


class PoseCandidates(NamedTuple):
    """The answer of a search after the frames so far."""

    status: Literal["found", "several", "searching"]  # one pose explains the frames; more than one; none long enough
    poses: list[PoseCandidate]  # best first; no two are at the same place
    particles: int  # how many poses were compared with this frame by their stored views
    renders: int  # how many images were drawn in this frame


class _Followed(MotionPrediction):
    """A candidate with the memory of its motion."""

    def __init__(self, pose: np.ndarray, value: float) -> None:
        super().__init__(pose)
        self.evidence, self.frames = value, 0

    def saw(self, pose: np.ndarray, value: float) -> None:
        self.found(pose)
        self.evidence = (1 - MEMORY) * self.evidence + MEMORY * value
        self.frames += 1

    def reaches(self, poses: np.ndarray) -> np.ndarray:
        """Return whether the camera can have moved from here to poses `(N, 4, 4)` since the last frame."""
        return (lengths(local(self.pose, poses)) <= MAX_SPREAD).all(axis=-1)


class GlobalSearch:
    """Looks for the camera in all free space of a map.

    seed: of all draws. max_places: of which views are stored, in seconds; a small map needs fewer. seen_from: see
    `FreeSpace`. Raises `ValueError` for a map without free space.
    """

    def __init__(
        self,
        renderer: DepthRenderer,
        *,
        seed: int = 0,
        max_places: int = MAX_PLACES,
        seen_from: np.ndarray | None = None,
    ) -> None:
        self.renderer = renderer
        self._coarse, self._middle, _ = pyramid(renderer)
        self.views = StoredViews(FreeSpace(renderer.scene_map, seen_from), renderer.scene_map.origin, max_places)
        self.rng = np.random.default_rng(seed)
        self._map_is_upright = is_upright(renderer.scene_map)
        self._followed: list[_Followed] = []

    @one_at_a_time
    def forget(self) -> None:
        """Start again, without candidates."""
        self._followed = []

    @one_at_a_time
    def step(
        self,
        depth: np.ndarray,
        gravity: np.ndarray | None = None,
        *,
        suggested: np.ndarray | None = None,
        assumed: np.ndarray = UPRIGHT,
    ) -> PoseCandidates:
        """Return the candidates after a depth image `(H, W)` in metres.

        gravity: `(3,)` down, in the camera's optical frame, as an accelerometer measures it to within `TILT_SIGMA`. If
        you leave it out, the image tells it (image_gravity.py), if it does not differ much from `assumed` `(3,)`.
        suggested: a state `(6,)` where the camera may be; it is judged like every other candidate.
        """
        down, tilt_sigma = self._down(depth, gravity, assumed)
        levels = (self._coarse, self._middle)
        for level in levels:
            level.measure(depth)
        starts, compared = self._starts(depth, down, tilt_sigma)
        new = self._refined(starts)
        if suggested is not None:
            new = np.concatenate([new, optical_pose(suggested)[None]])
        values = self._values(new)
        self._follow(new, values)
        self._add_new(new, values)
        self._drop()
        candidates = [
            PoseCandidate(state_from_optical_pose(one.pose), one.evidence, one.frames)
            for one in sorted(self._followed, key=lambda one: -one.evidence)
        ]
        return PoseCandidates(_status(candidates), candidates, compared, sum(level.renders for level in levels))

    def _down(self, depth: np.ndarray, gravity: np.ndarray | None, assumed: np.ndarray) -> tuple[np.ndarray, float]:
        """Return down `(3,)`, a unit vector in the optical frame, and its sigma in radians."""
        if gravity is None and self._map_is_upright:
            return down_from_image(depth, self.renderer.camera, assumed)
        given = np.asarray(assumed if gravity is None else gravity, dtype=np.float64)
        if given.shape != (3,) or not np.isfinite(given).all() or not given.any():
            raise ValueError(f"gravity must be three finite numbers, not all zero; got {given}")
        return given / np.linalg.norm(given), UNKNOWN_TILT_SIGMA if gravity is None else TILT_SIGMA

    def _starts(self, depth: np.ndarray, down: np.ndarray, tilt_sigma: float) -> tuple[np.ndarray, int]:
        """Return the poses `(N, 4, 4)` whose stored views agree best with the image, and how many were compared."""
        camera = self.renderer.camera
        coarsest = camera.resized(*COARSEST)
        points = coarsest.points(subsample_depth(depth, camera, coarsest))
        poses, scores, compared = [], [], 0
        for one in _downs(down, tilt_sigma):
            upright = upright_rotation(one)
            all_scores = self.views.scores(look_at(points, upright), WIDE_ALPHA).ravel()
            best = np.argpartition(-all_scores, min(LOOKED_AT, len(all_scores) - 1))[:LOOKED_AT]
            poses.append(self.views.poses(best, upright))
            scores.append(all_scores[best])
            compared += len(all_scores)
        every = np.concatenate(poses)
        return every[distinct(every, np.concatenate(scores), STARTS[0], APART)], compared

    def _refined(self, poses: np.ndarray) -> np.ndarray:
        """Return the best of poses `(N, 4, 4)` that differ, after all steps of refinement."""
        for scale, keep in zip(START_SCALES, STARTS, strict=True):
            images = self._coarse.draw(poses)
            kept = distinct(poses, self._coarse.score(images), keep, DISTINCT)
            poses = self._coarse.step(poses[kept], images[kept], scale)
        return self._finish(poses)

    def _follow(self, new: np.ndarray, new_values: np.ndarray) -> None:
        """Move every candidate on to the best of a small cloud, refined, or to a new pose within its reach."""
        if not self._followed:
            return
        clouds = [one.draw(FOLLOWERS, one.spread(), self.rng) for one in self._followed]
        poses = np.concatenate(clouds)
        owner = np.repeat(np.arange(len(self._followed)), FOLLOWERS)
        for scale, keep in zip(FOLLOW_SCALES, FOLLOWERS_KEPT, strict=True):
            images = self._coarse.draw(poses)
            scores = self._coarse.score(images)
            of_each = [np.flatnonzero(owner == i) for i in range(len(self._followed))]
            kept = np.concatenate([mine[np.argsort(-scores[mine], kind="stable")[:keep]] for mine in of_each])
            poses, owner = self._coarse.step(poses[kept], images[kept], scale), owner[kept]
        poses = self._finish(poses)
        values = self._values(poses)
        for i, one in enumerate(self._followed):
            mine, near = owner == i, one.reaches(new)
            options = np.concatenate([poses[mine], new[near]])
            best_values = np.concatenate([values[mine], new_values[near]])
            best = np.argmax(best_values)
            one.saw(options[best], float(best_values[best]))

    def _add_new(self, poses: np.ndarray, values: np.ndarray) -> None:
        """Follow the best of the new poses, unless they are known."""
        for index in distinct(poses, values, MAX_CANDIDATES, ELSEWHERE):
            known = any(same_place(one.pose, poses[index]) for one in self._followed)
            if values[index] >= REFINED_LOST and not known:
                self._followed.append(_Followed(poses[index], float(values[index])))

    def _finish(self, poses: np.ndarray) -> np.ndarray:
        for scale in FINISH_SCALES:
            poses = self._middle.step(poses, self._middle.draw(poses), scale)
        return poses

    def _values(self, poses: np.ndarray) -> np.ndarray:
        """Return agreeing - 3 through of every pose, on the middle image."""
        found = [agreement(self._middle.measured, image) for image in self._middle.draw(poses)]
        return np.nan_to_num([one.refined_support for one in found], nan=-1.0)

    def _drop(self) -> None:
        """Drop candidates that no longer agree, the worse of two that became one, and the worst beyond a number."""
        kept: list[_Followed] = []
        for one in sorted(self._followed, key=lambda o: (-min(o.frames, FRAMES_TO_BELIEVE), -o.evidence)):
            if one.evidence >= REFINED_LOST and not any(same_place(one.pose, other.pose) for other in kept):
                kept.append(one)
        self._followed = kept[:MAX_CANDIDATES]


def _status(poses: list[PoseCandidate]) -> Literal["found", "several", "searching"]:
    """Return what candidates, best first, amount to."""
    old = [one for one in poses if one.frames >= FRAMES_TO_BELIEVE]
    if not old:
        return "searching"
    rivals = [one for one in poses if one is not old[0] and one.evidence > old[0].evidence - CLEAR_GAP]
    return "several" if rivals else "found"


def _downs(down: np.ndarray, tilt_sigma: float) -> np.ndarray:
    """Return unit vectors `(K, 3)` to try as down: the given one, and if it is not sure, six that lie one sigma off."""
    if tilt_sigma <= SURE_TILT:
        return down[None]
    angles = np.arange(6) * np.pi / 3
    around = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(6)]) * tilt_sigma
    tilts = np.concatenate([np.zeros((1, 3)), around]) @ upright_rotation(down)  # about axes that lie level
    return np.einsum("kij,j->ki", rotation_exp(tilts), down)


def upright_rotation(down: np.ndarray) -> np.ndarray:
    """Return the shortest rotation `(3, 3)` that turns `down` `(3,)`, in the optical frame, into the world's -z."""
    a, b = down / np.linalg.norm(down), np.array([0.0, 0.0, -1.0])
    axis, cosine = np.cross(a, b), float(a @ b)
    sine = np.linalg.norm(axis)
    if sine >= 1e-9:
        return rotation_exp(axis / sine * np.arctan2(sine, cosine))
    if cosine > 0:
        return np.eye(3)
    axis = np.cross(a, np.eye(3)[np.argmin(np.abs(a))])
    return rotation_exp(np.pi * axis / np.linalg.norm(axis))


def same_place(a: np.ndarray, b: np.ndarray) -> bool:
    """Return whether two camera poses `(4, 4)` are nearer to each other than `ELSEWHERE`."""
    return bool((lengths(local(a, b)) < ELSEWHERE).all())
