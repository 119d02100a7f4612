"""The filter stepper: buttons for the four steps of figure 1, the particles from above, weights, sample size."""

from collections.abc import Callable

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.patches import Rectangle

from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Drawing, Panel, Slider
from course_lib.lessons.lesson_07.filter_stepper import (
    ALLOWED_AFTER,
    FRAMES,
    MAX_PARTICLES,
    NotNowError,
    Settings,
    StepperState,
    Stretch,
    View,
    corridor_stretch,
    look,
    present_particles,
    start,
    step,
    whole_round,
)
from course_lib.plots import figures

_HEADING = 0.12  # metres, length of the line that shows where a particle looks


class StepperSession:
    """The present state of one panel, and the views of its particles, drawn once as long as they do not change."""

    def __init__(self, stretch: Stretch) -> None:
        self.stretch, self.state, self.message = stretch, start(stretch), ""
        self._drawn: tuple[bytes, np.ndarray] | None = None

    def view(self, settings: Settings) -> View:
        """What the present frame shows with these settings."""
        particles = present_particles(self.state, settings)
        if self._drawn is None or self._drawn[0] != particles.tobytes():
            self._drawn = particles.tobytes(), self.stretch.renderer.render(particles)
        return look(self.state, settings, self.stretch, self._drawn[1])

    def press(self, name: str, values: dict) -> dict:
        """Do a step; where it cannot come now, keep the state and say so."""
        self.message = ""
        try:
            self.state = step(self.state, name, self.view(settings_of(**values)))
        except NotNowError as error:
            self.message = f"Not now: {error}."
        return values

    def round(self, values: dict) -> dict:
        """Go on to the estimate of the next frame."""
        self.message = ""
        try:
            self.state = whole_round(self.state, settings_of(**values), self.stretch)
        except NotNowError as error:
            self.message = f"Not now: {error}."
        return values

    def reset(self) -> None:
        """Back to the first frame."""
        self.state, self.message = start(self.stretch), ""


def settings_of(alpha: float, beta: float, n_particles: float, noise: float, seed: float) -> Settings:
    """The sliders' values, whole numbers as such."""
    return Settings(alpha, beta, int(n_particles), noise, int(seed))


def describe(state: StepperState, view: View, true: np.ndarray, message: str) -> str:
    """The lines under the picture; what has not been computed yet is not told."""
    following = [name for name, after in ALLOWED_AFTER.items() if state.done in after]
    lines = [f"frame {state.frame} of {len(FRAMES) - 1}; last step: {state.done}; now: {' or '.join(following)}"]
    if message:
        lines.insert(0, message)
    if state.done == "propagate":
        lines.append("no weights yet: all particles weigh the same")
    elif state.done == "resample":
        lines.append(f"different particles: {len(np.unique(view.indices))} of {len(view.particles)}, all weights equal")
    else:
        lines.append(
            f"effective sample size {view.ess:.1f} of {len(view.particles)}; "
            f"largest weight {view.weights.max():.2f}; raw score of the best, l / m: {view.score:.2f}"
        )
    if state.done == "estimate":
        off = np.hypot(*(view.estimate[:2] - true[:2]))
        lines.append(f"estimate: off by {off:.2f} m, {abs(np.rad2deg(view.estimate[5] - true[5])):.1f} degrees")
    return "\n".join(lines)


