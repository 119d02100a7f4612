"""Figures of lesson 00, and its panel, which moves a particle until eq. (8) is at its peak."""

import numpy as np
from matplotlib.figure import Figure

from course_lib.depth_mcl.likelihood import ALPHA, valid_pixels
from course_lib.depth_mcl.localizer import Estimate
from course_lib.spherical_stereo.pose.localization import Localization
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap
from courseware.lessons.kit.display import described
from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.panel import Drawing, Panel, Slider, Switch
from courseware.lessons.lesson_00.recorded import Moment, moment, moved
from courseware.plots import figures
from courseware.plots.corridor_figures import floor_plan
from courseware.plots.panorama_drawing import add_list, draw_objects, panorama
from courseware.plots.room_figures import draw_pose, map_axes
from courseware.simulation.room.stereo_recording import StereoPair

DEPTH_LIMITS = (0.0, 10.0)  # metres: the range of the camera
HALF_VIEW = np.deg2rad(21.8)  # half of the SR4000's 43.6 degrees
UNITS = {"x": "m", "y": "m", "yaw": "degrees"}
RANGES = {"x": (1.5, 0.05), "y": (0.6, 0.01), "yaw": (15.0, 0.1)}  # of the panel: to each side, and a step
BESIDE = {"loc": "center left", "bbox_to_anchor": (1.0, 0.5), "frameon": False}  # a legend right of its axes


def idea_figure(now: Moment, guess: np.ndarray) -> Figure:
    """Draw the camera and a particle from above, the measured image, and the image that the particle would see."""
    figure, (plan, left, right) = figures.new_figure(1, 3, size=(9.8, 2.9))
    walls = floor_plan(now.renderer.scene_map.vertices, now.state[2])
    walls = walls[np.abs(walls[:, 0] - now.state[0]) < 3.5]
    plan.plot(*walls.T, ".", color="0.6", markersize=1.2, zorder=1)
    for index, (name, state) in enumerate({"camera (true)": now.state, "particle (guess)": guess}.items()):
        style, yaw = figures.line_style(index), state[5] + np.array([HALF_VIEW, 0, -HALF_VIEW])
        edges = state[:2, None] + np.array([2.0, 0.0, 2.0]) * [np.cos(yaw), np.sin(yaw)]
        plan.plot(*edges, **(style | {"marker": ""}))
        plan.plot(*state[:2], **(style | {"linestyle": "none", "markersize": 8}), label=name)
    plan.set(title="From above", xlabel="x [m]", ylabel="y [m]", ylim=(-2.2, 3.4), aspect="equal")
    plan.set_xlim(now.state[0] - 3, now.state[0] + 3)
    plan.legend(loc="upper center", fontsize=8, ncols=2, columnspacing=0.8, handletextpad=0.2)
    figures.depth_image(left, now.measured, "Measured by the camera", DEPTH_LIMITS)
    drawn = figures.depth_image(right, now.renderer.render(guess)[0], "Seen from the particle", DEPTH_LIMITS)
    figures.colour_bar(figure, drawn, [left, right])
    alt = """The corridor from above with the camera and a guess 1.2 m behind it; the depth image that the camera
        measured; the depth image that the map gives for the guess."""
    return described(figure, alt)


def hills_figure(offsets: dict[str, np.ndarray], shares: dict[str, np.ndarray]) -> Figure:
    """Draw equation (8) over the particle's distance from the true pose, one picture for each of x, y and yaw."""
    figure, axes = figures.new_figure(1, 3, size=(9.4, 2.7))
    for index, (a, name) in enumerate(zip(axes, offsets, strict=True)):
        a.plot(offsets[name], shares[name], **(figures.line_style(index) | {"markersize": 3.5}))
        a.axvline(0, color="black", linewidth=0.8, linestyle=(0, (4, 3)))
        a.set(title=f"{name} alone is wrong", xlabel=f"{name} - true {name} [{UNITS[name]}]")
        a.set(ylabel="l / m [-]", ylim=(0, 0.85))
    alt = "Three curves of l / m over the error in x, y and yaw; each is a hill with its top at zero error."
    return described(figure, alt)


def covered_figure(offsets: np.ndarray, shares: dict[str, np.ndarray]) -> Figure:
    """Draw equation (8) along the corridor for several parts of one image."""
    figure, axes = figures.new_figure(size=(6.4, 2.9))
    for index, (name, share) in enumerate(shares.items()):
        axes.plot(offsets, share, **(figures.line_style(index) | {"markersize": 4}), label=name)
    axes.set(title="Equation (8) along the corridor", xlabel="x - true x [m]", ylabel="l / m [-]", ylim=(0, 1))
    axes.legend(**BESIDE)
    alt = (
        "l / m over the error along the corridor: a steep hill for the whole image, nearly a level line for the floor."
    )
    return described(figure, alt)


