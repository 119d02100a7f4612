"""Search one depth image: from a cloud of particles to the refined poses that explain the image best.

    anneal    draw particles in the cloud and weigh them on coarse images, gently, so that many survive; resample them,
              and draw again with less noise
    refine    take the best that differ (poses.py), and move them by Gauss-Newton on finer and finer images
              (refinement.py, schedule.py)
    choose    the pose of the greatest merit, and its rivals

The merit of a pose is the score of its image, eq. (8), plus what the prediction says of the pose (prediction.py).
Nothing is remembered from one frame to the next: that is the task of localizer.py.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from course_lib.beyond.six_dof.poses import distinct, retract
from course_lib.beyond.six_dof.prediction import MeasuredMotion, MotionPrediction, Rival
from course_lib.beyond.six_dof.schedule import Layer, Level, Step
from course_lib.depth_mcl.particle_filter import resample
from course_lib.depth_mcl.status import Agreement, agreement
from course_lib.depth_mcl.uncertainty import Tempered, temper

# Chosen on the kitchen and the shipped corridor; those of rivals also on walks through rooms (seeds 10,041 to 10,066).
APART = 0.2  # of the cloud's spread: refinement brings two particles that are nearer than this to the same pose
DISTINCT = np.array([0.02, np.deg2rad(1.0)])  # metres, radians: two refined poses that are nearer are the same
RIVAL_APART = np.array([0.15, np.deg2rad(10.0)])  # metres, radians: a nearer pose is no other place, only less exact
RIVAL_WITHIN = 0.06  # of merit (alpha = 0.1 m): a pose that is worse by more than this is no rival of the best one


class Cloud(NamedTuple):
    """Where a frame is searched."""

    prediction: MotionPrediction
    spread: np.ndarray  # `(6,)` standard deviations about the prediction, metres and radians, camera's axes.
    measured: MeasuredMotion | None  # The motion since the frame before, if something measured it.

    def merit(self, scores: np.ndarray, poses: np.ndarray) -> np.ndarray:
        """Return raw scores `(N,)` plus what the prediction says of the poses `(N, 4, 4)`: `(N,)`."""
        return scores + self.prediction.preference(poses, self.spread, self.measured)


class Generation(NamedTuple):
    """The particles of one layer."""

    poses: np.ndarray  # `(N, 4, 4)` camera-to-world.
    scores: np.ndarray  # `(N,)` raw scores on the coarse image.
    tempered: Tempered  # Their weights, and how sharp these are.


class Found(NamedTuple):
    """The result of one search."""

    pose: np.ndarray  # `(4, 4)` camera-to-world, the one of the greatest merit.
    score: float  # Raw score of its fine image.
    agreement: Agreement  # How its fine image agrees with the map.
    particles: np.ndarray  # `(N, 4, 4)` of the last layer.
    layers: tuple[Tempered, ...]  # The weights of every layer, in order.
    rivals: tuple[Rival, ...]  # Other poses that explain the image nearly as well, the best first.


def search(
    levels: Sequence[Level],
    cloud: Cloud,
    layers: Sequence[Layer],
    steps: Sequence[Step],
    rng: np.random.Generator,
    *,
    n_particles: int,
    n_rivals: int,
) -> Found:
    """Return the best pose of the particles that went through all layers and all steps of refinement.

    levels: coarse, middle and fine, each with the measured image. n_particles: of a layer whose share is 1.
    n_rivals: at most how many rivals are reported.
    """
    generations = anneal(levels[0], cloud, layers, rng, n_particles)
    poses = refine_best(levels, cloud, generations, steps)
    fine = levels[-1]
    images = fine.draw(poses)
    scores = fine.score(images)
    merits = cloud.merit(scores, poses)
    best, *others = distinct(poses, merits, 1 + n_rivals, RIVAL_APART)
    rivals = [Rival(poses[other], float(merits[other] - merits[best])) for other in others]
    return Found(
        poses[best],
        float(scores[best]),
        agreement(fine.measured, images[best]),
        generations[-1].poses,
        tuple(generation.tempered for generation in generations),
        tuple(rival for rival in rivals if rival.evidence >= -RIVAL_WITHIN),
    )


def anneal(
    level: Level, cloud: Cloud, layers: Sequence[Layer], rng: np.random.Generator, n_particles: int
) -> list[Generation]:
    """Draw particles in the cloud, weigh and resample them, layer by layer, and return every generation."""
    generations: list[Generation] = []
    for layer in layers:
        n = max(1, round(layer.particles * n_particles))
        spread = layer.spread * cloud.spread
        if not generations:
            poses = cloud.prediction.draw(n, spread, rng, cloud.measured)
        else:
            last = generations[-1]
            parents = last.poses[resample(last.tempered.weights, rng, n=n)]
            poses = retract(parents, spread * rng.standard_normal((n, 6)))
        scores = level.score(level.draw(poses))
        generations.append(Generation(poses, scores, temper(scores, layer.survivors * n)))
    return generations


def refine_best(
    levels: Sequence[Level], cloud: Cloud, generations: Sequence[Generation], steps: Sequence[Step]
) -> np.ndarray:
    """Return poses `(K, 4, 4)`: the best particles of all generations that differ, after the steps of refinement."""
    poses = np.concatenate([generation.poses for generation in generations])
    merits = cloud.merit(np.concatenate([generation.scores for generation in generations]), poses)
    poses = poses[distinct(poses, merits, steps[0].hypotheses if steps else 1, APART * cloud.spread[[0, 3]])]
    for index, step in enumerate(steps):
        level = levels[step.level]
        images = level.draw(poses)
        if index:  # the first step has its poses from the line above
            kept = distinct(poses, cloud.merit(level.score(images), poses), step.hypotheses, DISTINCT)
            poses, images = poses[kept], images[kept]
        poses = level.step(poses, images, step.scale)
    return poses
