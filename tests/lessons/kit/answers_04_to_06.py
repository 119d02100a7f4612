"""Answers that students may give to lessons 04 to 06, for test_exercise_answers.py."""

import numpy as np
from scipy.integrate import trapezoid
from scipy.optimize import brentq
from scipy.stats import norm

from course_lib.geometry import pose_matrix, wrap_angle

LIGHT = 299_792_458.0  # m/s


def phasor(r, f):
    return np.exp(4j * np.pi * f * r / LIGHT)


def pairs(first, second):
    return zip(first, second, strict=True)


def abs_miss(candidates, reading, turn):
    return np.abs((candidates - reading + turn / 2) % turn - turn / 2)


def by_candidates(miss, least=0.0):
    """04.2: of all ranges that are read as `a`, the one with the least `miss(candidates, reading at b, turn at b)`."""

    def answer(a, f_a, b, f_b, farthest):
        turn_a, turn_b, best = LIGHT / (2 * f_a), LIGHT / (2 * f_b), []
        for one, other in zip(a, b, strict=True):
            candidates = np.arange(one, farthest, turn_a)
            best.append(candidates[miss(candidates, other, turn_b).argmin()] + (least if one < 0.6 else 0))
        return np.array(best)

    return answer


def first_within(limit):
    """04.2: the first range that is read as `a` and nearly as `b`."""

    def answer(a, f_a, b, f_b, farthest):
        turn_a, turn_b, found = LIGHT / (2 * f_a), LIGHT / (2 * f_b), []
        for one, other in zip(a, b, strict=True):
            candidates = np.arange(one, farthest, turn_a)
            found.append(candidates[np.argmax(abs_miss(candidates, other, turn_b) < limit)])
        return found

    return answer


def unlimited(a, f_a, b, f_b, farthest):
    candidates = a[:, None] + np.arange(int(farthest * 2 * f_a / LIGHT) + 1) * LIGHT / (2 * f_a)
    return candidates[np.arange(len(a)), abs_miss(candidates, b[:, None], LIGHT / (2 * f_b)).argmin(axis=1)]


def light_share(r, r1, p1, r2, p2, f):
    near, far = np.sin(4 * np.pi * f / LIGHT * np.array([r - r1, r2 - r]))
    return far / (near + far)


def step_by_step(look):
    """05.4: `look(bel, moves)` gives the moved belief; then the sensor."""

    def answer(bel, moves, doors, seen, hit, false_alarm):
        p = np.where(doors, hit, false_alarm)
        new = look(bel, moves) * (p if seen else 1 - p)
        return new / new.sum()

    return answer


def convolved(bel, moves):
    whole = np.convolve(bel, moves)
    return np.append(whole[: len(bel) - 1], whole[len(bel) - 1 :].sum())


def three_moves(bel, moves):
    return convolved(bel, np.append(moves, [0, 0])[:3])


def fancy_index(bel, moves):
    moved = np.zeros(len(bel))
    for k, p in enumerate(moves):
        moved[np.minimum(np.arange(len(bel)) + k, len(bel) - 1)] += p * bel
    return moved


def stopped_where_he_was(bel, moves):
    moved = np.zeros(len(bel))
    for cell, share in enumerate(bel):
        for k, p in enumerate(moves):
            moved[cell + k if cell + k < len(bel) else cell] += p * share
    return moved


def rolled(bel, moves):
    moved = np.zeros(len(bel))
    for k, p in enumerate(moves):
        turned = np.roll(bel, k)
        if k:
            turned[-1] += turned[:k].sum()
            turned[:k] = 0
        moved += p * turned
    return moved


def by_whole_pose(particles, forward, left, draws):
    steps = np.column_stack([forward * draws[:, 0], left * draws[:, 1], 0 * draws[:, 0]])
    moved = particles.copy()
    moved[:, :3] += [pose_matrix(p)[:3, :3] @ step for p, step in zip(particles, steps, strict=True)]
    return moved


def share_by_search(r, r1, p1, r2, p2, f):
    """04.3: the share by halving an interval, since the reading falls from r2 to r1 with it."""
    near, far, hand = p1 * phasor(r1, f) / r1**2, p2 * phasor(r2, f) / r2**2, phasor(r, f)
    low, high = np.zeros(len(r)), np.ones(len(r))
    for _ in range(60):
        share = (low + high) / 2
        too_far = ((share * near + (1 - share) * far) / hand).imag > 0
        low, high = np.where(too_far, share, low), np.where(too_far, high, share)
    return (low + high) / 2


