"""Exercises of lesson 10: draws from free cells, injected particles, sampling until it is enough, distinct places."""

import functools

import numpy as np

from course_lib.beyond.lost_and_found import adaptive_count
from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.exercises import Exercise

kld_count = functools.cache(adaptive_count.kld_count)  # a check asks for thousands

# 10.1: evenly from the free cells


def free_places(free, cell, u):
    """Places (n, 2) in metres, evenly from the free cells of a grid (rows, columns); u (n, 3) in [0, 1)."""
    rows, columns = np.nonzero(free)
    chosen = (u[:, 0] * len(rows)).astype(int)
    return cell * np.column_stack([columns[chosen] + u[:, 1], rows[chosen] + u[:, 2]])


def grids(rng: np.random.Generator) -> tuple:
    """Oblong grids, a fifth to two thirds free; one in four has a single free cell."""
    free = rng.random((int(rng.integers(3, 6)), int(rng.integers(7, 11)))) < rng.uniform(0.3, 0.7)
    if rng.random() < 0.25:
        free[:] = False
    free[-1, 0] = True
    return free, float(rng.choice([0.1, 0.25, 0.5])), rng.random((int(rng.integers(5, 12)), 3))


def numbers_on_the_borders(rng: np.random.Generator) -> tuple:
    """Numbers at the very start of each of four free cells: cutting off differs from rounding up here."""
    free = np.array([[False, True, True], [True, False, True]])
    return free, 0.5, np.column_stack([[0.0, 0.25, 0.5, 0.75], rng.random((4, 2))])


def row_first(free, cell, u):
    open_rows, found = np.flatnonzero(free.any(axis=1)), []
    for a, b, c in u:
        row, share = open_rows[int(a * len(open_rows))], a * len(open_rows) % 1
        columns = np.flatnonzero(free[row])
        found.append((columns[int(share * len(columns))] + b, row + c))
    return cell * np.array(found)


# 10.2: how many new particles


def new_shares(scores, short, long):
    """Share (T,) of particles to draw from anywhere, for every frame; NaN scores change nothing."""
    s = L = scores[0]
    shares = []
    for score in scores:
        if not np.isnan(score):
            s, L = s + short * (score - s), L + long * (score - L)
        shares.append(max(0, 1 - s / L))
    return np.array(shares)


def falling_scores(rng: np.random.Generator) -> tuple:
    """A level score, a fall, frames in the dark before and in the fall, and a rise."""
    level, low = rng.uniform(0.7, 0.95), rng.uniform(0.1, 0.5)
    scores = np.concatenate([np.full(rng.integers(5, 9), level), np.full(8, low), np.full(10, level)])
    scores += rng.uniform(-0.03, 0.03, len(scores))
    scores[[3, 9, 10, -2]] = np.nan
    return scores, float(rng.uniform(0.3, 0.6)), float(rng.uniform(0.02, 0.1))


def the_example_of_the_task(rng: np.random.Generator) -> tuple:
    return np.array([0.8, 0.8, np.nan, 0.4]), 0.5, 0.1


def seen_before(scores):
    seen = np.flatnonzero(~np.isnan(scores))
    return scores[seen[np.searchsorted(seen, np.arange(len(scores)), side="right") - 1]]


def filled_from_later(scores):
    seen = np.flatnonzero(~np.isnan(scores))
    return np.interp(np.arange(len(scores)), seen, scores[seen])


# 10.3: until it is enough


def draws_needed(bins, least):
    """How many draws KLD-sampling makes; bins (T,): where each draw would land."""
    seen = set()
    for n, one in enumerate(bins, start=1):
        seen.add(int(one))
        if n >= kld_count(len(seen), least, 10**6):
            return n
    return len(bins)


def all_bins_at_once(bins, least):
    return kld_count(len(np.unique(bins)), least, 10**6)


def landings(rng: np.random.Generator) -> tuple:
    """Bins of 400 draws from few or many places, the last draws from elsewhere; bin numbers are no indices."""
    numbers = rng.choice(10_000, 50, replace=False) - 500
    k = int(rng.choice([1, 3, 8, 40]))
    early = rng.choice(numbers[:k], 350, p=rng.dirichlet(np.full(k, 0.7)))
    return np.append(early, rng.choice(numbers[40:], 50)), int(rng.choice([20, 150]))


def two_bins_only(rng: np.random.Generator) -> tuple:
    return np.array([7, 7, 7, *[2, 7] * 48, 2]), 20


