"""Exercises of lesson 10: draws from free cells, injected particles, sampling until it is enough, distinct places."""

import functools
from collections.abc import Callable

import numpy as np

from course_lib.beyond.lost_and_found.adaptive_count import kld_count
from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.exercises import Exercise, Mistake

# 10.1: evenly from the free cells


def free_places(free: np.ndarray, cell: float, u: np.ndarray) -> np.ndarray:
    """Places (n, 2) [m], each x, y, evenly from the free cells of a grid; u (n, 3) even numbers in [0, 1)."""
    rows, columns = np.nonzero(free)
    chosen = (u[:, 0] * len(rows)).astype(int)
    return cell * np.column_stack([columns[chosen] + u[:, 1], rows[chosen] + u[:, 2]])


def _grids(rng: np.random.Generator) -> tuple:
    """Oblong grids, a fifth to two thirds free; one in four has a single free cell."""
    shape = int(rng.integers(3, 6)), int(rng.integers(7, 11))
    free = rng.random(shape) < rng.uniform(0.3, 0.7)
    if rng.random() < 0.25:
        free[:] = False
    free[-1, 0] = True
    return free, float(rng.choice([0.1, 0.25, 0.5])), rng.random((int(rng.integers(5, 12)), 3))


def _places(change: Callable) -> Callable:
    """A mistake: `change(rows, columns, chosen, u)` gives x and y in cells."""

    def mistaken(free, cell, u):
        rows, columns = np.nonzero(free)
        chosen = (u[:, 0] * len(rows)).astype(int)
        return cell * np.column_stack(change(rows, columns, chosen, u))

    return mistaken


def _from_the_box(free, cell, u):
    height, width = free.shape
    return cell * np.column_stack([u[:, 1] * width, u[:, 2] * height])


