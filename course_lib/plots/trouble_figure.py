"""Recovery from sensor trouble: how many frames are within the usual error again, trouble by trouble."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

_TITLES = {"depth_xyyaw": "depth filter, wagon", "depth_6": "annealed filter, by hand", "stereo": "panoramas"}


def trouble_figure(results: Mapping[str, dict]) -> Figure:
    """A panel a method: the share of frames within the usual error ten good frames after each trouble.

    results: by method, as `demo trouble` stores them. Rows without a frame to judge have no bar.
    """
    figure = Figure(figsize=(1.0 + 4.2 * len(results), 4.4), layout="constrained")
    panels = np.atleast_1d(figure.subplots(1, len(results), squeeze=False)[0])
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
        axes.set(
            yticks=range(len(troubles)), yticklabels=troubles, xlim=(0, 104), xlabel="within the usual error [%]",
            title=_TITLES.get(name, name),
        )  # fmt: skip
        axes.invert_yaxis()
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=8)
    return figure
