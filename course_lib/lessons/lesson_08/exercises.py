"""Exercises of lesson 08: the paper's error, a row of its table 1, noticing a loss, what frames that are alike say."""

import numpy as np

from course_lib.lessons.kit.exercises import Exercise, Mistake

# 08.1: distance to the nearest point of the path


def nearest_distances(estimated: np.ndarray, path: np.ndarray) -> np.ndarray:
    """Horizontal distance (T,) [m] from each estimate (T, 3) to the nearest point of the path (P, 3)."""
    return _pairwise(estimated[:, :2], path[:, :2]).min(axis=1)


def _pairwise(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.linalg.norm(a[:, None, :] - b[None, :, :], axis=2)


def _track_and_path(rng: np.random.Generator) -> tuple:
    n, p = int(rng.integers(4, 8)), int(rng.integers(9, 15))
    # The floor is uneven and the camera bobs: the nearest point in space need not be the nearest on the floor.
    path = np.column_stack([np.linspace(0, 6, p), 0.3 * rng.normal(size=p), 0.2 * rng.normal(size=p)])
    estimated = np.column_stack([rng.uniform(0, 6, n), rng.normal(0, 0.3, n), rng.uniform(0.8, 1.2, n)])
    return estimated, path


def _on_the_path(rng: np.random.Generator) -> tuple:
    """Estimates above points of the path, in another order: all errors are 0."""
    path = np.column_stack([np.arange(6.0), rng.normal(size=6), np.zeros(6)])
    return path[[4, 0, 2]] + [0.0, 0.0, 1.0], path


def _a_single_estimate(rng: np.random.Generator) -> tuple:
    return rng.normal(size=(1, 3)), rng.normal(size=(2, 3))


def _a_hump_in_the_floor(rng: np.random.Generator) -> tuple:
    """The nearest point in space, on a hump of the floor, is not the nearest on the floor plan."""
    path = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.9]])
    return np.array([[1.3, 0.1, 1.0]]), path


def _nearest_in_space(estimated: np.ndarray, path: np.ndarray) -> np.ndarray:
    nearest = _pairwise(estimated, path).argmin(axis=1)
    return np.linalg.norm(estimated[:, :2] - path[nearest, :2], axis=1)


def _same_index(estimated: np.ndarray, path: np.ndarray) -> np.ndarray:
    return np.linalg.norm(estimated[:, :2] - path[: len(estimated), :2], axis=1)


def _nearest_along_x(estimated: np.ndarray, path: np.ndarray) -> np.ndarray:
    nearest = np.abs(estimated[:, None, 0] - path[None, :, 0]).argmin(axis=1)
    return np.linalg.norm(estimated[:, :2] - path[nearest, :2], axis=1)


def _to_segments(estimated: np.ndarray, path: np.ndarray) -> np.ndarray:
    start, along = path[:-1, :2], np.diff(path[:, :2], axis=0)
    share = ((estimated[:, None, :2] - start) * along).sum(axis=2) / (along**2).sum(axis=1)
    nearest = start + np.clip(share, 0, 1)[:, :, None] * along
    return np.linalg.norm(estimated[:, None, :2] - nearest, axis=2).min(axis=1)


def _along_the_axes(estimated: np.ndarray, path: np.ndarray) -> np.ndarray:
    return np.abs(estimated[:, None, :2] - path[None, :, :2]).sum(axis=2).min(axis=1)


def _nearest_by_axes(estimated: np.ndarray, path: np.ndarray) -> np.ndarray:
    return np.linalg.norm(np.abs(estimated[:, None, :2] - path[None, :, :2]).min(axis=1), axis=1)


# 08.2: the three numbers of a row of table 1


def table_row(errors: np.ndarray) -> tuple[float, float, float]:
    """Median [m], sigma about zero [m] and share of errors of at most 0.30 m, of errors (T,) in metres."""
    return np.median(errors), np.sqrt(np.mean(errors**2)), np.mean(errors <= 0.30)


def _errors(rng: np.random.Generator) -> tuple:
    errors = np.abs(rng.normal(0.1, 0.2, size=rng.integers(12, 30))) + 0.05
    # Exactly at the gate: "at most" lets it in.
    errors[rng.integers(errors.size)] = 0.30
    return (errors,)


def _all_alike(rng: np.random.Generator) -> tuple:
    """A filter that is off by the same everywhere, by just the limit: no scatter, and yet an error."""
    return (np.full(int(rng.integers(3, 9)), 0.30),)


