"""The two recorded runs, exact states in metres and radians: a wagon pushed down the corridor, and a carried camera."""

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from scipy.interpolate import CubicSpline, PchipInterpolator

from course_lib.geometry import pose_matrix, rotation_angle

FRAME_RATE = 10.0  # frames per second; chosen, within the SR4000's rates

Run = tuple[np.ndarray, np.ndarray]  # states `(T, 6)` and times `(T,)`
Pushing = tuple[
    np.ndarray, np.ndarray, np.ndarray
]  # `(T,)` each: factor on the speed, radians turned, metres to the left


@dataclass(frozen=True)
class WagonModel:
    """How the wagon is pushed. The wagon's size is that of a laboratory trolley."""

    frames: int = 304  # number of frames; chosen
    start: float = 2.4  # m along x; chosen
    mean_step: float = 0.0965  # m between frames; chosen
    step_spread: float = 0.015  # share of the mean step by which the pushing speed varies, slowly; chosen
    height: float = 1.0  # m, camera above the floor; chosen
    wander: float = 0.28  # m, greatest sideways wish of the path; chosen
    knot_spacing: float = 3.1  # m between the path's knots; chosen
    clearance: float = 0.42  # m from the path to clutter: half the wagon and a hand's breadth; chosen
    heading_wobble_deg: float = 1.0  # degrees, one sigma about the path's direction, smooth over about a second; chosen
    height_jitter: float = 0.001  # m, one sigma, cut at two sigma: wheels on linoleum; chosen
    tilt_jitter_deg: float = 0.1  # degrees, one sigma, cut at two sigma, roll and pitch; chosen


@dataclass(frozen=True)
class PushModel:
    """How somebody who walks pushes the wagon; path, height and wheels stay those of WagonModel."""

    speed_spread: float = 0.25  # share of the mean speed, one sigma, over seconds; chosen: a stroll of 0.5 to 1.4 m/s
    speed_seconds: float = 2.0  # s over which the speed changes; chosen
    least_and_most: tuple[float, float] = (0.4, 1.6)  # shares of the mean speed, but for stops; chosen
    steps_per_second: float = 1.8  # chosen: usual for a stroll
    step_spread: float = 0.10  # share of the speed that comes and goes with every step, amplitude; chosen
    stops: tuple[int, int] = (2, 4)  # how often the wagon stands still, least and most; chosen: doors, people
    stop_seconds: tuple[float, float] = (0.5, 2.0)  # s; chosen
    ramp_seconds: float = 0.7  # s from speed to standing still and back; chosen: about 1.4 m/s^2
    sway_deg: float = 1.5  # degrees, amplitude with every second step: hips turn by about 5, arms give way; chosen
    wobble: float = 0.012  # m sideways, amplitude with every second step; chosen: a head's sway is about twice that


@dataclass(frozen=True)
class HandModel:
    """How the camera is carried by hand."""

    frames: int = 150  # number of frames; chosen
    start: float = 13.0  # m along x, before the first portal; chosen
    mean_step: float = 0.068  # m between frames; chosen
    heights: tuple[float, float] = (1.2, 1.6)  # m; chosen
    tilt_deg: float = 18.0  # degrees, greatest roll and pitch; chosen
    look_deg: float = 30.0  # degrees, greatest turn of the view from the way forward; chosen
    knot_seconds: float = 2.2  # s between knots of the angles; chosen
    wander: float = 0.30  # m, greatest sideways wish; chosen
    tremor_deg: float = 0.15  # degrees, one sigma, frame to frame; chosen
    greatest_step: float = 0.1  # m between frames, a run with a longer one is drawn again; chosen
    greatest_turn_deg: float = 5.0  # degrees between frames, likewise; chosen


@dataclass(frozen=True)
class FloorSurveyModel:
    """How the drawn line under the wagon is surveyed."""

    spacing: float = 0.01  # m between points along the line; chosen
    noise: float = 0.002  # m, one sigma per axis; chosen
    registration: float = 0.003  # m, one sigma per axis, one offset for the whole line; chosen