def _from_all_cells(free, cell, u):
    height, width = free.shape
    chosen = (u[:, 0] * height * width).astype(int)
    return cell * np.column_stack([chosen % width + u[:, 1], chosen // width + u[:, 2]])


def _rounded_index(free, cell, u):
    rows, columns = np.nonzero(free)
    chosen = np.round(u[:, 0] * (len(rows) - 1)).astype(int)
    return cell * np.column_stack([columns[chosen] + u[:, 1], rows[chosen] + u[:, 2]])


def _by_rows_first(free, cell, u):
    open_rows = np.flatnonzero(free.any(axis=1))
    found = []
    for a, b, c in u:
        row = open_rows[int(a * len(open_rows))]
        columns = np.flatnonzero(free[row])
        share = a * len(open_rows) % 1
        found.append((columns[int(share * len(columns))] + b, row + c))
    return cell * np.array(found)


def _last_cell_never(free, cell, u):
    rows, columns = np.nonzero(free)
    chosen = (u[:, 0] * (len(rows) - 1)).astype(int)
    return cell * np.column_stack([columns[chosen] + u[:, 1], rows[chosen] + u[:, 2]])


def _column_by_column(free, cell, u):
    columns, rows = np.nonzero(free.T)
    chosen = (u[:, 0] * len(rows)).astype(int)
    return cell * np.column_stack([columns[chosen] + u[:, 1], rows[chosen] + u[:, 2]])


def _occupied(free, cell, u):
    if free.all():
        return np.zeros((len(u), 2))
    return free_places(~free, cell, u)


def _first_of_each_cell(rng: np.random.Generator) -> tuple:
    """Numbers at the very start of each of four free cells, 0 first: cutting off differs from rounding up here."""
    free = np.array([[False, True, True], [True, False, True]])
    return free, 0.5, np.column_stack([[0.0, 0.25, 0.5, 0.75], rng.random((4, 2))])


def _next_lower(free, cell, u):
    rows, columns = np.nonzero(free)
    chosen = np.ceil(u[:, 0] * len(rows)).astype(int) - 1
    return cell * np.column_stack([columns[chosen] + u[:, 1], rows[chosen] + u[:, 2]])


# 10.2: how many new particles


def new_shares(scores: np.ndarray, short: float, long: float) -> np.ndarray:
    """Share (T,) of particles to draw from anywhere: max(0, 1 - short mean / long mean); NaN scores change nothing."""
    return _shares(scores, short, long)


def _shares(
    scores,
    short,
    long,
    share=lambda s, u: max(0.0, 1 - s / u),
    start=None,
    dark: str = "keep",
    before=False,
):
    found, s, usual = [], start, start
    for score in scores:
        value = score
        if np.isnan(value):
            if dark == "zero":
                value = 0.0
            elif dark == "no share":
                found.append(0.0)
                continue
            elif dark == "forget":
                s = usual = start
                found.append(0.0)
                continue
        if before:
            found.append(0.0 if s is None else share(s, usual))
        if dark == "nan" or not np.isnan(value):
            s = value if s is None else s + short * (value - s)
            usual = value if usual is None else usual + long * (value - usual)
        if not before:
            found.append(share(s, usual))
    return np.array(found)


def _scores(rng: np.random.Generator) -> tuple:
    """A level score, a fall, frames in the dark before and in the fall, and a rise."""
    level, low = rng.uniform(0.7, 0.95), rng.uniform(0.1, 0.5)
    scores = np.concatenate([np.full(rng.integers(5, 9), level), np.full(8, low), np.full(10, level)])
    scores += rng.uniform(-0.03, 0.03, len(scores))
    scores[3], scores[9:11], scores[-2] = np.nan, np.nan, np.nan
    return scores, float(rng.uniform(0.3, 0.6)), float(rng.uniform(0.02, 0.1))


def _example_2(rng: np.random.Generator) -> tuple:
    return np.array([0.8, 0.8, np.nan, 0.4]), 0.5, 0.1


def _last_seen(scores, between=False):
    seen = np.flatnonzero(~np.isnan(scores))
    if between:
        return np.interp(np.arange(len(scores)), seen, scores[seen])
    return scores[seen[np.searchsorted(seen, np.arange(len(scores)), side="right") - 1]]


# 10.3: until it is enough


def draws_needed(bins: np.ndarray, least: int) -> int:
    """How many draws KLD-sampling takes: bins (T,) are the bins in which draw after draw would land."""
    seen: set[int] = set()
    for n, one in enumerate(bins, start=1):
        seen.add(int(one))
        if n >= _bound(len(seen), least):
            return n
    return len(bins)


@functools.cache
def _bound(bins: int, least: int) -> int:
    """`kld_count` without an upper bound, each value once: a check asks for thousands."""
    return kld_count(bins, least, 10**6)


def _landings(rng: np.random.Generator) -> tuple:
    """Bins of 400 draws from few or many places, the last draws from elsewhere; bin numbers are no indices. From forty
    places the draws run out."""
    numbers = rng.choice(10_000, 50, replace=False) - 500
    k = int(rng.choice([1, 3, 8, 40]))
    early = rng.choice(numbers[:k], 350, p=rng.dirichlet(np.full(k, 0.7)))
    return np.append(early, rng.choice(numbers[40:], 50)), int(rng.choice([20, 150]))


def _sampling(enough: Callable, after: int = 0) -> Callable:
    """A mistake: draws until `enough(n, seen, least, bins)`; `after` is added to the count."""

    def mistaken(bins, least):
        seen: set[int] = set()
        for n, one in enumerate(bins, start=1):
            seen.add(int(one))
            if enough(n, seen, least, bins):
                return n + after
        return len(bins)

    return mistaken


def _all_bins_at_once(bins, least):
    return min(_bound(len(np.unique(bins)), least), len(bins))


def _never_runs_out(bins, least):
    seen: set[int] = set()
    for n, one in enumerate(bins, start=1):
        seen.add(int(one))
        if n >= _bound(len(seen), least):
            return n
    return _bound(len(seen), least)


def _needed_in_the_end(bins, least):
    seen: set[int] = set()
    for n, one in enumerate(bins, start=1):
        seen.add(int(one))
        if n >= _bound(len(seen), least):
            return len(seen)
    return len(seen)


def _new_bins_only(bins, least):
    """The bound is renewed only where a bin is new, without least."""
    seen: set[int] = set()
    for n, one in enumerate(bins, start=1):
        seen.add(int(one))
        if n >= _bound(len(seen), 1):
            return n
    return len(bins)


def _example_3(rng: np.random.Generator) -> tuple:
    return np.array([7, 7, 7, *[2, 7] * 48, 2]), 20


def _a_new_bin_at_the_bound(rng: np.random.Generator) -> tuple:
    """The draw that would be enough lands in a new bin: now it is not enough."""
    return np.array([5] * 19 + [9, 5] * 40), 20


def _fewer_than_the_minimum(rng: np.random.Generator) -> tuple:
    return np.array([3, 3, 8, 3, 1]), 20


def _ever_new_bins(rng: np.random.Generator) -> tuple:
    """More draws than the lesson's upper bound, from so many bins that they are not enough."""
    return np.arange(3_200) % 400, 20


def _one_bin_behind(bins, least):
    seen: set[int] = set()
    for n, one in enumerate(bins, start=1):
        if n >= _bound(max(1, len(seen)), least):
            return n
        seen.add(int(one))
    return len(bins)


def _reached(bins, least):
    return draws_needed(np.append(bins, bins[-1:]), least) <= len(bins)


# 10.4: distinct places


def distinct_places(states: np.ndarray, scores: np.ndarray, metres: float, radians: float) -> np.ndarray:
    """Indices of the best state of every place, best first; states (n, 3) are [x, y, yaw]."""
    return np.array(_greedy(states, scores, metres, radians), dtype=int)


def _near(a, b, metres, radians):
    return np.hypot(*(a[:2] - b[:2])) < metres and abs(wrap_angle(a[2] - b[2])) < radians


def _greedy(states, scores, metres, radians, near=_near, order=None):
    kept: list[int] = []
    for i in np.argsort(-scores) if order is None else order:
        if not any(near(states[i], states[j], metres, radians) for j in kept):
            kept.append(int(i))
    return kept


def _hypotheses(rng: np.random.Generator) -> tuple:
    """Clouds about places of which two share a position, two share a heading, and one looks along the seam."""
    corner = rng.uniform(0, 10, 2)
    offsets = np.array([[0, 0, 0.3], [0, 0, 2.0], [4, 0, 0.3], [0, 5, np.pi], [9, 9, -1.0]])
    places = offsets + np.append(corner, 0)
    n = int(rng.integers(25, 36))
    states = np.repeat(places, -(-n // len(places)), axis=0)
    states = states + rng.uniform(-1, 1, states.shape) * [0.5, 0.5, 0.25]
    states[:, 2] = wrap_angle(states[:, 2])
    states = rng.permutation(states)
    return states, rng.permutation(np.linspace(0.2, 0.95, len(states))), 0.6, 0.35


def _last_only(states, scores, metres, radians):
    kept: list[int] = []
    for i in np.argsort(-scores):
        if not kept or not _near(states[i], states[kept[-1]], metres, radians):
            kept.append(int(i))
    return np.array(kept)


def _against_all(states, scores, metres, radians):
    """A state stays if no better one at all is near, kept or not."""
    order = np.argsort(-scores)
    kept = [
        int(i) for k, i in enumerate(order) if not any(_near(states[i], states[j], metres, radians) for j in order[:k])
    ]
    return np.array(kept)


def _example_4(rng: np.random.Generator) -> tuple:
    states = np.array([[0, 0, 3.1], [0.1, 0, -3.1], [0, 0, 0], [5, 0, 3.1]])
    return states, np.array([0.7, 0.9, 0.5, 0.6]), 0.5, 0.3


def _at_the_limit(rng: np.random.Generator) -> tuple:
    """Exactly half a metre apart: that is not nearer than half a metre."""
    return np.array([[1.0, 2.0, 0.4], [1.5, 2.0, 0.4], [1.5, 2.25, 0.4]]), np.array([0.9, 0.5, 0.4]), 0.5, 0.3


def _ahead_and_back(rng: np.random.Generator) -> tuple:
    """One spot: two that look ahead, on either side of 0, and two that look back, on either side of pi."""
    headings = np.array([0.1, -0.1, 3.1, -3.1])
    return np.column_stack([np.zeros((4, 2)), headings]), rng.permutation([0.9, 0.8, 0.6, 0.5]), 0.5, 0.3


def _one_alone(rng: np.random.Generator) -> tuple:
    return np.array([[1.0, 2.0, 3.0]]), np.array([0.7]), 0.5, 0.3


def _best_only(states, scores, metres, radians):
    best = np.argmax(scores)
    order = [int(i) for i in np.argsort(-scores)]
    return np.array([i for i in order if i == best or not _near(states[i], states[best], metres, radians)])


def _clustered(near: Callable = _near, order: Callable | None = None) -> Callable:
    """A mistake: as the reference, with another test of nearness or another order."""

    def mistaken(states, scores, metres, radians):
        sequence = None if order is None else order(scores)
        return np.array(_greedy(states, scores, metres, radians, near, sequence), dtype=int)

    return mistaken


EXERCISES = [
    Exercise(
        number="10.1",
        solution=free_places,
        inputs=_grids,
        cases=(_first_of_each_cell,),
        mistakes=(
            Mistake(
                _next_lower,
                "Where u falls just on a border yours is a cell too low: u = 0 is the first cell.",
            ),
            Mistake(
                lambda free, cell, u: free_places(free[::-1], cell, u),
                "You count the rows from the last one up. The first row begins at y = 0.",
            ),
            Mistake(
                lambda free, cell, u: free_places(free, cell, u) - cell / 2,
                "You take whole numbers for the middles of the cells. Here cell c reaches from c to c + 1.",
            ),
            Mistake(
                _places(lambda rows, columns, chosen, u: [columns[chosen] + u[:, 0], rows[chosen] + u[:, 1]]),
                "You use u[:, 0] twice: it chooses the cell, u[:, 1] and u[:, 2] say where in it.",
            ),
            Mistake(
                _from_the_box,
                "These places fill the whole box, walls included. Choose among the free cells first, by u[:, 0].",
            ),
            Mistake(
                _from_all_cells,
                "You choose among all cells of the grid. np.nonzero(free) lists only those that are free.",
            ),
            Mistake(_occupied, "Your places lie where it is *not* free."),
            Mistake(
                _places(lambda rows, columns, chosen, u: [rows[chosen] + u[:, 1], columns[chosen] + u[:, 2]]),
                "x runs along the columns and y along the rows; you have them the other way round.",
            ),
            Mistake(
                _places(lambda rows, columns, chosen, u: [columns[chosen], rows[chosen]]),
                "All places of a cell are its corner. u[:, 1] and u[:, 2] say where in the cell.",
            ),
            Mistake(
                _places(lambda rows, columns, chosen, u: [columns[chosen] + 0.5, rows[chosen] + 0.5]),
                "All places of a cell are its middle. u[:, 1] and u[:, 2] say where in the cell.",
            ),
            Mistake(
                _places(lambda rows, columns, chosen, u: [columns[chosen] + u[:, 2], rows[chosen] + u[:, 1]]),
                "The right cells, but u[:, 1] is for x and u[:, 2] for y.",
            ),
            Mistake(
                lambda free, cell, u: free_places(free, 1.0, u),
                "You count in cells. Times the side of a cell they are metres.",
            ),
            Mistake(
                lambda free, cell, u: (
                    free_places(free, 1.0, np.column_stack([u[:, 0], 0 * u[:, 1:]])) * cell + u[:, 1:]
                ),
                "You add u in metres. It is a share of the cell: multiply it by the side, too.",
            ),
            Mistake(
                _rounded_index,
                "Rounding gives the first and the last free cell half their share. Cut the decimals off instead.",
            ),
            Mistake(
                _places(lambda rows, columns, chosen, u: [rows[chosen], columns[chosen]]),
                "Two things: x runs along the columns, y along the rows; and u[:, 1], u[:, 2] say where in the cell.",
            ),
            Mistake(
                lambda free, cell, u: free_places(free, 1 / cell, u),
                "You divide by the side of a cell. Four cells of 0.5 m are 2 m.",
            ),
            Mistake(
                _column_by_column,
                "You count the free cells column by column. The task counts them row by row, as np.nonzero does.",
            ),
            Mistake(_last_cell_never, "The last free cell is never chosen: u < 1, so multiply by the number of cells."),
            Mistake(
                _by_rows_first,
                "You draw a row first: a row with one free cell gets as many places as a full one. Draw the cell.",
            ),
        ),
        level="warm-up",
    ),
    Exercise(
        number="10.2",
        solution=new_shares,
        inputs=_scores,
        cases=(_example_2,),
        mistakes=(
            Mistake(
                lambda scores, short, long: _shares(_last_seen(scores), short, long),
                "In the dark you take the last score once more. That moves both means; they stay as they are.",
            ),
            Mistake(
                lambda scores, short, long: _shares(scores, short, long, lambda s, u: abs(1 - s / u)),
                "You take the absolute value. Where the short mean is the greater one all is well: the share is 0.",
            ),
            Mistake(
                lambda scores, short, long: _shares(scores, short, long, lambda s, u: min(0.0, 1 - s / u)),
                "min keeps what is below 0. The share is never less than 0: max.",
            ),
            Mistake(
                lambda scores, short, long: _shares(scores, short, long, lambda s, u: max(0.0, u / s - 1)),
                "You divide by the short mean. The long one, what is usual, stands below the fraction line.",
            ),
            Mistake(
                lambda scores, short, long: _shares(scores, short, long, lambda s, u: float(s < u)),
                "That is an alarm, yes or no. A share says *how much* of the particles.",
            ),
            Mistake(
                lambda scores, short, long: np.where(np.isnan(scores), np.nan, new_shares(scores, short, long)),
                "In a dark frame you give NaN. The means stay as they are, and so does the share.",
            ),
            Mistake(
                lambda scores, short, long: _shares(_last_seen(scores, between=True), short, long),
                "You fill dark frames from later ones. The filter does not know the future: the means stay.",
            ),
            Mistake(
                lambda scores, short, long: _shares(scores, short, long, lambda s, u: 1 - s / u),
                "A share cannot be negative: where the short mean is the greater one, it is 0.",
            ),
            Mistake(
                lambda scores, short, long: _shares(scores, long, short),
                "Upside down: the short mean, which follows quickly, goes above the fraction line, the long one below.",
            ),
            Mistake(
                lambda scores, short, long: _shares(scores, short, long, lambda s, u: min(1.0, s / u)),
                "That is how much of the score is left. The share of new particles is what is missing from 1.",
            ),
            Mistake(
                lambda scores, short, long: _shares(scores, short, long, lambda s, u: max(0.0, u - s)),
                "You take the difference of the means. It is their ratio that counts.",
            ),
            Mistake(
                lambda scores, short, long: _shares(scores, short, long, start=0.0),
                "Your means begin at 0, and the long one needs a hundred frames to forget it. Begin with a score.",
            ),
            Mistake(
                lambda scores, short, long: _shares(scores, short, long, dark="nan"),
                "One NaN score makes every later mean NaN. In the dark the means stay as they are.",
            ),
            Mistake(
                lambda scores, short, long: _shares(
                    scores, short, long, lambda s, u: np.maximum(0, 1 - s / u), dark="nan"
                ),
                "The NaN of a dark frame stays in your means for good. np.isnan tells which scores to leave out.",
            ),
            Mistake(
                lambda scores, short, long: _shares(scores, short, long, dark="zero"),
                "You take a dark frame for the score 0. Nothing was seen, so the means stay as they are.",
            ),
            Mistake(
                lambda scores, short, long: _shares(scores, short, long, dark="no share"),
                "In a dark frame you give 0. The means stay as they are, and so does the share.",
            ),
            Mistake(
                lambda scores, short, long: _shares(scores, short, long, dark="forget"),
                "After a dark frame your means begin anew. They stay as they are.",
            ),
            Mistake(
                lambda scores, short, long: _shares(scores, short, long, before=True),
                "You are a frame late: first take the frame's score into the means, then form the share.",
            ),
            Mistake(
                lambda scores, short, long: np.where(
                    np.isnan(scores), np.nan, np.maximum(0, 1 - scores / np.nanmean(scores))
                ),
                "You compare each score with the mean of all. The filter does not know the future: use running means.",
            ),
            Mistake(
                lambda scores, short, long: _shares(scores, 1 - short, 1 - long),
                "You weigh the old mean with the share. The share is that of the new frame.",
            ),
            Mistake(
                lambda scores, short, long: _shares(scores[~np.isnan(scores)], short, long),
                "You drop the dark frames. Every frame needs its share, T of them.",
            ),
        ),
    ),
    Exercise(
        number="10.3",
        solution=draws_needed,
        inputs=_landings,
        cases=(
            _example_3,
            _a_new_bin_at_the_bound,
            _fewer_than_the_minimum,
            _ever_new_bins,
        ),
        mistakes=(
            Mistake(
                _one_bin_behind,
                "You ask before you look: the bin of the present draw counts, too, before you compare.",
            ),
            Mistake(
                lambda bins, least: max(least, draws_needed(bins, least)),
                "Where the draws run out before `least` yours says `least`. All T were made, no more.",
            ),
            Mistake(
                lambda bins, least: draws_needed(bins, 100),
                "Your `least` is always 100, as in the lesson: use the argument.",
            ),
            Mistake(
                lambda bins, least: draws_needed(bins, least) if _reached(bins, least) else -1,
                "Where the draws run out yours says -1. Then all T were made: the answer is T.",
            ),
            Mistake(
                _sampling(lambda n, seen, least, bins: n >= min(3_000, _bound(len(seen), least))),
                "You stop at 3,000, the upper bound of the lesson. Here it is 10**6.",
            ),
            Mistake(
                lambda bins, least: len(np.unique(bins)),
                "That is the number of bins. Asked for is the number of draws.",
            ),
            Mistake(
                _all_bins_at_once,
                "You look at all bins before you draw. What counts is the bins that were hit so far.",
            ),
            Mistake(
                _sampling(lambda n, seen, least, bins: n >= _bound(n, least)),
                "You never stop. Do you count draws for bins? Two draws in one bin occupy one bin.",
            ),
            Mistake(
                _sampling(lambda n, seen, least, bins: n > _bound(len(seen), least)),
                "One too many: after each draw, it is enough as soon as n *reaches* the bound.",
            ),
            Mistake(
                _sampling(lambda n, seen, least, bins: n >= _bound(len(seen), least), after=-1),
                "One too few: you count draws from 0.",
            ),
            Mistake(_new_bins_only, "You never use `least`: fewer draws than that are never enough."),
            Mistake(
                _sampling(lambda n, seen, least, bins: n >= least),
                "You stop at `least` always. The bound grows with the bins that are hit.",
            ),
            Mistake(
                _never_runs_out,
                "Where the draws run out before the bound is reached, the answer is how many there were.",
            ),
            Mistake(
                lambda bins, least: _bound(len(np.unique(bins)), least),
                "You look at all bins before you draw, and never at how many draws there are. Go from draw to draw.",
            ),
            Mistake(
                _sampling(lambda n, seen, least, bins: n >= _bound(len(seen) - 1, least)),
                "You count one bin too few: the first one counts, too.",
            ),
            Mistake(_needed_in_the_end, "Yours gives the number of bins. Asked is the number of draws."),
            Mistake(
                _sampling(lambda n, seen, least, bins: n >= _bound(len(seen) + 1, least)),
                "You count one bin too many.",
            ),
            Mistake(
                _sampling(lambda n, seen, least, bins: n >= _bound(max(seen) - min(seen) + 1, least)),
                "You count too many bins: each counts once, however often it is hit, and their numbers have gaps.",
            ),
        ),
    ),
    Exercise(
        number="10.4",
        solution=distinct_places,
        inputs=_hypotheses,
        cases=(
            _example_4,
            _at_the_limit,
            _ahead_and_back,
            _one_alone,
        ),
        mistakes=(
            Mistake(
                _clustered(lambda a, b, m, r: np.hypot(*(a[:2] - b[:2])) < m and abs(a[2] - b[2]) % np.pi < r),
                "A remainder of pi takes looking back for looking ahead: wrap the difference of the headings instead.",
            ),
            Mistake(
                _clustered(lambda a, b, m, r: np.hypot(*(a[:2] - b[:2])) <= m and abs(wrap_angle(a[2] - b[2])) < r),
                "Exactly at the limit is not nearer than it: a new place. Use <.",
            ),
            Mistake(
                _clustered(
                    lambda a, b, m, r: (
                        np.hypot(*(a[:2] - b[:2])) < m and abs(a[2] % (2 * np.pi) - b[2] % (2 * np.pi)) < r
                    )
                ),
                "From 0 to 2 pi the seam is ahead: 0.1 and 6.2 rad are near. Wrap the *difference* of the headings.",
            ),
            Mistake(
                _clustered(lambda a, b, m, r: np.hypot(*(a[:2] - b[:2])) < m and abs(np.sin(a[2] - b[2])) < np.sin(r)),
                "The sine of a half turn is 0, too: looking back you take for the same. Wrap the difference instead.",
            ),
            Mistake(
                _clustered(lambda a, b, m, r: np.linalg.norm(a - b) < m),
                "You make one length of metres and radians. Each has its own limit.",
            ),
            Mistake(
                _clustered(lambda a, b, m, r: np.sum((a[:2] - b[:2]) ** 2) < m and abs(wrap_angle(a[2] - b[2])) < r),
                "You compare a squared distance with metres: the root is missing.",
            ),
            Mistake(
                _clustered(lambda a, b, m, r: np.abs(a[:2] - b[:2]).sum() < m and abs(wrap_angle(a[2] - b[2])) < r),
                "You add the ways along x and y. The straight way is the root of the sum of their squares.",
            ),
            Mistake(
                _best_only,
                "You compare with the very best state alone. Compare with every place that is kept.",
            ),
            Mistake(
                lambda s, v, m, r: v[distinct_places(s, v, m, r)],
                "Yours gives the scores of the places. Asked are their indices.",
            ),
            Mistake(
                lambda s, v, m, r: distinct_places(s, v, m, r)[0],
                "Yours gives the best place alone. Asked are all of them, best first.",
            ),
            Mistake(
                lambda s, v, m, r: np.argsort(np.argsort(-v))[distinct_places(s, v, m, r)],
                "Yours are ranks in the sorted list. Asked are indices into the states as they were given.",
            ),
            Mistake(
                _clustered(lambda a, b, m, r: np.hypot(*(a[:2] - b[:2])) < m and abs(a[2] - b[2]) < r),
                "3.1 and -3.1 rad are 0.08 rad apart, not 6.2: wrap the difference of the headings.",
            ),
            Mistake(
                _clustered(lambda a, b, m, r: np.hypot(*(a[:2] - b[:2])) < m or abs(wrap_angle(a[2] - b[2])) < r),
                "One place needs both: near *and* looking the same way. You join what is alike in one.",
            ),
            Mistake(
                _clustered(lambda a, b, m, r: np.hypot(*(a[:2] - b[:2])) < m),
                "You forget the heading: two directions at one spot are two places.",
            ),
            Mistake(
                _clustered(lambda a, b, m, r: abs(wrap_angle(a[2] - b[2])) < r),
                "You forget the position: two rooms seen the same way are two places.",
            ),
            Mistake(
                _clustered(order=lambda scores: range(len(scores))),
                "You take the states in the order given. The best of all comes first, then the next best.",
            ),
            Mistake(
                _clustered(order=np.argsort),
                "You begin with the worst: argsort goes upwards.",
            ),
            Mistake(_last_only, "You compare with the place kept last. Compare with every place that is kept."),
            Mistake(
                _against_all,
                "You drop what is near *any* better state. Near one that was itself dropped does not count.",
            ),
            Mistake(
                _clustered(lambda a, b, m, r: np.hypot(*(a[:2] - b[:2])) + abs(wrap_angle(a[2] - b[2])) < m + r),
                "You add metres and radians. Each has its own limit.",
            ),
            Mistake(
                _clustered(lambda a, b, m, r: np.abs(a[:2] - b[:2]).max() < m and abs(wrap_angle(a[2] - b[2])) < r),
                "x and y each within the limit is a square. A distance is the root of the sum of squares.",
            ),
            Mistake(
                _clustered(lambda a, b, m, r: np.hypot(*(a[:2] - b[:2])) < m and wrap_angle(a[2] - b[2]) < r),
                "A turn to the right is negative, and so always below the limit: take its absolute value.",
            ),
            Mistake(
                _clustered(lambda a, b, m, r: np.hypot(*(a[:2] - b[:2])) < m and (a[2] - b[2]) % (2 * np.pi) < r),
                "The remainder goes one way around only: a small turn to the right becomes nearly a full one.",
            ),
            Mistake(
                lambda s, v, m, r: np.array(len(distinct_places(s, v, m, r))),
                "Yours gives how many places there are. Asked are their indices.",
            ),
            Mistake(
                lambda s, v, m, r: np.isin(np.arange(len(v)), distinct_places(s, v, m, r)),
                "Yours gives True or False for every state. Asked are the indices of the places, best first.",
            ),
            Mistake(
                lambda s, v, m, r: np.sort(distinct_places(s, v, m, r)),
                "The right places, but sorted by index. The best comes first.",
            ),
            Mistake(
                lambda s, v, m, r: s[distinct_places(s, v, m, r)],
                "Yours gives the states themselves. Asked are their indices.",
            ),
            Mistake(
                lambda s, v, m, r: distinct_places(s, v, m, np.deg2rad(r)),
                "The limit is in radians already.",
            ),
        ),
        level="challenge",
    ),
]
