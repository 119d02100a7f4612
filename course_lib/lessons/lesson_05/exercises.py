"""Exercises of lesson 05: spread, noise along own axes, who is near, a step of the Bayes filter, the least noise."""

import numpy as np
from scipy.stats import norm

from course_lib.geometry import pose_matrix, wrap_angle
from course_lib.lessons.kit.exercises import Exercise, Mistake

# 05.1: the spread after t frames


def spread_after(spread0: np.ndarray, sigma: np.ndarray, t: int) -> np.ndarray:
    """Standard deviations (6,) of a cloud after t frames of noise sigma (6,), from spread0 (6,) at the start."""
    return np.sqrt(spread0**2 + t * sigma**2)


def _spreads(rng: np.random.Generator) -> tuple:
    spread0, sigma = rng.uniform(0.05, 0.6, 6), rng.uniform(0.02, 0.3, 6)
    spread0[rng.integers(6)] = 0.0
    sigma[rng.integers(6)] = 0.0
    return spread0, sigma, int(rng.integers(2, 60))


def _the_courses_noise(rng: np.random.Generator) -> tuple:
    return np.zeros(6), np.array([0.15, 0.04, 0, 0, 0, np.deg2rad(1.5)]), 100


def _no_frame(rng: np.random.Generator) -> tuple:
    return rng.uniform(0.1, 0.5, 6), rng.uniform(0.1, 0.5, 6), 0


# 05.2: noise along the particle's own axes


def propagate_own_axes(particles: np.ndarray, sigma_forward: float, sigma_left: float, draws: np.ndarray) -> np.ndarray:
    """Particles (N, 6) moved by noise along each one's own forward and left axes; draws (N, 2) standard normal."""
    forward, left = sigma_forward * draws[:, 0], sigma_left * draws[:, 1]
    return _moved(particles, forward, left, particles[:, 5])


def _moved(particles: np.ndarray, forward: np.ndarray, left: np.ndarray, yaw: np.ndarray) -> np.ndarray:
    moved = particles.copy()
    moved[:, 0] += forward * np.cos(yaw) - left * np.sin(yaw)
    moved[:, 1] += forward * np.sin(yaw) + left * np.cos(yaw)
    return moved


def _particles_and_draws(rng: np.random.Generator) -> tuple:
    n = int(rng.integers(4, 9))
    particles = np.zeros((n, 6))
    particles[:, :3] = rng.uniform([5, -1, 0.8], [15, 1, 1.2], (n, 3))
    particles[:, 3:5] = rng.uniform(-0.3, 0.3, (n, 2))
    particles[:, 5] = rng.uniform(-np.pi, np.pi, n)
    return particles, rng.uniform(0.1, 0.3), rng.uniform(0.02, 0.09), rng.standard_normal((n, 2))


def _four_headings(rng: np.random.Generator) -> tuple:
    """Headings along the axes and at the seam, one step forward and one to the left."""
    particles = np.tile([10.0, 0.5, 1.0, 0.1, -0.2, 0.0], (8, 1))
    particles[:, 5] = np.tile(np.deg2rad([0, 90, -90, -180]), 2)
    return particles, 0.2, 0.05, np.repeat(np.eye(2), 4, axis=0)


def _by_column(column):
    """A mistake: the particles turn their steps by another column of their states."""

    def mistaken(particles, sigma_forward, sigma_left, draws):
        return _moved(particles, sigma_forward * draws[:, 0], sigma_left * draws[:, 1], particles[:, column])

    return mistaken


def _with(change):
    """A mistake: the particles moved as `change(forward, left, yaw)` says, which returns the three to use instead."""

    def mistaken(particles, sigma_forward, sigma_left, draws):
        forward, left = sigma_forward * draws[:, 0], sigma_left * draws[:, 1]
        return _moved(particles, *change(forward, left, particles[:, 5]))

    return mistaken


def _steps_alone(particles, sigma_forward, sigma_left, draws):
    right = propagate_own_axes(particles, sigma_forward, sigma_left, draws)
    return right - particles


def _by_whole_rotation(particles, sigma_forward, sigma_left, draws):
    steps = np.column_stack([draws * [sigma_forward, sigma_left], np.zeros(len(draws))])
    moved = particles.copy()
    moved[:, :3] += np.einsum("nab,nb->na", pose_matrix(particles)[:, :3, :3], steps)
    return moved


