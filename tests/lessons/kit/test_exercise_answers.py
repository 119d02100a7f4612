"""Answers that students gave: what is wrong fails with a hint that fits, and what is right by another way passes."""

import importlib
from pathlib import Path

import numpy as np
import pytest

from course_lib.lessons.kit.exercises import find_exercise, judge

pytestmark = pytest.mark.usefixtures("values_once")

# Seed 0 is that of `check`; the other shows that nothing hangs on one set of inputs.
SEEDS = range(2)
LEFT_OUT = "which case is left out?"


def table(errors):
    return np.median(errors), np.sqrt(np.mean(errors**2)), np.mean(errors <= 0.30)


def first_row(low, patience):
    """Frame at which `patience` True in a row are complete, by windows; -1 if never."""
    whole = [frame for frame in range(patience - 1, len(low)) if all(low[frame - patience + 1 : frame + 1])]
    return whole[0] if whole else -1


def window_skips_last(scores, limit, patience):
    for i in range(len(scores) - patience):
        if np.all(scores[i : i + patience] < limit):
            return i + patience - 1
    return -1


def window_runs_over(scores, limit, patience):
    for i in range(len(scores)):
        if np.all(scores[i : i + patience] < limit):
            return i + patience - 1
    return -1


def minus_one_in_the_loop(scores, limit, patience):
    in_a_row = 0
    for frame, score in enumerate(scores):
        in_a_row = in_a_row + 1 if score < limit else 0
        if in_a_row == patience:
            return frame
        return -1


def moving_average(scores, limit, patience):
    means = np.convolve(scores, np.ones(patience) / patience, mode="valid")
    below = np.flatnonzero(means < limit)
    return below[0] + patience - 1 if len(below) else -1


def counted_from_one(scores, limit, patience):
    frame = first_row(scores < limit, patience)
    return frame + 1 if frame >= 0 else -1


def segments(estimated, path):
    result = []
    for p in estimated[:, :2]:
        best = np.inf
        for a, b in zip(path[:-1, :2], path[1:, :2], strict=True):
            share = np.clip(np.dot(p - a, b - a) / np.dot(b - a, b - a), 0, 1)
            best = min(best, np.linalg.norm(a + share * (b - a) - p))
        result.append(best)
    return np.array(result)


WRONG = [
    ("08.1", segments, "lines between the points"),
    ("08.1", lambda e, p: np.array([np.abs(p[:, :2] - q).sum(axis=1).min() for q in e[:, :2]]), "add the ways"),
    ("08.2", lambda e: (*table(e)[:2], np.mean(e < 0.30)), "exactly 0.30 m"),
    ("08.2", lambda e: (*table(e)[:2], np.mean(e > 0.30)), "beyond 0.30 m"),
    ("08.2", lambda e: tuple(round(float(v), 3) for v in table(e)), "round to three digits"),
    ("08.2", lambda e: (table(e)[1], table(e)[0], table(e)[2]), "in another order"),
    ("08.2", lambda e: table(e)[:2], "returns a tuple of 2."),
    ("08.3", window_skips_last, "never look at the last score"),
    ("08.3", lambda s, limit, patience: first_row(s[:-1] < limit, patience), "never look at the last score"),
    ("08.3", window_runs_over, "for a whole row"),
    ("08.3", lambda s, limit, patience: first_row(s < 0.45, patience), LEFT_OUT),
    ("08.3", lambda s, limit, patience: first_row(s < limit, 2), LEFT_OUT),
    ("08.3", lambda s, limit, patience: first_row(s <= limit, patience), "equal to the limit"),
    ("08.3", counted_from_one, "count frames from 1"),
    ("08.3", minus_one_in_the_loop, "inside the loop"),
    ("08.3", moving_average, "mean of a row"),
    ("20.1", lambda raw, units, invalid: [[v / units if v else np.nan for v in row] for row in raw], "You take 0"),
    ("20.2", lambda k, s: np.diag([s, s, 1]) @ k, "half a pixel off"),
    (
        "20.2",
        lambda k, s: np.array([[s * k[0, 0], 0, k[0, 2] * s], [0, s * k[0, 0], k[1, 2] * s], [0, 0, 1]]),
        "differ",
    ),
    ("20.3", lambda u, v, h, d: np.median(d * (np.tan(np.pi * v / h) - np.tan(np.pi * u / h))), "from the horizon"),
    ("20.3", lambda u, v, h, d: np.median(d) * np.median(np.tan(np.pi * (u - v) / h)), "differ"),
]
RIGHT = [
    ("08.1", lambda e, p: [min(np.hypot(*(q - r)[:2]) for r in p) for q in e]),
    ("08.2", lambda e: np.array(table(e))),
    ("08.2", lambda e: list(table(e))),
    ("08.3", lambda s, limit, patience: first_row(s < limit, patience)),
    ("20.1", lambda raw, units, invalid: [[np.nan if v == invalid else v / units for v in row] for row in raw]),
    ("20.2", lambda k, s: np.array([[s, 0, s / 2 - 0.5], [0, s, s / 2 - 0.5], [0, 0, 1]]) @ k),
    ("20.3", lambda u, v, h, d: np.median(d * (1 / np.tan(np.pi * v / h) - 1 / np.tan(np.pi * u / h)))),
]


FILES = sorted(Path(__file__).parent.glob("answers_*.py"))
OTHERS = [importlib.import_module(f"{__package__}.{path.stem}") for path in FILES]
WRONG_ANSWERS = [*WRONG, *(answer for module in OTHERS for answer in module.WRONG)]
RIGHT_ANSWERS = [*RIGHT, *(answer for module in OTHERS for answer in module.RIGHT)]


def number_of(given):
    return given if isinstance(given, str) else ""


@pytest.mark.parametrize(("number", "answer", "words"), WRONG_ANSWERS, ids=number_of)
def test_a_wrong_answer_fails_with_a_hint_that_fits(number, answer, words):
    for seed in SEEDS:
        with np.errstate(divide="ignore", invalid="ignore"):
            verdict = judge(find_exercise(number), answer, seed)
        assert verdict.status == "wrong"
        assert words in verdict.message


@pytest.mark.parametrize(("number", "answer"), RIGHT_ANSWERS, ids=number_of)
def test_another_way_to_the_right_values_passes(number, answer):
    for seed in SEEDS:
        assert judge(find_exercise(number), answer, seed).status == "right"
