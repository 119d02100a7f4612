"""Exercises of lesson 08: the paper's error, a row of its table 1, noticing a loss, what frames that are alike say."""

import numpy as np

from course_lib.lessons.kit.exercises import Exercise

# 08.1: distance to the nearest point of the path


def nearest_distances(estimated, path):
    """Horizontal distance in metres (T,) from estimates (T, 3) to the nearest point of a path (P, 3)."""
    # Distances from each estimate to all points of the path; keep the least.
    distances = [np.linalg.norm(path[:, :2] - p, axis=1) for p in estimated[:, :2]]
    return np.min(distances, axis=1)


def track_and_path(rng: np.random.Generator) -> tuple:
    n, p = int(rng.integers(4, 8)), int(rng.integers(9, 15))
    # The floor is uneven and the camera bobs: the nearest point in space need not be the nearest on the floor.
    path = np.column_stack([np.linspace(0, 6, p), 0.3 * rng.normal(size=p), 0.2 * rng.normal(size=p)])
    return np.column_stack([rng.uniform(0, 6, n), rng.normal(0, 0.3, n), rng.uniform(0.8, 1.2, n)]), path


def all_errors_zero(rng: np.random.Generator) -> tuple:
    """Estimates above points of the path, in another order."""
    path = np.column_stack([np.arange(6.0), rng.normal(size=6), np.zeros(6)])
    return path[[4, 0, 2]] + [0.0, 0.0, 1.0], path


def a_single_estimate(rng: np.random.Generator) -> tuple:
    return rng.normal(size=(1, 3)), rng.normal(size=(2, 3))


def a_hump_in_the_floor(rng: np.random.Generator) -> tuple:
    """The nearest point in space, on a hump of the floor, is not the nearest on the floor plan."""
    return np.array([[1.3, 0.1, 1.0]]), np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.9]])


def nearest_by(estimated, path, columns):
    """A mistake: the point of the path that is nearest in other columns than x and y."""
    apart = estimated[:, None, columns] - path[:, columns]
    return np.linalg.norm(estimated[:, :2] - path[np.linalg.norm(apart, axis=2).argmin(axis=1), :2], axis=1)


def to_lines(estimated, path):
    """A mistake: the distance to the lines between the points of the path."""
    start, along = path[:-1, :2], np.diff(path[:, :2], axis=0)
    share = ((estimated[:, None, :2] - start) * along).sum(axis=2) / (along**2).sum(axis=1)
    nearest = start + np.clip(share, 0, 1)[:, :, None] * along
    return np.linalg.norm(estimated[:, None, :2] - nearest, axis=2).min(axis=1)


# 08.2: the three numbers of a row of table 1


def table_row(errors):
    """Median [m], sigma about zero [m], and share of errors of at most 0.30 m."""
    # Median, root mean square about zero, share within three of the paper's sigma.
    return np.median(errors), np.sqrt(np.mean(errors**2)), np.mean(errors <= 0.30)


def errors_of_a_run(rng: np.random.Generator) -> tuple:
    errors = np.abs(rng.normal(0.1, 0.2, rng.integers(12, 30))) + 0.05
    errors[rng.integers(errors.size)] = 0.30  # exactly at the gate: "at most" lets it in
    return (errors,)


def all_errors_equal(rng: np.random.Generator) -> tuple:
    """A filter that is off by the same everywhere, by just the limit: no scatter, and yet an error."""
    return (np.full(int(rng.integers(3, 9)), 0.30),)


# 08.3: since when has the filter been lost?


def lost_since(scores, limit, patience):
    """Frame at which `patience` scores in a row are below `limit` for the first time; -1 if never."""
    # Count low scores in a row; a good score starts the count again.
    in_a_row = 0
    for frame, score in enumerate(scores):
        in_a_row = in_a_row + 1 if score < limit else 0
        if in_a_row == patience:
            return frame
    return -1


