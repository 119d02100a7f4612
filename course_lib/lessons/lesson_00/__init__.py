"""Lesson 00, start here: the corridor's recording beside its map, the panel that looks for eq. (8)'s peak, a room."""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np
import trimesh
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from course_lib.depth_mcl.camera import DepthCamera
from course_lib.depth_mcl.likelihood import ALPHA, likelihood, valid_pixels
from course_lib.depth_mcl.localizer import Estimate
from course_lib.depth_mcl.rendering.renderer import DepthRenderer
from course_lib.depth_mcl.scene_map import SceneMap
from course_lib.depth_mcl.sequence import DepthSequence, read_sequence
from course_lib.geometry import state_from_optical_pose
from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Drawing, Panel, Slider, Switch
from course_lib.lessons.kit.paths import data_path
from course_lib.plots import figures
from course_lib.plots.corridor_figures import floor_plan
from course_lib.plots.room_figures import draw_box, draw_pose, map_axes, panorama
from course_lib.spherical_stereo.pose.localization import Localization
from course_lib.spherical_stereo.recording import StereoPair
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

FRAME = 100  # of the corridor run: benches, doors and pillars in view, nothing special (chosen)
DEPTH_LIMITS = (0.0, 10.0)  # metres: the range of the camera
PAIR = 3  # of the room's experiment 1: most objects in view, nothing special (chosen)
_HALF_WIDTHS = {"x": 1.5, "y": 0.6, "yaw": 15.0}  # metres, metres, degrees about the true pose
_STEPS = {"x": 0.05, "y": 0.01, "yaw": 0.1}
_UNITS = {"x": "m", "y": "m", "yaw": "degrees"}
_WRONG_START = -1.2  # metres along x, where the panel begins


class Moment(NamedTuple):
    """One frame of the recording, with all that it is compared with."""

    measured: np.ndarray
    """`(H, W)` metres, NaN where nothing was measured."""
    state: np.ndarray
    """`(6,)` the true pose."""
    renderer: DepthRenderer

    def share(self, states: np.ndarray) -> np.ndarray:
        """l / m `(N,)`: the likelihood, eq. (8), divided by the number of measured pixels: 1 for perfect agreement."""
        return likelihood(self.measured, self.renderer.render(states)) / valid_pixels(self.measured).sum()


@functools.cache
def moment(frame: int = FRAME) -> Moment:
    """A frame of the corridor run with the map's renderer; kept, since a panel asks for it again and again."""
    sequence = read_sequence(data_path("corridor/wagon"))
    renderer = DepthRenderer(SceneMap.load(data_path("corridor/map.ply")), sequence.camera())
    return Moment(sequence.depth(frame), state_from_optical_pose(sequence.camera_to_world[frame]), renderer)


def wall_reads(distance: float) -> float:
    """Depth [m] that the renderer gives for a wall `distance` metres ahead: does drawing work on this computer?"""
    box = trimesh.creation.box(bounds=np.array([[distance, -9.0, -9.0], [distance + 0.1, 9.0, 9.0]]))
    with DepthRenderer(SceneMap(box.vertices, box.faces), DepthCamera.sr4000()) as renderer:
        return float(renderer.render(np.zeros(6))[0, 72, 88])


def moved(state: np.ndarray, name: str, offsets: np.ndarray) -> np.ndarray:
    """States `(N, 6)`: one state, moved along "x" or "y" (metres) or turned by "yaw" (degrees)."""
    states = np.tile(state, (len(np.atleast_1d(offsets)), 1))
    states[:, {"x": 0, "y": 1, "yaw": 5}[name]] += np.deg2rad(offsets) if name == "yaw" else offsets
    return states


def draw_camera(axes: Axes, state: np.ndarray, index: int, label: str) -> None:
    """A camera from above: its place and the edges of its view, 2 m long."""
    style = figures.line_style(index)
    half = np.deg2rad(21.8)  # half of the SR4000's 43.6 degrees
    ends = state[5] + np.array([half, -half])
    x, y = state[0] + 2.0 * np.cos(ends), state[1] + 2.0 * np.sin(ends)
    axes.plot([x[0], state[0], x[1]], [y[0], state[1], y[1]], **(style | {"marker": ""}))
    axes.plot(state[0], state[1], **(style | {"linestyle": "none", "markersize": 8}), label=label)


