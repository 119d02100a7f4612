"""Measure how the camera moved between two depth images, from the images alone, without a map.

A point p of the present image lies on the surface that the image before shows. The motion T moves it to g = T p, which
falls on a pixel of the image before, with point q and normal n. If T is right,

    r_j = n_j . (T p_j - q_j) = 0,    J_j = (R' n_j, p_j x R' n_j)

Gauss-Newton (refinement.py) solves this from several starts, coarse images first, because a camera carried by hand may
turn by half of its field of view from one frame to the next. This is projective point-to-plane ICP (Blais and Levine
1995).
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from course_lib.beyond.six_dof.covariance import PREDICTED, RIVAL_SCALE, SCALE, fused, information, with_rivals
from course_lib.beyond.six_dof.poses import distinct, local, retract
from course_lib.beyond.six_dof.prediction import MeasuredMotion, Rival
from course_lib.beyond.six_dof.refinement import NormalEquations, solve, surface_normals
from course_lib.beyond.six_dof.schedule import COARSE, MIDDLE
from course_lib.depth_mcl.status import MIN_PIXELS
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.compiled import compiled

# Chosen on the kitchen, the walk through rooms and walks of the demo (seeds from 10,041 on).
# The search starts from each of these turns about the optical axes, radians, after each of these steps, metres.
TURNS = np.deg2rad([[0, 0, 0], [0, 14, 0], [0, -14, 0], [0, 28, 0], [0, -28, 0], [14, 0, 0], [-14, 0, 0]])
STEPS = np.array([[0, 0, 0], [0.2, 0, 0], [-0.2, 0, 0], [0, 0, 0.2]])
COARSE_SCALES = (0.3, 0.2, 0.15, 0.1, 0.1, 0.07)  # metres, of the robust weights: one Gauss-Newton step for each
FINE_SCALES = (0.07, 0.05, 0.05, 0.03, 0.03)  # the same on the finer images
PIXELS = 5.0  # times as many pixels are independent as before a map, because the map's errors play no part
FLOOR = np.array([0.008, np.deg2rad(0.25)])  # metres, radians: the least error, which the camera's own errors cause
KEPT = 3  # motions that go from the coarse images to the finer ones
APART = np.array([0.04, np.deg2rad(3.0)])  # metres, radians: two motions that are nearer are the same
MIN_PAIRED = 0.25  # of points that fall on the image before, at least, for a motion that is believed
MIN_AGREEING = 0.7  # mean weight of these points, at least, for a motion that is believed
CLEARLY = 0.05  # of score: the most that a motion may lose when it is kept along what the images do not show
EXPECTED = 0.004  # of score for one unit of the guess's log density: it decides between motions that fit alike
FARTHEST = 25.0  # squared distance from the guess, in units of its spread, at which the penalty stops growing
UNPAIRED = 0.1  # the cost of a point that misses the image before, as a share of the cost of one that disagrees


class View(NamedTuple):
    """A measured image as a surface in the camera's optical frame."""

    camera: DepthCamera
    points: np.ndarray  # `(H, W, 3)`, NaN = no measurement.
    normals: np.ndarray  # `(H, W, 3)`, NaN also next to an edge.

    @classmethod
    def of(cls, depth: np.ndarray, camera: DepthCamera, pixels: int) -> "View":
        """Return the view of every k-th row and column of a depth image `(H, W)`, so that about `pixels` measure.

        The rays of these pixels stay as they were. In `Level`'s images a pixel has the depth of a neighbour's ray. Such
        errors are the same at the same pixels wherever the camera is, so the camera would seem to stand still.
        """
        with np.errstate(invalid="ignore"):
            measured = np.where((depth > camera.near) & (depth < camera.far), depth, np.nan)
        k = max(1, round(np.sqrt(np.isfinite(measured).sum() / pixels)))
        camera = camera.every(k)
        (points,), (normals,) = surface_normals(measured[None, ::k, ::k].astype(np.float64), camera)
        return cls(camera, points, normals)