def share_by_cross(r, r1, p1, r2, p2, f):
    across_near = (p1 / r1**2 * phasor(r1, f) / phasor(r, f)).imag
    across_far = (p2 / r2**2 * phasor(r2, f) / phasor(r, f)).imag
    return across_far / (across_far - across_near)


def least_of(n):
    """04.4: mean and deviation from P(least > x) = sf(x)^n alone, by parts."""
    x = np.linspace(-8, 8, 8001)
    above = norm.sf(x) ** n
    mean = x[0] + trapezoid(above, x)
    second = x[0] ** 2 + 2 * trapezoid(x * above, x)
    return mean, np.sqrt(second - mean**2)


def least_by_drawing(n):
    least = np.random.default_rng(1).standard_normal((100_000, n), dtype=np.float32).min(axis=1)
    return least.mean(), least.std()


def moved(particles, dx, dy):
    result = particles.copy()
    result[:, 0] += dx
    result[:, 1] += dy
    return result


def by_axes(step, column=5):
    """Particles moved by `step(forward, left, cosine, sine)`, which returns the steps in x and y."""

    def answer(particles, sigma_forward, sigma_left, draws):
        yaw = particles[:, column]
        return moved(particles, *step(sigma_forward * draws[:, 0], sigma_left * draws[:, 1], np.cos(yaw), np.sin(yaw)))

    return answer


def complex_steps(particles, sigma_forward, sigma_left, draws):
    step = (sigma_forward * draws[:, 0] + 1j * sigma_left * draws[:, 1]) * np.exp(1j * particles[:, 5])
    return moved(particles, step.real, step.imag)


def near(particles, state, radius):
    return np.hypot(particles[:, 0] - state[0], particles[:, 1] - state[1]) <= radius


def turn(particles, state):
    return particles[:, 5] - state[5]


def bayes_on_cells(ring=False, eta=True):
    def answer(bel, moves, doors, seen, hit, false_alarm):
        n, moved = len(bel), [0.0] * len(bel)
        for start, share in enumerate(bel):
            for k, p in enumerate(moves):
                moved[(start + k) % n if ring else min(start + k, n - 1)] += share * p
        chance = [hit if door else false_alarm for door in doors]
        after = np.array([m * (c if seen else 1 - c) for m, c in zip(moved, chance, strict=True)])
        return after / after.sum() if eta else after

    return answer


def bayes_by_matrix(bel, moves, doors, seen, hit, false_alarm):
    n = len(bel)
    transition = np.zeros((n, n))
    for k, p in enumerate(moves):
        np.add.at(transition, (np.minimum(np.arange(n) + k, n - 1), np.arange(n)), p)
    chance = np.where(doors, hit, false_alarm)
    after = (chance if seen else 1 - chance) * (transition @ bel)
    return after / np.sum(after)


def by_lines(left_out=False, guard=True, power=2, mean=False):
    """06.2: the given code with each of its faults left in or mended."""

    def answer(measured, images, alpha, beta):
        term = alpha / (alpha + np.abs(measured - images))
        if left_out:
            values = np.nanmean(np.where(np.isinf(images), np.nan, term), axis=(1, 2))
        else:
            values = (np.nanmean if mean and np.isfinite(measured).any() else np.nansum)(term, axis=(1, 2))
        if guard and not np.ptp(values) > 0:
            return np.ones(len(images)) / len(images)
        normalized = (values - values.min()) / (np.ptp(values) + 1e-12)
        return to_sum_one(np.exp(-((normalized - 1) ** 2) / beta**power))

    return answer


def weighed(x, w):
    """06.4: weighted mean and its standard error."""
    mean = np.average(x, weights=w)
    return mean, np.sqrt(np.sum(w**2 * (x - mean) ** 2)) / np.sum(w)


def spread_out(likelihoods):
    spread = np.ptp(likelihoods)
    return (likelihoods - likelihoods.min()) / spread if spread else np.ones(len(likelihoods))


def w_of(likelihoods, beta):
    return np.exp(-((spread_out(likelihoods) - 1) ** 2) / beta**2)


def to_sum_one(w):
    return w / w.sum()


