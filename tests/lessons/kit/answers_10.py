"""Answers that students may give to lesson 10, for test_exercise_answers.py."""

import numpy as np

from course_lib.beyond.lost_and_found.adaptive_count import kld_count

ENOUGH = 10**6


def chosen_cells(free, u):
    listed = [(r, c) for r in range(free.shape[0]) for c in range(free.shape[1]) if free[r, c]]
    return [listed[int(a * len(listed))] for a in u[:, 0]]


def by_loops(free, cell, u):
    places = [(c + x, r + y) for (r, c), (_, x, y) in zip(chosen_cells(free, u), u, strict=True)]
    return [[cell * x, cell * y] for x, y in places]


def by_argwhere(free, cell, u):
    corners = np.argwhere(free)[np.floor(u[:, 0] * free.sum()).astype(int)]
    return ((corners[:, ::-1] + u[:, 1:]) * cell).astype(np.float32)


def rejected(free, cell, u):
    """Draws from the box, and keeps what is free: fewer places than asked."""
    height, width = free.shape
    columns, rows = (u[:, 1] * width).astype(int), (u[:, 2] * height).astype(int)
    return (cell * np.column_stack([u[:, 1] * width, u[:, 2] * height]))[free[rows, columns]]


def column_by_column(free, cell, u):
    columns, rows = np.nonzero(free.T)
    chosen = (u[:, 0] * len(rows)).astype(int)
    return cell * np.column_stack([columns[chosen] + u[:, 1], rows[chosen] + u[:, 2]])


def means(scores, share):
    found = [scores[0]]
    for score in scores[1:]:
        found.append(found[-1] if np.isnan(score) else share * score + (1 - share) * found[-1])
    return np.array(found)


def by_ratio(scores, short, long):
    return np.clip(1 - means(scores, short) / means(scores, long), 0, None)


def by_list(scores, short, long):
    return [float(max(0, (u - s) / u)) for s, u in zip(means(scores, short), means(scores, long), strict=True)]


def plain_nan(scores, short, long):
    s = u = scores[0]
    found = []
    for score in scores:
        s, u = s + short * (score - s), u + long * (score - u)
        found.append(np.maximum(0, 1 - s / u))
    return np.array(found)


def python_max_of_nan(scores, short, long):
    """`max(0, nan)` is 0 in Python: all is calm for ever after the first dark frame."""
    s = u = scores[0]
    found = []
    for score in scores:
        s, u = s + short * (score - s), u + long * (score - u)
        found.append(max(0, 1 - s / u))
    return np.array(found)


def with_clip_at_one(scores, short, long):
    return np.clip(means(scores, short) / means(scores, long), 0, 1)


def by_unique(bins, least):
    for n in range(1, len(bins) + 1):
        if n >= kld_count(len(set(bins[:n].tolist())), least, ENOUGH):
            return n
    return len(bins)


def by_while(bins, least):
    n, seen = 0, {}
    while n < len(bins) and n < kld_count(len(seen), least, ENOUGH):
        seen[int(bins[n])] = True
        n += 1
    return np.array([n])[0]


def draws(bins, enough):
    for n in range(1, len(bins) + 1):
        if enough(n, bins[:n]):
            return n
    return len(bins)


def changes(part):
    return 1 + int((np.diff(part) != 0).sum())


def by_changes(bins, least):
    return draws(bins, lambda n, part: n >= kld_count(changes(part), least, ENOUGH))


def near(a, b, metres, radians):
    turn = abs(a[2] - b[2]) % (2 * np.pi)
    return np.hypot(a[0] - b[0], a[1] - b[1]) < metres and min(turn, 2 * np.pi - turn) < radians


def by_lists(states, scores, metres, radians):
    kept = []
    for i in sorted(range(len(scores)), key=lambda i: -scores[i]):
        if all(not near(states[i], states[j], metres, radians) for j in kept):
            kept.append(i)
    return kept


def by_striking_out(states, scores, metres, radians):
    left, kept = set(range(len(scores))), []
    while left:
        best = max(left, key=lambda i: scores[i])
        kept.append(best)
        left -= {i for i in left if i == best or near(states[i], states[best], metres, radians)}
    return np.array(kept, dtype=np.int32)


def kept_by(near_enough, order=lambda scores: np.argsort(-scores)):
    def answer(states, scores, metres, radians):
        kept = []
        for i in order(scores):
            if not any(near_enough(states[i], states[j], metres, radians) for j in kept):
                kept.append(int(i))
        return np.array(kept)

    return answer


def flat(a, b):
    return np.hypot(*(a[:2] - b[:2]))


WRONG = [
    ("10.1", rejected, "must have shape"),
    ("10.1", column_by_column, "column by column"),
    ("10.1", lambda free, cell, u: by_argwhere(free, 1 / cell, u), "divide by the side"),
    ("10.1", lambda free, cell, u: cell * np.argwhere(free)[(u[:, 0] * free.sum()).astype(int)], "Two things"),
    ("10.1", lambda free, cell, u: by_argwhere(free, cell, u)[0], "must have shape"),
    ("10.2", plain_nan, "stays in your means"),
    ("10.2", python_max_of_nan, "every later mean NaN"),
    ("10.2", with_clip_at_one, "what is missing from 1"),
    ("10.2", lambda scores, short, long: by_ratio(np.nan_to_num(scores), short, long), "score 0"),
    ("10.2", lambda scores, short, long: by_ratio(scores, short, long)[-1], "must have shape"),
    ("10.2", lambda scores, short, long: 1 - means(scores, short) / means(scores, long), "cannot be negative"),
    ("10.3", by_changes, "counts once"),
    ("10.3", lambda bins, least: kld_count(len(set(bins.tolist())), least, ENOUGH), "Go from draw to draw"),
    ("10.3", lambda bins, least: draws(bins, lambda n, part: n >= kld_count(len(part), least, ENOUGH)), "never stop"),
    ("10.3", lambda bins, least: draws(bins, lambda n, part: n >= kld_count(len(np.unique(part)) - 1, least, ENOUGH)),
     "one bin too few"),
    ("10.3", lambda bins, least: by_unique(bins, 1), "`least`"),
    ("10.4", kept_by(lambda a, b, m, r: flat(a, b) < m and abs(a[2] - b[2]) % np.pi < r), "wrap"),
    ("10.4", kept_by(lambda a, b, m, r: flat(a, b) < m and (a[2] - b[2]) % (2 * np.pi) < r), "one way around"),
    ("10.4", kept_by(lambda a, b, m, r: flat(a, b) < m and abs(a[2] - b[2]) < r), "wrap"),
    ("10.4", kept_by(near, order=np.argsort), "upwards"),
    ("10.4", lambda s, v, m, r: len(by_lists(s, v, m, r)), "how many"),
    ("10.4", lambda s, v, m, r: np.isin(np.arange(len(v)), by_lists(s, v, m, r)), "indices"),
]  # fmt: skip
RIGHT = [
    ("10.1", by_loops),
    ("10.1", by_argwhere),
    ("10.2", by_ratio),
    ("10.2", by_list),
    ("10.3", by_unique),
    ("10.3", by_while),
    ("10.4", by_lists),
    ("10.4", by_striking_out),
]
