"""Does distance improve the pose? Paper 2 against a pose from directions alone, from the same matches.

Earlier methods had one camera: they knew in which direction an object stands, but not how far away it is (paper 2,
section 1). Paper 2 says that distance improves the accuracy (section 4). Here every fit gets the same pairs of object
and landmark. The weighted fit takes direction and distance, each by its own sigma: they are in its covariances.
"""

from collections.abc import Iterable

import numpy as np

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, RigidFitError, fit_rigid_2d, rotation_2d
from course_lib.spherical_stereo.ranging.object_positions import Noise
from courseware.experiments.intervals import median_interval
from courseware.experiments.room_evaluation import NO_OBJECT, pose_errors

MIN_BEARINGS = 3  # A pose has three unknowns, and each direction gives one equation.
MAX_SIGMA = 1.0  # Metres: a position that the directions tell less exactly is no answer (chosen beforehand).
STEPS, CONVERGED, TINY = 100, 1e-9, 1e-12  # Damped Gauss-Newton: at most, metres and radians, against 0 / 0.
FITS = ALONE, PAPER, WEIGHTED = "direction alone", "the paper's fit", "direction and distance, weighted_fit"
FEW = 3, 5  # Pairs drawn from the true ones: what is distance worth where little is seen?
DRAW_SEED = 0xBEA


def fit_bearings(bearings: np.ndarray, landmarks: np.ndarray) -> Pose2D | None:
    """Return the pose that sees the landmarks in the measured directions; None if the directions do not tell it.

    min over x, y, theta of sum_i e_i^2,    e_i = atan2(Y_i - y, X_i - x) - theta - b_i,  wrapped to [-pi, pi)

    e_i is the angle from the measured direction to the predicted one. bearings: b `(n,)`, radians, counterclockwise
    from body x. landmarks: (X, Y) `(n, 2)`, metres. Damped Gauss-Newton from four starts; the best end counts.
    None: fewer than three directions, or `Noise.box_centre` leaves the position less exact than `MAX_SIGMA`. This
    happens if the camera and all landmarks lie on one circle, because the same angles are seen from all of it.
    """
    bearings, landmarks = np.asarray(bearings, float).reshape(-1), np.asarray(landmarks, float).reshape(-1, 2)
    if len(bearings) < MIN_BEARINGS:
        return None
    ends = [_gauss_newton(start, bearings, landmarks) for start in _starts(bearings, landmarks)]
    pose = min(ends, key=lambda end: np.sum(_residuals(end, bearings, landmarks)[0] ** 2))
    jacobian = _residuals(pose, bearings, landmarks)[1]
    # What the directions tell of the position once the heading is fitted, too.
    information = np.linalg.eigvalsh(np.cov(jacobian[:, :2].T, ddof=0))[0] * len(bearings) / Noise().box_centre ** 2
    return Pose2D(float(pose[0]), float(pose[1]), wrap_angle(pose[2])) if information * MAX_SIGMA**2 > 1 else None


