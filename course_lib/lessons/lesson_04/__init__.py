"""Lesson 04, the depth camera: its scene, its faults one by one, figures and panel."""

from __future__ import annotations

import dataclasses
import functools
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from course_lib.depth_mcl.camera import DepthCamera
from course_lib.depth_mcl.rendering.renderer import DepthRenderer
from course_lib.depth_mcl.scene_map import SceneMap
from course_lib.depth_mcl.sequence import DepthSequence
from course_lib.geometry import state_from_optical_pose
from course_lib.lessons.kit.box_world import Box, BoxWorld
from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider, Switch
from course_lib.lessons.kit.paths import data_path
from course_lib.plots import figures
from course_lib.simulation.sensors.time_of_flight import SPEED_OF_LIGHT, Frame, TimeOfFlightCamera, TimeOfFlightModel

MODEL = TimeOfFlightModel()
# Each fault of the camera, and the parameters of `TimeOfFlightModel` that switch it off.
FAULTS: dict[str, dict[str, float]] = {
    "noise": {"shot_noise": 0.0, "dark_noise": 0.0},
    "mixing": {"sub_rays": 1},
    "systematic": {"offset": 0.0, "wiggling": 0.0, "fixed_pattern": 0.0},
    "scattering": {"scattered_share": 0.0},
    "drop_outs": {"least_amplitude": 1e-9, "greatest_amplitude": np.inf},
    "wrapping": {},  # no parameter: `capture` adds the lost multiples of c / 2f
}
LENGTH = 12.0  # metres from the origin to the scene's end wall
EYE_HEIGHT = 1.2  # metres
_ERRORS = np.linspace(-0.4, 0.4, 42)  # edges of an odd number of bins: one is centred at zero
_DEPTHS = np.linspace(0, 13, 66)


class Capture(NamedTuple):
    """One frame of the simulated camera beside the truth."""

    depth: np.ndarray
    """`(H, W)` [m] along the optical axis, NaN = no measurement"""
    true: np.ndarray
    """`(H, W)` [m] depth on the ray through each pixel's centre, inf = nothing there"""
    frame: Frame
    """what the camera reports: ranges, amplitudes, and the ranges of what each pixel sees"""


def model(faults: set[str] | frozenset[str], frequency: float = MODEL.frequency) -> TimeOfFlightModel:
    """The camera with these faults alone (names of `FAULTS`), modulated at `frequency` hertz."""
    changes = {key: value for name, off in FAULTS.items() if name not in faults for key, value in off.items()}
    return dataclasses.replace(MODEL, frequency=frequency, **changes)


QUIET = model(frozenset())  # the camera without any fault; its ranges still repeat


@functools.cache
def scene() -> BoxWorld:
    """A corridor of 12 m: pole, crate of rubber, reflecting band, an end wall with an open window and a dark door."""
    side, end = 1.5, LENGTH
    return BoxWorld(
        [
            Box((-1.0, -side, -0.2), (end, side, 0.0), 0.38),  # floor
            Box((-1.0, -side, 2.6), (end, side, 2.8), 0.78),  # ceiling
            Box((-1.0, side, -0.2), (end, side + 0.2, 2.8), 0.72),  # left wall
            Box((-1.0, -side - 0.2, -0.2), (end, -side, 2.8), 0.72),  # right wall
            Box((end, 0.2, 0.0), (end + 0.2, side, 2.6), 0.85),  # end wall, left of the door
            Box((end, -0.6, 0.0), (end + 0.2, 0.2, 2.1), 0.15),  # dark door
            Box((end, -0.6, 2.1), (end + 0.2, 0.2, 2.6), 0.85),  # above it
            Box((end, -side, 0.0), (end + 0.2, -0.6, 1.0), 0.85),  # below the open window
            Box((end, -side, 1.9), (end + 0.2, -0.6, 2.6), 0.85),  # above it
            Box((2.5, 0.28, 0.0), (2.56, 0.34, 2.6), 0.6),  # pole
            Box((4.0, -1.0, 0.0), (4.5, -0.4, 0.8), 0.06),  # crate of rubber
            Box((5.0, 0.7, 0.0), (5.3, 1.1, 2.6), 0.72),  # pillar
            Box((4.99, 0.7, 1.25), (5.0, 1.1, 1.4), 50.0),  # its retroreflective band
        ]
    )


