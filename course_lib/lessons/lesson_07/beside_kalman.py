"""A corridor of one dimension, in which the exact answer is known: a Kalman filter, particles, and doors alike."""

from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from course_lib.depth_mcl.particle_filter import resample
from course_lib.plots import figures

# The wagon: metres that it is told to roll a frame, standard deviations of its rolling and of its laser (chosen).
STEP, ROLLING, LASER = 0.30, 0.05, 0.20
START = 1.0
FRAMES = 30
RUNS = 40
# The corridor with doors that look alike: where they are, how well one is seen, how long the corridor is, metres.
DOORS = (2.0, 4.0, 8.0)
SEEN = 0.20
LENGTH = 10.0


def wagon_and_laser(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """True places `(30,)` of a wagon that rolls from `START`, and what its laser measures of them `(30,)`, metres."""
    rng = np.random.default_rng(seed)
    true = START + np.cumsum(STEP + rng.normal(0, ROLLING, FRAMES))
    return true, true + rng.normal(0, LASER, FRAMES)


def kalman_means(measured: np.ndarray) -> np.ndarray:
    """The Kalman filter's estimates `(T,)` of a run that begins, known exactly, at `START`."""
    mean, variance, means = START, 0.0, []
    for z in measured:
        mean, variance = mean + STEP, variance + ROLLING**2
        gain = variance / (variance + LASER**2)
        mean, variance = mean + gain * (z - mean), (1 - gain) * variance
        means.append(mean)
    return np.array(means)


def particle_means(measured: np.ndarray, n_particles: int, seed: int) -> np.ndarray:
    """The particle filter's estimates `(T,)` of the same run: same motion, same likelihood."""
    rng, x, means = np.random.default_rng(seed), np.full(n_particles, START), []
    for z in measured:
        x = x + STEP + rng.normal(0, ROLLING, n_particles)
        w = np.exp(-((z - x) ** 2) / (2 * LASER**2))
        w /= w.sum()
        means.append(w @ x)
        x = x[resample(w, rng)]
    return np.array(means)


class BesideKalman(NamedTuple):
    """Root mean square distances of `RUNS` runs, `(RUNS,)` each, metres."""

    from_kalman: np.ndarray
    """Particle filter to Kalman filter."""
    from_truth: np.ndarray
    """Particle filter to wagon."""
    kalman_from_truth: np.ndarray


def beside_kalman(n_particles: int) -> BesideKalman:
    """Both filters on the same data, run after run."""
    rows = []
    for seed in range(1, RUNS + 1):
        true, measured = wagon_and_laser(seed)
        exact, found = kalman_means(measured), particle_means(measured, n_particles, 1000 + seed)
        rows.append([np.sqrt(np.mean((a - b) ** 2)) for a, b in ((found, exact), (found, true), (exact, true))])
    return BesideKalman(*np.array(rows).T)


class Bell(NamedTuple):
    """One Gaussian over the corridor."""

    mean: float
    sigma: float

    def share_within(self, place: float, reach: float) -> float:
        """How much of it lies within `reach` metres of a place, 0 to 1."""
        x = np.linspace(place - reach, place + reach, 2001)
        return float(np.trapezoid(self.density(x), x))

    def density(self, x: np.ndarray) -> np.ndarray:
        """p(x) [1/m]."""
        return np.exp(-0.5 * ((x - self.mean) / self.sigma) ** 2) / (self.sigma * np.sqrt(2 * np.pi))


def best_bells(moves: tuple[float, ...]) -> list[Bell]:
    """After each move and each door seen, the bell with the mean and the spread of what it should be.

    A Kalman filter carries one bell. This is the best it could do: the exact product of its bell with the doors'
    likelihood, and of that the mean and the standard deviation. At first every place in the corridor is as likely.
    """
    x = np.linspace(-LENGTH, 2 * LENGTH, 6001)
    belief = np.where((x >= 0) & (x <= LENGTH), 1.0, 0.0)
    bells = []
    for move in moves:
        if bells:
            belief = Bell(bells[-1].mean + move, np.hypot(bells[-1].sigma, ROLLING)).density(x)
        belief = belief * door_likelihood(x)
        mean = float(np.sum(belief * x) / belief.sum())
        bells.append(Bell(mean, float(np.sqrt(np.sum(belief * (x - mean) ** 2) / belief.sum()))))
    return bells


def door_likelihood(x: np.ndarray) -> np.ndarray:
    """p(a door is seen | x), up to a factor, for places `(N,)`."""
    return np.exp(-((np.asarray(x)[:, None] - DOORS) ** 2) / (2 * SEEN**2)).sum(axis=1)


def doors_figure(clouds: list[np.ndarray], bells: list[Bell], true: list[float]) -> Figure:
    """The particles as a histogram and the one bell, after the first door and after the second."""
    figure, axes = figures.new_figure(1, 2, size=(9.0, 2.9))
    x = np.linspace(0, LENGTH, 500)
    for a, cloud, bell, place, name in zip(axes, clouds, bells, true, ("first", "second"), strict=True):
        a.hist(cloud, bins=np.arange(0, LENGTH + 0.1, 0.2), density=True, color=figures.SKY_BLUE, label="particles")
        a.plot(x, bell.density(x), color=figures.VERMILION, linewidth=2, linestyle="--", label="one bell (Kalman)")
        a.plot(DOORS, np.full(len(DOORS), 0.07), "^", color=figures.BLACK, markersize=8, label="door")
        a.axvline(place, color="0.3", linewidth=1, label="the robot")
        a.set(
            title=f"After the {name} door", xlabel="x along the corridor [m]", ylabel="bel(x) [1/m]", xlim=(0, LENGTH)
        )
    axes[1].legend(loc="upper right", fontsize=8, framealpha=0.95)
    return figure