def _by_whole_rotation_on_the_floor(particles, sigma_forward, sigma_left, draws):
    moved = _by_whole_rotation(particles, sigma_forward, sigma_left, draws)
    moved[:, 2] = particles[:, 2]
    return moved


def _as_variances(particles, sigma_forward, sigma_left, draws):
    return propagate_own_axes(particles, sigma_forward**2, sigma_left**2, draws)


def _left_minus(particles, sigma_forward, sigma_left, draws):
    forward, left, yaw = sigma_forward * draws[:, 0], sigma_left * draws[:, 1], particles[:, 5]
    moved = particles.copy()
    moved[:, 0] += forward * np.cos(yaw) + left * np.sin(yaw)
    moved[:, 1] += forward * np.sin(yaw) + left * np.cos(yaw)
    return moved


def _by_matrix(rows):
    """A mistake: the step in x and y is the matrix `rows(cos yaw, sin yaw)` times (forward, left)."""

    def mistaken(particles, sigma_forward, sigma_left, draws):
        turns = np.array(rows(np.cos(particles[:, 5]), np.sin(particles[:, 5])))
        moved = particles.copy()
        moved[:, :2] += np.einsum("abn,nb->na", turns, draws * [sigma_forward, sigma_left])
        return moved

    return mistaken


# 05.3: how many particles are near a state


def share_near(particles: np.ndarray, state: np.ndarray, radius: float, angle: float) -> float:
    """Share (0 to 1) of particles within `radius` [m] of a state on the floor and within `angle` [rad] of its yaw."""
    near = np.hypot(*(particles[:, :2] - state[:2]).T) <= radius
    return float(np.mean(near & (np.abs(wrap_angle(particles[:, 5] - state[5])) <= angle)))


def _cloud_and_state(rng: np.random.Generator) -> tuple:
    """A cloud about as wide as radius and angle, at another height than the state, mostly about the wrap; a few look
    the other way, and at times one is exactly `radius` away."""
    n = int(rng.integers(40, 81))
    # Eighths of a metre are exact in floating point, so that a distance can equal the radius.
    radius, angle = rng.choice([0.125, 0.25]), np.deg2rad(rng.uniform(5, 15))
    place = rng.integers(40, 121, 2) / 8
    middle = np.array([*place, 1.0, 0, 0, rng.choice([np.pi, rng.uniform(-2, 2)], p=[0.8, 0.2])])
    scatter = [0.8 * radius, 0.8 * radius, 0.8 * radius, 2 * angle, 2 * angle, angle]
    particles = middle + rng.standard_normal((n, 6)) * scatter
    particles[:3, 5] += np.pi
    state = middle + np.array([0, 0, 0.3 * radius, 0, 0, -0.3 * angle])
    if rng.random() < 0.5:
        particles[-1] = state + np.array([radius, 0, 0, 0, 0, 0])
    particles[:, 5], state[5] = wrap_angle(particles[:, 5]), wrap_angle(state[5])
    return particles, state, radius, angle


def _nobody_near(rng: np.random.Generator) -> tuple:
    particles = rng.normal([10, 0, 1, 0, 0, 0], 0.2, (12, 6))
    return particles, np.array([20.0, 0, 1, 0, 0, 0]), 0.5, 0.2


def _exactly_there(rng: np.random.Generator) -> tuple:
    """A radius and an angle of 0: only particles at the state itself are near, and they are."""
    particles = np.tile([10.0, 0.5, 1.0, 0, 0, 0.5], (4, 1))
    particles[1, 0] += 0.25
    particles[2, 5] += 0.25
    return particles, particles[0].copy(), 0.0, 0.0


def _at_the_seam(rng: np.random.Generator) -> tuple:
    """The task's own example."""
    state = np.array([10.0, 0.5, 1.0, 0, 0, np.deg2rad(-179)])
    return np.array([[10.0, 0.5, 1.0, 0, 0, np.deg2rad(179)]]), state, 0.1, np.deg2rad(5)


def _tests(particles: np.ndarray, state: np.ndarray, radius: float, angle: float) -> tuple[np.ndarray, np.ndarray]:
    near = np.hypot(*(particles[:, :2] - state[:2]).T) <= radius
    return near, np.abs(wrap_angle(particles[:, 5] - state[5])) <= angle


def _near_in(columns):
    """A mistake: near on the floor, and near in these angles of the state."""

    def mistaken(particles, state, radius, angle):
        near, _ = _tests(particles, state, radius, angle)
        turned = np.abs(wrap_angle(particles[:, columns] - state[columns])) <= angle
        return np.mean(near & turned.all(axis=1))

    return mistaken