def a_new_bin_at_the_bound(rng: np.random.Generator) -> tuple:
    return np.array([5] * 19 + [9, 5] * 40), 20


def fewer_draws_than_the_least(rng: np.random.Generator) -> tuple:
    return np.array([3, 3, 8, 3, 1]), 20


def ever_new_bins(rng: np.random.Generator) -> tuple:
    """More draws than the lesson's upper bound, from so many bins that they are not enough."""
    return np.arange(3_200) % 400, 20


# 10.4: distinct places


def distinct_places(states, scores, metres, radians):
    """Indices of the best state of every place, best first; states (n, 3) are [x, y, yaw]."""
    kept = []
    for i in np.argsort(-scores):
        apart = np.hypot(*(states[kept, :2] - states[i, :2]).T) if kept else np.array([])
        turned = np.abs(wrap_angle(states[kept, 2] - states[i, 2])) if kept else np.array([])
        if not ((apart < metres) & (turned < radians)).any():
            kept.append(int(i))
    return np.array(kept)


def near(a, b, metres, radians):
    return np.hypot(*(a[:2] - b[:2])) < metres and abs(wrap_angle(a[2] - b[2])) < radians


def compared_with_the_last(states, scores, metres, radians):
    kept = []
    for i in np.argsort(-scores):
        if not kept or not near(states[i], states[kept[-1]], metres, radians):
            kept.append(int(i))
    return np.array(kept)


def compared_with_the_best(states, scores, metres, radians):
    best, order = np.argmax(scores), np.argsort(-scores)
    return np.array([i for i in order if i == best or not near(states[i], states[best], metres, radians)])


def compared_with_all_better(states, scores, metres, radians):
    order = np.argsort(-scores)
    better = [(i, order[:k]) for k, i in enumerate(order)]
    return np.array([i for i, js in better if not any(near(states[i], states[j], metres, radians) for j in js)])


