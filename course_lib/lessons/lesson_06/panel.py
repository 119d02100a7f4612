"""Lesson 06's panel: alpha, beta and a person before the lens."""

import functools

import numpy as np

from course_lib.depth_mcl.likelihood import likelihood, normalize_likelihood, valid_pixels, weights
from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider
from course_lib.lessons.lesson_06.profiles import (
    AXES,
    FORMS,
    N_PLACES,
    behind_a_person,
    peak,
    profile,
    small_scene,
    views_along,
)
from course_lib.plots import figures


def likelihood_panel() -> Panel:
    """Sliders for alpha, beta and a person before the lens; the likelihoods along one axis, and the paper's weights."""
    scene = small_scene()
    for name in AXES:
        views_along(name)
    figure, (pixel, along, weight) = figures.new_figure(1, 3, size=(9.8, 3.5))
    difference = np.linspace(0, 1, 101)
    (term,) = pixel.plot(difference, difference, color=figures.BLUE, linewidth=1.8)
    (half,) = pixel.plot([0.1], [0.5], "o", color=figures.VERMILION, markersize=8, label="alpha: counts half")
    pixel.set(title="One pixel's term of eq. (8)", xlabel="difference |dz| [m]", ylabel="term [-]", ylim=(0, 1.05))
    pixel.legend(loc="upper right")
    unit = np.linspace(-1, 1, N_PLACES)  # shares of the reach: the tick labels follow the axis
    curves = {}
    for index, name in enumerate(FORMS):
        style = figures.line_style(index) | {"markevery": 5, "markersize": 4}
        (curves[name],) = along.plot(unit, unit, **style, label=name)
    along.set(title="Normalized likelihood, eq. (9)", ylabel="normalized [-]", ylim=(-0.03, 1.62))
    along.legend(loc="upper center", ncols=2, fontsize=7, framealpha=0.95, columnspacing=1.0)
    (stems,) = weight.plot(unit, unit, **(figures.line_style(0) | {"markersize": 4, "linewidth": 0.8}))
    weight.set(title="Weight w of the paper, eq. (10)", ylabel="weight w [-]", ylim=(-0.03, 1.1))
    ends = []
    for axes in (along, weight):
        axes.axvline(0, color="0.5", linewidth=0.9, linestyle=(0, (6, 3)))
        axes.set(xlim=(-1.05, 1.05), xticks=np.linspace(-1, 1, 5), xticklabels=["", "", "0", "", ""])
        axes.set_xlabel("offset from the truth [m or degrees]")
        place = {"ha": "center", "va": "top", "fontsize": 9, "transform": axes.get_xaxis_transform(), "clip_on": False}
        # Only the two ends: text is what takes longest to draw.
        ends += [(sign, axes.text(sign, -0.03, "", **place)) for sign in (-1, 1)]
    live = LiveFigure(figure, [term, half, *curves.values(), stems, *(text for _, text in ends)])

    def draw(alpha: float, beta: float, hidden: float, axis: str) -> Drawing:
        chosen = AXES[axis]
        measured = behind_a_person(scene.measured, hidden)
        term.set_ydata(alpha / (alpha + difference))
        half.set_data([alpha], [0.5])
        raw = likelihood(measured, views_along(axis), alpha)
        profiles = _profiles(axis, hidden) | {"paper, eq. (8)": normalize_likelihood(raw)}
        for name, curve in curves.items():
            curve.set_ydata(profiles[name])
        w = weights(profiles["paper, eq. (8)"], beta)
        w = w / w.max()
        stems.set_ydata(w)
        for sign, text in ends:
            text.set_text(f"{sign * chosen.reach:g}")
        off = ", ".join(f"{name} {peak(chosen, profiles[name])[0]:.2g}" for name in FORMS)
        lines = [
            f"along {axis}: the best of {N_PLACES} cameras is off by [{chosen.unit}]: {off}",
            f"paper: width at half height {peak(chosen, profiles['paper, eq. (8)'])[1]:.2f} {chosen.unit}; "
            f"cameras with w of at least 0.5: {(w >= 0.5).sum()}; "
            f"raw score of the best, l / m: {raw.max() / valid_pixels(measured).sum():.2f}",
        ]
        alt = (
            f"One pixel's term of eq. (8) for alpha {alpha:g} m; four likelihoods along {axis}, {hidden:.0%} of the "
            f"view hidden by a person; and the paper's weights for beta {beta:g}. {' '.join(lines)}"
        )
        return Drawing(live.png(), alt, "\n".join(lines))

    controls = [
        Slider("alpha", "alpha [m]", 0.01, 1.0, 0.1, 0.01),
        Slider("beta", "beta [-]", 0.002, 0.5, 0.01, 0.002),
        Slider("hidden", "hidden by a person [share]", 0.0, 0.95, 0.0, 0.05),
        Choice("axis", "axis", tuple(AXES), "x"),
    ]
    return Panel("06 likelihood sliders", controls, draw)


@functools.lru_cache(maxsize=256)
def _profiles(axis_name: str, hidden: float) -> dict[str, np.ndarray]:
    """The forms without alpha: they change with the axis and the person only."""
    measured = behind_a_person(small_scene().measured, hidden)
    return {name: profile(form, axis_name, measured) for name, form in FORMS.items() if name != "paper, eq. (8)"}


PANELS = {"06 likelihood sliders": likelihood_panel}
