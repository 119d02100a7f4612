"""Does the covariance cover? The errors of a filter in units of its own covariance, beside what they should be."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure
from scipy.stats import chi2

from course_lib.plots.figures import BLACK, line_style, new_figure

DIMENSIONS = 6
LEAST, GREATEST = 0.02, 1000.0  # of the axis; what is farther off is drawn at its end


def covariance_figure(
    runs: Mapping[str, Sequence[dict[str, list]]], title: str = "Does the covariance cover?"
) -> Figure:
    """Share of the frames whose normalized error squared, e' C^-1 e / 6, is at most x; a line for each row's runs.

    Left of the dashed line of the chi-squared distribution a filter is more exact than it says, right of it less.
    runs: of `experiments.six_degrees.run_frames`; those without a covariance are left out.
    """
    figure, axes = new_figure(size=(6.4, 4.6))
    x = np.geomspace(LEAST, GREATEST, 300)
    axes.plot(x, 100 * chi2.cdf(DIMENSIONS * x, DIMENSIONS), "--", color=BLACK, linewidth=1.2, label="as it should be")
    for index, (name, own) in enumerate(runs.items()):
        errors, within = (
            np.concatenate([run[key] for run in own if key in run] or [[]])
            for key in ("normalized_error", "within_3_sigma")
        )
        errors = np.sort(np.clip(errors[np.isfinite(errors)], LEAST, GREATEST))
        if not len(errors):
            continue
        share = 100 * np.arange(1, len(errors) + 1) / len(errors)
        label = f"{name}: {100 * within.mean():.1f} % within three sigma"
        axes.step(errors, share, where="post", **line_style(index) | {"marker": "", "label": label})
    axes.set(
        title=title,
        xlabel="squared error in units of its covariance, e' C$^{-1}$ e / 6",
        ylabel="frames with at most this error [%]",
        xscale="log",
        xlim=(LEAST, GREATEST),
        ylim=(0, 101),
    )
    figure.legend(loc="outside lower left", fontsize=8)
    return figure
