"""The claims of F3: joins are as honest as their closed form says, and the band is right."""

import numpy as np
import pytest

from courseware.answers.foundation_3 import fuse_correlated
from courseware.lessons.foundation_3 import fusion
from courseware.lessons.foundation_3.fusion import JOINS, band, covariance_intersection, join, kalman_update, sees


@pytest.mark.parametrize("how", JOINS)
def test_the_actual_covariance_of_a_join_is_that_of_a_simulation(how):
    rng, start, R_a, R_b = np.random.default_rng(1), np.diag([4.0, 2.0]), sees(20), sees(80)
    e0, a, b = (np.linalg.cholesky(P) @ rng.standard_normal((2, 40_000)) for P in (start, R_a, R_b))
    (x_a, P_a), (x_b, P_b) = kalman_update(e0, start, a, np.eye(2), R_a), kalman_update(e0, start, b, np.eye(2), R_b)
    omega = covariance_intersection(np.zeros(2), P_a, np.zeros(2), P_b)[2] if how == JOINS[1] else None
    alpha, beta = (1, 1) if omega is None else (omega, 1 - omega)
    pull = alpha * np.linalg.solve(P_a, x_a) + beta * np.linalg.solve(P_b, x_b)
    pull -= np.linalg.solve(start, e0) * (how == JOINS[2])
    found = join(start, R_a, R_b, how)
    assert np.cov(found.claimed @ pull) == pytest.approx(found.actual, abs=0.06)


@pytest.mark.parametrize("shared", [-0.9, 0.0, 0.7, 1.0])
def test_covariance_intersection_never_claims_too_much(shared):
    rng = np.random.default_rng(2)
    for _ in range(20):
        A, B = np.tril(rng.uniform(0.3, 2, (2, 2))), np.tril(rng.uniform(0.3, 2, (2, 2)))
        _, P, omega = covariance_intersection(np.zeros(2), A @ A.T, np.zeros(2), B @ B.T)
        pulls = omega * np.linalg.inv(A @ A.T) @ A, (1 - omega) * np.linalg.inv(B @ B.T) @ B
        actual = sum(one @ one.T for one in pulls) + shared * (pulls[0] @ pulls[1].T + pulls[1] @ pulls[0].T)
        assert np.linalg.eigvalsh(P - P @ actual @ P).min() > -1e-9


def test_the_band_holds_95_percent_of_honest_means_and_the_wagon_is_honest():
    rng, (low, high) = np.random.default_rng(3), band(20, 6)
    means = fusion.normalized_errors(rng.standard_normal((4000, 20, 6)), np.eye(6)).mean(axis=1)
    assert np.mean((means > low) & (means < high)) == pytest.approx(0.95, abs=0.01)
    assert 0.9 < fusion.wagon(400, 1.0, 7).mean() < 1.1 < 3 < fusion.wagon(400, 0.25, 7)[-1].mean()


def test_an_estimate_made_from_the_start_is_the_join_with_it():
    P0, P1 = np.diag([16.0, 20.0]), np.diag([12.0, 0.4])
    x, P = fuse_correlated(np.zeros(2), P0, np.ones(2), P1, P1)
    assert x == pytest.approx(np.ones(2))
    assert P == pytest.approx(P1)
