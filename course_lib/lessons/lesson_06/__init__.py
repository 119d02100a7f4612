"""Lesson 06, likelihood and weights: one depth image of the corridor, four likelihoods, and their panel."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from course_lib.depth_mcl.fallon import DEPTH_CUT, DEPTH_SIGMA, depth_log_likelihood, disparity_log_likelihood
from course_lib.depth_mcl.likelihood import ALPHA, likelihood, normalize_likelihood, valid_pixels, weights
from course_lib.depth_mcl.rendering.renderer import DepthRenderer
from course_lib.depth_mcl.scene_map import SceneMap
from course_lib.depth_mcl.sensor import subsample_depth
from course_lib.depth_mcl.sequence import read_sequence
from course_lib.geometry import state_from_optical_pose
from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider
from course_lib.lessons.kit.paths import data_path
from course_lib.lessons.lesson_06.gaussian import gaussian_log_likelihood
from course_lib.plots import figures

FRAME = 100  # of the wagon's run: two people stand before the camera who are not in the map
SMALL = (44, 36)  # pixels of the small images: a sixteenth, so that a profile takes milliseconds
N_PLACES = 41  # cameras along one axis
PERSON_DEPTH = 1.2  # metres, of the person whom the panel puts before the lens

Form = Callable[[np.ndarray, np.ndarray], np.ndarray]
FORMS: dict[str, Form] = {
    "paper, eq. (8)": likelihood,
    "Gaussian": gaussian_log_likelihood,
    "half-normal + uniform": depth_log_likelihood,
    "disparity": disparity_log_likelihood,
}


class Axis(NamedTuple):
    """One of the six components of a state, and how far a profile reaches to each side."""

    name: str
    index: int
    reach: float
    """Metres, or degrees for an angle."""

    @property
    def unit(self) -> str:
        return "m" if self.index < 3 else "degrees"

    def offsets(self) -> np.ndarray:
        """Where the cameras of a profile stand, `(N_PLACES,)` metres or degrees from the truth."""
        return np.linspace(-self.reach, self.reach, N_PLACES)

    def states(self, truth: np.ndarray) -> np.ndarray:
        """States `(N_PLACES, 6)` that differ from the truth along this axis only."""
        states = np.tile(truth, (N_PLACES, 1))
        states[:, self.index] += self.offsets() if self.index < 3 else np.deg2rad(self.offsets())
        return states


AXES = {
    axis.name: axis
    for axis in (
        Axis("x", 0, 1.0),
        Axis("y", 1, 0.4),
        Axis("z", 2, 0.4),
        Axis("roll", 3, 15.0),
        Axis("pitch", 4, 15.0),
        Axis("yaw", 5, 15.0),
    )
}


class Scene(NamedTuple):
    """One frame of the wagon's run as a small image, and what draws the map for small images."""

    measured: np.ndarray
    """`(36, 44)` metres, NaN = no measurement."""
    truth: np.ndarray
    """`(6,)` where the camera was."""
    renderer: DepthRenderer


@functools.cache
def small_scene() -> Scene:
    """The frame of this lesson at 44 x 36 pixels. Small images are drawn faster by rays than by a window."""
    sequence = read_sequence(data_path("corridor/wagon"))
    camera = sequence.camera()
    small = camera.resized(*SMALL)
    renderer = DepthRenderer(SceneMap.load(data_path("corridor/map.ply")), small, "ray")
    truth = state_from_optical_pose(sequence.camera_to_world[FRAME])
    return Scene(subsample_depth(sequence.depth(FRAME), camera, small), truth, renderer)


@functools.cache
def views_along(axis_name: str) -> np.ndarray:
    """Simulated images `(N_PLACES, 36, 44)` of the cameras along one axis."""
    scene = small_scene()
    return scene.renderer.render(AXES[axis_name].states(scene.truth))


def profile(form: Form, axis_name: str, measured: np.ndarray | None = None) -> np.ndarray:
    """A likelihood of the cameras along an axis, `(N_PLACES,)`, spread over [0, 1] by eq. (9)."""
    measured = small_scene().measured if measured is None else measured
    return normalize_likelihood(form(measured, views_along(axis_name)))


def peak(axis: Axis, normalized: np.ndarray) -> tuple[float, float]:
    """How far the highest place of a profile is from the truth, and how wide it is at half height (outer crossings).

    Half height of what eq. (9) spreads: the lowest of the places in the row has 0, so the reach matters a little.
    """
    offsets = axis.offsets()
    fine = np.linspace(offsets[0], offsets[-1], 40001)
    high = fine[np.interp(fine, offsets, normalized) >= 0.5]
    return float(abs(offsets[normalized.argmax()])), float(high[-1] - high[0])


