"""Figures of lesson 06, and its panel: alpha, beta and a person before the lens."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from course_lib.depth_mcl.likelihood import likelihood, normalize_likelihood, valid_pixels, weights
from courseware.lessons.kit.display import described
from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.panel import Choice, Drawing, Panel, Slider
from courseware.lessons.lesson_06 import forms
from courseware.lessons.lesson_06.forms import FORMS, N_PLACES, REACH, UNIT, peak, views_along
from courseware.plots import figures

SCENE_ALT = """A flat cloud of 200 arrowheads about the axes of the true pose: most are dark; the bright ones look the
    way the truth looks, and stand within a decimetre or two of it along the corridor."""


def terms_figure(measured: np.ndarray, terms: dict[str, np.ndarray]) -> Figure:
    """Draw the measured image, and for each particle every pixel's term of eq. (8) (NaN where nothing was measured)."""
    figure, axes = figures.new_figure(1, 1 + len(terms), size=(10.2, 2.9))
    figures.colour_bar(figure, figures.depth_image(axes[0], measured, "Measured", (0, 10)), axes[0])
    for a, (title, values) in zip(axes[1:], terms.items(), strict=True):
        image = figures.depth_image(a, values, title, (0, 1))
    figures.colour_bar(figure, image, axes[1:], "term of eq. (8) [-]")
    alt = """The measured image of a corridor with two people; the terms of particle A are bright except on the people
        and far away; those of particle B are dark nearly everywhere."""
    return described(figure, alt)


def cost_figure(difference: np.ndarray, costs: dict[str, np.ndarray]) -> Figure:
    """Draw what one pixel costs in each form, over its difference."""
    labels = {"title": "What one wrong pixel costs", "xlabel": "difference |dz| [m]", "ylabel": "cost, 1 at 1 m [-]"}
    alt = "Cost over difference: the Gaussian's parabola leaves the picture; the other two level off near 1."
    return described(figures.curves_figure(difference, costs, (6.6, 3.0), 0.08, **labels, ylim=(0, 4))[0], alt)


def weights_figure(normalized: np.ndarray, curves: dict[str, np.ndarray]) -> Figure:
    """Draw the weight before normalization over the normalized likelihood, for several beta."""
    labels = {"title": "Equation (10)", "xlabel": "normalized likelihood [-]", "ylabel": "weight w [-]"}
    alt = "Weight over normalized likelihood for four beta: the smaller beta, the later and steeper the rise to 1."
    return described(figures.curves_figure(normalized, curves, (6.0, 2.8), 0.1, **labels, ylim=(-0.03, 1.08))[0], alt)


def draw_profiles(axes: Axes, x: np.ndarray, profiles: dict[str, np.ndarray]) -> list:
    """Draw named profiles `(N_PLACES,)` over x, and return their lines."""
    axes.axvline(0, color="0.5", linewidth=0.9, linestyle=(0, (6, 3)))
    styles = [figures.line_style(index) | {"markevery": 5, "markersize": 4} for index in range(len(profiles))]
    return [axes.plot(x, profiles[name], **style, label=name)[0] for name, style in zip(profiles, styles, strict=True)]


def profiles_figure(profiles: dict[str, dict[str, np.ndarray]]) -> Figure:
    """Draw axis name -> form name -> profile `(N_PLACES,)`: one small plot for each of the six axes."""
    figure, plots = figures.new_figure(2, 3, size=(9.6, 5.2))
    for axes, (name, along) in zip(plots.flat, profiles.items(), strict=True):
        draw_profiles(axes, forms.offsets(name), along)
        axes.set(title=f"Along {name}", xlabel=f"{name} - truth [{UNIT[name]}]", ylabel="normalized [-]")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=4, frameon=False)
    alt = """Six plots, one for each axis: the paper's form has the narrowest peak at the truth, half-normal and
        disparity wider ones, and the Gaussian is ragged, with its highest place elsewhere on all axes but roll."""
    return described(figure, alt)


PAPER = "paper, eq. (8)"
CONTROLS = [
    Slider("alpha", "alpha [m]", 0.01, 1.0, 0.1, 0.01),
    Slider("beta", "beta [-]", 0.002, 0.5, 0.01, 0.002),
    Slider("hidden", "hidden by a person [share]", 0.0, 0.95, 0.0, 0.05),
    Choice("axis", "axis", tuple(REACH), "x"),
]