def scores_with_dips(rng: np.random.Generator) -> tuple:
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


def short_dips_only(rng: np.random.Generator) -> tuple:
    """Rows that are one too short, with single good scores between them: nothing may be carried over."""
    return np.where([letter == "l" for letter in "llllhllllhhhllhlllh"], 0.2, 0.7), 0.5, 5


def low_in_the_first_frames(rng: np.random.Generator) -> tuple:
    """Low in the first frames, but not for long enough; later long enough."""
    return np.array([0.2, 0.3, 0.9, 0.8, 0.9, 0.1, 0.2, 0.1, 0.2, 0.9]), 0.5, 3


def lost_twice(rng: np.random.Generator) -> tuple:
    return np.array([0.9, 0.2, 0.2, 0.2, 0.9, 0.9, 0.1, 0.2, 0.1]), 0.5, 2


def fewer_scores_than_patience(rng: np.random.Generator) -> tuple:
    return np.array([0.1, 0.2]), 0.5, 4


def lost_from_the_start(rng: np.random.Generator) -> tuple:
    return np.full(6, 0.1), 0.5, 3


def never_low(rng: np.random.Generator) -> tuple:
    return np.full(8, 0.9), 0.5, 2


def first_window(scores, limit, patience, measure, first=None):
    """A mistake: the first frame with a low `measure` of the last `patience` scores."""
    first = patience - 1 if first is None else first
    low = [f for f in range(first, len(scores)) if measure(scores[max(0, f - patience + 1) : f + 1]) < limit]
    return low[0] if low else -1


def convolved(scores, limit, patience):
    """A mistake: means by np.convolve, which exchanges its two arrays where the first is the shorter one."""
    low = np.flatnonzero(np.convolve(scores, np.ones(patience) / patience, mode="valid") < limit)
    return low[0] + patience - 1 if len(low) else -1


# 08.4: what frames that are alike are worth


def effective_frames(n, a):
    """Number of independent errors whose mean is as sure as that of n errors of correlation a^k at k frames apart."""
    # Sum the correlations of all n^2 pairs. For our runs: 164 frames of 304 for ours, about 2 for Fallon's.
    pairs = sum((n - k) * a**k for k in range(1, n))  # those k apart, each once
    return n**2 / (n + 2 * pairs)


def length_and_likeness(rng: np.random.Generator) -> tuple:
    return int(rng.integers(3, 60)), float(rng.uniform(0.05, 0.95))


def independent_frames(rng: np.random.Generator) -> tuple:
    return int(rng.integers(3, 60)), 0.0


def all_the_same(rng: np.random.Generator) -> tuple:
    return int(rng.integers(3, 60)), 1.0


def a_below_zero(rng: np.random.Generator) -> tuple:
    """Errors that tend to change their sign: their mean is surer than that of independent ones."""
    return int(rng.integers(3, 60)), float(rng.uniform(-0.8, -0.2))


def four_frames(rng: np.random.Generator) -> tuple:
    return 4, 0.5


def a_long_run(rng: np.random.Generator) -> tuple:
    return 304, 0.99