def peak_table(profiles: dict[str, dict[str, np.ndarray]]) -> str:
    """How far each form's best camera is from the truth along each axis, and how wide its peak is, as a text."""
    lines = [f"{'off / width':22}" + "".join(f"{f'{name} [{AXES[name].unit}]':>16}" for name in profiles)]
    for form in FORMS:
        found = [(AXES[name], *peak(AXES[name], forms[form])) for name, forms in profiles.items()]
        cells = [
            f"{off:.2f} / {width:.2f}" if axis.unit == "m" else f"{off:.1f} / {width:.0f}" for axis, off, width in found
        ]
        lines.append(f"{form:22}" + "".join(f"{cell:>16}" for cell in cells))
    return "\n".join(lines)


def behind_a_person(measured: np.ndarray, share: float) -> np.ndarray:
    """The measured image with a share of its columns, from the right, hidden by a person right before the lens."""
    hidden = measured.copy()
    columns = round(share * measured.shape[1])
    hidden[:, measured.shape[1] - columns :] = PERSON_DEPTH
    return hidden


def cost_of_a_pixel(difference: np.ndarray, alpha: float = ALPHA) -> dict[str, np.ndarray]:
    """What one pixel's difference [m] takes away from each form's sum, in units of what 1 m takes away.

    The disparity form has no such curve: there the cost depends on the depth as well.
    """
    d = np.append(np.asarray(difference, dtype=np.float64), 1.0)
    half_normal = np.where(d <= DEPTH_CUT, np.exp(-(d**2) / (2 * DEPTH_SIGMA**2)), 0.0)
    ratio = 0.01 * 2 / (DEPTH_SIGMA * np.sqrt(2 * np.pi)) / (0.99 / DEPTH_CUT)
    costs = {
        "paper, eq. (8)": d / (alpha + d),
        "Gaussian": d**2,
        "half-normal + uniform": np.log1p(ratio) - np.log1p(ratio * half_normal),
    }
    return {name: cost[:-1] / cost[-1] for name, cost in costs.items()}


def terms_figure(measured: np.ndarray, terms: dict[str, np.ndarray]) -> Figure:
    """The measured image, and for each particle the term of eq. (8) of every pixel (NaN where nothing was measured)."""
    figure, axes = figures.new_figure(1, 1 + len(terms), size=(10.2, 2.9))
    depth = figures.depth_image(axes[0], measured, "Measured", (0, 10))
    figures.colour_bar(figure, depth, axes[0])
    for a, (title, values) in zip(axes[1:], terms.items(), strict=True):
        image = figures.depth_image(a, values, title, (0, 1))
    figures.colour_bar(figure, image, axes[1:], "term of eq. (8) [-]")
    return figure


def cost_figure(difference: np.ndarray, costs: dict[str, np.ndarray]) -> Figure:
    """What one pixel costs in each form, over its difference."""
    figure, axes = figures.new_figure(size=(6.6, 3.0))
    for index, (name, cost) in enumerate(costs.items()):
        axes.plot(difference, cost, **(figures.line_style(index) | {"markevery": 0.08}), label=name)
    axes.set(title="What one wrong pixel costs", xlabel="difference |dz| [m]", ylabel="cost, 1 at 1 m [-]")
    axes.set(ylim=(0, 4))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure


def profiles_figure(profiles: dict[str, dict[str, np.ndarray]]) -> Figure:
    """Axis name -> form name -> profile `(N_PLACES,)`: one small plot for each of the six axes."""
    figure, plots = figures.new_figure(2, 3, size=(9.6, 5.2))
    for axes, (name, forms) in zip(plots.flat, profiles.items(), strict=True):
        axis = AXES[name]
        axes.axvline(0, color="0.5", linewidth=0.9, linestyle=(0, (6, 3)))
        for index, (form, values) in enumerate(forms.items()):
            style = figures.line_style(index) | {"markevery": 5, "markersize": 4}
            axes.plot(axis.offsets(), values, **style, label=form)
        axes.set(title=f"Along {name}", xlabel=f"{name} - truth [{axis.unit}]", ylabel="normalized [-]")
    handles, labels = plots.flat[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False)
    return figure


def weights_figure(normalized: np.ndarray, curves: dict[str, np.ndarray]) -> Figure:
    """Weight before normalization over the normalized likelihood, for several beta."""
    figure, axes = figures.new_figure(size=(6.0, 2.8))
    for index, (name, w) in enumerate(curves.items()):
        axes.plot(normalized, w, **(figures.line_style(index) | {"markevery": 0.1}), label=name)
    axes.set(title="Equation (10)", xlabel="normalized likelihood [-]", ylabel="weight w [-]", ylim=(-0.03, 1.08))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure


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