def _own_three_sigma(errors: np.ndarray) -> tuple[float, float, float]:
    sigma = np.sqrt(np.mean(errors**2))
    return np.median(errors), sigma, np.mean(errors <= 3 * sigma)


# 08.3: since when has the filter been lost?


def lost_since(scores: np.ndarray, limit: float, patience: int) -> int:
    """First frame at which the last `patience` scores, its own included, all lie below `limit`; -1 if never."""
    in_a_row = 0
    for frame, score in enumerate(scores):
        in_a_row = in_a_row + 1 if score < limit else 0
        if in_a_row == patience:
            return frame
    return -1


def _scores(rng: np.random.Generator) -> tuple:
    """Scores with two short dips and, mostly, one long one; the dips alone add up to the patience or more.

    The long dip is at the start, in the middle, complete with the last frame, cut off one frame before it is complete,
    or left out. The first short dip ends with a score equal to the limit, which is not below it.
    """
    patience, n = int(rng.integers(2, 6)), int(rng.integers(40, 61))
    limit = rng.uniform(0.3, 0.6)
    scores = limit + rng.uniform(0.01, 0.2, size=n)
    low = limit - rng.uniform(0.01, 0.2, size=n)
    long_start = rng.choice([0, 30, n - patience, n - patience + 1, n], p=[0.2, 0.2, 0.3, 0.2, 0.1])
    long_length = patience + int(rng.integers(0, 3))
    for start, length in ((8, patience - 1), (18, patience - 1), (long_start, long_length)):
        scores[start : start + length] = low[start : start + length]
    scores[8 + patience - 1] = limit
    return scores, limit, patience


def _alternating(rng: np.random.Generator) -> tuple:
    """Rows that are one too short, with single good scores between them: nothing may be carried over."""
    low, high, limit = 0.2, 0.7, 0.5
    rows = [low] * 4 + [high] + [low] * 4 + [high] * 3 + [low] * 2 + [high] + [low] * 3 + [high]
    return np.array(rows), limit, 5


def _starts_low(rng: np.random.Generator) -> tuple:
    """Low in the first frames, but not for long enough; later long enough."""
    return np.array([0.2, 0.3, 0.9, 0.8, 0.9, 0.1, 0.2, 0.1, 0.2, 0.9]), 0.5, 3


def _twice_lost(rng: np.random.Generator) -> tuple:
    """The alarm is that of the first time."""
    return np.array([0.9, 0.2, 0.2, 0.2, 0.9, 0.9, 0.1, 0.2, 0.1]), 0.5, 2


def _shorter_than_patience(rng: np.random.Generator) -> tuple:
    """All low, but fewer scores than `patience`: never."""
    return np.array([0.1, 0.2]), 0.5, 4


def _low_from_the_start(rng: np.random.Generator) -> tuple:
    return np.full(6, 0.1), 0.5, 3


def _never_low(rng: np.random.Generator) -> tuple:
    return np.full(8, 0.9), 0.5, 2


def _counter(scores: np.ndarray, limit: float, patience: int, after_good) -> int:
    """The alarm of a counter that becomes `after_good(counter)` at a good score."""
    in_a_row = 0
    for frame, score in enumerate(scores):
        in_a_row = in_a_row + 1 if score < limit else after_good(in_a_row)
        if in_a_row == patience:
            return frame
    return -1


def _short_first_windows(scores: np.ndarray, limit: float, patience: int) -> int:
    low = (bool((scores[max(0, i - patience + 1) : i + 1] < limit).all()) for i in range(len(scores)))
    return next((i for i, is_low in enumerate(low) if is_low), -1)


def _last_alarm(scores: np.ndarray, limit: float, patience: int) -> int:
    alarms = [f for f in range(patience - 1, len(scores)) if (scores[f - patience + 1 : f + 1] < limit).all()]
    return alarms[-1] if alarms else -1


def _length_for_never(scores: np.ndarray, limit: float, patience: int) -> int:
    frame = lost_since(scores, limit, patience)
    return frame if frame >= 0 else len(scores)


def _first_dip(scores: np.ndarray, limit: float, patience: int) -> int:
    below = np.flatnonzero(scores < limit)
    return int(below[0]) if len(below) else -1


def _counted_in_all(scores: np.ndarray, limit: float, patience: int) -> int:
    below = np.flatnonzero(scores < limit)
    return int(below[patience - 1]) if len(below) >= patience else -1


def _start_of_dip(scores: np.ndarray, limit: float, patience: int) -> int:
    frame = lost_since(scores, limit, patience)
    return frame - patience + 1 if frame >= 0 else -1


