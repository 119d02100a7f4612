"""Where is the camera when nobody says? Many coarse particles over all free space; the best are kept and followed.

    search = GlobalSearch(renderer, seed=0)
    for depth, gravity in recording:
        candidates = search.step(depth, gravity)
        if candidates.status == "found": ...

The answer is one pose only if no other pose explains the frames as well; where a building repeats itself, it is
several. Gravity is known (an accelerometer measures it), so only four degrees of freedom have to be searched.
"""

from typing import Literal, NamedTuple

import numpy as np

from course_lib.beyond.being_lost import REFINED_LOST, agreement
from course_lib.beyond.lost_and_found.adaptive_count import kld_count, occupied_bins
from course_lib.beyond.lost_and_found.free_space import FreeSpace
from course_lib.beyond.six_dof.poses import distinct, lengths, local
from course_lib.beyond.six_dof.prediction import MotionPrediction
from course_lib.beyond.six_dof.schedule import Level, pyramid
from course_lib.depth_mcl.likelihood import paper_weighting
from course_lib.depth_mcl.one_at_a_time import one_at_a_time
from course_lib.geometry import optical_pose, rotation_exp, state_from_optical_pose
from course_lib.rendering.renderer import DepthRenderer

# All chosen on development recordings (the kitchen, the shipped corridor, corridor seeds from 10,001 on).
COARSEST = (20, 15)  # pixels of the images of which thousands are drawn
WIDE_ALPHA = 0.3  # metres, of eq. (8) for them: the nearest of thousands is still decimetres off
TILT_SIGMA = np.deg2rad(1.0)  # of the measured gravity
APART = np.array([0.25, np.deg2rad(12.0)])  # metres, radians: nearer particles are one start
DISTINCT = np.array([0.05, np.deg2rad(3.0)])  # nearer refined poses are one
ELSEWHERE = np.array([0.3, np.deg2rad(15.0)])  # poses farther apart are two places
BATCH = 500  # poses that are drawn and scored at once
STARTS = (300, 150, 80, 50, 30, 20)  # how many starts each step on the coarse image takes along
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

    state: np.ndarray  # `(6,)`.
    evidence: float  # Running mean of agreeing - 3 through over its frames: 1 at best.
    frames: int  # How many frames it has explained.


class PoseCandidates(NamedTuple):
    """The answer of a search after the frames so far."""

    status: Literal["found", "several", "searching"]  # one pose explains the frames; more than one; none long enough
    poses: list[PoseCandidate]  # Best first; no two are at the same place.
    particles: int  # How many poses were drawn from free space in this frame.
    renders: int  # How many images were drawn in this frame.


class _Followed(MotionPrediction):
    """A candidate with the memory of its motion."""

    def __init__(self, pose: np.ndarray, value: float) -> None:
        super().__init__(pose)
        self.evidence, self.frames = value, 0

    def saw(self, pose: np.ndarray, value: float) -> None:
        self.found(pose)
        self.evidence = (1 - MEMORY) * self.evidence + MEMORY * value
        self.frames += 1