def draw_walls(axes: Axes, scene_map: SceneMap, height: float, around: np.ndarray, reach: float = 3.0) -> None:
    """The map, cut at camera height, near a point; sets limits and labels."""
    walls = floor_plan(scene_map.vertices, height)
    walls = walls[np.abs(walls[:, 0] - around[0]) < reach + 0.5]
    axes.plot(walls[:, 0], walls[:, 1], ".", color="0.6", markersize=1.2, zorder=1)
    axes.set(xlim=(around[0] - reach, around[0] + reach), ylim=(-2.2, 2.2), xlabel="x [m]", ylabel="y [m]")


def idea_figure(now: Moment, guess: np.ndarray) -> Figure:
    """The camera and a particle from above, what the camera measured, and what the particle would see."""
    figure, (plan, left, right) = figures.new_figure(1, 3, size=(9.8, 2.9))
    draw_walls(plan, now.renderer.scene_map, now.state[2], now.state)
    draw_camera(plan, now.state, 0, "camera (true)")
    draw_camera(plan, guess, 1, "particle (guess)")
    plan.set(title="From above", ylim=(-2.2, 3.4), aspect="equal")
    plan.legend(loc="upper center", fontsize=8, ncols=2, columnspacing=0.8, handletextpad=0.2)
    figures.depth_image(left, now.measured, "Measured by the camera", DEPTH_LIMITS)
    drawn = figures.depth_image(right, now.renderer.render(guess)[0], "Seen from the particle", DEPTH_LIMITS)
    figures.colour_bar(figure, drawn, [left, right])
    return figure


def hills_figure(now: Moment, offsets: dict[str, np.ndarray], shares: dict[str, np.ndarray]) -> Figure:
    """Equation (8) over the particle's distance from the true pose, one picture for each of x, y and yaw."""
    figure, axes = figures.new_figure(1, 3, size=(9.4, 2.7))
    for index, (a, name) in enumerate(zip(axes, offsets, strict=True)):
        a.plot(offsets[name], shares[name], **(figures.line_style(index) | {"markersize": 3.5}))
        a.axvline(0, color="black", linewidth=0.8, linestyle=(0, (4, 3)))
        a.set(title=f"{name} alone is wrong", xlabel=f"{name} - true {name} [{_UNITS[name]}]", ylim=(0, 0.85))
        a.set_ylabel("l / m [-]")
    return figure


def covered_figure(offsets: np.ndarray, shares: dict[str, np.ndarray]) -> Figure:
    """Equation (8) along the corridor for several parts of one image."""
    figure, axes = figures.new_figure(size=(6.4, 2.9))
    for index, (name, share) in enumerate(shares.items()):
        axes.plot(offsets, share, **(figures.line_style(index) | {"markersize": 4}), label=name)
    axes.set(title="Equation (8) along the corridor", xlabel="x - true x [m]", ylabel="l / m [-]", ylim=(0, 1))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure


def filter_figure(estimates: list[Estimate], true: np.ndarray) -> Figure:
    """From above: the particles of every frame, the estimates and the true positions `(T, 2 or 3)`."""
    figure, axes = figures.new_figure(size=(8.6, 2.9))
    positions = np.array([estimate.state for estimate in estimates])
    cloud = np.concatenate([estimate.particles for estimate in estimates])
    axes.plot(cloud[:, 0], cloud[:, 1], ".", color=figures.SKY_BLUE, markersize=3, label="particles of all frames")
    axes.plot(true[:, 0], true[:, 1], **(figures.line_style(0) | {"markersize": 7}), label="true position")
    axes.plot(positions[:, 0], positions[:, 1], **(figures.line_style(3) | {"markersize": 5}), label="estimate")
    axes.set(title="The filter at work, seen from above (y enlarged)", xlabel="x [m]", ylabel="y [m]")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure


def room_figure(pair: StereoPair, found: Localization, semantic_map: SemanticMap) -> Figure:
    """The second method on one pair: what was detected in the upper panorama, and the pose on the map."""
    image, _ = pair.images()
    figure, (view, plan) = figures.new_figure(1, 2, size=(10.4, 4.0))
    panorama(view, image, f"Upper camera: {len(found.upper_detections)} objects found")
    for one in found.upper_detections:
        draw_box(view, one.box, image.shape[1], one.label, one.label)
    for index, (_, landmark) in enumerate(found.used_pairs):
        ends = np.stack([(found.pose.x, found.pose.y), semantic_map.positions[landmark]])
        plan.plot(*ends.T, color="0.6", linewidth=0.8, label=None if index else "used for the pose")
    draw_pose(plan, *pair.pose, figures.BLACK, "true pose")
    draw_pose(plan, found.pose.x, found.pose.y, found.pose.theta, figures.ORANGE, "estimated pose")
    map_axes(plan, semantic_map, "The semantic map, from above")
    plan.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=7, frameon=False)
    return figure