def _one_late(scores: np.ndarray, limit: float, patience: int) -> int:
    return lost_since(scores, limit, patience + 1)


def _from_one(scores: np.ndarray, limit: float, patience: int) -> int:
    frame = lost_since(scores, limit, patience)
    return frame + 1 if frame >= 0 else -1


def _equal_is_low(scores: np.ndarray, limit: float, patience: int) -> int:
    return lost_since(scores, np.nextafter(limit, np.inf), patience)


def _last_left_out(scores: np.ndarray, limit: float, patience: int) -> int:
    return lost_since(scores[:-1], limit, patience)


def _over_the_end(scores: np.ndarray, limit: float, patience: int) -> int:
    low = (bool((scores[i : i + patience] < limit).all()) for i in range(len(scores)))
    return next((i + patience - 1 for i, is_low in enumerate(low) if is_low), -1)


def _averaged(scores: np.ndarray, limit: float, patience: int) -> int:
    means = [scores[i : i + patience].mean() for i in range(len(scores) - patience + 1)]
    return next((i + patience - 1 for i, mean in enumerate(means) if mean < limit), -1)


def _convolved(scores: np.ndarray, limit: float, patience: int) -> int:
    """The mean by np.convolve, which exchanges its two arrays where the first is the shorter one."""
    below = np.flatnonzero(np.convolve(scores, np.ones(patience) / patience, mode="valid") < limit)
    return int(below[0]) + patience - 1 if len(below) else -1


def _gives_up(scores: np.ndarray, limit: float, patience: int) -> int:
    return patience - 1 if (scores[:patience] < limit).all() else -1


def _zero_for_never(scores: np.ndarray, limit: float, patience: int) -> int:
    return max(lost_since(scores, limit, patience), 0)


def _first_window(scores: np.ndarray, limit: float, patience: int, summary) -> int:
    lows = (f for f in range(patience - 1, len(scores)) if summary(scores[f - patience + 1 : f + 1]) < limit)
    return next(lows, -1)


def _row_ended(scores: np.ndarray, limit: float, patience: int) -> int:
    frame = lost_since(scores, limit, patience)
    while 0 <= frame < len(scores) - 1 and scores[frame + 1] < limit:
        frame += 1
    return frame


# 08.4: what frames that are alike are worth


def effective_frames(n: int, a: float) -> float:
    """How many independent errors have a mean as sure as that of n errors whose correlation is a^k at k frames apart.

    Var(mean) = s^2 / n^2 sum_ij a^|i - j|, and s^2 / n_eff of independent ones.
    """
    i = np.arange(n)
    return float(n**2 / np.sum(float(a) ** np.abs(i[:, None] - i)))


def _run_length_and_likeness(rng: np.random.Generator) -> tuple:
    return int(rng.integers(3, 60)), float(rng.uniform(0.05, 0.95))


def _independent(rng: np.random.Generator) -> tuple:
    return int(rng.integers(3, 60)), 0.0


def _all_the_same(rng: np.random.Generator) -> tuple:
    return int(rng.integers(3, 60)), 1.0


def _taking_turns(rng: np.random.Generator) -> tuple:
    """Errors that tend to change their sign: their mean is surer than that of independent ones."""
    return int(rng.integers(3, 60)), float(rng.uniform(-0.8, -0.2))


def _four_frames(rng: np.random.Generator) -> tuple:
    return 4, 0.5


def _fallons_run(rng: np.random.Generator) -> tuple:
    return 304, 0.99