class GlobalSearch:
    """Looks for the camera in all free space of a map. least, most: poses drawn in a frame (KLD-sampling)."""

    def __init__(self, renderer: DepthRenderer, *, seed: int = 0, least: int = 1_000, most: int = 10_000) -> None:
        self.renderer = renderer
        camera = renderer.camera.resized(*COARSEST)
        coarsest = DepthRenderer(renderer.scene_map, camera, renderer.backend, exact=renderer.exact)
        self._coarsest = Level(coarsest, renderer.camera, paper_weighting(WIDE_ALPHA))
        self._coarse, self._middle, _ = pyramid(renderer)
        self.free_space = FreeSpace(renderer.scene_map)
        self.rng = np.random.default_rng(seed)
        self.least, self.most = least, most
        self._followed: list[_Followed] = []
        self._count = most

    @one_at_a_time
    def forget(self) -> None:
        """Start anew, without candidates."""
        self._followed, self._count = [], self.most

    @one_at_a_time
    def step(
        self,
        depth: np.ndarray,
        gravity: np.ndarray,
        tilt_sigma: float = TILT_SIGMA,
        suggested: np.ndarray | None = None,
    ) -> PoseCandidates:
        """Return the candidates after a depth image `(H, W)` in metres.

        gravity: `(3,)` down, in the camera's optical frame, known to within `tilt_sigma` radians. suggested: a state
        `(6,)` where the camera may be; it is judged like every other candidate.
        """
        gravity = np.asarray(gravity, dtype=np.float64)
        if gravity.shape != (3,) or not np.isfinite(gravity).all() or not gravity.any():
            raise ValueError(f"gravity must be three finite numbers, not all zero; got {gravity}")
        levels = (self._coarsest, self._coarse, self._middle)
        for level in levels:
            level.measure(depth)
        self._follow()
        poses, scores = self._draw(gravity, tilt_sigma)
        self._add_new(poses, scores, suggested)
        self._drop()
        candidates = [
            PoseCandidate(state_from_optical_pose(one.pose), one.evidence, one.frames)
            for one in sorted(self._followed, key=lambda one: -one.evidence)
        ]
        return PoseCandidates(_status(candidates), candidates, len(poses), sum(level.renders for level in levels))

    def _draw(self, gravity: np.ndarray, tilt_sigma: float) -> tuple[np.ndarray, np.ndarray]:
        """Return poses from free space and their scores on the coarsest image."""
        poses, scores = [], []
        for begin in range(0, self._count, BATCH):
            positions = self.free_space.draw(min(BATCH, self._count - begin), self.rng)
            poses.append(upright_poses(positions, gravity, tilt_sigma, self.rng))
            scores.append(self._coarsest.score(self._coarsest.draw(poses[-1])))
        return np.concatenate(poses), np.concatenate(scores)

    def _follow(self) -> None:
        """Move every candidate on to the best of a small cloud, refined."""
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
            mine = np.flatnonzero(owner == i)
            best = mine[np.argmax(values[mine])]
            one.saw(poses[best], values[best])

    def _add_new(self, poses: np.ndarray, scores: np.ndarray, suggested: np.ndarray | None) -> None:
        """Refine the best of the new poses and follow them, unless they are known."""
        poses = poses[distinct(poses, scores, STARTS[0], APART)]
        for scale, keep in zip(START_SCALES, STARTS, strict=True):
            images = self._coarse.draw(poses)
            kept = distinct(poses, self._coarse.score(images), keep, DISTINCT)
            poses = self._coarse.step(poses[kept], images[kept], scale)
        poses = self._finish(poses)
        if suggested is not None:
            poses = np.concatenate([poses, optical_pose(suggested)[None]])
        values = self._values(poses)
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
        bins = occupied_bins(np.array([one.pose for one in self._followed]), 0.5, 0.5)
        self._count = self.most if bins == 0 else kld_count(bins, self.least, self.most)


def _status(poses: list[PoseCandidate]) -> Literal["found", "several", "searching"]:
    """Return what candidates, best first, amount to."""
    old = [one for one in poses if one.frames >= FRAMES_TO_BELIEVE]
    if not old:
        return "searching"
    rivals = [one for one in poses if one is not old[0] and one.evidence > old[0].evidence - CLEAR_GAP]
    return "several" if rivals else "found"


def upright_poses(
    positions: np.ndarray, gravity: np.ndarray, tilt_sigma: float, rng: np.random.Generator
) -> np.ndarray:
    """Draw camera-to-world poses `(N, 4, 4)` at positions `(N, 3)`, of any heading, upright as gravity says.

    gravity: `(3,)` down in the camera's optical frame, known to within `tilt_sigma` radians. The world's z is up.
    """
    n, down = len(positions), gravity / np.linalg.norm(gravity)
    tilt = np.concatenate([tilt_sigma * rng.standard_normal((n, 2)), np.zeros((n, 1))], axis=1)
    heading = np.concatenate([np.zeros((n, 2)), rng.uniform(-np.pi, np.pi, (n, 1))], axis=1)
    poses = np.tile(np.eye(4), (n, 1, 1))
    poses[:, :3, :3] = rotation_exp(heading) @ rotation_exp(tilt) @ _turn(down, np.array([0.0, 0.0, -1.0]))
    poses[:, :3, 3] = positions
    return poses


def _turn(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the rotation `(3, 3)` that turns unit vector a into b by the shortest way."""
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
