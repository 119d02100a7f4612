"""The filter stepper: buttons for the four steps of figure 1, the particles from above, weights, sample size."""

from functools import partial

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.patches import Rectangle

from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Drawing, Panel, Slider
from course_lib.lessons.lesson_07 import filter_stepper as stepper
from course_lib.plots import figures

HEADING = 0.12  # metres, length of the line that shows where a particle looks
CONTROLS = [
    Slider("alpha", "alpha [m]", 0.01, 1.0, 0.1, 0.01),
    Slider("beta", "beta [-]", 0.005, 1.0, 0.1, 0.005),
    Slider("n_particles", "number of particles N", 5, stepper.MAX_PARTICLES, 50, 5),
    Slider("noise", "noise, times 0.15 m, 0.04 m, 1.5 degrees", 0.0, 3.0, 1.0, 0.1),
    Slider("seed", "seed", 0, 9, 1, 1),
]


def describe(state: stepper.StepperState, view: stepper.View, true: np.ndarray, message: str) -> str:
    """Return the lines under the picture, without what has not been computed yet."""
    following = " or ".join(name for name, after in stepper.ALLOWED_AFTER.items() if state.done in after)
    n, lines = len(view.particles), [message] if message else []
    lines.append(f"frame {state.frame} of {len(stepper.FRAMES) - 1}; last step: {state.done}; now: {following}")
    if state.done == "propagate":
        lines.append("no weights yet: all particles weigh the same")
    elif state.done == "resample":
        lines.append(f"different particles: {len(np.unique(view.indices))} of {n}, all weights equal")
    else:
        size = f"effective sample size {view.ess:.1f} of {n}; largest weight {view.weights.max():.2f}; "
        lines.append(f"{size}raw score of the best, l / m: {view.score:.2f}")
    if state.done == "estimate":
        off, turned = np.hypot(*(view.estimate[:2] - true[:2])), abs(np.rad2deg(view.estimate[5] - true[5]))
        lines.append(f"estimate: off by {off:.2f} m, {turned:.1f} degrees")
    return "\n".join(lines)


def stepper_panel() -> Panel:
    """Make the panel. Every panel has a state of its own, which its buttons move on."""
    stretch, state, message = stepper.corridor_stretch(), stepper.start(), ""
    figure, (plan, weight, bar) = figures.new_figure(1, 3, size=(10.0, 3.5))
    plan.get_gridspec().set_width_ratios([2.6, 1.5, 0.5])
    plan.plot(*stretch.walls.T, ".", color="0.55", markersize=3, label="wall")
    plan.plot(*stretch.true[:, :2].T, color="0.45", linewidth=0.9, linestyle=(0, (6, 3)), label="true path")
    (truth,) = plan.plot([], [], "o", mfc="none", color=figures.BLACK, markersize=13, mew=2, label="camera")
    (estimate,) = plan.plot([], [], "D", color=figures.VERMILION, markersize=8, label="estimate")
    cloud = plan.scatter([], [], color=figures.BLUE, alpha=0.75, linewidths=0, label="particles, by weight")
    headings = plan.add_collection(LineCollection([], colors=figures.BLUE, linewidths=0.8, alpha=0.6))
    low, high = stretch.true[:, 0].min() - 0.9, stretch.true[:, 0].max() + 0.9
    plan.set(xlim=(low, high), ylim=(-1.8, 2.2), title="From above", xlabel="x along the corridor [m]", ylabel="y [m]")
    plan.legend(loc="upper center", ncols=5, fontsize=7, framealpha=0.95, columnspacing=1.0, handletextpad=0.4)
    stems = weight.add_collection(LineCollection([], colors=figures.BLUE, linewidths=1.6))
    weight.set(xlim=(-1, stepper.MAX_PARTICLES), ylim=(0, 1.05), title="Weights (best = 1)")
    weight.set(xlabel="particle i [-]", ylabel="weight w [-]")
    full = bar.add_patch(Rectangle((0.2, 0), 0.6, 0, fill=False, edgecolor="0.4", linestyle="--"))
    size = bar.add_patch(Rectangle((0.2, 0), 0.6, 0, color=figures.ORANGE))
    bar.set(xlim=(0, 1), ylim=(0, stepper.MAX_PARTICLES + 3), xticks=[], title="Sample size")
    bar.set(xlabel="dashed: N [-]", ylabel="effective sample size [particles]")
    live = LiveFigure(figure, [headings, cloud, truth, estimate, stems, size, full])

    def present_view(n_particles: float, seed: float, **values: float) -> stepper.View:
        return stepper.look(state, n_particles=int(n_particles), seed=int(seed), **values)

    def draw(**values: float) -> Drawing:
        view, true = present_view(**values), stretch.true[state.frame]
        n, weighed = len(view.particles), state.done in ("weigh", "estimate")
        w = view.weights if weighed else np.full(n, 1 / n)
        shown, share = view.particles, w
        if state.done == "resample":
            kept, copies = np.unique(view.indices, return_counts=True)
            shown, share = view.particles[kept], copies / n
        ends = shown[:, :2] + HEADING * np.column_stack([np.cos(shown[:, 5]), np.sin(shown[:, 5])])
        headings.set_segments(np.stack([shown[:, :2], ends], axis=1))
        cloud.set(offsets=shown[:, :2], sizes=10 + 260 * share)
        truth.set_data(true[:1], true[1:2])
        estimate.set_data(*(view.estimate[:2, None] if state.done == "estimate" else ([], [])))
        stems.set_segments([[(i, 0), (i, height)] for i, height in enumerate(w / w.max())])
        size.set(height=view.ess if weighed else n, alpha=1.0 if weighed else 0.35)
        full.set_height(n)
        summary = describe(state, view, true, message)
        alt = f"""The corridor from above with {n} particles, their weights, and the effective sample size as a bar, after
            the step {state.done}. {summary}"""
        return Drawing(live.png(), alt, summary)

    def press(name: str, values: dict, whole_round: bool = False) -> dict:
        """Do a step, or finish the frame and go on to the next estimate. Say so if none can come now."""
        nonlocal state, message
        message = stepper.refusal(state, name)
        if not message:
            before = state._replace(done="resample") if whole_round else state
            after = stepper.step(before, name, present_view(**values))
            state = after._replace(done="estimate") if whole_round else after
        return values

    def reset(values: dict) -> dict:
        nonlocal state, message
        state, message = stepper.start(), ""
        return panel.defaults()

    actions = {"Reset": reset} | {name.capitalize(): partial(press, name) for name in stepper.ALLOWED_AFTER}
    actions["Whole round"] = partial(press, "propagate", whole_round=True)
    panel = Panel("07 filter stepper", CONTROLS, draw, actions=actions)
    return panel


PANELS = {"07 filter stepper": stepper_panel}
