"""Exercises of F3: many independent estimates, a filter with gaps, two estimates that err together."""

import numpy as np

from courseware.lessons.kit.exercises import Exercise


def fuse(means, covariances):
    """Mean (d,) and covariance (d, d) of n independent estimates (n, d) with covariances (n, d, d)."""
    # Certainties add, and so do certainties times means.
    certainties = np.linalg.inv(covariances)
    covariance = np.linalg.inv(certainties.sum(axis=0))
    return covariance @ np.einsum("nij,nj->i", certainties, means), covariance


def spread(rng: np.random.Generator, d: int) -> np.ndarray:
    """Make a covariance (d, d) with long and short axes and with correlations."""
    A = rng.normal(size=(d, d)) * rng.uniform(0.3, 2, d)
    return A @ A.T + 0.1 * np.eye(d)


def several(rng: np.random.Generator) -> tuple:
    n, d = int(rng.integers(2, 5)), int(rng.integers(2, 4))
    return rng.normal(0, 3, (n, d)), np.array([spread(rng, d) for _ in range(n)])


def track(z, x, P, F, Q, H, R):
    """Means (T, d) and covariances (T, d, d) after each frame of the measurements z (T, m); a row of nan is a gap.

    x (d,), P (d, d): the estimate before the first frame, which begins with a prediction.
    """
    means, covariances = [], []
    for one in z:
        x, P = F @ x, F @ P @ F.T + Q
        if not np.isnan(one).any():  # without a measurement the prediction stands
            K = P @ H.T @ np.linalg.inv(H @ P @ H.T + R)
            x, P = x + K @ (one - H @ x), P - K @ H @ P
        means.append(x)
        covariances.append(P)
    return np.array(means), np.array(covariances)


def drive(rng: np.random.Generator, gaps: float = 0.3) -> tuple:
    """Make measurements of a place, with gaps, and a model of place and speed."""
    z = np.where(rng.random((5, 1)) < gaps, np.nan, rng.normal(0, 2, (5, 1)))
    step = np.array([[1, rng.uniform(0.2, 1)], [0, 1]])
    return z, rng.normal(size=2), spread(rng, 2), step, spread(rng, 2) / 9, np.eye(2)[:1], rng.uniform(0.1, 1, (1, 1))


def fuse_correlated(x0, P0, x1, P1, C):
    """Best mean (d,) and covariance (d, d) of two estimates whose errors have the cross covariance C (d, d).

    C = E[e0 e1^T]. Both estimates are of the same state: x = x0 + K (x1 - x0), with the K of the least covariance.
    """
    # The derivative of the covariance with respect to K vanishes where K S = P0 - C.
    S = P0 + P1 - C - C.T
    K = (P0 - C) @ np.linalg.inv(S)
    return x0 + K @ (x1 - x0), P0 - K @ (P0 - C).T


def dependent(rng: np.random.Generator) -> tuple:
    d = int(rng.integers(2, 4))
    both = spread(rng, 2 * d)
    return rng.normal(0, 2, d), both[:d, :d], rng.normal(0, 2, d), both[d:, d:], both[:d, d:]