@functools.lru_cache(maxsize=64)
def _truth(x: float, camera: DepthCamera) -> np.ndarray:
    """Depth `(H, W)` [m] of the scene on the rays through the pixels' centres, from (x, 0, EYE_HEIGHT)."""
    eye, directions = np.array([x, 0, EYE_HEIGHT]), _in_world(camera.rays())
    return scene().cast(eye, directions).distance


def _in_world(optical: np.ndarray) -> np.ndarray:
    """Directions in the world of a level camera that looks along +x: optical z, -x, -y."""
    return np.stack([optical[..., 2], -optical[..., 0], -optical[..., 1]], axis=-1)


class _Remembered:
    """The scene, which keeps what it answered to the last few cameras: a fault that is switched moves no ray."""

    def __init__(self) -> None:
        self.reflectivity = scene().reflectivity
        self._answers: dict[tuple, object] = {}

    def cast(self, origins: np.ndarray, directions: np.ndarray):
        key = (tuple(np.round(origins, 6)), directions.shape)
        if key not in self._answers:
            if len(self._answers) >= 8:
                self._answers.pop(next(iter(self._answers)))
            self._answers[key] = scene().cast(origins, directions)
        return self._answers[key]


_remembered = functools.cache(_Remembered)


@functools.lru_cache(maxsize=16)
def _camera(camera: DepthCamera, tof: TimeOfFlightModel, seed: int) -> TimeOfFlightCamera:
    return TimeOfFlightCamera(camera, tof, np.random.default_rng(seed))


def capture(
    x: float,
    faults: set[str] | frozenset[str] = frozenset(FAULTS),
    camera: DepthCamera | None = None,
    frequency: float = MODEL.frequency,
    seed: int = 0,
) -> Capture:
    """A frame of the scene from (x, 0, 1.2 m), looking along +x, with these faults of the camera alone.

    Without "wrapping" the multiple of c / 2f that the camera cannot know is added: as if it measured with two
    frequencies.
    """
    camera = camera or DepthCamera.sr4000()
    tof = model(faults, frequency)
    # The width of the scattered light is told in the pixels of the full image.
    tof = dataclasses.replace(tof, scatter_width=MODEL.scatter_width * camera.width / DepthCamera.sr4000().width)
    state = np.array([x, 0, EYE_HEIGHT, 0, 0, 0])
    frame = _camera(camera, tof, seed).capture(_remembered(), state, np.random.default_rng(seed + 1))
    depth = frame.depth.astype(np.float64)
    if "wrapping" not in faults:
        seen = np.isfinite(frame.nearest)
        turns = np.round((np.where(seen, frame.nearest, frame.range) - frame.range) / tof.unambiguous_range)
        depth += turns * tof.unambiguous_range / np.linalg.norm(camera.rays(), axis=-1)
    return Capture(depth, _truth(x, camera), frame)


def returns(x: float, camera: DepthCamera) -> tuple[np.ndarray, np.ndarray]:
    """Range along the ray [m] and reflectivity times cosine of incidence, `(H, W)` each, at the pixels' centres."""
    rays = _in_world(camera.rays())
    hits = scene().cast(np.array([x, 0, EYE_HEIGHT]), rays / np.linalg.norm(rays, axis=-1, keepdims=True))
    return hits.distance.astype(np.float64), np.where(hits.face >= 0, scene().reflectivity[hits.face] * hits.cosine, 0)


def wall(distance: float, reflectivity: float = 0.72, edge: float = -9.0) -> Box:
    """A wall across the view, `distance` metres ahead, from y = `edge` to the left."""
    return Box((distance, edge, -9.0), (distance + 0.1, 9.0, 9.0), reflectivity)