def filter_figure(estimates: list[Estimate], true: np.ndarray) -> Figure:
    """Draw the particles of every frame, the estimates and the true positions `(T, 2 or 3)` from above."""
    figure, axes = figures.new_figure(size=(8.6, 2.9))
    cloud = np.concatenate([estimate.particles for estimate in estimates])
    positions = np.array([estimate.state for estimate in estimates])
    axes.plot(*cloud[:, :2].T, ".", color=figures.SKY_BLUE, markersize=3, label="particles of all frames")
    axes.plot(*true[:, :2].T, **(figures.line_style(0) | {"markersize": 7}), label="true position")
    axes.plot(*positions[:, :2].T, **figures.line_style(3), label="estimate")
    axes.set(title="The filter at work, seen from above (y enlarged)", xlabel="x [m]", ylabel="y [m]")
    axes.legend(**BESIDE)
    alt = "Ten estimates beside ten true positions from above, with the clouds of particles around them."
    return described(figure, alt)


def room_figure(pair: StereoPair, found: Localization, semantic_map: SemanticMap) -> Figure:
    """Draw the second method on one pair: the objects in the upper panorama, and the pose on the map."""
    image, _ = pair.images()
    boxes, labels = zip(*[(one.box, one.label) for one in found.upper_detections], strict=True)
    figure, (view, plan) = figures.new_figure(1, 2, size=(10.4, 4.6))
    panorama(view, image, f"Upper camera: {len(boxes)} objects found")
    for index, (_, landmark) in enumerate(found.used_pairs):
        ends = np.stack([found.pose[:2], semantic_map.positions[landmark]])
        plan.plot(*ends.T, color="0.6", linewidth=0.8, label=None if index else "used for the pose")
    draw_pose(plan, *pair.pose, figures.BLACK, "true pose")
    draw_pose(plan, *found.pose, figures.ORANGE, "estimated pose")
    map_axes(plan, semantic_map, "The semantic map, from above")
    plan.legend(**BESIDE, fontsize=7)
    lines = [f"{number:2d} {label}" for number, label in enumerate(labels, start=1)]
    add_list(figure, lines, 7, "the numbers in the panorama", labels)
    draw_objects(view, boxes, labels, image.shape[1])
    alt = """The upper panorama with a numbered box around every object found; and the room from above with the true
        and the estimated pose and lines to the objects that were used."""
    return described(figure, alt)


def pose_panel() -> Panel:
    """Move a particle until its view agrees with the measured one. There eq. (8) is greatest."""
    now = moment()
    measured = valid_pixels(now.measured)
    truth = {"x": now.state[0], "y": now.state[1], "yaw": np.rad2deg(now.state[5])}
    figure, ((measured_axes, seen_axes, term_axes), hill_axes) = figures.new_figure(2, 3, size=(9.8, 5.0))
    figures.depth_image(measured_axes, now.measured, "Measured by the camera", DEPTH_LIMITS)
    blank = np.zeros(now.measured.shape)
    seen = figures.depth_image(seen_axes, blank, "Seen from the particle", DEPTH_LIMITS)
    figures.colour_bar(figure, seen, [measured_axes, seen_axes])
    terms = figures.depth_image(term_axes, blank, "Every pixel's term of eq. (8)", (0, 1))
    figures.colour_bar(figure, terms, term_axes, "agreement [-]")
    markers, hills, sliders, goal = [], [], [], {}
    for index, (a, (name, (half, step))) in enumerate(zip(hill_axes, RANGES.items(), strict=True)):
        offsets, unit = np.linspace(-half, half, 31), UNITS[name]
        shares = now.share(moved(now.state, name, offsets))
        hills += a.plot(truth[name] + offsets, shares, **(figures.line_style(index) | {"marker": ""}))
        markers += a.plot([], [], "o", color=figures.VERMILION, markersize=9)
        a.set(title=f"l / m over {name}", xlabel=f"{name} of the particle [{unit}]", ylabel="l / m [-]")
        a.set(xlim=(truth[name] - half, truth[name] + half), ylim=(0, 0.9))
        goal[name] = at = round(round(truth[name] / step) * step, 2)
        start = round(at - 1.2, 2) if name == "x" else at  # the panel begins 1.2 m behind the true pose
        sliders.append(Slider(name, f"{name} [{unit}]", round(at - half, 2), round(at + half, 2), start, step))
    live = LiveFigure(figure, [seen, terms, *hills, *markers])

    def draw(x: float, y: float, yaw: float, hills_shown: bool) -> Drawing:
        state = now.state.copy()
        state[[0, 1, 5]] = x, y, np.deg2rad(yaw)
        simulated = now.renderer.render(state)[0]
        term = ALPHA / (ALPHA + np.abs(now.measured - simulated))
        share, near = term[measured].mean(), (term[measured] > 0.5).mean()  # one half is a difference of alpha
        seen.set_data(np.ma.masked_invalid(simulated))
        terms.set_data(np.ma.masked_invalid(term))
        for hill, marker, value in zip(hills, markers, (x, y, yaw), strict=True):
            marker.set_data([value], [share])
            hill.set_visible(hills_shown)
        summary = f"eq. (8): l / m = {share:.2f} of 1;  measured pixels that agree to 0.1 m: {near:.0%}"
        alt = (
            f"Depth image of the camera; depth image seen from a particle at x {x:.2f} m, y {y:.2f} m, yaw {yaw:.1f} "
            f"degrees; agreement of every pixel; and three plots of l / m with the particle's value, {share:.2f}."
        )
        return Drawing(live.png(), alt, summary)

    controls = [*sliders, Switch("hills_shown", "show the hills")]
    return Panel("00 find the pose", controls, draw, actions={"Show the true pose": lambda values: dict(goal)})


PANELS = {"00 find the pose": pose_panel}