def true_positions(sequence: DepthSequence, frames: range) -> np.ndarray:
    """True camera positions `(T, 3)` [m] of some frames."""
    return sequence.camera_to_world[frames.start : frames.stop : frames.step, :3, 3]


def _settable(name: str, value: float) -> float:
    """The value that a slider of this name can be set to, nearest to `value`."""
    return round(round(value / _STEPS[name]) * _STEPS[name], 2)


def pose_panel() -> Panel:
    """Move a particle until what it would see agrees with what the camera measured: eq. (8) is greatest there."""
    now = moment()
    truth = {"x": now.state[0], "y": now.state[1], "yaw": np.rad2deg(now.state[5])}
    goal = {name: _settable(name, value) for name, value in truth.items()}
    figure, axes = figures.new_figure(2, 3, size=(9.8, 5.0))
    (measured_axes, seen_axes, term_axes), hill_axes = axes
    figures.depth_image(measured_axes, now.measured, "Measured by the camera", DEPTH_LIMITS)
    blank = np.zeros(now.measured.shape)
    seen = figures.depth_image(seen_axes, blank, "Seen from the particle", DEPTH_LIMITS)
    figures.colour_bar(figure, seen, [measured_axes, seen_axes])
    terms = figures.depth_image(term_axes, blank, "Every pixel's term of eq. (8)", (0, 1))
    figures.colour_bar(figure, terms, term_axes, "agreement [-]")
    moving = [seen, terms]
    markers, hills = {}, []
    for index, (name, a) in enumerate(zip(truth, hill_axes, strict=True)):
        offsets = np.linspace(-_HALF_WIDTHS[name], _HALF_WIDTHS[name], 31)
        values = truth[name] + offsets
        style = figures.line_style(index) | {"marker": ""}
        hills += a.plot(values, now.share(moved(now.state, name, offsets)), **style)
        (markers[name],) = a.plot([], [], "o", color=figures.VERMILION, markersize=9)
        a.set(title=f"l / m over {name}", xlabel=f"{name} of the particle [{_UNITS[name]}]", ylabel="l / m [-]")
        a.set(xlim=(values[0], values[-1]), ylim=(0, 0.9))
    live = LiveFigure(figure, [*moving, *hills, *markers.values()])

    def draw(x: float, y: float, yaw: float, hills_shown: bool) -> Drawing:
        state = now.state.copy()
        state[[0, 1, 5]] = x, y, np.deg2rad(yaw)
        simulated = now.renderer.render(state)
        difference = np.abs(now.measured - simulated[0])
        share = likelihood(now.measured, simulated)[0] / valid_pixels(now.measured).sum()
        seen.set_data(np.ma.masked_invalid(simulated[0]))
        terms.set_data(np.ma.masked_invalid(ALPHA / (ALPHA + difference)))
        for name, value in (("x", x), ("y", y), ("yaw", yaw)):
            markers[name].set_data([value], [share])
        for hill in hills:
            hill.set_visible(hills_shown)
        near = (difference < ALPHA).sum() / valid_pixels(now.measured).sum()
        summary = f"eq. (8): l / m = {share:.2f} of 1;  measured pixels that agree to 0.1 m: {near:.0%}"
        alt = (
            f"Depth image of the camera; depth image seen from a particle at x {x:.2f} m, y {y:.2f} m, yaw {yaw:.1f} "
            f"degrees; agreement of every pixel; and three plots of l / m with the particle's value, {share:.2f}."
        )
        return Drawing(live.png(), alt, summary)

    controls = [
        Slider(
            name,
            f"{name} [{_UNITS[name]}]",
            round(goal[name] - _HALF_WIDTHS[name], 2),
            round(goal[name] + _HALF_WIDTHS[name], 2),
            _settable(name, goal[name] + _WRONG_START) if name == "x" else goal[name],
            _STEPS[name],
        )
        for name in truth
    ]
    controls.append(Switch("hills_shown", "show the hills"))
    return Panel("00 find the pose", controls, draw, actions={"Show the true pose": lambda values: dict(goal)})


PANELS = {"00 find the pose": pose_panel}
