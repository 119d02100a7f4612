"""The filter of figure 1, one step at a time on a stretch of the corridor: its state, its pure steps, and its panel.

A state holds what earlier frames have left: the frame, the last step, and the particles before this frame's noise.
`look` computes all that is shown from it and the sliders, with fixed draws for a seed and a frame, so that a slider
changes the present frame at once.
"""

import functools
from collections import namedtuple

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.patches import Rectangle
from scipy.special import softmax

from course_lib.depth_mcl import particle_filter
from course_lib.depth_mcl.likelihood import ALPHA, likelihood, normalize_likelihood, valid_pixels, weights
from course_lib.depth_mcl.localizer import SIGMA_XY_YAW
from course_lib.depth_mcl.motion import propagate
from course_lib.geometry import state_from_optical_pose
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.sensor import subsample_depth
from courseware.lessons.kit.corridor_data import corridor_map, wagon_run
from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.panel import Drawing, Panel, Slider
from courseware.plots import figures
from courseware.plots.corridor_figures import floor_plan

FRAMES = range(60, 84)  # of the wagon's run, the stretch of lesson 08
MAX_PARTICLES = 100
# Buttons in the order of figure 1, and after which steps each may be pressed.
ALLOWED_AFTER = {
    "propagate": ("propagate", "weigh", "estimate", "resample"),
    "weigh": ("propagate",),
    "estimate": ("weigh",),
    "resample": ("weigh", "estimate"),
}
Stretch = namedtuple("Stretch", "measured true walls renderer")
StepperState = namedtuple("StepperState", "frame done parents")
View = namedtuple("View", "particles weights score ess estimate indices")
FollowedStretch = namedtuple("FollowedStretch", "errors ess")


@functools.cache
def corridor_stretch() -> Stretch:
    """Return depth images `(T, 26, 32)` [m], the camera's states `(T, 6)`, walls at its height `(M, 2)`, a renderer."""
    sequence, scene_map, camera = wagon_run(), corridor_map(), wagon_run().camera()
    small = camera.resized(32, 26)  # few pixels, so that a hundred views take milliseconds
    true = state_from_optical_pose(sequence.camera_to_world[list(FRAMES)])
    measured = np.stack([subsample_depth(sequence.depth(frame), camera, small) for frame in FRAMES])
    walls = floor_plan(scene_map.vertices, true[0, 2])
    near = (walls[:, 0] > true[:, 0].min() - 1.5) & (walls[:, 0] < true[:, 0].max() + 1.5)
    return Stretch(measured, true, walls[near], DepthRenderer(scene_map, small, "ray", exact=True))


def start() -> StepperState:
    """Put all particles at the true first pose, eqs (3), (4); the next frame's noise and weights are done already."""
    return StepperState(1, "weigh", particle_filter.initial_particles(corridor_stretch().true[0], MAX_PARTICLES))


