"""Exercises of lesson 10: draws from free cells, injected particles, sampling until it is enough, distinct places."""

import functools

import numpy as np

from course_lib.geometry import wrap_angle
from courseware.lessons.kit.exercises import Exercise
from courseware.lessons.lesson_10 import adaptive_count

kld_count = functools.cache(adaptive_count.kld_count)  # a check asks for thousands


def free_places(free, cell, u):
    """Places (n, 2) in metres, evenly from the free cells of a grid (rows, columns); u (n, 3) in [0, 1)."""
    rows, columns = np.nonzero(free)
    chosen = (u[:, 0] * len(rows)).astype(int)
    return cell * np.column_stack([columns[chosen] + u[:, 1], rows[chosen] + u[:, 2]])


def grids(rng):
    """Oblong grids, a fifth to two thirds free; one in four has a single free cell."""
    free = rng.random((rng.integers(3, 6), rng.integers(7, 11))) < rng.uniform(0.3, 0.7) * (rng.random() > 0.25)
    free[-1, 0] = True
    return free, float(rng.choice([0.1, 0.25, 0.5])), rng.random((rng.integers(5, 12), 3))


def new_shares(scores, short, long):
    """Share (T,) of particles to draw from anywhere, for every frame; NaN scores change nothing."""
    s = L = scores[0]
    shares = []
    for score in scores:
        if not np.isnan(score):
            s, L = s + short * (score - s), L + long * (score - L)
        shares.append(max(0, 1 - s / L))
    return np.array(shares)


def falling_scores(rng):
    """A level score, a fall, and a rise, with frames in the dark before the fall and in it."""
    level, low = rng.uniform(0.7, 0.95), rng.uniform(0.1, 0.5)
    scores = np.repeat([level, low, level], [rng.integers(5, 9), 8, 10])
    scores += rng.uniform(-0.03, 0.03, len(scores))
    scores[[3, 9, 10, -2]] = np.nan
    return scores, float(rng.uniform(0.3, 0.6)), float(rng.uniform(0.02, 0.1))


def draws_needed(bins, least):
    """How many draws KLD-sampling makes; bins (T,): where each draw would land."""
    seen = set()
    for n, one in enumerate(bins, start=1):
        seen.add(int(one))
        if n >= kld_count(len(seen), least, 10**6):
            return n
    return len(bins)


def landings(rng):
    """Bins of 400 draws from few or many places, the last draws from elsewhere; bin numbers are no indices."""
    numbers, k = rng.choice(10_000, 50, replace=False) - 500, int(rng.choice([1, 3, 8, 40]))
    early = rng.choice(numbers[:k], 350, p=rng.dirichlet(np.full(k, 0.7)))
    return np.append(early, rng.choice(numbers[40:], 50)), int(rng.choice([20, 150]))


def distinct_places(states, scores, metres, radians):
    """Indices of the best state of every place, best first; states (n, 3) are [x, y, yaw]."""
    kept = []
    for i in np.argsort(-scores):
        apart = np.hypot(*(states[kept, :2] - states[i, :2]).T) if kept else np.array([])
        turned = np.abs(wrap_angle(states[kept, 2] - states[i, 2])) if kept else np.array([])
        if not ((apart < metres) & (turned < radians)).any():
            kept.append(int(i))
    return np.array(kept)


def clouds_of_states(rng):
    """Clouds about places of which two share a position, two share a heading, and one looks along the seam."""
    offsets = np.array([[0, 0, 0.3], [0, 0, 2.0], [4, 0, 0.3], [0, 5, np.pi], [9, 9, -1.0]])
    places = np.repeat(offsets + np.append(rng.uniform(0, 10, 2), 0), int(rng.integers(5, 9)), axis=0)
    states = places + rng.uniform(-1, 1, places.shape) * [0.5, 0.5, 0.25]
    states[:, 2] = wrap_angle(states[:, 2])
    return rng.permutation(states), rng.permutation(np.linspace(0.2, 0.95, len(states))), 0.6, 0.35


def search_numbers(bins, miss, probability):
    """Least number of even draws, and the KLD error [nats], for a building of so many equally likely bins."""
    from scipy.stats import norm

    # The camera's bin gets none of n draws with probability (1 - 1 / bins)^n; (10.3) is solved for the error.
    least = int(np.ceil(np.log(miss) / np.log(1 - 1 / bins)))
    share = 2 / (9 * (bins - 1))
    bracket = 1 - share + np.sqrt(share) * norm.ppf(probability)
    return least, (bins - 1) / (2 * least) * bracket**3