def behind_a_person(share: float) -> np.ndarray:
    """Return the measured image with a share of its columns, from the right, hidden by a person at 1.2 m."""
    hidden = forms.small_scene().measured.copy()
    hidden[:, hidden.shape[1] - round(share * hidden.shape[1]) :] = 1.2
    return hidden


def likelihood_panel() -> Panel:
    """Show one pixel's term, the likelihoods along one axis, and the paper's weights."""
    for axis in REACH:
        views_along(axis)  # drawn now, so that no redraw waits for them
    figure, (pixel, along, weight) = figures.new_figure(1, 3, size=(9.8, 3.5))
    difference, shares = np.linspace(0, 1, 101), np.linspace(-1, 1, N_PLACES)
    (term,) = pixel.plot(difference, difference, color=figures.BLUE, linewidth=1.8)
    (half,) = pixel.plot([0.1], [0.5], "o", color=figures.VERMILION, markersize=8, label="alpha: counts half")
    pixel.set(title="One pixel's term of eq. (8)", xlabel="difference |dz| [m]", ylabel="term [-]", ylim=(0, 1.05))
    pixel.legend(loc="upper right")
    curves = draw_profiles(along, shares, dict.fromkeys(FORMS, shares))
    along.set(title="Normalized likelihood, eq. (9)", ylabel="normalized [-]", ylim=(-0.03, 1.62))
    along.legend(loc="upper center", ncols=2, fontsize=7, framealpha=0.95, columnspacing=1.0)
    (stems,) = draw_profiles(weight, shares, {PAPER: shares})
    stems.set(markevery=None, linewidth=0.8)
    weight.set(title="Weight w of the paper, eq. (10)", ylabel="weight w [-]", ylim=(-0.03, 1.1))
    ends = []  # the only tick labels that move with the axis, because text is what takes longest to draw
    for axes in (along, weight):
        axes.set(xlim=(-1.05, 1.05), xticks=np.linspace(-1, 1, 5), xticklabels=["", "", "0", "", ""])
        axes.set_xlabel("offset from the truth [m or degrees]")
        place = {"ha": "center", "va": "top", "fontsize": 9, "transform": axes.get_xaxis_transform(), "clip_on": False}
        ends += [axes.text(sign, -0.03, "", **place) for sign in (-1, 1)]
    live = LiveFigure(figure, [term, half, *curves, stems, *ends])

    def draw(alpha: float, beta: float, hidden: float, axis: str) -> Drawing:
        measured = behind_a_person(hidden)
        raw = likelihood(measured, views_along(axis), alpha)
        profiles = {name: forms.profile(form, axis, measured) for name, form in FORMS.items()}
        profiles[PAPER] = normalize_likelihood(raw)
        w = weights(profiles[PAPER], beta)
        w = w / w.max()
        half.set_xdata([alpha])
        shown = [alpha / (alpha + difference), *profiles.values(), w]
        for line, values in zip([term, *curves, stems], shown, strict=True):
            line.set_ydata(values)
        for text in ends:
            text.set_text(f"{text.get_position()[0] * REACH[axis]:g}")
        off = ", ".join(f"{name} {peak(axis, values)[0]:.2g}" for name, values in profiles.items())
        summary = (
            f"along {axis}: the best of {N_PLACES} cameras is off by [{UNIT[axis]}]: {off}\n"
            f"paper: width at half height {peak(axis, profiles[PAPER])[1]:.2f} {UNIT[axis]}; "
            f"cameras with w of at least 0.5: {(w >= 0.5).sum()}; "
            f"raw score of the best, l / m: {raw.max() / valid_pixels(measured).sum():.2f}"
        )
        alt = f"""One pixel's term of eq. (8) for alpha {alpha:g} m; four likelihoods along {axis}, {hidden:.0%} of the
            view hidden by a person; and the paper's weights for beta {beta:g}. {summary}"""
        return Drawing(live.png(), alt, summary)

    return Panel("06 likelihood sliders", CONTROLS, draw)


PANELS = {"06 likelihood sliders": likelihood_panel}