def smooth_signal(n: int, width: float, rng: Generator) -> np.ndarray:
    """Smooth random signal `(n,)` with zero mean and standard deviation one; `width` in frames."""
    margin = int(4 * width)
    kernel = np.exp(-0.5 * (np.arange(-margin, margin + 1) / width) ** 2)
    signal = np.convolve(rng.normal(size=n + 2 * margin), kernel, mode="valid")
    return signal / np.sqrt(np.sum(kernel**2))


def wagon_run(model: WagonModel, clutter_boxes: np.ndarray, rng: Generator, pushing: Pushing | None = None) -> Run:
    """The run of the wagon, clear of the clutter `(n, 2, 2)`; without pushing it rolls evenly."""
    length = model.mean_step * model.frames * (1 + model.step_spread) + 1.0
    path = _clear_path(model.start, length, model.wander, model.knot_spacing, model.clearance, clutter_boxes, rng)
    # Arc length along the path, so that steps are steps along the floor.
    x = np.linspace(model.start, model.start + length, 8000)
    arc = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(path(x))))])
    speed = 1 + np.clip(smooth_signal(model.frames, 25, rng), -2, 2) * model.step_spread
    factor, sway, wobble = pushing or (1.0, 0.0, np.zeros(1))
    speed = speed * factor
    travelled = np.cumsum(model.mean_step * speed) - model.mean_step * speed[0]
    at = np.interp(travelled, arc, x)
    along = np.arctan(path(at, 1))
    heading = along + np.deg2rad(model.heading_wobble_deg) * smooth_signal(model.frames, 6, rng) + sway
    place = np.column_stack([at, path(at)]) + wobble[:, None] * np.column_stack([-np.sin(along), np.cos(along)])
    jitter = np.clip(rng.normal(size=(model.frames, 3)), -2, 2)
    z, tilts = model.height + model.height_jitter * jitter[:, 0], np.deg2rad(model.tilt_jitter_deg) * jitter[:, 1:]
    return np.column_stack([place, z, tilts, heading]), np.arange(model.frames) / FRAME_RATE


def draw_pushing(model: PushModel, frames: int, rng: Generator) -> Pushing:
    """How the wagon is pushed over so many frames: speed that varies and stops, sway and wobble while it moves."""
    times = np.arange(frames) / FRAME_RATE
    slow = 1 + model.speed_spread * smooth_signal(frames, model.speed_seconds * FRAME_RATE, rng)
    slow = np.clip(slow / slow.mean(), *model.least_and_most)
    step = 2 * np.pi * (model.steps_per_second * times + rng.random())
    moving = np.ones(frames)
    for _ in range(rng.integers(model.stops[0], model.stops[1] + 1)):
        middle, half = rng.uniform(0, times[-1]), rng.uniform(*model.stop_seconds) / 2
        share = np.clip((np.abs(times - middle) - half) / model.ramp_seconds, 0, 1)
        moving *= (1 - np.cos(np.pi * share)) / 2
    # Left and right foot: what turns and shifts the wagon takes two steps to come back.
    side = moving * np.sin(step / 2)
    speed = slow * (1 + model.step_spread * np.sin(step)) * moving  # its mean without stops is one
    return speed, np.deg2rad(model.sway_deg) * side, model.wobble * side


def hand_run(model: HandModel, clutter_boxes: np.ndarray, rng: Generator) -> Run:
    """The run of the camera carried by hand, without a step or a turn above the greatest."""
    for _ in range(100):
        states, times = _draw_hand_run(model, clutter_boxes, rng)
        step, turn = steps_and_turns(states)
        if step.max() <= model.greatest_step and np.rad2deg(turn.max()) <= model.greatest_turn_deg:
            return states, times
    raise ValueError(f"100 runs had steps over {model.greatest_step} m or turns over {model.greatest_turn_deg} degrees")