# fmt: off
EXERCISES = [
    Exercise("10.1", free_places, grids, "warm-up", cases={
        # The numbers are at the very start of four free cells: cutting off differs from rounding up.
        "numbers on the borders": lambda rng: (np.array([[False, True, True], [True, False, True]]), 0.5,
                                               np.column_stack([[0.0, 0.25, 0.5, 0.75], rng.random((4, 2))])),
    }, mistakes="""
        ... => return cell * u[:, 1:] * free.shape[::-1]
        Your places fill the whole box, walls included. Choose among the free cells first, by u[:, 0].
        ... => return np.zeros((len(u), 2)) if free.all() else free_places(~free, cell, u)
        Your places lie where it is *not* free.
        columns[chosen] + u[:, 1], rows[chosen] + u[:, 2] => rows[chosen] + u[:, 1], columns[chosen] + u[:, 2]
        x runs along the columns and y along the rows. You have them the other way round.
        columns[chosen] + u[:, 1], rows[chosen] + u[:, 2] => columns[chosen], rows[chosen]
        All your places are corners of cells. u[:, 1] and u[:, 2] say where in the cell.
        columns[chosen] + u[:, 1], rows[chosen] + u[:, 2] => columns[chosen] + u[:, 2], rows[chosen] + u[:, 1]
        The cells are right, but u[:, 1] is for x and u[:, 2] is for y.
        return cell * => return
        You count in cells. Multiply by the side of a cell to get metres.
        (u[:, 0] * len(rows)).astype(int) => np.round(u[:, 0] * (len(rows) - 1)).astype(int)
        If you round, the first and the last free cell get half their share. Cut the decimals off instead.
        rows, columns = np.nonzero(free) => columns, rows = np.nonzero(free.T)
        You count the free cells column by column. The task counts them row by row, as np.nonzero does.
        (u[:, 0] * len(rows)).astype(int) => (u[:, 0] * (len(rows) - 1)).astype(int)
        You never choose the last free cell. The numbers in u stay below 1, so there is no need to take one cell away.
    """),
    Exercise("10.2", new_shares, falling_scores, cases={
        "the example of the task": lambda rng: (np.array([0.8, 0.8, np.nan, 0.4]), 0.5, 0.1),
    }, mistakes="""
        max(0, 1 - s / L) => 1 - s / L
        If the short mean is the greater one, all is well. Then the share is 0, and it is never negative.
        return np.array(shares) => return np.where(np.isnan(scores), np.nan, shares)
        return np.array(shares) => return np.where(np.isnan(scores), 0.0, shares)
        In a dark frame the means stay as they are, and so does the share. It is neither NaN nor 0.
        ... => return new_shares(scores, long, short)
        You have them upside down. The short mean, which follows quickly, goes above the fraction line.
        max(0, 1 - s / L) => min(1, s / L)
        Your share is how much of the score is left. New particles replace the part that is missing from 1.
        1 - s / L => L - s
        You take the difference of the means. Their ratio counts.
        s = L = scores[0] => s = L = 0.0
        Your means begin at 0, and the long one needs a hundred frames to forget it. Begin with the first score.
        if not np.isnan(score): => if True:
        One NaN score makes every later mean NaN. In the dark the means stay as they are.
        ... => return new_shares(np.nan_to_num(scores), short, long)
        You take a dark frame for the score 0. The camera saw nothing, so the means stay as they are.
        ... => return np.append(0.0, new_shares(scores, short, long)[:-1])
        You are a frame late. First take the frame's score into the means, then form the share.
        ... => return new_shares(scores, 1 - short, 1 - long)
        You multiply the old mean by the share. The share belongs to the new frame.
    """),
    Exercise("10.3", draws_needed, landings, cases={
        "two bins only": lambda rng: (np.array([7, 7, 7, *[2, 7] * 48, 2]), 20),
        "a new bin at the bound": lambda rng: (np.array([5] * 19 + [9, 5] * 40), 20),
        "fewer draws than the least": lambda rng: (np.array([3, 3, 8, 3, 1]), 20),
        # More draws than the lesson's upper bound, and still they are not enough.
        "ever new bins": lambda rng: (np.arange(3_200) % 400, 20),
    }, mistakes="""
        len(seen), least => max(1, len(set(bins[: n - 1]))), least
        You compare too early. First count the bin of the present draw, then compare.
        return len(bins) => return -1
        If the draws run out before the bound is reached, the answer is their number T.
        return n => return len(seen) and also return len(bins) => return len(seen)
        You give the number of bins. The task asks for the number of draws.
        ... => return kld_count(len(np.unique(bins)), least, 10**6)
        You look at all bins before you draw. Only the bins that were hit so far count.
        kld_count(len(seen) => kld_count(n
        You never stop. Do you count draws instead of bins? Two draws in one bin occupy one bin.
        kld_count(len(seen), least => kld_count(len(seen), 1
        You do not use `least`, the smallest number of draws that can be enough.
        kld_count(len(seen), least, 10**6) => least
        You always stop at `least`. The bound grows with the bins that are hit.
        len(seen) => len(seen) - 1
        len(seen) => max(seen) - min(seen) + 1
        Every bin counts once, also the first one, and the bin numbers have gaps.
    """),
    Exercise("10.4", distinct_places, clouds_of_states, cases={
        "headings at the seam": lambda rng: (np.array([[0, 0, 3.1], [0.1, 0, -3.1], [0, 0, 0], [5, 0, 3.1]]),
                                             np.array([0.7, 0.9, 0.5, 0.6]), 0.5, 0.3),
        "exactly at the limit": lambda rng: (np.array([[1.0, 2.0, 0.4], [1.5, 2.0, 0.4], [1.5, 2.25, 0.4]]),
                                             np.array([0.9, 0.5, 0.4]), 0.5, 0.3),
        "ahead and back": lambda rng: (np.column_stack([np.zeros((4, 2)), [0.1, -0.1, 3.1, -3.1]]),
                                       rng.permutation([0.9, 0.8, 0.6, 0.5]), 0.5, 0.3),
        "one state alone": lambda rng: (np.array([[1.0, 2.0, 3.0]]), np.array([0.7]), 0.5, 0.3),
    }, mistakes="""
        states[kept, => states[kept[:1],
        states[kept, => states[kept[-1:],
        You compare with one state alone, the best or the last. Compare with every place that is kept.
        states[kept, => states[scores > scores[i],
        You compare with *all* better states. A state that was dropped itself does not count.
        return np.array(kept) => return scores[kept]
        return np.array(kept) => return np.isin(np.arange(len(scores)), kept)
        Return indices into the states as they were given, not scores, states or a mask.
        wrap_angle(states[kept, 2] - states[i, 2]) => states[kept, 2] - states[i, 2]
        3.1 and -3.1 rad are 0.08 rad apart and not 6.2. Wrap the difference of the headings.
        (apart < metres) & (turned < radians) => (apart < metres) | (turned < radians)
        States at one place are near *and* look the same way. You ask for only one of the two.
        (apart < metres) & (turned < radians) => apart < metres
        You forget the heading. Two directions at one spot are two places.
        (apart < metres) & (turned < radians) => turned < radians
        You forget the position. Two rooms with the same heading are two places.
        np.argsort(-scores) => range(len(scores))
        np.argsort(-scores) => np.argsort(scores)
        The best of all comes first, then the next best. Sort by falling score.
        return np.array(kept) => return np.sort(kept)
        These are the right places, but you sort them by index. The best comes first.
    """),
    Exercise("10.5", search_numbers, lambda rng: (
        int(10 ** rng.uniform(0.7, 4)), float(10 ** rng.uniform(-3, -0.7)), float(rng.uniform(0.9, 0.999)),
    ), "challenge", cases={
        "two bins with a whole number": lambda rng: (2, 0.25, 0.99),
    }, mistakes="""
        np.log(miss) / np.log(1 - 1 / bins) => -np.log(miss) * bins
        exp(-n / bins) is (1 - 1 / bins)^n for many bins only. Take the logarithm of the power itself.
        np.ceil => np.floor
        This is one draw too few. With it the bin is missed more often than `miss`. Round up.
        1 - 1 / bins => 1 / bins
        1 / bins is the probability that a draw hits the camera's bin. Which one must happen n times in a row?
        np.log(miss) => np.log(miss / bins)
        You ask that no bin at all is missed. Only the camera's own bin must get a draw.
        np.log(miss) => np.log(1 - miss)
        `miss` is the probability that the bin gets no draw, not that it gets one.
        (2 * least) => least
        Solve (10.3) for the error once more. It stands below the fraction line together with a 2.
        norm.ppf(probability) => norm.ppf(1 - probability)
        norm.ppf(probability) => norm.ppf((1 + probability) / 2)
        z belongs to `probability` itself, on one side of the bell. Take norm.ppf(probability).
        (bins - 1) / => bins /
        All bins are occupied, so k = bins, and (10.3) has k - 1 above the fraction line.
        return least, (bins - 1) / (2 * least) * bracket**3 => return least, 0.05
        Do not take the lesson's error. Take the one with which (10.3) asks for just `least` particles.
    """),
]