EXERCISES = [
    Exercise(
        number="08.1",
        solution=nearest_distances,
        inputs=_track_and_path,
        level="warm-up",
        cases=(_on_the_path, _a_single_estimate, _a_hump_in_the_floor),
        mistakes=(
            Mistake(
                lambda estimated, path: _pairwise(estimated[:, :2], path[:, :2]).max(axis=1),
                "That is the farthest point of the path. The nearest one is asked for.",
            ),
            Mistake(
                lambda estimated, path: _pairwise(estimated[:, 1:], path[:, 1:]).min(axis=1),
                "You take the columns y and z. The floor is x and y, the first two.",
            ),
            Mistake(
                lambda estimated, path: np.abs(estimated[:, None, 0] - path[None, :, 0]).min(axis=1),
                "You look at x alone. The distance on the floor has two parts, x and y.",
            ),
            Mistake(
                lambda estimated, path: np.abs(estimated[:, None, :2] - path[None, :, :2]).max(axis=2).min(axis=1),
                "You take the larger of the ways along x and y. The straight way is the root of the sum of squares.",
            ),
            Mistake(
                _nearest_by_axes,
                "Your nearest x and nearest y may be of two points: distances first, then the minimum.",
            ),
            Mistake(
                _nearest_in_space,
                "You search in space and measure on the floor. Leave out z before you search, not after.",
            ),
            Mistake(
                lambda estimated, path: _pairwise(estimated, path).min(axis=1),
                "Your distance includes z: the camera is a metre above the line on the floor. Use x and y only.",
            ),
            Mistake(
                _same_index,
                "You compare point k with estimate k. Nobody says that they belong together: search the whole path.",
            ),
            Mistake(
                lambda estimated, path: _pairwise(estimated[:, :2], path[:, :2]).min(axis=0),
                "Yours has one number for each point of the path: you took the minimum over the wrong axis.",
            ),
            Mistake(
                lambda estimated, path: _pairwise(estimated[:, :2], path[:, :2]).mean(axis=1),
                "That is the mean distance to all points of the path. Only the nearest one counts.",
            ),
            Mistake(
                lambda estimated, path: _pairwise(estimated[:, :2], path[:, :2]).min(axis=1) ** 2,
                "Yours is in square metres: the last square root is missing.",
            ),
            Mistake(
                lambda estimated, path: np.abs(estimated[:, None, 1] - path[None, :, 1]).min(axis=1),
                "You look at y alone. The distance on the floor has two parts, x and y.",
            ),
            Mistake(
                lambda estimated, path: _pairwise(estimated[:, :2], path[:, :2]).argmin(axis=1),
                "argmin tells which point is nearest, its number; the task asks how far it is, in metres.",
            ),
            Mistake(
                lambda estimated, path: np.sqrt((_pairwise(estimated[:, :2], path[:, :2]) ** 2).sum(axis=1)),
                "You sum over the whole path. np.linalg.norm needs axis=1 to give one distance for each point.",
            ),
            Mistake(
                _to_segments,
                "You measure to the lines between the points of the path. Here only the points themselves count.",
            ),
            Mistake(
                _along_the_axes,
                "You add the ways along x and y. The straight way is the root of the sum of their squares.",
            ),
            Mistake(
                _nearest_along_x,
                "You take the point with the nearest x. Where the path bends, another point may be nearer.",
            ),
        ),
    ),
    Exercise(
        number="08.2",
        solution=table_row,
        inputs=_errors,
        cases=(_all_alike,),
        mistakes=(
            Mistake(
                lambda errors: (np.sort(errors)[len(errors) // 2], *table_row(errors)[1:]),
                "For an even number of errors yours is the upper of the middle two; a median lies halfway between.",
            ),
            Mistake(
                lambda errors: (np.sort(errors)[(len(errors) - 1) // 2], *table_row(errors)[1:]),
                "For an even number of errors yours is the lower of the middle two; a median lies halfway between.",
            ),
            Mistake(
                lambda errors: (errors[len(errors) // 2], *table_row(errors)[1:]),
                "Yours is the middle frame. A median is the middle of the errors *sorted* by size.",
            ),
            Mistake(
                lambda errors: (np.median(errors), np.mean(errors), np.mean(errors <= 0.30)),
                "Your sigma is the mean error. Square the errors, take the mean, then the root.",
            ),
            Mistake(
                lambda errors: (np.median(errors), np.sqrt(np.sum(errors**2)) / len(errors), np.mean(errors <= 0.30)),
                "You divide by T after the root. Root *mean* square: the mean first, then the root.",
            ),
            Mistake(
                lambda errors: (
                    np.median(errors),
                    np.sqrt(np.sum(errors**2) / (len(errors) - 1)),
                    np.mean(errors <= 0.30),
                ),
                "You divide by T - 1: that is for scatter about an estimated mean. Here it is the mean of T squares.",
            ),
            Mistake(
                lambda errors: (
                    np.median(errors),
                    np.sqrt(np.mean((errors - np.median(errors)) ** 2)),
                    np.mean(errors <= 0.30),
                ),
                "Your sigma is about the median. Here it is about zero: nothing is subtracted.",
            ),
            Mistake(
                lambda errors: (*table_row(errors)[:2], np.mean(errors <= 0.10)),
                "Your limit is 0.10 m, one sigma of the paper. The table has three of them, 0.30 m.",
            ),
            Mistake(
                lambda errors: (np.median(errors), np.std(errors), np.mean(errors <= 0.30)),
                "np.std measures the scatter about the mean: a constant error of 5 m would get 0. Take it about zero.",
            ),
            Mistake(
                lambda errors: (np.median(errors), np.std(errors, ddof=1), np.mean(errors <= 0.30)),
                "That is a standard deviation about the mean. Here sigma is about zero: nothing is subtracted.",
            ),
            Mistake(
                lambda errors: (np.median(errors), np.linalg.norm(errors), np.mean(errors <= 0.30)),
                "Your sigma grows with the number of frames: divide the sum of the squares by T before the root.",
            ),
            Mistake(
                lambda errors: (np.mean(errors), np.sqrt(np.mean(errors**2)), np.mean(errors <= 0.30)),
                "Your first number is the mean; one wild frame pulls it up. The table holds the median.",
            ),
            Mistake(
                _own_three_sigma,
                "You use three of the run's own sigma: a bad run would then get a wide gate. It is 0.30 m for all.",
            ),
            Mistake(
                lambda errors: (np.median(errors), np.mean(errors**2), np.mean(errors <= 0.30)),
                "Your sigma is in square metres: the square root is missing.",
            ),
            Mistake(
                lambda errors: (np.median(errors), np.sqrt(np.mean(errors**2)), 100 * np.mean(errors <= 0.30)),
                "Your last number is in percent; here it is a share from 0 to 1.",
            ),
            Mistake(
                lambda errors: (np.median(errors), np.sqrt(np.mean(errors**2)), np.sum(errors <= 0.30)),
                "Your last number counts frames. A share is that count divided by the number of frames.",
            ),
            Mistake(
                lambda errors: (np.median(errors), np.sqrt(np.mean(errors**2)), np.mean(errors < 0.30)),
                "An error of exactly 0.30 m is *at most* 0.30 m: it counts.",
            ),
            Mistake(
                lambda errors: (np.median(errors), np.sqrt(np.mean(errors**2)), np.mean(errors > 0.30)),
                "Your last number is the share of the errors beyond 0.30 m; the task asks for the others.",
            ),
            Mistake(
                lambda errors: tuple(np.round(table_row(errors), 3)),
                "You round to three digits, as the example is printed. Give the numbers as they come out.",
            ),
        ),
        tolerance=1e-9,
    ),
    Exercise(
        number="08.3",
        solution=lost_since,
        inputs=_scores,
        cases=(
            _alternating,
            _starts_low,
            _twice_lost,
            _shorter_than_patience,
            _low_from_the_start,
            _never_low,
        ),
        mistakes=(
            Mistake(
                lambda scores, limit, patience: _counter(scores, limit, patience, lambda n: 1),
                "A good score sets your counter to 1. It counts low scores, and after a good one there is none.",
            ),
            Mistake(
                lambda scores, limit, patience: lost_since(-scores, -limit, patience),
                "You count scores *above* the limit. Low ones raise the alarm.",
            ),
            Mistake(
                lambda scores, limit, patience: _first_window(scores, limit, patience, np.median),
                "You take the median of a row. A single good score ends the row: each of them must be low.",
            ),
            Mistake(
                _row_ended,
                "You wait for the end of the whole row. The alarm comes as soon as `patience` scores are complete.",
            ),
            Mistake(
                lambda scores, limit, patience: _counter(scores, limit, patience, lambda n: max(n - 1, 0)),
                "Your counter goes down by one at a good score. In a row means: a good score ends the row.",
            ),
            Mistake(
                lambda scores, limit, patience: _counter(scores, limit, patience, lambda n: n // 2),
                "Your counter is halved at a good score. In a row means: start again from nothing.",
            ),
            Mistake(
                _short_first_windows,
                "In the first frames your window holds fewer than `patience` scores, and yours takes them for a row.",
            ),
            Mistake(_last_alarm, "That is the last frame of an alarm. Asked for is the first one: stop there."),
            Mistake(
                _length_for_never,
                "Where the filter is never lost yours says the number of frames. The task asks for -1.",
            ),
            Mistake(_first_dip, "You raise the alarm at the first low score. A person who walks by would do that."),
            Mistake(
                _counted_in_all,
                "You count all low scores together. Start again from 0 whenever a score is good: in a row.",
            ),
            Mistake(
                _start_of_dip,
                "You name the frame where the row begins. Nobody can know that yet: name the one where it is complete.",
            ),
            Mistake(_one_late, "You wait one frame too long: the row is complete with its patience-th low score."),
            Mistake(_from_one, "Your frame is one too high: do you count frames from 1? The first is frame 0."),
            Mistake(_equal_is_low, "A score equal to the limit is not below it."),
            Mistake(_last_left_out, "You never look at the last score: the row may be complete with just that one."),
            Mistake(
                _over_the_end,
                "Near the end fewer than `patience` scores are left, and yours takes them for a whole row.",
            ),
            Mistake(
                _averaged,
                "You take the mean of a row: one very low score then hides a good one. Each of them must be low.",
            ),
            Mistake(
                _convolved,
                "np.convolve gives the mean of a row: one very low score hides a good one. Each of them must be low.",
            ),
            Mistake(
                lambda scores, limit, patience: -1,
                "Yours says -1 whatever the scores are. Does the -1 stand inside the loop? It belongs after it.",
            ),
            Mistake(_gives_up, "Yours gives up at the first good score. That only starts the count again: go on."),
            Mistake(_zero_for_never, "Where the filter is never lost yours says frame 0. The task asks for -1."),
        ),
    ),
    Exercise(
        number="08.4",
        solution=effective_frames,
        inputs=_run_length_and_likeness,
        level="challenge",
        cases=(_independent, _all_the_same, _taking_turns, _four_frames, _fallons_run),
        mistakes=(
            Mistake(
                lambda n, a: n / (1 + (n - 1) * a),
                "You take all pairs for equally alike. Frames k apart have the correlation a^k, which falls.",
            ),
            Mistake(
                lambda n, a: min(float(n), effective_frames(n, a)),
                "You stop at n. Errors that take turns (a below 0) cancel: they are worth more than n.",
            ),
            Mistake(
                lambda n, a: effective_frames(n, abs(a)),
                "You take the absolute value of a. Errors that take turns, a below 0, cancel: keep the sign.",
            ),
            Mistake(
                lambda n, a: float(round(effective_frames(n, a))),
                "You round to whole frames. Leave the number as it comes.",
            ),
            Mistake(
                lambda n, a: float(int(effective_frames(n, a))),
                "You cut the decimals off. Leave the number as it comes.",
            ),
            Mistake(
                lambda n, a: n**2 / (n + 2 * sum((n - k) * a**k for k in range(1, n - 1))),
                "The farthest pair is missing: the first frame and the last are n - 1 apart.",
            ),
            Mistake(
                lambda n, a: n**2 / (n + 2 * sum((n - k + 1) * a**k for k in range(1, n))),
                "You count one pair too many at every distance: 4 frames have 3 pairs of neighbours.",
            ),
            Mistake(
                lambda n, a: n / (1 + 2 * sum((n - k) * a**k for k in range(1, n))),
                "One division by n is missing: of n errors the *share* with a partner k frames on is (n - k) / n.",
            ),
            Mistake(
                lambda n, a: n * (1 - a) / (1 + a),
                "Close: that is the limit of long runs. Near the ends a frame has fewer neighbours: sum over pairs.",
            ),
            Mistake(
                lambda n, a: n / (1 + sum((1 - k / n) * a**k for k in range(1, n))),
                "Every pair counts twice: frame 3 with frame 5, and frame 5 with frame 3.",
            ),
            Mistake(
                lambda n, a: n / (1 + 2 * a * (n - 1) / n),
                "You count direct neighbours only. Frames two apart are alike as well, by a * a, and so on.",
            ),
            Mistake(
                lambda n, a: n / (1 + 2 * sum(a**k for k in range(1, n))),
                "How many pairs are k apart? Not n: only n - k.",
            ),
            Mistake(
                lambda n, a: effective_frames(n, a) / n,
                "That is the share of the frames that counts. Asked for is their number.",
            ),
            Mistake(
                lambda n, a: n / effective_frames(n, a),
                "That is by how much the variance grows. Divide n by it.",
            ),
            Mistake(
                lambda n, a: n / np.sqrt(n / effective_frames(n, a)),
                "Compare variances, not standard deviations: no root.",
            ),
            Mistake(lambda n, a: n * (1 - a), "A guess? Write down the variance of the sum of n errors, pair by pair."),
            Mistake(lambda n, a: n * (1 - a**2), "That is how much *new* each frame brings, not what the mean gains."),
            Mistake(
                lambda n, a: n / (2 * sum((1 - k / n) * a**k for k in range(n))),
                "A frame with itself counts once, not twice: only pairs of different frames are doubled.",
            ),
            Mistake(lambda n, a: float(n), "That is for independent frames. These are alike: a of their neighbours."),
        ),
    ),
]