def _not_wrapped(particles, state, radius, angle):
    near, _ = _tests(particles, state, radius, angle)
    return np.mean(near & (np.abs(particles[:, 5] - state[5]) <= angle))


def _in_space(particles, state, radius, angle):
    _, turned = _tests(particles, state, radius, angle)
    return np.mean(turned & (np.linalg.norm(particles[:, :3] - state[:3], axis=1) <= radius))


def _share_of_those_near(particles, state, radius, angle):
    near, turned = _tests(particles, state, radius, angle)
    return np.sum(near & turned) / max(np.sum(near), 1)


def _absolute_yaws(particles, state, radius, angle):
    near, _ = _tests(particles, state, radius, angle)
    return np.mean(near & (np.abs(np.abs(particles[:, 5]) - np.abs(state[5])) <= angle))


def _in_a_square(particles, state, radius, angle):
    _, turned = _tests(particles, state, radius, angle)
    return np.mean(turned & (np.abs(particles[:, :2] - state[:2]) <= radius).all(axis=1))


def _without_absolute(particles, state, radius, angle):
    near, _ = _tests(particles, state, radius, angle)
    return np.mean(near & (wrap_angle(particles[:, 5] - state[5]) <= angle))


def _squares_against_radius(particles, state, radius, angle):
    _, turned = _tests(particles, state, radius, angle)
    return np.mean(turned & (((particles[:, :2] - state[:2]) ** 2).sum(axis=1) <= radius))


# 05.4: one step of the Bayes filter on cells


def bayes_step(bel: np.ndarray, moves: np.ndarray, doors: np.ndarray, seen: bool, hit: float, false_alarm: float):
    """Belief (n,) over the cells of a corridor with an end, after a move and a look for doors.

    moves: probabilities of 0, 1, 2, ... cells forward; what would pass the last cell stops there. hit, false_alarm:
    probability of seeing a door where there is one, and where there is none.
    """
    return _to_one(_look(_move(bel, moves), doors, seen, hit, false_alarm))


def _to_one(bel: np.ndarray) -> np.ndarray:
    return bel / bel.sum()


def _move(bel: np.ndarray, moves: np.ndarray, at_the_end: str = "stops") -> np.ndarray:
    moved, n = np.zeros(len(bel)), len(bel)
    for cell in range(n):
        for k, p in enumerate(moves):
            if cell + k < n:
                moved[cell + k] += p * bel[cell]
            elif at_the_end == "stops":
                moved[-1] += p * bel[cell]
            elif at_the_end == "ring":
                moved[(cell + k) % n] += p * bel[cell]
            elif at_the_end == "stays":
                moved[cell] += p * bel[cell]
    return moved


def _look(bel: np.ndarray, doors: np.ndarray, seen: bool, hit: float, false_alarm: float) -> np.ndarray:
    at_door = np.where(doors, hit, false_alarm)
    return bel * (at_door if seen else 1 - at_door)


def _corridor_with_doors(rng: np.random.Generator) -> tuple:
    n = int(rng.integers(8, 15))
    doors = rng.permutation(np.arange(n) < 3)
    bel, moves = rng.dirichlet(np.ones(n)), rng.dirichlet([2, 5, 2])
    return bel, moves, doors, bool(rng.random() < 0.5), rng.uniform(0.6, 0.95), rng.uniform(0.05, 0.3)


def _five_moves(rng: np.random.Generator) -> tuple:
    bel, _, *rest = _corridor_with_doors(rng)
    return bel, rng.dirichlet(np.ones(5)), *rest


def _more_moves_than_cells(rng: np.random.Generator) -> tuple:
    return rng.dirichlet(np.ones(4)), rng.dirichlet(np.ones(7)), np.arange(4) == 2, False, 0.9, 0.2


def _at_rest(rng: np.random.Generator) -> tuple:
    bel, _, *rest = _corridor_with_doors(rng)
    return bel, np.array([1.0]), *rest


def _nearly_at_the_end(rng: np.random.Generator) -> tuple:
    return np.array([0, 0, 0, 0.3, 0.7]), np.array([0.1, 0.8, 0.1]), np.arange(5) == 4, True, 0.8, 0.1


def _a_sure_sensor(rng: np.random.Generator) -> tuple:
    return np.full(6, 1 / 6), np.array([0.0, 1.0]), np.arange(6) % 3 == 0, False, 1.0, 0.0