# fmt: off
EXERCISES = [
    Exercise("08.1", nearest_distances, track_and_path, "warm-up", cases=[
        all_errors_zero, a_single_estimate, a_hump_in_the_floor,
    ], mistakes="""
        path[:, :2] - p => path - p and also estimated[:, :2] => estimated
        Your distance includes z: the camera is a metre above the line on the floor. Use x and y only.
        ... => return nearest_by(estimated, path, [0, 1, 2])
        You search in space and measure on the floor. Leave out z before you search, not after.
        ... => return nearest_by(estimated, path, [0])
        You take the point with the nearest x. Where the path bends, another point may be nearer.
        [:, :2] => [:, 1:]
        You take the columns y and z. The floor is x and y, the first two.
        [:, :2] => [:, :1]
        [:, :2] => [:, 1:2]
        You look at x or at y alone. The distance on the floor has two parts, x and y.
        path[:, :2] - p, axis=1 => path[:, :2] - p, 1, axis=1
        path[:, :2] - p, axis=1 => path[:, :2] - p, np.inf, axis=1
        You add the ways along x and y, or take the larger. The straight way is the root of the sum of their squares.
        ... => return np.hypot(*[np.abs(path[:, k] - estimated[:, [k]]).min(axis=1) for k in (0, 1)])
        Your nearest x and nearest y may be of two points: distances first, then the minimum.
        ... => return np.linalg.norm(estimated[:, :2] - path[: len(estimated), :2], axis=1)
        You compare point k with estimate k. Nobody says that they belong together: search the whole path.
        np.min(distances => np.argmin(distances
        argmin tells which point is nearest, its number; the task asks how far it is, in metres.
        np.min(distances => np.mean(distances
        That is the mean distance to all points of the path. Only the nearest one counts.
        ... => return np.array([np.linalg.norm(path[:, :2] - p) for p in estimated[:, :2]])
        You sum over the whole path. np.linalg.norm needs axis=1 to give one distance for each point.
        ... => return to_lines(estimated, path)
        You measure to the lines between the points of the path. Here only the points themselves count.
    """),
    Exercise("08.2", table_row, errors_of_a_run, cases=[all_errors_equal], tolerance=1e-9, mistakes="""
        np.median(errors) => np.sort(errors)[len(errors) // 2]
        np.median(errors) => np.sort(errors)[(len(errors) - 1) // 2]
        For an even number of errors yours is one of the middle two; a median lies halfway between.
        np.median(errors) => errors[len(errors) // 2]
        Yours is the middle frame. A median is the middle of the errors *sorted* by size.
        np.sqrt(np.mean(errors**2)) => np.std(errors)
        np.std measures the scatter about the mean: a constant error of 5 m would get 0. Take it about zero.
        np.sqrt(np.mean(errors**2)) => np.std(errors, ddof=1)
        np.sqrt(np.mean(errors**2)) => np.sqrt(np.mean((errors - np.median(errors)) ** 2))
        Your sigma is about the mean or the median. Here it is about zero: nothing is subtracted.
        np.sqrt(np.mean(errors**2)) => np.mean(errors)
        Your sigma is the mean error. Square the errors, take the mean, then the root.
        np.sqrt(np.mean(errors**2)) => np.sqrt(np.sum(errors**2)) / len(errors)
        np.sqrt(np.mean(errors**2)) => np.linalg.norm(errors)
        Root *mean* square: divide the sum of the squares by T, before you take the root, not after the root.
        np.mean(errors**2) => np.sum(errors**2) / (len(errors) - 1)
        You divide by T - 1: that is for scatter about an estimated mean. Here it is the mean of T squares.
        errors <= 0.30 => errors <= 3 * np.sqrt(np.mean(errors**2))
        You use three of the run's own sigma: a bad run would then get a wide gate. It is 0.30 m for all.
        np.mean(errors <= 0.30) => 100 * np.mean(errors <= 0.30)
        np.mean(errors <= 0.30) => np.sum(errors <= 0.30)
        Your last number is in percent, or counts frames. It is a share from 0 to 1.
        errors <= 0.30 => errors > 0.30
        Your last number is the share of the errors beyond 0.30 m; the task asks for the others.
    """),
    Exercise("08.3", lost_since, scores_with_dips, cases=[
        short_dips_only, low_in_the_first_frames, lost_twice, fewer_scores_than_patience, lost_from_the_start,
        never_low,
    ], mistakes="""
        in_a_row == patience => in_a_row == 1
        You raise the alarm at the first low score. A person who walks by would do that.
        else 0 => else in_a_row
        You count all low scores together. Start again from 0 whenever a score is good: in a row.
        else 0 => else max(in_a_row - 1, 0)
        else 0 => else in_a_row // 2
        else 0 => else 1
        In a row means: a good score sets the counter to 0. It neither lowers it a little nor sets it to 1.
        score < limit => score > limit
        You count scores *above* the limit. Low ones raise the alarm.
        in_a_row == patience => in_a_row > patience
        You wait one frame too long: the row is complete with its patience-th low score.
        in_a_row == patience => in_a_row >= patience and not (scores[frame + 1 : frame + 2] < limit).any()
        You wait for the end of the whole row. The alarm comes as soon as `patience` scores are complete.
        return frame => return frame - patience + 1
        You name the frame where the row begins. Nobody can know that yet: name the one where it is complete.
        return frame => return frame + 1
        Your frame is one too high: do you count frames from 1? The first is frame 0.
        ... => k = lost_since(scores[::-1], limit, patience); return -1 if k < 0 else len(scores) + patience - 2 - k
        That is the last frame of an alarm. Asked for is the first one: stop there.
        ... => return first_window(scores, limit, patience, np.mean)
        ... => return first_window(scores, limit, patience, np.median)
        ... => return convolved(scores, limit, patience)
        You take the mean of a row, or its median: a very low score hides a good one. Each of them must be low.
        ... => return first_window(scores, limit, patience, np.max, first=0)
        In the first frames your window holds fewer than `patience` scores, and yours takes them for a row.
        ... => return lost_since(np.append(scores, np.zeros(patience - 1)), limit, patience)
        Near the end fewer than `patience` scores are left, and yours takes them for a whole row.
        enumerate(scores) => enumerate(scores[:-1])
        You never look at the last score: the row may be complete with just that one.
        return -1 => return len(scores)
        return -1 => return 0
        Where the filter is never lost yours says frame 0 or the number of frames. The task asks for -1.
        ... => return -1
        Yours says -1 whatever the scores are. Does the -1 stand inside the loop? It belongs after it.
    """),
    Exercise("08.4", effective_frames, length_and_likeness, "challenge", cases=[
        independent_frames, all_the_same, a_below_zero, four_frames, a_long_run,
    ], mistakes="""
        a**k => a
        You take all pairs for equally alike. Frames k apart have the correlation a^k, which falls.
        ... => return n * (1 - a) / (1 + a)
        ... => return n * (1 - a) / (1 + a) if a < 1 else 1
        Close: that is the limit of long runs. Near the ends a frame has fewer neighbours: sum over pairs.
        (n - k) * a**k => n * a**k
        How many pairs are k apart? Not n: only n - k.
        2 * pairs => pairs
        Every pair counts twice: frame 3 with frame 5, and frame 5 with frame 3.
        range(1, n) => range(n) and also n + 2 * pairs => 2 * pairs
        A frame with itself counts once, not twice: only pairs of different frames are doubled.
        range(1, n) => range(1, 2)
        You count direct neighbours only. Frames two apart are alike as well, by a * a, and so on.
        n**2 / (n + 2 * pairs) => n / (1 + 2 * pairs)
        One division by n is missing: of n errors the *share* with a partner k frames on is (n - k) / n.
        n**2 => n
        That is the share of the frames that counts. Asked for is their number.
        n**2 / (n + 2 * pairs) => (n + 2 * pairs) / n
        That is by how much the variance grows. Divide n by it.
        ... => return np.sqrt(n * effective_frames(n, a))
        Compare variances, not standard deviations: no root.
        a**k => abs(a) ** k
        ... => return min(n, effective_frames(n, a))
        Errors that take turns, a below 0, cancel: keep the sign of a, and do not stop at n.
        ... => return round(effective_frames(n, a))
        ... => return int(effective_frames(n, a))
        You round to whole frames. Leave the number as it comes.
        ... => return n * (1 - a)
        ... => return n * (1 - a**2)
        A guess? Write down the variance of the sum of n errors, pair by pair.
        ... => return n
        That is for independent frames. These are alike: a of their neighbours.
    """),
]