# Exercise, answer, words of the hint that must come.
WRONG = [
    ("04.1", lambda r, rays: r / np.linalg.norm(rays[..., :2], axis=-1), "no forward component"),
    ("04.1", lambda r, rays: np.sqrt(r**2 - rays[..., 0] ** 2 - rays[..., 1] ** 2), "per metre of depth"),
    ("04.1", lambda r, rays: r * np.cos(np.arctan(rays[..., 0])) * np.cos(np.arctan(rays[..., 1])), "two tilts"),
    ("04.1", lambda r, rays: np.where(np.isnan(r), np.inf, r / np.linalg.norm(rays, axis=-1)), "stays NaN; inf would"),
    ("04.2", by_candidates(lambda c, b, turn: abs(c % turn - b)), "on the circle"),
    ("04.2", by_candidates(lambda c, b, turn: abs(c - b)), "What would the camera *read*"),
    ("04.2", by_candidates(lambda c, b, turn: (c - b + turn / 2) % turn - turn / 2), "has a sign"),
    ("04.2", by_candidates(lambda c, b, turn: abs_miss(c, b, turn)[:2]), "no or one turn"),
    ("04.2", lambda a, f_a, b, f_b, far: by_candidates(abs_miss)(b, f_b, a, f_a, far), "starts from read_a"),
    ("04.2", lambda a, f_a, b, f_b, far: a, "That is the reading"),
    ("04.2", lambda a, f_a, b, f_b, far: by_candidates(abs_miss, 1e3)(a, f_a, b, f_b, far), "Right on"),
    ("04.3", lambda r, r1, p1, r2, p2, f: (r2 - r) / (r2 - r1), "You mix ranges"),
    ("04.3", lambda r, r1, p1, r2, p2, f: share_by_cross(r, r1, p1, r2, p2, 15e6), "15 MHz"),
    ("04.3", lambda r, r1, p1, r2, p2, f: share_by_search(r, r1, p1 * r1**2, r2, p2 * r2**2, f), "as bright as a near"),
    ("04.3", lambda r, r1, p1, r2, p2, f: 1 - share_by_search(r, r1, p1, r2, p2, f), "on the farther surface"),
    ("04.3", lambda r, r1, p1, r2, p2, f: r1**2 / (r1**2 + r2**2), "Right on"),
    ("04.3", lambda r, r1, p1, r2, p2, f: p2 * r1**2 / (p1 * r2**2 + p2 * r1**2), "equally long"),
    ("04.3", lambda r, r1, p1, r2, p2, f: share_by_cross(r, r1, p1, r2, p2, LIGHT / 4 / np.pi), "sine of metres"),
    ("04.4", lambda n: (-np.sqrt(2 * np.log(n)), least_of(n)[1]), "very large n"),
    ("04.4", lambda n: (least_of(n)[0], least_of(n)[1] ** 2), "is the variance"),
    ("04.4", lambda n: (least_of(n)[0], n**-0.5), "scatter of a mean"),
    ("04.4", lambda n: -np.array(least_of(n)), "differ"),
    ("04.4", lambda n: (-least_of(n)[0], least_of(n)[1]), "keeps the nearest"),
    ("05.1", lambda start, sigma, t: np.sqrt(start + t * sigma**2), "not the spread at the start"),
    ("05.1", lambda start, sigma, t: np.sqrt(start**2 + t * sigma), "but not sigma"),
    ("05.1", lambda start, sigma, t: np.sqrt(sigma**2 + t * start**2), "swapped the two"),
    ("05.2", by_axes(lambda ahead, left, c, s: (ahead * s + left * c, ahead * c - left * s)), "have changed places"),
    ("05.2", by_axes(lambda ahead, left, c, s: (ahead * c, ahead * s + left)), "but not left"),
    ("05.2", by_axes(lambda ahead, left, c, s: (ahead * c, left * s)), "a part in x *and* a part in y"),
    ("05.2", by_axes(lambda ahead, left, c, s: (ahead * c - left * s, ahead * s + left * c), column=4), "by the pitch"),
    ("05.2", by_axes(lambda ahead, left, c, s: (ahead * c - left * s, ahead * s + left * c), column=3), "by the roll"),
    ("05.2", lambda p, forward, left, draws: complex_steps(p, 1, 1, draws), "about a metre long"),
    ("05.3", lambda p, s, r, a: near(p, s, r).mean() * (np.abs(wrap_angle(turn(p, s))) <= a).mean(), "two shares"),
    ("05.3", lambda p, s, r, a: np.mean(near(p, s, r) & (wrap_angle(abs(turn(p, s))) <= a)), "Wrap first"),
    ("05.3", lambda p, s, r, a: np.mean(near(p, s, r) & (turn(p, s) % (2 * np.pi) <= a)), "to the right"),
    ("05.3", lambda p, s, r, a: np.mean(near(p, s, r - 1e-9) & (abs(wrap_angle(turn(p, s))) <= a)), "exactly `radius`"),
    ("05.3", lambda p, s, r, a: np.mean(near(p, s, r) & (abs(np.sin(turn(p, s))) <= np.sin(a))), "not yet"),
    ("05.3", lambda p, s, r, a: np.mean(near(p, s, r) & (abs(wrap_angle(turn(p, s))) < a)), "With an angle of 0"),
    (
        "05.3",
        lambda p, s, r, a: np.mean(near(p, s, r) & (abs(wrap_angle(p - s))[:, 3:] <= a).all(1)),
        "roll and pitch as",
    ),
    ("05.3", lambda p, s, r, a: np.mean(near(p, s, r) & (abs(wrap_angle(p - s))[:, 3] <= a)), "compare the roll"),
    ("05.4", bayes_on_cells(ring=True), "is a ring"),
    ("05.4", bayes_on_cells(eta=False), "what is eta for"),
    ("05.4", lambda b, m, d, seen, hit, false: bayes_on_cells()(b, m, d, True, hit, false), "always take it"),
    ("05.4", lambda b, m, d, seen, hit, false: bayes_on_cells()(b, m, d, seen, false, hit), "changed places"),
    ("05.4", lambda b, m, d, seen, hit, false: bayes_on_cells()(b, [1], d, seen, hit, false), "correction alone"),
    ("05.4", lambda b, m, d, seen, hit, false: bayes_on_cells()(b, m, d, True, 1, 1), "prediction alone"),
    ("05.5", lambda s, n, frames, p: s / norm.ppf((1 - p) ** (1 / n)), "holds for one frame"),
    ("05.5", lambda s, n, frames, p: s / norm.ppf((1 - p**frames) ** (1 / n)), "undo that power"),
    ("05.5", lambda s, n, frames, p: s / norm.ppf(1 - p ** (1 / frames)), "for one particle"),
    ("05.5", lambda s, n, frames, p: s / norm.ppf(((1 - p) / frames) ** (1 / n)), "is a bound"),
    ("05.5", lambda s, n, frames, p: s / norm.ppf(1 - (1 - (1 - p ** (1 / frames))) / n), "differ"),
    ("05.5", lambda s, n, frames, p: s / norm.ppf(p ** (1 / frames / n)), "stay below the step"),
    ("06.1", lambda t, a: a * (1 - t), "at one half it gives two thirds"),
    ("06.1", lambda t, a: a / t, "alpha + d"),
    ("06.1", lambda t, a: a * t / (1 - t + 1e-300), "differ"),
    ("06.1", lambda t, a: a / (a + t), "solve for the difference"),
    ("06.2", by_lines(left_out=True, guard=True, power=2), "One fault is left, in the first two lines"),
    ("06.2", by_lines(left_out=False, guard=False, power=2), "what does (9) give where all agree"),
    ("06.2", by_lines(left_out=False, guard=True, power=4), "compare the exponent"),
    ("06.2", by_lines(left_out=True, guard=False, power=4), "All three faults"),
    ("06.2", lambda m, s, a, beta: by_lines()(np.nan_to_num(m), np.nan_to_num(s, posinf=0), a, beta), "not yet"),
    ("06.2", lambda m, s, a, beta: by_lines()(m, np.minimum(s, 11), a, beta), "wall at 11 m"),
    ("06.2", lambda m, s, a, beta: np.nan_to_num(by_lines(guard=False)(m, s, a, beta)), "You hide a 0/0"),
    ("06.2", lambda m, s, a, beta: len(s) * by_lines()(m, s, a, beta), "differ"),
    ("06.3", lambda v, beta: v[np.argmin(np.abs(w_of(v, beta) - 0.5))], "near one half"),
    ("06.3", lambda v, beta: (v.min() + v.max()) / 2, "normalized likelihood"),
    ("06.3", lambda v, beta: v.max() - 0.8326 * beta * np.ptp(v), "rounded"),
    ("06.3", lambda v, beta: np.interp(1 - beta * np.log(2) ** 0.5, [0, 1], [v.min(), v.max()]), "stop at the worst"),
    ("06.4", lambda x, p, q: weighed(x, p / q)[:1] * 2, "differ"),
    ("06.4", lambda x, p, q: (weighed(x, p / q)[0], weighed(x, p / q)[1] / len(x) ** 0.5), "sum to 1 already"),
    ("06.4", lambda x, p, q: (np.average(x, weights=p / q), x.std() / len(x) ** 0.5), "unweighed samples"),
    (
        "06.4",
        lambda x, p, q: (weighed(x, p / q)[0], np.std(p / q * x) / len(x) ** 0.5 / np.mean(p / q)),
        "scatters too",
    ),
    ("06.4", lambda x, p, q: weighed(x, q / p), "upside down"),
    ("06.4", lambda x, p, q: weighed(x, p), "target alone"),
    ("04.1", lambda r, rays: r / np.hypot(rays[..., 1], 1), "up and down only"),
    ("04.1", lambda r, rays: r / rays.sum(axis=-1), "add the components"),
    ("04.2", first_within(0.3), "fits roughly"),
    ("04.2", first_within(0.1), "fits roughly"),
    ("04.2", unlimited, "beyond `farthest`"),
    ("04.2", lambda a, f_a, b, f_b, farthest: (a + b) / 2, "First find how many"),
    ("04.3", light_share, "share of the *light*"),
    ("05.1", lambda s0, s, t: np.sqrt(s0**2 + (t + 1) * s**2), "one frame too many"),
    ("05.1", lambda s0, s, t: np.maximum(s0, np.sqrt(t) * s), "greater of the two"),
    ("05.2", by_whole_pose, "leave the floor"),
    ("05.4", step_by_step(three_moves), "first three moves"),
    ("05.4", step_by_step(rolled), "longer than the corridor"),
    ("05.4", step_by_step(fancy_index), "np.add.at"),
    ("05.4", step_by_step(stopped_where_he_was), "stays where he was"),
    ("05.4", step_by_step(lambda bel, moves: convolved(bel, np.append(0, moves))), "one cell too far"),
    ("05.5", lambda step, n, frames, p: step / norm.ppf(1 - p ** (1 / frames / n)), "One of the n is enough"),
    ("05.5", lambda step, n, frames, p: -step / least_of(n)[0], "in the *mean*"),
]
# Exercise, answer by another way than the solution.
RIGHT = [
    ("04.1", lambda r, rays: r * np.cos(np.arctan(np.hypot(rays[..., 0], rays[..., 1])))),
    ("04.1", lambda r, rays: r / (rays**2).sum(-1) ** 0.5),
    (
        "04.1",
        lambda r, rays: [[a / np.linalg.norm(ray) for a, ray in zip(*row, strict=True)] for row in pairs(r, rays)],
    ),
    ("04.2", by_candidates(lambda c, b, turn: 1 - np.cos(2 * np.pi * (c - b) / turn))),
    ("04.2", by_candidates(lambda c, b, turn: np.minimum((c - b) % turn, (b - c) % turn))),
    ("04.3", share_by_search),
    ("04.3", share_by_cross),
    ("04.4", least_of),
    ("04.4", lambda n: list(least_by_drawing(n))),
    ("05.1", lambda start, sigma, t: np.hypot(start, np.sqrt(t) * sigma)),
    ("05.1", lambda start, sigma, t: [(a * a + t * b * b) ** 0.5 for a, b in zip(start, sigma, strict=True)]),
    ("05.2", complex_steps),
    ("05.2", by_axes(lambda ahead, left, c, s: (ahead * c - left * s, ahead * s + left * c))),
    ("05.3", lambda p, s, r, a: np.count_nonzero(near(p, s, r) & (np.cos(turn(p, s)) >= np.cos(a))) / len(p)),
    ("05.3", lambda p, s, r, a: [np.mean([near(q[None], s, r)[0] and abs(wrap_angle(q[5] - s[5])) <= a for q in p])]),
    ("05.4", lambda *given: bayes_on_cells()(*given)),
    ("05.4", bayes_by_matrix),
    ("05.5", lambda s, n, frames, p: s / norm.isf(1 - (1 - p ** (1 / frames)) ** (1 / n))),
    ("05.5", lambda s, n, frames, p: brentq(lambda sigma: (1 - norm.cdf(s / sigma) ** n) ** frames - p, s / 9, 9 * s)),
    ("06.1", lambda t, a: a / t - a),
    ("06.1", lambda t, a: [float(a * (1 / x - 1)) for x in t]),
    ("06.2", by_lines()),
    ("06.2", lambda m, s, a, beta: by_lines(mean=True)(m, s, a, beta)),
    ("06.2", lambda m, s, a, beta: by_lines()(np.where(np.isnan(m), 1.0, m), np.where(np.isnan(m), 1.0, s), a, beta)),
    ("06.3", lambda v, beta: v.min() + (1 - beta * np.log(2) ** 0.5) * np.ptp(v)),
    ("06.3", lambda v, beta: [v.max() - np.ptp(v) * np.sqrt(-(beta**2) * np.log(0.5))]),
    ("06.4", lambda x, p, q: weighed(x, p / q)),
    ("06.4", lambda x, p, q: list(np.multiply(weighed(x, p / q), [1, (len(x) / (len(x) - 1)) ** 0.5]))),
    ("05.4", step_by_step(convolved)),
    ("05.4", lambda *given: step_by_step(convolved)(*given).tolist()),
]