def frames_of(boxes: list[Box], n_frames: int, camera: DepthCamera, seed: int = 0) -> np.ndarray:
    """`(n, H, W)` depth images [m] of a few boxes by one camera with all its faults, at the origin, looking along x."""
    rng = np.random.default_rng(seed)
    tof, world = TimeOfFlightCamera(camera, MODEL, rng), BoxWorld(boxes)
    return np.stack([tof.capture(world, np.zeros(6), rng).depth for _ in range(n_frames)])


@functools.cache
def true_world() -> SceneMap:
    """The corridor as it was on the day of the recording, people and all. No filter ever sees it."""
    return SceneMap.load(data_path("corridor/true_world.ply"))


def true_depths(recording: DepthSequence, camera: DepthCamera, frames: range) -> np.ndarray:
    """`(n, H, W)` true depths [m] of recorded frames: the true world drawn from the true poses."""
    states = state_from_optical_pose(recording.camera_to_world[list(frames)])
    with DepthRenderer(true_world(), camera.with_clip_planes(0.1, 40.0)) as renderer:
        return renderer.render(states)


KINDS = ("no measurement", "within 5 cm", "5 to 30 cm off", "wrapped", "other, mostly edges")


def sort_errors(measured: np.ndarray, true: np.ndarray, repeats: float = MODEL.unambiguous_range) -> dict[str, float]:
    """Share of all pixels in each of `KINDS`. Wrapped: about one whole c / 2f too near."""
    error = measured - true
    lost = np.isnan(measured)
    with np.errstate(invalid="ignore"):
        close, middling = np.abs(error) <= 0.05, (np.abs(error) > 0.05) & (np.abs(error) <= 0.3)
        wrapped = np.abs(error + repeats) < 0.1 * repeats
    rest = ~(lost | close | middling | wrapped)
    return dict(zip(KINDS, (float(kind.mean()) for kind in (lost, close, middling, wrapped, rest)), strict=True))


def idea_figure(points: np.ndarray, image: np.ndarray) -> Figure:
    """The camera's points from above, and the depth image that they make."""
    figure, (plan, right) = figures.new_figure(1, 2, size=(9.2, 3.3))
    cloud = points.reshape(-1, 3)
    cloud = cloud[np.isfinite(cloud).all(axis=1)]
    plan.scatter(cloud[:, 0], cloud[:, 2], c=cloud[:, 2], s=1.2, cmap="cividis", vmin=0, vmax=10)
    plan.plot(0, 0, "s", color=figures.BLACK, markersize=8)
    plan.text(0.25, -0.15, "camera")
    for slope in (-0.4, 0.4):
        plan.plot([0, 10 * slope], [0, 10], color="0.6", linewidth=0.8)
    plan.set(title="What the camera delivers: points, seen from above", xlabel="X, to the right [m]")
    plan.set(ylabel="Z, along the optical axis [m]", xlim=(-4.2, 4.2), ylim=(-0.5, 10.3))
    drawn = figures.depth_image(right, image, "The same points as a depth image, eq. (7)", (0, 10))
    figures.colour_bar(figure, drawn, right)
    return figure