def look(state: StepperState, beta: float, n_particles: float = 50, noise: float = 1.0, seed: int = 1) -> View:
    """Do all steps of the present frame; noise: a factor on the system noise of 0.15 m, 0.04 m, 1.5 degrees.

    The parents, evenly thinned or copied to N, get this frame's noise: particles `(N, 6)`. score: l / m of the best.
    indices `(N,)`: which particles live on.
    """
    stretch, n = corridor_stretch(), int(n_particles)
    parents = state.parents[np.arange(n) * len(state.parents) // n]
    particles = propagate(parents, noise * np.array(SIGMA_XY_YAW), np.random.default_rng([seed, state.frame]))
    measured = stretch.measured[state.frame]
    raw = likelihood(measured, stretch.renderer.render(particles), ALPHA)
    w = weights(normalize_likelihood(raw), beta)
    indices = particle_filter.resample(w, np.random.default_rng([seed, state.frame, 1]))
    ess, estimate = particle_filter.effective_sample_size(w), particle_filter.weighted_mean_state(particles, w)
    return View(particles, w, raw.max() / max(1, valid_pixels(measured).sum()), ess, estimate, indices)


def refusal(state: StepperState, name: str) -> str:
    """Return why the step `name` cannot come now, and "" if it can."""
    if state.done not in ALLOWED_AFTER[name]:
        return f"Not now: {name} comes after {' or '.join(ALLOWED_AFTER[name])}; the last step was {state.done}."
    ended = name == "propagate" and state.frame + 1 == len(FRAMES)
    return "Not now: the stretch ends here: press Reset." if ended else ""


def step(state: StepperState, name: str, view: View) -> StepperState:
    """Return the state after the button `name`. The present particles, resampled or not, are the next parents."""
    if name != "propagate":
        return state._replace(done=name)
    parents = view.particles[view.indices] if state.done == "resample" else view.particles
    return StepperState(state.frame + 1, "propagate", parents)


def follow(beta: float, resampled: bool = True, carried: bool = False, seed: int = 1) -> FollowedStretch:
    """Do the steps over the whole stretch, and return errors on the floor `(T,)` [m] and sample sizes `(T,)`.

    carried: multiply the weights into those of the frame before, which is right if nothing is resampled.
    """
    true, state, errors, ess, logs = corridor_stretch().true, start(), [], [], 0.0
    while True:
        view = look(state, beta, seed=seed)
        logs = np.log(np.maximum(view.weights, 1e-300)) + (logs if carried else 0.0)
        w = softmax(logs)
        estimate = particle_filter.weighted_mean_state(view.particles, w)
        errors.append(np.linalg.norm(estimate[:2] - true[state.frame, :2]))
        ess.append(particle_filter.effective_sample_size(w))
        if state.frame == len(true) - 1:
            return FollowedStretch(np.array(errors), np.array(ess))
        state = step(state._replace(done="resample" if resampled else "estimate"), "propagate", view)


def describe(state: StepperState, view: View) -> str:
    """Return the lines under the picture, without what has not been computed yet."""
    following = " or ".join(name for name, after in ALLOWED_AFTER.items() if state.done in after)
    n, true = len(view.particles), corridor_stretch().true[state.frame]
    lines = [f"frame {state.frame} of {len(FRAMES) - 1}; last step: {state.done}; now: {following}"]
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


CONTROLS = [
    Slider("beta", "beta [-]", 0.005, 1.0, 0.1, 0.005),
    Slider("n_particles", "number of particles N", 5, MAX_PARTICLES, 50, 5),
    Slider("noise", "noise, times 0.15 m, 0.04 m, 1.5 degrees", 0.0, 3.0, 1.0, 0.1),
]


def stepper_panel() -> Panel:
    """Make the panel. Every panel has a state of its own, which its buttons move on."""
    stretch, state, message = corridor_stretch(), start(), ""
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
    weight.set(xlim=(-1, MAX_PARTICLES), ylim=(0, 1.05), title="Weights (best = 1)")
    weight.set(xlabel="particle i [-]", ylabel="weight w [-]")
    full = bar.add_patch(Rectangle((0.2, 0), 0.6, 0, fill=False, edgecolor="0.4", linestyle="--"))
    size = bar.add_patch(Rectangle((0.2, 0), 0.6, 0, color=figures.ORANGE))
    bar.set(xlim=(0, 1), ylim=(0, MAX_PARTICLES + 3), xticks=[], title="Sample size", xlabel="dashed: N [-]")
    bar.set_ylabel("effective sample size [particles]")
    live = LiveFigure(figure, [headings, cloud, truth, estimate, stems, size, full])

    def draw(**values: float) -> Drawing:
        view, true = look(state, **values), stretch.true[state.frame]
        n, weighed = len(view.particles), state.done in ("weigh", "estimate")
        w = view.weights if weighed else np.full(n, 1 / n)
        shown, share = view.particles, w
        if state.done == "resample":
            kept, copies = np.unique(view.indices, return_counts=True)
            shown, share = view.particles[kept], copies / n
        ends = shown[:, :2] + 0.12 * np.column_stack([np.cos(shown[:, 5]), np.sin(shown[:, 5])])
        headings.set_segments(np.stack([shown[:, :2], ends], axis=1))
        cloud.set(offsets=shown[:, :2], sizes=10 + 260 * share)
        truth.set_data(true[:1], true[1:2])
        estimate.set_data(*(view.estimate[:2, None] if state.done == "estimate" else ([], [])))
        stems.set_segments([[(i, 0), (i, height)] for i, height in enumerate(w / w.max())])
        size.set(height=view.ess if weighed else n, alpha=1.0 if weighed else 0.35)
        full.set_height(n)
        summary = "\n".join([message] * bool(message) + [describe(state, view)])
        alt = f"""The corridor from above with {n} particles, their weights, and the effective sample size as a bar,
            after the step {state.done}. {summary}"""
        return Drawing(live.png(), alt, summary)

    def press(values: dict, name: str, whole_round: bool = False) -> dict:
        """Do a step, or finish the frame and go on to the next estimate. Say so if none can come now."""
        nonlocal state, message
        message = refusal(state, name)
        if not message:
            before = state._replace(done="resample") if whole_round else state
            after = step(before, name, look(state, **values))
            state = after._replace(done="estimate") if whole_round else after
        return values

    def reset(values: dict) -> dict:
        nonlocal state, message
        state, message = start(), ""
        return panel.defaults()

    steps = {name.capitalize(): functools.partial(press, name=name) for name in ALLOWED_AFTER}
    steps["Whole round"] = functools.partial(press, name="propagate", whole_round=True)
    panel = Panel("07 filter stepper", CONTROLS, draw, actions={"Reset": reset} | steps)
    return panel


PANELS = {"07 filter stepper": stepper_panel}
