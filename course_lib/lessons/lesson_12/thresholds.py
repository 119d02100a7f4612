"""Precision and recall over score thresholds, measured on four panoramas."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from course_lib.experiments.intervals import wilson_percent
from course_lib.experiments.room_evaluation import match_detections
from course_lib.lessons.kit.display import described
from course_lib.lessons.kit.progress_bar import progress
from course_lib.lessons.kit.room_photographs import room_recording
from course_lib.lessons.lesson_12.seam_cuts import LOWEST, detector
from course_lib.plots import figures

SCORED_PAIRS = (0, 3, 9, 15)  # of experiment 1, spread over the room (chosen)


class ThresholdScore(NamedTuple):
    """What a score threshold gives: boxes that are right, boxes made, objects that there are."""

    right: int
    made: int
    wanted: int


def precision_and_recall(thresholds: Sequence[float]) -> dict[float, ThresholdScore]:
    """Return the scores at IoU 0.5 over the upper images of `SCORED_PAIRS`. The network runs once an image."""
    record, scores = room_recording(1), {}
    pairs = [record.pairs[index] for index in SCORED_PAIRS]
    seen = [detector(LOWEST).detect(pair.images()[0]) for pair in progress(pairs, "detecting objects")]
    for threshold in thresholds:
        total = np.zeros(3, dtype=int)
        for pair, found in zip(pairs, seen, strict=True):
            kept = [one for one in found if one.score >= threshold]
            matching = match_detections(kept, pair.upper_objects, record.width)
            total += [matching.correct.sum(), len(matching.correct), matching.n_objects]
        scores[threshold] = ThresholdScore(*total.tolist())
    return scores


def threshold_figure(scores: dict[float, ThresholdScore], chosen: float) -> Figure:
    """Precision and recall over the score threshold, with Wilson's 95 % intervals."""
    figure, axes = figures.new_figure(size=(6.4, 3.2))
    for index, (name, of) in enumerate((("precision", "made"), ("recall", "wanted"))):
        counts = [(one.right, getattr(one, of)) for one in scores.values()]
        shares = np.array([right / total for right, total in counts])
        bars = np.abs(np.array([wilson_percent(*count) for count in counts]).T / 100 - shares)
        style = figures.line_style(index) | {"label": name, "capsize": 3}
        axes.errorbar(np.add(list(scores), 0.006 * index), shares, bars, **style)
    axes.axvline(chosen, color=figures.BLACK, linewidth=1.2, linestyle="--", label="chosen in training")
    axes.set(title="A threshold is a bargain", xlabel="score threshold [-]", ylabel="share [-]", ylim=(0.4, 1.02))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    alt = (
        "Precision rises from 0.88 to 1 and recall falls from 0.96 to 0.63 as the score threshold goes from 0.1 to 0.9;"
        " bars show the 95 % intervals."
    )
    return described(figure, alt)