# fmt: off
EXERCISES = [
    Exercise("F3.1", fuse, several, "warm-up", cases={
        "one alone": lambda rng: (rng.normal(size=(1, 2)), spread(rng, 2)[None]),
        "nearly useless beside good": lambda rng: (rng.normal(size=(2, 2)), np.array([np.eye(2), 1e4 * np.eye(2)])),
    }, mistakes="""
        certainties.sum(axis=0) => certainties.mean(axis=0)
        means), covariance => means), np.linalg.inv(certainties.mean(axis=0))
        You average the certainties. They *add*: each further estimate makes the result surer.
        covariance @ np.einsum("nij,nj->i", certainties, means) => means.mean(axis=0)
        Your covariance is right. Your mean weighs all estimates alike: weigh each by its certainty.
        covariance @ np.einsum("nij,nj->i", certainties, means) => np.einsum("nij,nj->i", certainties, means)
        You have added certainty times mean. Multiply the sum by the joint covariance.
        means), covariance => means), certainties.sum(axis=0)
        That is the sum of the certainties. Its inverse is the covariance.
        = np.linalg.inv(covariances) => = covariances
        You add covariances. Add their inverses, the certainties.
        np.linalg.inv(covariances) => 1 / covariances
        np.linalg.inv(covariances) => 1 / np.where(covariances == 0, np.inf, covariances)
        You invert number by number. A certainty is the inverse of the *matrix*.
        np.linalg.inv(covariances) => np.array([np.diag(1 / np.diag(P)) for P in covariances])
        You use the variances alone. How the numbers err together, off the diagonal, counts, too.
        ... => return means.mean(axis=0), covariances.mean(axis=0)
        ... => return means.mean(axis=0), covariances.mean(axis=0) / len(means)
        That weighs all estimates alike. Weigh each by its certainty, the inverse of its covariance.
        means), covariance => means), covariances.mean(axis=0)
        Your mean is right. Your covariance is the mean of the given ones, as if nothing was gained.
        means), covariance => means), covariances.sum(axis=0) / len(means) ** 2
        Your mean is right. Your covariance is that of the plain mean, which weighs all alike.
    """),
    Exercise("F3.2", track, drive, cases={
        "a gap first": lambda rng: (np.array([[np.nan], [1.0], [0.5]]), *drive(rng)[1:]),
        "gaps only": lambda rng: (np.full((3, 1), np.nan), *drive(rng)[1:]),
        "no gap": lambda rng: drive(rng, 0.0),
    }, mistakes="""
        F @ x, F @ P @ F.T + Q => x, P
        The prediction is missing. It comes in every frame, with a measurement and without one.
        F @ P @ F.T + Q => F @ P @ F.T
        You leave out Q. Without system noise the filter soon stops listening to measurements.
        F @ P @ F.T + Q => P + Q
        The covariance moves, too: F P F^T turns what is unknown in the speed into what is unknown in the place.
        F @ P @ F.T + Q => F @ P + Q
        F @ P @ F.T + Q => F.T @ P @ F + Q
        The covariance moves by F P F^T, with F on its left and the transpose of F on its right.
        for one in z: => for one in np.nan_to_num(z):
        You take a gap for a measurement of 0. In a gap there is nothing to update.
        if not np.isnan(one).any(): => if True: and also one - H @ x => np.nan_to_num(one - H @ x)
        You put the prediction in for the gap. The mean stays right, but the filter becomes too sure.
        H @ P @ H.T + R) => H @ P @ H.T)
        R is missing: your filter believes each measurement fully.
        one - H @ x => one
        K multiplies the innovation: what was measured minus what was expected, H x.
        P - K @ H @ P => P
        Your covariance never shrinks. After a measurement it is (I - K H) P.
        P - K @ H @ P => P - K @ H @ P + K @ R @ K.T
        You add K R K^T once too often. (I - K H) P holds the noise of the measurement already.
        P - K @ H @ P => (np.eye(len(x)) - K @ H) @ P @ (np.eye(len(x)) - K @ H).T
        With (I - K H) on both sides of P, the noise K R K^T must be added. With it on one side, nothing.
        x, P = F @ x, F @ P @ F.T + Q => pass and also (P) => (P); x = F @ x; P = F @ P @ F.T + Q
        You update first and predict then. The task begins each frame with a prediction.
    """),
    Exercise("F3.3", fuse_correlated, dependent, "challenge", cases={
        "independent": lambda rng: (np.zeros(2), spread(rng, 2), np.ones(2), spread(rng, 2), np.zeros((2, 2))),
        "the second made from the first": lambda rng: (
            np.zeros(2), (P := spread(rng, 2)) + spread(rng, 2), np.ones(2), P, P),
    }, mistakes="""
        S = P0 + P1 - C - C.T => C = 0 * C; S = P0 + P1
        That holds for independent errors. C must make the second estimate count less.
        P0 + P1 - C - C.T => P0 + P1
        Your S leaves out C. The difference x1 - x0 has less noise if both err together.
        P0 + P1 - C - C.T => P0 + P1 - C
        P0 + P1 - C - C.T => P0 + P1 - 2 * C
        C is not symmetric: the covariance of x1 - x0 has C once as it is and once transposed.
        P0 + P1 - C - C.T => P0 + P1 + C + C.T
        That is the covariance of the sum. You need that of the difference, x1 - x0.
        K = (P0 - C) => K = P0
        Your K leaves out C. Where both err together, x1 - x0 says less about the error of x0.
        K = (P0 - C) => K = (P1 - C.T)
        That is the weight of x0. K is the weight of x1, which grows with the uncertainty of x0.
        (P0 - C) @ np.linalg.inv(S) => np.linalg.inv(S) @ (P0 - C)
        The inverse of S stands on the wrong side. Matrices do not commute.
        K = (P0 - C) => K = (P0 - C.T)
        Which is transposed? C = E[e0 e1^T], and K must fit the error of x0 to the difference.
        P0 - K @ (P0 - C).T => P0 - K @ P0
        P0 - K @ (P0 - C).T => (np.eye(len(x0)) - K) @ P0
        Your mean is right. (I - K) P0 holds for independent errors only.
        P0 - K @ (P0 - C).T => P0 - K @ S
        Your mean is right. The gain is K S K^T, with K on both sides.
        K @ (x1 - x0) => K @ (x0 - x1)
        Your mean moves away from the second estimate: x0 + K (x1 - x0).
        S = P0 + P1 - C - C.T => C = C * 0 + np.diag(np.diag(C)); S = P0 + P1 - C - C.T
        You use the diagonal of C alone. The errors of different numbers depend on each other, too.
    """),
]