def _the_tasks_corridor(rng: np.random.Generator) -> tuple:
    return np.array([0.5, 0.5, 0.0]), np.array([0.0, 1.0]), np.array([False, True, False]), True, 0.8, 0.2


def _counted_once(bel, moves, doors, seen, hit, false_alarm):
    """`moved[target] += p * bel`: of several that stop in the last cell only one is added."""
    moved, cells = np.zeros(len(bel)), np.arange(len(bel))
    for k, p in enumerate(moves):
        moved[np.minimum(cells + k, len(bel) - 1)] += p * bel
    return _to_one(_look(moved, doors, seen, hit, false_alarm))


# 05.5: the least noise that keeps up


def min_sigma(step: float, n: int, frames: int, p: float) -> float:
    """Least sigma [m] at which, with probability p, in each of `frames` frames one of n normal steps is >= step [m].

    P(one of n) = 1 - Phi(step / sigma)^n; the frames are independent, so that this to the power of `frames` is p.
    """
    return step / norm.ppf((1 - p ** (1 / frames)) ** (1 / n))


def _wagons(rng: np.random.Generator) -> tuple:
    return rng.uniform(0.02, 0.3), int(rng.integers(50, 2000)), int(rng.integers(20, 500)), rng.uniform(0.6, 0.99)


def _the_courses_wagon(rng: np.random.Generator) -> tuple:
    return 0.0965, 200, 303, 0.95


def _mean_farthest(n: int) -> float:
    """Mean of the farthest of n standard normal steps."""
    x = np.linspace(-9, 9, 3001)
    return float(np.sum(x * n * norm.pdf(x) * norm.cdf(x) ** (n - 1)) * (x[1] - x[0]))


def _one_frame(rng: np.random.Generator) -> tuple:
    return 0.1, 20, 1, 0.9