def stepper_panel(title: str = "07 filter stepper") -> Panel:
    """The panel; every panel has a session of its own."""
    stretch = corridor_stretch()
    session = StepperSession(stretch)
    figure, (plan, weight, bar) = figures.new_figure(1, 3, size=(10.0, 3.5))
    plan.get_gridspec().set_width_ratios([2.6, 1.5, 0.5])
    plan.plot(*stretch.walls.T, ".", color="0.55", markersize=3, label="wall")
    plan.plot(*stretch.true[:, :2].T, color="0.45", linewidth=0.9, linestyle=(0, (6, 3)), label="true path")
    (truth,) = plan.plot([], [], "o", mfc="none", color=figures.BLACK, markersize=13, mew=2, label="camera")
    (estimate,) = plan.plot([], [], "D", color=figures.VERMILION, markersize=8, label="estimate")
    cloud = plan.scatter([], [], color=figures.BLUE, alpha=0.75, linewidths=0, label="particles, by weight")
    headings = LineCollection([], colors=figures.BLUE, linewidths=0.8, alpha=0.6)
    plan.add_collection(headings)
    low, high = stretch.true[:, 0].min() - 0.9, stretch.true[:, 0].max() + 0.9
    plan.set(xlim=(low, high), ylim=(-1.8, 2.2), title="From above", xlabel="x along the corridor [m]", ylabel="y [m]")
    plan.legend(loc="upper center", ncols=5, fontsize=7, framealpha=0.95, columnspacing=1.0, handletextpad=0.4)
    stems = LineCollection([], colors=figures.BLUE, linewidths=1.6)
    weight.add_collection(stems)
    weight.set(xlim=(-1, MAX_PARTICLES), ylim=(0, 1.05), title="Weights (best = 1)")
    weight.set(xlabel="particle i [-]", ylabel="weight w [-]")
    full = bar.add_patch(Rectangle((0.2, 0), 0.6, 0, fill=False, edgecolor="0.4", linestyle="--"))
    size = bar.add_patch(Rectangle((0.2, 0), 0.6, 0, color=figures.ORANGE))
    bar.set(xlim=(0, 1), ylim=(0, MAX_PARTICLES + 3), xticks=[], title="Sample size")
    bar.set(xlabel="dashed: N [-]", ylabel="effective sample size [particles]")
    live = LiveFigure(figure, [headings, cloud, truth, estimate, stems, size, full])

    def draw(**values: float) -> Drawing:
        settings = settings_of(**values)
        view = session.view(settings)
        done, n = session.state.done, settings.n_particles
        true = stretch.true[session.state.frame]
        weighed = done in ("weigh", "estimate")
        w = view.weights if weighed else np.full(n, 1 / n)
        shown, share = view.particles, w
        if done == "resample":
            kept, copies = np.unique(view.indices, return_counts=True)
            shown, share = view.particles[kept], copies / n
        ends = shown[:, :2] + _HEADING * np.column_stack([np.cos(shown[:, 5]), np.sin(shown[:, 5])])
        headings.set_segments(np.stack([shown[:, :2], ends], axis=1))
        cloud.set_offsets(shown[:, :2])
        cloud.set_sizes(10 + 260 * share)
        truth.set_data(true[:1], true[1:2])
        estimate.set_data(*(view.estimate[:2, None] if done == "estimate" else ([], [])))
        relative = w / w.max()
        places = np.arange(n)
        stems.set_segments(np.stack([np.stack([places, 0 * places], 1), np.stack([places, relative], 1)], axis=1))
        size.set_height(view.ess if weighed else n)
        size.set_alpha(1.0 if weighed else 0.35)
        full.set_height(n)
        summary = describe(session.state, view, true, session.message)
        alt = (
            f"The corridor from above with {n} particles, their weights, and the effective sample size as a bar, after "
            f"the step {done}. {' '.join(summary.splitlines())}"
        )
        return Drawing(live.png(), alt, summary)

    def reset(values: dict) -> dict:
        session.reset()
        return panel.defaults()

    def button(name: str) -> Callable[[dict], dict]:
        return lambda values: session.press(name, values)

    controls = [
        Slider("alpha", "alpha [m]", 0.01, 1.0, 0.1, 0.01),
        Slider("beta", "beta [-]", 0.005, 1.0, 0.1, 0.005),
        Slider("n_particles", "number of particles N", 5, MAX_PARTICLES, 50, 5),
        Slider("noise", "noise, times 0.15 m, 0.04 m, 1.5 degrees", 0.0, 3.0, 1.0, 0.1),
        Slider("seed", "seed", 0, 9, 1, 1),
    ]
    actions = {"Reset": reset} | {name.capitalize(): button(name) for name in ALLOWED_AFTER}
    panel = Panel(title, controls, draw, actions=actions | {"Whole round": session.round})
    return panel


PANELS = {"07 filter stepper": stepper_panel}