def steps_and_turns(states: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distance in metres and angle in radians from each of the states `(T, 6)` to the next, `(T - 1,)` each."""
    rotations = pose_matrix(states)[:, :3, :3]
    turns = rotation_angle(np.swapaxes(rotations[:-1], 1, 2) @ rotations[1:])
    return np.linalg.norm(np.diff(states[:, :3], axis=0), axis=1), turns


def _draw_hand_run(model: HandModel, clutter_boxes: np.ndarray, rng: Generator) -> Run:
    times = np.arange(model.frames) / FRAME_RATE
    length = model.mean_step * model.frames + 2.0
    path = _clear_path(model.start, length, model.wander, 2.3, 0.40, clutter_boxes, rng)
    x = model.start + model.mean_step * np.arange(model.frames) + 0.05 * smooth_signal(model.frames, 12, rng)
    knots = np.arange(0, times[-1] + 2 * model.knot_seconds, model.knot_seconds)

    def wave(low: float, high: float) -> np.ndarray:
        return PchipInterpolator(knots, rng.uniform(low, high, len(knots)))(times)

    # Steps of the body while walking: two steps a second, up and down and from side to side.
    gait = 2 * np.pi * 1.7 * times
    z = wave(model.heights[0] + 0.02, model.heights[1] - 0.02) + 0.012 * np.sin(gait)
    y = path(x) + 0.012 * np.sin(gait / 2)
    angles = np.stack([wave(-most, most) for most in (model.tilt_deg, model.tilt_deg, model.look_deg)], axis=1)
    angles += model.tremor_deg * rng.normal(size=angles.shape)
    return np.column_stack([x, y, z, np.deg2rad(angles)]), times


def survey_floor_line(states: np.ndarray, model: FloorSurveyModel, rng: Generator) -> np.ndarray:
    """Points `(P, 3)` on the line on the floor below the camera, as a laser survey, registered to the map, has them."""
    xy = states[:, :2]
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(xy, axis=0), axis=1))])
    # A wagon that stands still is at one place of the line for many frames: a spline through them would loop.
    moved = np.concatenate([[True], np.diff(arc) > 0.005])
    line = CubicSpline(arc[moved], xy[moved])(np.arange(0.0, arc[-1], model.spacing))
    points = np.column_stack([line, np.zeros(len(line))])
    offset = model.registration * rng.normal(size=3)
    return points + offset + model.noise * rng.normal(size=points.shape)


def _clear_path(
    start: float, length: float, wander: float, spacing: float, clearance: float, boxes: np.ndarray, rng: Generator
):
    """Smooth y(x) in metres through drawn knots, moved aside where clutter boxes would come nearer than `clearance`."""
    knots = np.arange(start - spacing, start + length + 2 * spacing, spacing)
    wish = CubicSpline(knots, rng.uniform(-wander, wander, len(knots)))
    x = np.arange(start - 1.0, start + length + 1.0, 0.05)
    y = wish(x)
    low, high = np.full_like(x, -0.55), np.full_like(x, 0.55)
    for (x_low, y_low), (x_high, y_high) in boxes:
        beside = (x > x_low - 0.6) & (x < x_high + 0.6)
        if y_low > 0 or (y_low + y_high) / 2 > 0.0:
            high[beside] = np.minimum(high[beside], y_low - clearance)
        else:
            low[beside] = np.maximum(low[beside], y_high + clearance)
    wrong = low > high
    if wrong.any():
        raise ValueError(f"no way past the clutter at x = {x[wrong][0]:.2f} m: move it towards the walls")
    # Clamp, smooth the corners that clamping makes, and clamp only by what smoothing may undo (centimetres).
    window = np.hanning(41) / np.hanning(41).sum()
    clamped = np.clip(y, low + 0.02, high - 0.02)
    return CubicSpline(x, np.convolve(np.pad(clamped, 20, mode="edge"), window, mode="valid"))