EXERCISES = [
    Exercise(
        number="05.1",
        solution=spread_after,
        inputs=_spreads,
        cases=(_the_courses_noise, _no_frame),
        level="warm-up",
        mistakes=(
            Mistake(
                lambda spread0, sigma, t: spread0 + np.sqrt(t) * sigma,
                "You add standard deviations. Independent things add their variances: square, add, take the root.",
            ),
            Mistake(
                lambda spread0, sigma, t: np.sqrt(t) * sigma,
                "You forgot that the cloud has a spread at the start. Its variance counts, too.",
            ),
            Mistake(
                lambda spread0, sigma, t: np.sqrt(spread0**2 + (t * sigma) ** 2),
                "Your noise grows with t. Each frame adds one variance, so the variance grows with t, not its square.",
            ),
            Mistake(
                lambda spread0, sigma, t: spread0**2 + t * sigma**2,
                "That is the variance. The standard deviation is its root.",
            ),
            Mistake(
                lambda spread0, sigma, t: spread0 + t * sigma,
                "You let all steps point the same way. They are random: variances add, not standard deviations.",
            ),
            Mistake(
                lambda spread0, sigma, t: np.sqrt(t * (spread0**2 + sigma**2)),
                "You count the spread at the start in every frame. It is there once.",
            ),
            Mistake(
                lambda spread0, sigma, t: np.sqrt(spread0**2 + sigma**2),
                "That is the spread after one frame. Where is t?",
            ),
            Mistake(
                lambda spread0, sigma, t: np.sqrt(np.maximum(spread0**2 + (t - 1) * sigma**2, 0)),
                "One frame is missing: the first frame moves the particles already.",
                others=(lambda spread0, sigma, t: np.sqrt(spread0**2 + max(t - 1, 0) * sigma**2),),
            ),
            Mistake(
                lambda spread0, sigma, t: np.sqrt(spread0 + t * sigma),
                "You add standard deviations under the root. Square them first.",
            ),
            Mistake(
                lambda spread0, sigma, t: np.sqrt(spread0 + t * sigma**2),
                "You square sigma, but not the spread at the start. It is a standard deviation as well.",
            ),
            Mistake(
                lambda spread0, sigma, t: np.sqrt(spread0**2 + t * sigma),
                "You square the spread at the start, but not sigma.",
            ),
            Mistake(
                lambda spread0, sigma, t: np.sqrt(sigma**2 + t * spread0**2),
                "You swapped the two: the spread at the start counts once, sigma in every frame.",
            ),
            Mistake(
                lambda spread0, sigma, t: np.sqrt(spread0**2 + (t + 1) * sigma**2),
                "You count one frame too many: after t frames there were t steps, the start is none.",
            ),
            Mistake(
                lambda spread0, sigma, t: np.maximum(spread0, np.sqrt(t) * sigma),
                "You take the greater of the two. Both spread the cloud: their variances add.",
            ),
        ),
    ),
    Exercise(
        number="05.2",
        solution=propagate_own_axes,
        inputs=_particles_and_draws,
        cases=(_four_headings,),
        mistakes=(
            Mistake(_by_column(4), "You turn the steps by the pitch. The heading is the yaw, the last of the six."),
            Mistake(_by_column(3), "You turn the steps by the roll. The heading is the yaw, the last of the six."),
            Mistake(
                _with(lambda forward, left, yaw: (forward, left, 0 * yaw)),
                "You add forward to x and left to y. That holds for yaw 0 only: turn the step by the particle's yaw.",
            ),
            Mistake(
                _with(lambda forward, left, yaw: (forward, left, -yaw)),
                "Your steps turn the wrong way: from the body to the world, by +yaw.",
            ),
            Mistake(
                _with(lambda forward, left, yaw: (forward, left, np.full_like(yaw, yaw[0]))),
                "All your particles step in the direction of the first one. Each has a yaw of its own.",
            ),
            Mistake(
                _with(lambda forward, left, yaw: (left, forward, yaw)),
                "You swapped forward and left: the first column of `draws` is forward.",
            ),
            Mistake(
                _with(lambda forward, left, yaw: (forward, -left, yaw)),
                "Your second step goes to the right. Left is forward turned by +90 degrees: (-sin, cos).",
            ),
            Mistake(
                _with(lambda forward, left, yaw: (forward, left, np.deg2rad(yaw))),
                "The yaw of a particle is in radians already.",
            ),
            Mistake(
                _with(lambda forward, left, yaw: (forward, 0 * left, yaw)),
                "Your particles never step sideways: the noise along the left axis is missing.",
            ),
            Mistake(
                _with(lambda forward, left, yaw: (np.abs(forward), left, yaw)),
                "Your particles never step back. The noise is normal: half of the draws are negative.",
            ),
            Mistake(
                _as_variances, "You multiply the draws by sigma squared. A standard normal draw times sigma is right."
            ),
            Mistake(_left_minus, "One sign is wrong in x: left points along (-sin yaw, cos yaw)."),
            Mistake(_steps_alone, "These are the steps alone. Add them to the particles."),
            Mistake(
                lambda particles, sigma_forward, sigma_left, draws: propagate_own_axes(particles, 1, 1, draws),
                "Your steps are about a metre long: multiply the draws by their sigmas.",
            ),
            Mistake(
                lambda particles, sigma_forward, sigma_left, draws: propagate_own_axes(
                    particles, sigma_left, sigma_forward, draws
                ),
                "You swapped the sigmas: sigma_forward belongs to the first column of `draws`.",
            ),
            Mistake(
                lambda particles, sigma_forward, sigma_left, draws: propagate_own_axes(
                    particles, sigma_forward, sigma_left, draws[:, ::-1]
                ),
                "You swapped the columns of `draws`: the first one is forward.",
            ),
            Mistake(
                _by_matrix(lambda c, s: [[s, c], [c, -s]]),
                "Sine and cosine have changed places. At yaw 0 forward is along x: so x has the cosine.",
            ),
            Mistake(
                _by_matrix(lambda c, s: [[c, -s], [s, -c]]),
                "One sign is wrong in y: left points along (-sin yaw, cos yaw).",
            ),
            Mistake(
                _by_matrix(lambda c, s: [[c, 0 * s], [s, 1 + 0 * c]]),
                "You turn forward, but not left: left is forward turned by +90 degrees, (-sin yaw, cos yaw).",
            ),
            Mistake(
                _by_matrix(lambda c, s: [[c, 0 * s], [0 * c, s]]),
                "Each of the two steps has a part in x *and* a part in y.",
            ),
            Mistake(
                _with(lambda forward, left, yaw: (forward, left, np.rad2deg(yaw))),
                "You turn the yaw into degrees; np.sin and np.cos take radians.",
            ),
            Mistake(
                _with(lambda forward, left, yaw: (forward, left, np.full_like(yaw, yaw.mean()))),
                "All your particles step in one mean direction. Each has a yaw of its own.",
            ),
            Mistake(
                _with(lambda forward, left, yaw: (forward, left, np.pi / 2 - yaw)),
                "Sine and cosine have changed places: forward is (cos, sin) of the yaw.",
            ),
            Mistake(
                _by_whole_rotation,
                "You turn by roll and pitch as well, and the steps leave the floor. Only the yaw turns them; z stays.",
            ),
            Mistake(
                _by_whole_rotation_on_the_floor,
                "z stays, but roll and pitch still shorten and bend your steps. Only the yaw turns them.",
            ),
        ),
    ),
    Exercise(
        number="05.3",
        solution=share_near,
        inputs=_cloud_and_state,
        cases=(_at_the_seam, _nobody_near, _exactly_there),
        mistakes=(
            Mistake(
                _near_in([3, 4, 5]),
                "You ask for roll and pitch as well. The task asks for the yaw alone.",
            ),
            Mistake(_near_in([3]), "You compare the roll. The heading is the yaw, the last of the six."),
            Mistake(_near_in([4]), "You compare the pitch. The heading is the yaw, the last of the six."),
            Mistake(
                lambda particles, state, radius, angle: np.mean(
                    _tests(particles, state, radius, angle)[0]
                    & (np.abs(wrap_angle(particles[:, 5] - state[5])) < angle)
                ),
                "With an angle of 0 nobody is near in yours, not even a twin of the state. *At most* means <=.",
            ),
            Mistake(
                _not_wrapped,
                "Wrap the difference of the yaws: 179 and -179 degrees are 2 degrees apart, not 358.",
            ),
            Mistake(_in_space, "Your distance includes z. Near on the floor means x and y only."),
            Mistake(
                lambda particles, state, radius, angle: np.mean(
                    np.logical_or(*_tests(particles, state, radius, angle))
                ),
                "You count particles that are near in place *or* in heading. They must be near in both.",
            ),
            Mistake(
                lambda particles, state, radius, angle: np.sum(
                    np.logical_and(*_tests(particles, state, radius, angle))
                ),
                "You count the particles. A share is that count divided by their number.",
            ),
            Mistake(
                lambda particles, state, radius, angle: np.mean(_tests(particles, state, radius, angle)[0]),
                "You look at the place alone. The heading must be near, too.",
            ),
            Mistake(
                lambda particles, state, radius, angle: np.mean(_tests(particles, state, radius, angle)[1]),
                "You look at the heading alone. The place must be near, too.",
            ),
            Mistake(
                lambda particles, state, radius, angle: 1 - share_near(particles, state, radius, angle),
                "That is the share of the particles that are *not* near.",
            ),
            Mistake(
                lambda particles, state, radius, angle: 100 * share_near(particles, state, radius, angle),
                "Yours is in percent; the task asks for a share from 0 to 1.",
            ),
            Mistake(
                _in_a_square, "You test x and y one by one: that is a square. The distance is the root of dx^2 + dy^2."
            ),
            Mistake(_without_absolute, "A yaw far to the right passes your test. Compare the absolute difference."),
            Mistake(_squares_against_radius, "You compare a squared distance with the radius: take the root."),
            Mistake(
                lambda particles, state, radius, angle: share_near(particles, state, radius, np.deg2rad(angle)),
                "Degrees meet radians in your test: the yaws and `angle` are all in radians. Convert nothing.",
            ),
            Mistake(
                lambda particles, state, radius, angle: np.prod(
                    np.mean(_tests(particles, state, radius, angle), axis=1)
                ),
                "You multiply two shares. Ask of each particle whether it passes both tests, then take one mean.",
            ),
            Mistake(
                _share_of_those_near,
                "You divide by the particles that are near in place. The share is one of all particles.",
            ),
            Mistake(
                _absolute_yaws,
                "You compare the sizes of two yaws: 20 and -20 degrees are not one heading. Wrap their difference.",
            ),
            Mistake(
                lambda particles, state, radius, angle: np.mean(
                    _tests(particles, state, radius, angle)[0]
                    & (wrap_angle(np.abs(particles[:, 5] - state[5])) <= angle)
                ),
                "Wrap first, then take the absolute value: wrapping afterwards makes large differences negative.",
            ),
            Mistake(
                lambda particles, state, radius, angle: np.mean(
                    _tests(particles, state, radius, angle)[0]
                    & (np.mod(particles[:, 5] - state[5], 2 * np.pi) <= angle)
                ),
                "From 0 to 2 pi a small turn to the right is nearly 2 pi. Wrap to -pi ... pi, then the absolute value.",
            ),
            Mistake(
                lambda particles, state, radius, angle: np.mean(
                    (np.hypot(*(particles[:, :2] - state[:2]).T) < radius) & _tests(particles, state, radius, angle)[1]
                ),
                "A particle at exactly `radius` metres is left out. *At most* means <=.",
            ),
            Mistake(
                lambda particles, state, radius, angle: np.mean(
                    (np.abs(particles[:, :2] - state[:2]).sum(axis=1) <= radius)
                    & _tests(particles, state, radius, angle)[1]
                ),
                "You add the ways along x and y. The distance is the root of dx^2 + dy^2.",
            ),
        ),
    ),
    Exercise(
        number="05.4",
        solution=bayes_step,
        inputs=_corridor_with_doors,
        cases=(_nearly_at_the_end, _a_sure_sensor, _the_tasks_corridor, _five_moves, _more_moves_than_cells, _at_rest),
        mistakes=(
            Mistake(
                lambda bel, moves, doors, seen, hit, false_alarm: _to_one(
                    _look(_move(bel, moves, "ring"), doors, seen, hit, false_alarm)
                ),
                "In yours the corridor is a ring: what passes its end comes in at its start. Here it stops at the end.",
            ),
            Mistake(
                lambda bel, moves, doors, seen, hit, false_alarm: _to_one(
                    _look(_move(bel, moves, "is lost"), doors, seen, hit, false_alarm)
                ),
                "What would pass the last cell gets lost in yours, and dividing by the sum hides it. It stops there.",
            ),
            Mistake(
                lambda bel, moves, doors, seen, hit, false_alarm: _look(
                    _move(bel, moves), doors, seen, hit, false_alarm
                ),
                "Your belief does not sum to 1: what is eta for?",
            ),
            Mistake(
                lambda bel, moves, doors, seen, hit, false_alarm: _move(
                    _to_one(_look(bel, doors, seen, hit, false_alarm)), moves
                ),
                "You look first and move then. The picture was taken after the move.",
            ),
            Mistake(
                lambda bel, moves, doors, seen, hit, false_alarm: bayes_step(bel, moves, doors, True, hit, false_alarm),
                "You always take it that a door was seen. What is the probability of *not* seeing one?",
            ),
            Mistake(
                lambda bel, moves, doors, seen, hit, false_alarm: _to_one(
                    _move(bel, moves) * np.where(doors == seen, hit, false_alarm)
                ),
                "Not seeing a door where there is none has the probability 1 - false_alarm, not hit.",
            ),
            Mistake(
                lambda bel, moves, doors, seen, hit, false_alarm: _to_one(
                    _move(bel, moves) * np.where(doors == seen, hit, 1 - hit)
                ),
                "Your sensor errs as often at a door as elsewhere. There are two numbers: hit and false_alarm.",
            ),
            Mistake(
                lambda bel, moves, doors, seen, hit, false_alarm: bayes_step(bel, moves, doors, seen, false_alarm, hit),
                "hit and false_alarm have changed places: hit is the probability of seeing a door *at* a door.",
            ),
            Mistake(
                lambda bel, moves, doors, seen, hit, false_alarm: bayes_step(
                    bel[::-1], moves, doors[::-1], seen, hit, false_alarm
                )[::-1],
                "Your wagon rolls backwards: moves[k] is the probability of k cells *forward*.",
            ),
            Mistake(
                lambda bel, moves, doors, seen, hit, false_alarm: _move(bel, moves),
                "That is the prediction alone. The correction by what was seen is missing.",
            ),
            Mistake(
                lambda bel, moves, doors, seen, hit, false_alarm: _to_one(_look(bel, doors, seen, hit, false_alarm)),
                "That is the correction alone. The wagon has moved before.",
            ),
            Mistake(
                lambda bel, moves, doors, seen, hit, false_alarm: bayes_step(
                    bel, moves[:3], doors, seen, hit, false_alarm
                ),
                "You look at the first three moves alone. `moves` may have any length.",
            ),
            Mistake(
                lambda bel, moves, doors, seen, hit, false_alarm: bayes_step(
                    bel, moves[: len(bel)], doors, seen, hit, false_alarm
                ),
                "`moves` may be longer than the corridor: whoever rolls on by more cells than there are stops, too.",
            ),
            Mistake(
                _counted_once,
                "`a[index] += ...` counts an index that comes twice only once: use np.add.at, or loop over cells.",
            ),
            Mistake(
                lambda bel, moves, doors, seen, hit, false_alarm: _to_one(
                    _look(_move(bel, moves, "stays"), doors, seen, hit, false_alarm)
                ),
                "Whoever would pass the end stays where he was in yours. He rolls on and stops in the last cell.",
            ),
            Mistake(
                lambda bel, moves, doors, seen, hit, false_alarm: bayes_step(
                    bel, np.append(0.0, moves), doors, seen, hit, false_alarm
                ),
                "You roll one cell too far: moves[0] is the probability of staying.",
            ),
            Mistake(
                lambda bel, moves, doors, seen, hit, false_alarm: bayes_step(
                    bel, moves, doors, False, hit, false_alarm
                ),
                "You always take it that no door was seen. `seen` says whether one was.",
            ),
        ),
    ),
    Exercise(
        number="05.5",
        solution=min_sigma,
        inputs=_wagons,
        cases=(_the_courses_wagon, _one_frame),
        level="challenge",
        mistakes=(
            Mistake(
                lambda step, n, frames, p: min_sigma(step, n, 1, p),
                "That holds for one frame. It must go well in *every* one of them: multiply the probabilities.",
            ),
            Mistake(
                lambda step, n, frames, p: step / norm.ppf((1 - p) ** (1 / (n * frames))),
                "Yours reaches the step in at least one of all frames. It has to in every single one.",
            ),
            Mistake(
                lambda step, n, frames, p: step / norm.ppf((1 - (1 - (1 - p) / frames)) ** (1 / n)),
                "Nearly: adding up the frames' risks is a bound. The frames are independent: multiply.",
            ),
            Mistake(
                lambda step, n, frames, p: step / norm.ppf(p ** (1 / (frames * n))),
                "You ask that *all* particles stay below the step. One that reaches it is enough: 1 - Phi^n.",
            ),
            Mistake(
                lambda step, n, frames, p: step / norm.ppf((1 - p ** (1 / frames)) / n),
                "Phi^n is no product with n: undo a power by a root.",
            ),
            Mistake(
                lambda step, n, frames, p: step / norm.isf((1 - p ** (1 / frames)) ** (1 / n)),
                "The sign is turned: Phi is the probability of being *below* the step.",
            ),
            Mistake(
                lambda step, n, frames, p: step / norm.ppf((1 - p**frames) ** (1 / n)),
                "You raise p to the power of the frames. p is the probability for all of them: undo that power.",
            ),
            Mistake(
                lambda step, n, frames, p: step / norm.ppf(1 - p ** (1 / frames)),
                "That is a sigma for one particle, and negative. One minus q is Phi to the power of n.",
            ),
            Mistake(
                lambda step, n, frames, p: min_sigma(step, n, frames, 1 - p),
                "You took p for the probability of failing.",
            ),
            Mistake(
                lambda step, n, frames, p: step / norm.ppf((1 + (1 - p ** (1 / frames)) ** (1 / n)) / 2),
                "A step backwards of the same size does not help: only one side of the normal distribution counts.",
            ),
            Mistake(
                lambda step, n, frames, p: norm.ppf((1 - p ** (1 / frames)) ** (1 / n)),
                "That is how many sigmas the farthest step surely reaches. How large is sigma then?",
            ),
            Mistake(
                lambda step, n, frames, p: step * norm.ppf((1 - p ** (1 / frames)) ** (1 / n)),
                "Close: sigma times that number shall be the step, so divide.",
            ),
            Mistake(
                lambda step, n, frames, p: step / np.sqrt(2 * np.log(n)),
                "sqrt(2 ln n) is roughly where the farthest of n lies in the mean. Here p and the frames count, too.",
            ),
            Mistake(
                lambda step, n, frames, p: step / norm.ppf(p ** (1 / frames)),
                "Where is n? With more particles the farthest step is longer.",
            ),
            Mistake(
                lambda step, n, frames, p: step / norm.ppf(1 - p ** (1 / (frames * n))),
                "You ask that *every* particle makes the step. One of the n is enough.",
            ),
            Mistake(
                lambda step, n, frames, p: step / _mean_farthest(n),
                "That keeps up in the *mean*, as in *Measure*. With probability p for all frames it takes more: use p.",
            ),
        ),
    ),
]