def clouds_of_states(rng: np.random.Generator) -> tuple:
    """Clouds about places of which two share a position, two share a heading, and one looks along the seam."""
    offsets = np.array([[0, 0, 0.3], [0, 0, 2.0], [4, 0, 0.3], [0, 5, np.pi], [9, 9, -1.0]])
    places = offsets + np.append(rng.uniform(0, 10, 2), 0)
    states = np.repeat(places, -(-int(rng.integers(25, 36)) // len(places)), axis=0)
    states = states + rng.uniform(-1, 1, states.shape) * [0.5, 0.5, 0.25]
    states[:, 2] = wrap_angle(states[:, 2])
    return rng.permutation(states), rng.permutation(np.linspace(0.2, 0.95, len(states))), 0.6, 0.35


def headings_at_the_seam(rng: np.random.Generator) -> tuple:
    states = np.array([[0, 0, 3.1], [0.1, 0, -3.1], [0, 0, 0], [5, 0, 3.1]])
    return states, np.array([0.7, 0.9, 0.5, 0.6]), 0.5, 0.3


def exactly_at_the_limit(rng: np.random.Generator) -> tuple:
    return np.array([[1.0, 2.0, 0.4], [1.5, 2.0, 0.4], [1.5, 2.25, 0.4]]), np.array([0.9, 0.5, 0.4]), 0.5, 0.3


def ahead_and_back(rng: np.random.Generator) -> tuple:
    """One spot: two that look ahead, on either side of 0, and two that look back, on either side of pi."""
    headings = np.array([0.1, -0.1, 3.1, -3.1])
    return np.column_stack([np.zeros((4, 2)), headings]), rng.permutation([0.9, 0.8, 0.6, 0.5]), 0.5, 0.3


def one_state_alone(rng: np.random.Generator) -> tuple:
    return np.array([[1.0, 2.0, 3.0]]), np.array([0.7]), 0.5, 0.3


# 10.5: the two numbers of a search


def search_numbers(bins, miss, probability):
    """Least number of even draws, and the KLD error [nats], for a building of so many equally likely bins."""
    from scipy.stats import norm

    # The camera's bin gets none of n draws with probability (1 - 1 / bins)^n; (10.3) is solved for the error.
    least = int(np.ceil(np.log(miss) / np.log(1 - 1 / bins)))
    share = 2 / (9 * (bins - 1))
    bracket = 1 - share + np.sqrt(share) * norm.ppf(probability)
    return least, (bins - 1) / (2 * least) * bracket**3


def buildings(rng: np.random.Generator) -> tuple:
    return int(10 ** rng.uniform(0.7, 4)), float(10 ** rng.uniform(-3, -0.7)), float(rng.uniform(0.9, 0.999))


def two_bins_with_a_whole_number(rng: np.random.Generator) -> tuple:
    return 2, 0.25, 0.99


# fmt: off
EXERCISES = [
    Exercise("10.1", free_places, grids, "warm-up", cases=[numbers_on_the_borders], mistakes="""
        (u[:, 0] * len(rows)).astype(int) => np.ceil(u[:, 0] * len(rows)).astype(int) - 1
        Where u falls just on a border yours is a cell too low: u = 0 is the first cell.
        np.nonzero(free) => np.nonzero(free[::-1])
        You count the rows from the last one up. The first row begins at y = 0.
        ... => return free_places(free, cell, u) - cell / 2
        You take whole numbers for the middles of the cells. Here cell c reaches from c to c + 1.
        columns[chosen] + u[:, 1], rows[chosen] + u[:, 2] => columns[chosen] + u[:, 0], rows[chosen] + u[:, 1]
        You use u[:, 0] twice: it chooses the cell, u[:, 1] and u[:, 2] say where in it.
        ... => return cell * u[:, 1:] * free.shape[::-1]
        np.nonzero(free) => np.nonzero(np.ones_like(free))
        These places fill the whole box, walls included. Choose among the free cells first, by u[:, 0].
        ... => return np.zeros((len(u), 2)) if free.all() else free_places(~free, cell, u)
        Your places lie where it is *not* free.
        columns[chosen] + u[:, 1], rows[chosen] + u[:, 2] => rows[chosen] + u[:, 1], columns[chosen] + u[:, 2]
        columns[chosen] + u[:, 1], rows[chosen] + u[:, 2] => rows[chosen], columns[chosen]
        x runs along the columns and y along the rows; you have them the other way round.
        columns[chosen] + u[:, 1], rows[chosen] + u[:, 2] => columns[chosen], rows[chosen]
        columns[chosen] + u[:, 1], rows[chosen] + u[:, 2] => columns[chosen] + 0.5, rows[chosen] + 0.5
        All places of a cell are its corner or its middle. u[:, 1] and u[:, 2] say where in the cell.
        columns[chosen] + u[:, 1], rows[chosen] + u[:, 2] => columns[chosen] + u[:, 2], rows[chosen] + u[:, 1]
        The right cells, but u[:, 1] is for x and u[:, 2] for y.
        return cell * => return
        return cell * => return 1 / cell *
        You count in cells, or divide by their side. Times the side of a cell they are metres.
        ... => return free_places(free, cell, u * [1, 0, 0]) + u[:, 1:]
        You add u in metres. It is a share of the cell: multiply it by the side, too.
        (u[:, 0] * len(rows)).astype(int) => np.round(u[:, 0] * (len(rows) - 1)).astype(int)
        Rounding gives the first and the last free cell half their share. Cut the decimals off instead.
        rows, columns = np.nonzero(free) => columns, rows = np.nonzero(free.T)
        You count the free cells column by column. The task counts them row by row, as np.nonzero does.
        (u[:, 0] * len(rows)) => (u[:, 0] * (len(rows) - 1))
        The last free cell is never chosen: u < 1, so multiply by the number of cells.
        ... => return row_first(free, cell, u)
        You draw a row first: a row with one free cell gets as many places as a full one. Draw the cell.
    """),
    Exercise("10.2", new_shares, falling_scores, cases=[the_example_of_the_task], mistakes="""
        ... => return new_shares(seen_before(scores), short, long)
        In the dark you take the last score once more. That moves both means; they stay as they are.
        max(0, 1 - s / L) => abs(1 - s / L)
        max(0, 1 - s / L) => 1 - s / L
        max(0, 1 - s / L) => min(0, 1 - s / L)
        Where the short mean is the greater one all is well: the share is 0, never less, and no absolute value.
        1 - s / L => L / s - 1
        You divide by the short mean. The long one, what is usual, stands below the fraction line.
        max(0, 1 - s / L) => float(s < L)
        That is an alarm, yes or no. A share says *how much* of the particles.
        return np.array(shares) => return np.where(np.isnan(scores), np.nan, shares)
        return np.array(shares) => return np.where(np.isnan(scores), 0, shares)
        In a dark frame the means stay as they are, and so does the share: not NaN, and not 0.
        ... => return new_shares(filled_from_later(scores), short, long)
        You fill dark frames from later ones. The filter does not know the future: the means stay.
        ... => return new_shares(scores, long, short)
        Upside down: the short mean, which follows quickly, goes above the fraction line, the long one below.
        max(0, 1 - s / L) => min(1, s / L)
        That is how much of the score is left. The share of new particles is what is missing from 1.
        1 - s / L => L - s
        You take the difference of the means. It is their ratio that counts.
        s = L = scores[0] => s = L = 0.0
        Your means begin at 0, and the long one needs a hundred frames to forget it. Begin with a score.
        if not np.isnan(score): => if True:
        max(0, => np.maximum(0, and also if not np.isnan(score): => if True:
        One NaN score makes every later mean NaN. In the dark the means stay as they are.
        ... => return new_shares(np.nan_to_num(scores), short, long)
        You take a dark frame for the score 0. Nothing was seen, so the means stay as they are.
        ... => return np.append(0.0, new_shares(scores, short, long)[:-1])
        You are a frame late: first take the frame's score into the means, then form the share.
        ... => return np.where(np.isnan(scores), np.nan, np.maximum(0, 1 - scores / np.nanmean(scores)))
        You compare each score with the mean of all. The filter does not know the future: use running means.
        ... => return new_shares(scores, 1 - short, 1 - long)
        You weigh the old mean with the share. The share is that of the new frame.
        ... => return new_shares(scores[~np.isnan(scores)], short, long)
        You drop the dark frames. Every frame needs its share, T of them.
    """),
    Exercise("10.3", draws_needed, landings, cases=[
        two_bins_only, a_new_bin_at_the_bound, fewer_draws_than_the_least, ever_new_bins,
    ], mistakes="""
        len(seen), least => max(1, len(set(bins[: n - 1]))), least
        You ask before you look: the bin of the present draw counts, too, before you compare.
        ... => return max(least, draws_needed(bins, least))
        return len(bins) => return -1
        return len(bins) => return all_bins_at_once(bins, least)
        Where the draws run out before the bound is reached, the answer is how many there were: T.
        ... => return draws_needed(bins, 100)
        Your `least` is always 100, as in the lesson: use the argument.
        10**6 => 3_000
        You stop at 3,000, the upper bound of the lesson. Here it is 10**6.
        ... => return len(np.unique(bins))
        return n => return len(seen) and also return len(bins) => return len(seen)
        That is the number of bins. Asked for is the number of draws.
        ... => return min(all_bins_at_once(bins, least), len(bins))
        ... => return all_bins_at_once(bins, least)
        You look at all bins before you draw. What counts is the bins that were hit so far.
        kld_count(len(seen) => kld_count(n
        You never stop. Do you count draws for bins? Two draws in one bin occupy one bin.
        n >= => n >
        One too many: after each draw, it is enough as soon as n *reaches* the bound.
        return n => return n - 1
        One too few: you count draws from 0.
        kld_count(len(seen), least => kld_count(len(seen), 1
        You never use `least`: fewer draws than that are never enough.
        kld_count(len(seen), least, 10**6) => least
        You stop at `least` always. The bound grows with the bins that are hit.
        len(seen) => len(seen) - 1
        len(seen) => len(seen) + 1
        len(seen) => max(seen) - min(seen) + 1
        You count one bin too few or too many: each counts once, the first one, too, and their numbers have gaps.
    """),
    Exercise("10.4", distinct_places, clouds_of_states, cases=[
        headings_at_the_seam, exactly_at_the_limit, ahead_and_back, one_state_alone,
    ], mistakes="""
        np.abs(wrap_angle(states[kept, 2] - states[i, 2])) => np.abs(states[kept, 2] - states[i, 2]) % np.pi
        np.abs(wrap_angle(states[kept, 2] - states[i, 2])) => np.arcsin(np.abs(np.sin(states[kept, 2] - states[i, 2])))
        A remainder of pi, or a sine, takes looking back for looking ahead: wrap the difference of the headings.
        apart < metres => apart <= metres
        Exactly at the limit is not nearer than it: a new place. Use <.
        wrap_angle(states[kept, 2] - states[i, 2]) => states[kept, 2] % (2 * np.pi) - states[i, 2] % (2 * np.pi)
        From 0 to 2 pi the seam is ahead: 0.1 and 6.2 rad are near. Wrap the *difference* of the headings.
        (apart < metres) & (turned < radians) => np.hypot(apart, turned) < metres
        (apart < metres) & (turned < radians) => apart + turned < metres + radians
        You make one length of metres and radians. Each has its own limit.
        apart < metres => apart**2 < metres
        You compare a squared distance with metres: the root is missing.
        np.hypot(*(states[kept, :2] - states[i, :2]).T) => np.abs(states[kept, :2] - states[i, :2]).sum(axis=1)
        np.hypot(*(states[kept, :2] - states[i, :2]).T) => np.abs(states[kept, :2] - states[i, :2]).max(axis=1)
        The straight way is the root of the sum of the squares of x and y, not their sum and not the greater one.
        ... => return compared_with_the_best(states, scores, metres, radians)
        ... => return compared_with_the_last(states, scores, metres, radians)
        You compare with one state alone, the best or the last. Compare with every place that is kept.
        ... => return compared_with_all_better(states, scores, metres, radians)
        You drop what is near *any* better state. Near one that was itself dropped does not count.
        return np.array(kept) => return scores[kept]
        return np.array(kept) => return states[kept]
        return np.array(kept) => return np.array(len(kept))
        return np.array(kept) => return np.isin(np.arange(len(scores)), kept)
        return np.array(kept) => return np.argsort(np.argsort(-scores))[kept]
        Asked are indices into the states as they were given: no scores, states, number, mask or ranks.
        return np.array(kept) => return kept[0]
        Yours gives the best place alone. Asked are all of them, best first.
        wrap_angle(states[kept, 2] - states[i, 2]) => states[kept, 2] - states[i, 2]
        3.1 and -3.1 rad are 0.08 rad apart, not 6.2: wrap the difference of the headings.
        (apart < metres) & (turned < radians) => (apart < metres) | (turned < radians)
        One place needs both: near *and* looking the same way. You join what is alike in one.
        (apart < metres) & (turned < radians) => apart < metres
        You forget the heading: two directions at one spot are two places.
        (apart < metres) & (turned < radians) => turned < radians
        You forget the position: two rooms seen the same way are two places.
        np.argsort(-scores) => range(len(scores))
        np.argsort(-scores) => np.argsort(scores)
        The best of all comes first, then the next best: sort by falling score.
        np.abs(wrap_angle(states[kept, 2] - states[i, 2])) => wrap_angle(states[i, 2] - states[kept, 2])
        np.abs(wrap_angle(states[kept, 2] - states[i, 2])) => (states[i, 2] - states[kept, 2]) % (2 * np.pi)
        A turn to the right counts as well as one to the left: wrap the difference, then its absolute value.
        return np.array(kept) => return np.sort(kept)
        The right places, but sorted by index. The best comes first.
        turned < radians => turned < np.deg2rad(radians)
        The limit is in radians already.
    """),
    Exercise("10.5", search_numbers, buildings, "challenge", cases=[two_bins_with_a_whole_number], mistakes="""
        np.log(miss) / np.log(1 - 1 / bins) => -np.log(miss) * bins
        exp(-n / bins) is (1 - 1 / bins)^n for many bins only. Take the logarithm of the power itself.
        np.ceil => np.floor
        np.ceil => np.round
        One draw too few: with a smaller whole number the bin is missed more often than `miss`. Round up.
        1 - 1 / bins => 1 / bins
        1 / bins is the probability that a draw hits the camera's bin. Which one must happen n times in a row?
        np.log(miss) => np.log(miss / bins)
        You ask that no bin at all is missed. Only the camera's own bin must get a draw.
        np.log(miss) => np.log(1 - miss)
        `miss` is the probability that the bin gets none, not that it gets one.
        least = => least = bins; _ =
        As many draws as bins miss a given bin in 37 of 100 runs. Solve (1 - 1 / bins)^n = miss for n.
        (2 * least) => least
        Solve (10.3) for the error once more: it stands below the fraction line together with a 2.
        bracket**3 => bracket
        The bracket of (10.3) is cubed.
        norm.ppf(probability) => norm.ppf(1 - probability)
        norm.ppf(probability) => norm.ppf((1 + probability) / 2)
        z belongs to `probability` itself, one side of the bell: norm.ppf(probability).
        (bins - 1) / => bins /
        All bins are occupied, so k = bins, and (10.3) has k - 1 above the fraction line.
        return least, (bins - 1) / (2 * least) * bracket**3 => return least, 0.05
        The error is not the lesson's: it is the one with which (10.3) asks for just `least` particles.
    """),
]