def phase_figure(distances: tuple[float, ...] = (2.0, 6.0, 12.0), frequency: float = MODEL.frequency) -> Figure:
    """Light that goes out and comes back later: three delays on one clock face, and the range that is read off."""
    figure, (left, right) = figures.new_figure(1, 2, size=(9.2, 3.2))
    turn = np.linspace(0, 2 * np.pi, 200)
    left.plot(np.cos(turn), np.sin(turn), color="0.75", linewidth=1)
    repeats = SPEED_OF_LIGHT / (2 * frequency)
    true = np.linspace(0, 2.2 * repeats, 2000)
    read = true % repeats
    read[np.r_[False, np.diff(read) < 0]] = np.nan
    right.plot(true, read, color="0.4", linewidth=1.6)
    for index, distance in enumerate(distances):
        phase = 2 * np.pi * distance / repeats
        style = figures.line_style(index)
        hand = 1 - 0.15 * index  # shorter and shorter, or two in one direction would hide each other
        end = hand * np.cos(phase), hand * np.sin(phase)
        left.plot([0, end[0]], [0, end[1]], **(style | {"markersize": 8}), label=f"r = {distance:g} m")
        right.plot(distance, distance % repeats, **(style | {"linestyle": "none", "markersize": 8}))
    left.set(title="The phase of what comes back", xlabel="in step with the lamp [-]", aspect="equal")
    left.set(ylabel="a quarter turn late [-]", xlim=(-1.35, 1.35), ylim=(-1.2, 1.2))
    left.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    right.set(title="What the camera reads", xlabel="true range r [m]", ylabel="range that is read [m]")
    return figure


def noise_figure(distances: list[float], sigmas_mm: list[float]) -> Figure:
    """Scatter of a wall's depth from frame to frame over its distance."""
    figure, axes = figures.new_figure(size=(5.6, 2.8))
    axes.plot(distances, sigmas_mm, **figures.line_style(0), label="measured, 20 frames")
    line = sigmas_mm[0] / distances[0] * np.array([0, distances[-1]])
    axes.plot([0, distances[-1]], line, color="0.4", linestyle="--", label="in proportion to the distance")
    axes.set(title="Noise of a white wall", xlabel="distance [m]", ylabel="one sigma [mm]", ylim=(0, None))
    axes.legend(loc="upper left")
    return figure


def recorded_figure(measured: np.ndarray, true: np.ndarray) -> Figure:
    """One recorded frame, its truth, and the histogram of its errors."""
    figure, (left, middle, right) = figures.new_figure(1, 3, size=(10.0, 2.9))
    figures.depth_image(left, measured, "Measured", (0, 12))
    drawn = figures.depth_image(middle, true, "True", (0, 12))
    figures.colour_bar(figure, drawn, [left, middle])
    error = (measured - true)[np.isfinite(measured) & np.isfinite(true)]
    right.stairs(_counts(error, _ERRORS), _ERRORS, fill=True, color=figures.BLUE)
    _error_axis(right, "Histogram of the errors")
    return figure


def two_surfaces_figure(shares: np.ndarray, curves: dict[str, np.ndarray]) -> Figure:
    """Range that a pixel reads over the share of it that the nearer of two surfaces covers."""
    figure, axes = figures.new_figure(size=(6.6, 3.0))
    for index, (name, ranges) in enumerate(curves.items()):
        axes.plot(shares, ranges, **(figures.line_style(index) | {"markevery": 10}), label=name)
    axes.set(title="One pixel, two surfaces", xlabel="share of the pixel on the nearer surface [-]")
    axes.set(ylabel="range that is read [m]", ylim=(0, 10.2))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure


def _counts(values: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Counts in bins, those beyond both ends in the outermost ones, at least 0.5 (for a logarithmic axis)."""
    counts = np.histogram(np.clip(values, edges[0], edges[-1]), edges)[0]
    return np.maximum(counts, 0.5)


def _error_axis(axes, title: str) -> None:
    axes.set(yscale="log", title=title, ylabel="pixels [-]", ylim=(0.5, 3e4), xlim=(_ERRORS[0], _ERRORS[-1]))
    axes.set_xlabel("measured - true depth [m]\n(outermost bars: all beyond)")


_FREQUENCIES = {"15 MHz (10 m model)": 15e6, "30 MHz (5 m model)": 30e6}


def faults_panel() -> Panel:
    """Switch the sensor's faults on one by one; see the depth image, its error, and the histograms of both."""
    camera = DepthCamera.sr4000().resized(88, 72)
    figure, ((seen, off), (depths, errors)) = figures.new_figure(2, 2, size=(9.4, 5.2))
    blank = np.zeros(camera.shape)
    image = figures.depth_image(seen, blank, "Depth image, measured", (0, LENGTH))
    figures.colour_bar(figure, image, seen)
    error_image = figures.depth_image(off, blank, "Measured - true (hatched: no measurement)", (-0.1, 0.1))
    error_image.set_cmap(_two_sided())
    figures.colour_bar(figure, error_image, off, "error [m], cut at 0.1")
    true_steps = depths.stairs(np.ones(len(_DEPTHS) - 1), _DEPTHS, color=figures.BLACK, linewidth=1.4, label="true")
    steps = depths.stairs(np.ones(len(_DEPTHS) - 1), _DEPTHS, fill=True, color=figures.ORANGE, label="measured")
    steps.set_zorder(1)
    depths.set(title="Histogram of the depths", xlabel="depth Z [m]", ylabel="pixels [-]", yscale="log")
    depths.set(ylim=(0.5, 3e4), xlim=(0, 13))
    depths.legend(loc="upper right", ncols=2, fontsize=8)
    error_steps = errors.stairs(np.ones(len(_ERRORS) - 1), _ERRORS, fill=True, color=figures.BLUE)
    _error_axis(errors, "Histogram of the errors")
    live = LiveFigure(figure, [image, error_image, steps, true_steps, error_steps])

    def draw(x: float, frequency: str, **switches: bool) -> Drawing:
        faults = {name for name, on in switches.items() if on}
        shot = capture(x, faults, camera, _FREQUENCIES[frequency])
        there = np.isfinite(shot.depth) & np.isfinite(shot.true)
        error = np.where(there, shot.depth - np.where(there, shot.true, 0), np.nan)
        image.set_data(np.ma.masked_invalid(shot.depth))
        error_image.set_data(np.ma.masked_invalid(np.clip(error, -0.1, 0.1)))
        steps.set_data(_counts(shot.depth[np.isfinite(shot.depth)], _DEPTHS))
        true_steps.set_data(_counts(shot.true[np.isfinite(shot.true)], _DEPTHS))
        error_steps.set_data(_counts(error[there], _ERRORS))
        lost, small = np.isnan(shot.depth).mean(), (np.abs(error[there]) <= 0.05).mean()
        far = (np.abs(error[there]) > 1).mean()
        lines = [
            f"no measurement: {lost:.1%} of the pixels",
            f"of the others: error at most 5 cm: {small:.1%}; more than 1 m: {far:.1%}; "
            f"median |error| {np.median(np.abs(error[there])) * 1000:.1f} mm",
        ]
        names = ", ".join(name.replace("_", "-") for name in FAULTS if name in faults) or "none"
        alt = (
            f"Depth image of a corridor from x = {x:.1f} m with these faults of the camera: {names}; its difference "
            f"from the truth; histograms of depths and errors. {' '.join(lines)}"
        )
        return Drawing(live.png(), alt, "\n".join(lines))

    controls = [
        Switch("noise", "noise"),
        Switch("mixing", "mixing: a pixel has an area, not one ray"),
        Switch("systematic", "systematic: offset, wiggling, a pattern of the pixels"),
        Switch("scattering", "scattering: light strays inside the camera"),
        Switch("drop_outs", "drop-outs: too little or too much light gives no measurement"),
        Switch("wrapping", "wrapping: ranges repeat after c / 2f"),
        Slider("x", "camera at x [m]", 0.0, 8.0, 0.0, 0.1),
        Choice("frequency", "modulation", tuple(_FREQUENCIES), next(iter(_FREQUENCIES))),
    ]
    everything = dict.fromkeys(FAULTS, True)
    return Panel("04 the faults one by one", controls, draw, actions={"All faults": lambda values: everything})


def _two_sided():
    """Colours for errors of both signs, white at zero; clear where there is none."""
    from matplotlib import colormaps

    return colormaps["PuOr"].with_extremes(bad=(1, 1, 1, 0))


PANELS = {"04 the faults one by one": faults_panel}