def views_of(depth: np.ndarray, camera: DepthCamera) -> list[View]:
    """Return the coarse and the finer view of a depth image `(H, W)`, as `image_motion` takes them."""
    return [View.of(depth, camera, pixels) for pixels in (COARSE, MIDDLE)]


def paired(before: View, points: np.ndarray, pose: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return which points `(M, 3)` have a partner `(M,)`, and the normals `(K, 3)` and residuals `(K,)` of these.

    pose: `(4, 4)` of the present camera in the frame of the one before. Normals are along the present camera's axes,
    residuals in metres.
    """
    moved = points @ pose[:3, :3].T + pose[:3, 3]
    with np.errstate(invalid="ignore"):
        u, v, _ = before.camera.project(moved)
        column, row = np.floor(u + 0.5), np.floor(v + 0.5)
        inside = (column >= 0) & (column < before.camera.width) & (row >= 0) & (row < before.camera.height)
    pixel = np.where(inside, row, 0).astype(int), np.where(inside, column, 0).astype(int)
    n = before.normals[pixel]
    r = np.sum(n * (moved - before.points[pixel]), axis=-1)
    has_partner = inside & np.isfinite(r)
    return has_partner, n[has_partner] @ pose[:3, :3], r[has_partner]


def motion_equations(before: View, points: np.ndarray, poses: np.ndarray, scale: float) -> tuple:
    """Return the `NormalEquations` of one Gauss-Newton step for `poses` `(N, 4, 4)`, and how many points pair `(N,)`.

    w = 1 / (1 + (r / scale)^2)^2, as in `normal_equations`. This is the readable form of `compiled_motion_equations`.
    """
    systems, pairs = [], []
    for pose in poses:
        has_partner, n, r = paired(before, points, pose)
        jacobian = np.concatenate([n, np.cross(points[has_partner], n)], axis=1)
        w = 1.0 / (1.0 + (r / scale) ** 2) ** 2
        systems.append(((jacobian * w[:, None]).T @ jacobian, jacobian.T @ (w * r), w.sum()))
        pairs.append(len(r))
    return NormalEquations(*(np.array(part) for part in zip(*systems, strict=True))), np.array(pairs)


def compiled_motion_equations(before: View, points: np.ndarray, poses: np.ndarray, scale: float) -> tuple:
    """Return the numbers of `motion_equations` from a compiled loop; a test holds the two together."""
    camera = before.camera
    lens = (camera.fx, camera.fy, camera.cx, camera.cy)
    *system, pairs = _sums(before.points, before.normals, lens, np.ascontiguousarray(points), poses, float(scale))
    return NormalEquations(*system), pairs


@compiled(fastmath=False)  # NaN keeps its meaning
def _sums(targets, normals, lens, points, poses, scale):
    count, (height, width, _) = len(poses), targets.shape
    matrices, vectors = np.zeros((count, 6, 6)), np.zeros((count, 6))
    weights, pairs = np.zeros(count), np.zeros(count)
    jacobian = np.empty(6)
    fx, fy, cx, cy = lens
    for i in range(count):
        t = poses[i]
        for j in range(len(points)):
            px, py, pz = points[j]
            gx = t[0, 0] * px + t[0, 1] * py + t[0, 2] * pz + t[0, 3]
            gy = t[1, 0] * px + t[1, 1] * py + t[1, 2] * pz + t[1, 3]
            gz = t[2, 0] * px + t[2, 1] * py + t[2, 2] * pz + t[2, 3]
            if not gz > 0:
                continue
            u, v = np.floor(fx * gx / gz + cx + 0.5), np.floor(fy * gy / gz + cy + 0.5)
            if not (0 <= u < width and 0 <= v < height):
                continue
            a, b, c = normals[int(v), int(u)]
            qx, qy, qz = targets[int(v), int(u)]
            r = a * (gx - qx) + b * (gy - qy) + c * (gz - qz)
            if not np.isfinite(r):
                continue
            w = 1.0 / (1.0 + (r / scale) ** 2) ** 2
            nx = t[0, 0] * a + t[1, 0] * b + t[2, 0] * c
            ny = t[0, 1] * a + t[1, 1] * b + t[2, 1] * c
            nz = t[0, 2] * a + t[1, 2] * b + t[2, 2] * c
            jacobian[0], jacobian[1], jacobian[2] = nx, ny, nz
            jacobian[3], jacobian[4], jacobian[5] = py * nz - pz * ny, pz * nx - px * nz, px * ny - py * nx
            for k in range(6):
                vectors[i, k] += w * jacobian[k] * r
                for m in range(6):
                    matrices[i, k, m] += w * jacobian[k] * jacobian[m]
            weights[i] += w
            pairs[i] += 1
    return matrices, vectors, weights, pairs


def image_motion(
    before: Sequence[View], now: Sequence[View], guess: np.ndarray, spread: np.ndarray
) -> MeasuredMotion | None:
    """Return the motion between two frames, or None where it is not to be believed.

    before, now: a coarse and a finer view each (`views_of`). guess: a motion `(6,)` with standard deviations `spread`
    `(6,)`. The search starts from it, and from all `STEPS` and `TURNS`. Along directions that the images do not show,
    the result is the guess. The result is believed if enough points fall on the image before and agree with it. Another
    motion that explains the images nearly as well widens the covariance (`with_rivals`), if it is near the guess.
    """
    starts = np.concatenate([np.repeat(STEPS, len(TURNS), axis=0), np.tile(TURNS, (len(STEPS), 1))], axis=1)
    predicted = retract(np.eye(4), guess)
    poses = retract(np.eye(4), np.concatenate([guess[None], starts]))
    for old, new, scales, count in zip(before, now, (COARSE_SCALES, FINE_SCALES), (KEPT, 2), strict=True):
        has_normal = np.isfinite(new.normals).all(axis=-1)
        points = new.points[has_normal]
        if len(points) < MIN_PIXELS:
            return None
        for scale in scales:
            poses = retract(poses, solve(compiled_motion_equations(old, points, poses, scale)[0]))
        far = np.sum((local(predicted, poses) / spread) ** 2, axis=1)
        raw, shares, _ = _scores(old, points, poses)
        raw -= shares < MIN_PAIRED
        kept = distinct(poses, raw - EXPECTED * np.minimum(far, FARTHEST) / 2, count, APART)
        poses, scores, far = poses[kept], raw[kept], far[kept]
    has_partner, n, r = paired(old, points, poses[0])
    shown = information(points[has_partner], n, new.normals[has_normal][has_partner], r)
    covariance, gain = fused(np.diag((PREDICTED * spread) ** 2), PIXELS * shown)
    covariance += np.diag(np.repeat(FLOOR, 3) ** 2)
    fused_pose = retract(predicted, gain @ local(predicted, poses[0]))
    score, share, agreeing = (float(x[0]) for x in _scores(old, points, fused_pose[None]))
    if share < MIN_PAIRED or agreeing < MIN_AGREEING or score < scores[0] - CLEARLY:
        return None
    evidence = scores - RIVAL_SCALE * np.minimum(far, FARTHEST) / 2
    rivals = [Rival(pose, min(float(e - evidence[0]), 0.0)) for pose, e in zip(poses[1:], evidence[1:], strict=True)]
    return MeasuredMotion(local(np.eye(4), fused_pose), with_rivals(covariance, fused_pose, rivals))


def _scores(before: View, points: np.ndarray, poses: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the scores `(N,)` of motions, at most 1, the share of points that pair, and their mean weight."""
    system, pairs = compiled_motion_equations(before, points, poses, SCALE)
    score = system.weights / (pairs + UNPAIRED * (len(points) - pairs))
    return score, pairs / len(points), system.weights / np.maximum(pairs, 1)