def _residuals(pose: np.ndarray, bearings: np.ndarray, landmarks: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return e `(n,)` and its derivatives by x, y and theta `(n, 3)`: (Y - y, x - X) / rho^2 and -1."""
    x, y = (landmarks - pose[:2]).T
    squared = np.maximum(x**2 + y**2, TINY)
    return wrap_angle(np.arctan2(y, x) - pose[2] - bearings), np.stack([y / squared, -x / squared, -np.ones_like(x)], 1)


def _starts(bearings: np.ndarray, landmarks: np.ndarray) -> list[np.ndarray]:
    """Return four poses from a linear problem, sum_i (rho_i sin e_i)^2: two headings, each forward and backward.

    rho_i sin e_i = (-sin b_i, cos b_i) . (R(theta)' m_i - p),  p = R(theta)' t: linear in cos theta, sin theta and p.
    """
    across = np.stack([-np.sin(bearings), np.cos(bearings)], axis=1)
    of_heading = np.stack([(across * landmarks).sum(axis=1), (across * landmarks[:, ::-1]) @ [1, -1]], axis=1)
    solve, starts = np.linalg.pinv(across), []
    for heading in np.linalg.svd(of_heading - across @ solve @ of_heading)[2]:
        for vector in (heading, -heading):
            theta = np.arctan2(vector[1], vector[0])
            starts.append(np.array([*(rotation_2d(theta) @ solve @ of_heading @ vector), theta]))
    return starts


def _gauss_newton(pose: np.ndarray, bearings: np.ndarray, landmarks: np.ndarray) -> np.ndarray:
    residuals, jacobian = _residuals(pose, bearings, landmarks)
    damping = 1e-3  # A step that leads uphill is shortened by more damping.
    for _ in range(STEPS):
        normal = jacobian.T @ jacobian + TINY * np.eye(3)
        step = np.linalg.solve(normal + damping * np.diag(np.diag(normal)), -jacobian.T @ residuals)
        new_residuals, new_jacobian = _residuals(pose + step, bearings, landmarks)
        if new_residuals @ new_residuals <= residuals @ residuals:
            pose, residuals, jacobian, damping = pose + step, new_residuals, new_jacobian, damping / 10
        else:
            damping *= 10
        if np.abs(step).max() < CONVERGED:
            break
    return pose


def fit_errors(observations: list, landmarks: np.ndarray, true_pose: np.ndarray) -> list[tuple[float, float]]:
    """Return metres and degrees by which each of `FITS` is off; infinite if it gives no pose. landmarks: `(n, 2)`."""
    points = np.array([(one.x, one.y) for one in observations]).reshape(-1, 2)
    poses = [fit_bearings(np.arctan2(points[:, 1], points[:, 0]), landmarks)]
    for covariances in (None, np.array([one.covariance for one in observations]).reshape(-1, 2, 2)):
        try:
            poses.append(fit_rigid_2d(points, landmarks, covariances=covariances))
        except RigidFitError:
            poses.append(None)
    found = [pose_errors(pose, true_pose) for pose in poses]
    return [(np.inf, np.inf) if np.isnan(dx) else (float(np.hypot(dx, dy)), degrees) for dx, dy, degrees in found]


def compared(poses: Iterable[tuple]) -> dict[str, dict]:
    """Return the errors, and what distance changes, for the pairs as found, the true pairs, and a few of the true ones.

    poses: (unit, Localization, true landmarks, true pose, the map's positions). A unit is drawn as a whole: a room, or
    one pose at both heights. Change: the error less that of direction alone in each pose, its median in each unit, then
    the median of these and its interval. A fit without a pose has an infinite error, so all fits have the same poses.
    """
    rng, errors = np.random.default_rng(DRAW_SEED), {}
    for unit, found, true_landmarks, true_pose, positions in poses:
        true = [(i, k) for i, k in enumerate(true_landmarks) if k != NO_OBJECT]
        few = {f"{n}_true": [true[i] for i in rng.permutation(len(true))[:n]] for n in FEW if len(true) >= n}
        for name, pairs in {"as_found": list(found.used_pairs), "true": true, **few}.items():
            places = positions[[k for _, k in pairs]].reshape(-1, 2)
            own = fit_errors([found.observations[i] for i, _ in pairs], places, true_pose)
            errors.setdefault(name, []).append((unit, own))
    return {name: _summary(*map(np.array, zip(*rows, strict=True))) for name, rows in errors.items()}


def _summary(units: np.ndarray, errors: np.ndarray) -> dict:
    """Return the numbers of every fit; errors `(n, 3, 2)`."""
    with np.errstate(invalid="ignore"):
        apart = np.nan_to_num(errors - errors[:, :1], nan=0.0, posinf=np.inf, neginf=-np.inf)
    by_unit = np.array([np.median(apart[units == unit], axis=0) for unit in np.unique(units)])
    table: dict = {"poses": len(units), "units": len(by_unit)}
    for k, fit in enumerate(FITS):
        numbers = {"no_pose_percent": 100.0 * np.isinf(errors[:, k, 0]).mean()}
        for column, name in enumerate(("m", "deg")):
            middle, most = np.quantile(errors[:, k, column], (0.5, 0.9), method="higher")
            change = {f"{end}_change_{name}": x for end, x in median_interval(by_unit[:, k, column]).items()}
            numbers |= {f"median_{name}": middle, f"ninety_percent_{name}": most, **change}
        table[fit] = {key: float(x) if x is not None and np.isfinite(x) else None for key, x in numbers.items()}
    return table


def bearing_table(found: dict[str, dict]) -> str:
    """Return the table of `compared`: medians, 90 % of the poses, and what distance changes, pose by pose."""
    one = next(iter(found.values()))
    lines = [
        f"Direction and distance, from images: {one['poses']} poses, intervals (95 %) over {one['units']} units",
        f"{'':42}{'no pose':>8}{'median (90 %) of':>32}{'change from direction alone in':>51}",
        f"{'':42}{'[%]':>8}{'position [m]':>17}{'heading [deg]':>15}{'position [m]':>26}{'heading [deg]':>25}",
    ]
    for name, table in found.items():
        lines.append(f"Pairs {name.replace('_', ' ')} ({table['poses']} poses)")
        for fit in FITS:
            text = {key: "-" if x is None else f"{x:z.2f}" for key, x in table[fit].items()}
            sizes = [f"{text[f'median_{u}']} ({text[f'ninety_percent_{u}']})" for u in ("m", "deg")]
            ends = [[text[f"{end}_change_{u}"] for end in ("median", "low", "high")] for u in ("m", "deg")]
            told = ["" if fit == ALONE else f"{middle} ({low} to {high})" for middle, low, high in ends]
            lines.append("  {:40}{:>8}{:>17}{:>15}{:>26}{:>25}".format(fit, text["no_pose_percent"], *sizes, *told))
    return "\n".join(lines)
