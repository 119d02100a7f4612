"""Lesson 06's panel: alpha, beta and a person before the lens."""

import numpy as np

from course_lib.depth_mcl.likelihood import likelihood, normalize_likelihood, valid_pixels, weights
from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider
from course_lib.lessons.lesson_06.figures import draw_lines
from course_lib.lessons.lesson_06.forms import FORMS, peak, profile
from course_lib.lessons.lesson_06.places import N_PLACES, REACH, UNIT, small_scene, views_along
from course_lib.plots import figures

PAPER = "paper, eq. (8)"
PERSON_DEPTH = 1.2  # metres, of the person whom the panel puts before the lens
CONTROLS = [
    Slider("alpha", "alpha [m]", 0.01, 1.0, 0.1, 0.01),
    Slider("beta", "beta [-]", 0.002, 0.5, 0.01, 0.002),
    Slider("hidden", "hidden by a person [share]", 0.0, 0.95, 0.0, 0.05),
    Choice("axis", "axis", tuple(REACH), "x"),
]


def behind_a_person(share: float) -> np.ndarray:
    """The measured image with a share of its columns, from the right, hidden by a person right before the lens."""
    hidden = small_scene().measured.copy()
    hidden[:, hidden.shape[1] - round(share * hidden.shape[1]) :] = PERSON_DEPTH
    return hidden


def likelihood_panel() -> Panel:
    """Sliders for alpha, beta and a person before the lens; the likelihoods along one axis, and the paper's weights."""
    for axis in REACH:
        views_along(axis)  # drawn now, so that no redraw waits for them
    figure, (pixel, along, weight) = figures.new_figure(1, 3, size=(9.8, 3.5))
    difference, shares = np.linspace(0, 1, 101), np.linspace(-1, 1, N_PLACES)
    (term,) = pixel.plot(difference, difference, color=figures.BLUE, linewidth=1.8)
    (half,) = pixel.plot([0.1], [0.5], "o", color=figures.VERMILION, markersize=8, label="alpha: counts half")
    pixel.set(title="One pixel's term of eq. (8)", xlabel="difference |dz| [m]", ylabel="term [-]", ylim=(0, 1.05))
    pixel.legend(loc="upper right")
    curves = draw_lines(along, shares, dict.fromkeys(FORMS, shares), markevery=5, markersize=4)
    along.set(title="Normalized likelihood, eq. (9)", ylabel="normalized [-]", ylim=(-0.03, 1.62))
    along.legend(loc="upper center", ncols=2, fontsize=7, framealpha=0.95, columnspacing=1.0)
    (stems,) = weight.plot(shares, shares, **(figures.line_style(0) | {"markersize": 4, "linewidth": 0.8}))
    weight.set(title="Weight w of the paper, eq. (10)", ylabel="weight w [-]", ylim=(-0.03, 1.1))
    ends = []  # the only tick labels that move with the axis, because text is what takes longest to draw
    for axes in (along, weight):
        axes.axvline(0, color="0.5", linewidth=0.9, linestyle=(0, (6, 3)))
        axes.set(xlim=(-1.05, 1.05), xticks=np.linspace(-1, 1, 5), xticklabels=["", "", "0", "", ""])
        axes.set_xlabel("offset from the truth [m or degrees]")
        place = {"ha": "center", "va": "top", "fontsize": 9, "transform": axes.get_xaxis_transform(), "clip_on": False}
        ends += [axes.text(sign, -0.03, "", **place) for sign in (-1, 1)]
    live = LiveFigure(figure, [term, half, *curves, stems, *ends])

    def draw(alpha: float, beta: float, hidden: float, axis: str) -> Drawing:
        measured = behind_a_person(hidden)
        raw = likelihood(measured, views_along(axis), alpha)
        profiles = {name: profile(form, axis, measured) for name, form in FORMS.items()}
        profiles[PAPER] = normalize_likelihood(raw)
        w = weights(profiles[PAPER], beta)
        w = w / w.max()
        half.set_data([alpha], [0.5])
        shown = [alpha / (alpha + difference), *profiles.values(), w]
        for line, values in zip([term, *curves, stems], shown, strict=True):
            line.set_ydata(values)
        for index, text in enumerate(ends):
            text.set_text(f"{(2 * (index % 2) - 1) * REACH[axis]:g}")
        off = ", ".join(f"{name} {peak(axis, values)[0]:.2g}" for name, values in profiles.items())
        lines = [
            f"along {axis}: the best of {N_PLACES} cameras is off by [{UNIT[axis]}]: {off}",
            f"paper: width at half height {peak(axis, profiles[PAPER])[1]:.2f} {UNIT[axis]}; "
            f"cameras with w of at least 0.5: {(w >= 0.5).sum()}; "
            f"raw score of the best, l / m: {raw.max() / valid_pixels(measured).sum():.2f}",
        ]
        alt = (
            f"One pixel's term of eq. (8) for alpha {alpha:g} m; four likelihoods along {axis}, {hidden:.0%} of the "
            f"view hidden by a person; and the paper's weights for beta {beta:g}. {' '.join(lines)}"
        )
        return Drawing(live.png(), alt, "\n".join(lines))

    return Panel("06 likelihood sliders", CONTROLS, draw)


PANELS = {"06 likelihood sliders": likelihood_panel}
