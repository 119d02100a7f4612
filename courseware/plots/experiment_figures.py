"""Figures of the experiments' tables: covariances that cover or not, sensor trouble, thresholds on a confidence."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure
from scipy.stats import chi2

from courseware.plots.figures import BLACK, line_style, new_figure

DIMENSIONS = 6
MIN_ERROR, MAX_ERROR = 0.02, 1000.0  # of the axis; what is farther off is drawn at its end
_TITLES = {"depth_xyyaw": "depth filter, wagon", "depth_6": "annealed filter, by hand", "stereo": "panoramas"}


def covariance_figure(runs: Mapping[str, Sequence[dict[str, list]]]) -> Figure:
    """Share of the frames whose normalized error squared, e' C^-1 e / 6, is at most x; a line for each row's runs.

    Left of the dashed line of the chi-squared distribution a filter is more exact than it says, right of it less.
    runs: of `experiments.six_degrees.run_frames`; those without a covariance are left out.
    """
    figure, axes = new_figure(size=(6.4, 4.6))
    x = np.geomspace(MIN_ERROR, MAX_ERROR, 300)
    axes.plot(x, 100 * chi2.cdf(DIMENSIONS * x, DIMENSIONS), "--", color=BLACK, linewidth=1.2, label="as it should be")
    for index, (name, own) in enumerate(runs.items()):
        errors, within = (
            np.concatenate([run[key] for run in own if key in run] or [[]])
            for key in ("normalized_error", "within_3_sigma")
        )
        errors = np.sort(np.clip(errors[np.isfinite(errors)], MIN_ERROR, MAX_ERROR))
        if not len(errors):
            continue
        share = 100 * np.arange(1, len(errors) + 1) / len(errors)
        label = f"{name}: {100 * within.mean():.1f} % within three sigma"
        axes.step(errors, share, where="post", **line_style(index) | {"marker": "", "label": label})
    axes.set(title="Does the covariance cover?", xscale="log", xlim=(MIN_ERROR, MAX_ERROR), ylim=(0, 101))
    axes.set_xlabel("squared error in units of its covariance, e' C$^{-1}$ e / 6")
    axes.set_ylabel("frames with at most this error [%]")
    figure.legend(loc="outside lower left", fontsize=8)
    return figure


def trouble_figure(results: Mapping[str, dict]) -> Figure:
    """A panel a method: the share of frames within the usual error ten good frames after each trouble.

    results: by method, as `demo trouble` stores them. Rows without a frame to judge have no bar.
    """
    figure = Figure(figsize=(1.0 + 4.2 * len(results), 4.4), layout="constrained")
    panels = figure.subplots(1, len(results), squeeze=False)[0]
    for axes, (name, result) in zip(panels, results.items(), strict=True):
        rows = result["rows"]
        troubles = list(dict.fromkeys(row["trouble"] for row in rows))
        shares = list(dict.fromkeys(row["share"] for row in rows))
        height = 0.8 / len(shares)
        for k, share in enumerate(shares):
            chosen = [(troubles.index(row["trouble"]), row) for row in rows if row["share"] == share and row["judged"]]
            places = [place - 0.4 + height * (k + 0.5) for place, _ in chosen]
            back = [100 * row["recovered"] / row["judged"] for _, row in chosen]
            beside = [100 * row["undisturbed"] / row["judged"] for _, row in chosen]
            axes.barh(places, back, height, color=f"C{k}", label=f"{100 * share:g} % of frames")
            axes.plot(beside, places, "k|", markersize=7, label="undisturbed" if k == 0 else None)
        axes.set(yticks=range(len(troubles)), yticklabels=troubles, title=_TITLES.get(name, name))
        axes.set(xlim=(0, 104), xlabel="within the usual error [%]")
        axes.invert_yaxis()
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=8)
    return figure


def risk_coverage_figure(curves: Mapping[str, Mapping[str, list[float]]]) -> Figure:
    """Share of the answers that are wrong over the share of poses answered, as the threshold falls; a line a name."""
    figure, axes = new_figure()
    for index, (name, curve) in enumerate(curves.items()):
        style = line_style(index) | {"marker": ""}
        axes.step(curve["coverage_percent"], curve["risk_percent"], where="post", label=name, **style)
    axes.set(title="What a threshold buys", xlabel="poses answered [%]", ylabel="of them wrong [%]", xlim=(0, 101))
    axes.set_ylim(0, max(0.5, 1.05 * max(max(curve["risk_percent"]) for curve in curves.values())))
    axes.legend()
    return figure
