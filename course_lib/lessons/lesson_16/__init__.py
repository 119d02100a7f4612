"""Lesson 16, pose from points: matched points of the room, noise on points, the figures and the panel of the fit."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider
from course_lib.lessons.lesson_15 import room_map, room_scenes
from course_lib.plots import figures
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, RigidFitError, fit_rigid_2d

PAIR = "03_b"  # the same photographs as in lesson 15
SIGMA = 0.1  # metres, noise of a point in each direction where the lesson needs one (chosen: about what boxes give)
ROOM, LINE, CORNER, ONE_PLACE = "in a room", "in a line", "in one corner", "in one place"
MIRRORED, TWO = "mirrored", "two objects only"
_LANDMARKS = {
    ROOM: [[1.0, 1.0], [5.0, 1.5], [4.5, 4.5], [1.5, 4.0], [3.2, 5.0], [2.6, 0.6]],
    LINE: [[0.5, 5.0], [1.2, 5.0], [2.1, 5.0], [3.4, 5.0], [4.6, 5.0], [5.5, 5.0]],
    CORNER: [[5.0, 4.8], [5.2, 4.9], [5.1, 5.1], [4.9, 5.0], [5.3, 5.2], [5.0, 5.3]],
    ONE_PLACE: [[4.0, 4.0]] * 6,
    MIRRORED: [[1.0, 1.0], [5.0, 1.5], [4.5, 4.5], [1.5, 4.0], [3.2, 5.0], [2.6, 0.6]],
    TWO: [[1.0, 1.0], [4.5, 4.5]],
}
_PLACE = (2.5, 2.5)  # where the panel's camera stands, metres
_ARROW = 0.8  # metres, length of a heading


class Matched(NamedTuple):
    """Matched points, and the pose that they should give."""

    source: np.ndarray
    """`(n, 2)` body frame, metres."""
    target: np.ndarray
    """`(n, 2)` world, metres."""
    pose: Pose2D
    landmarks: tuple[int, ...] = ()
    """The landmarks that the points really show."""


def matched_points(name: str = PAIR) -> Matched:
    """Measured objects of a pair of photographs with their right landmarks: no matching takes part."""
    scene = room_scenes()[name]
    source = np.array([[one.x, one.y] for one in scene.observations])
    return Matched(source, room_map().positions[list(scene.true_landmarks)], scene.pose, scene.true_landmarks)


def pose_error(found: Pose2D, true: Pose2D) -> tuple[float, float]:
    """Metres, and degrees without sign."""
    off = float(np.hypot(found.x - true.x, found.y - true.y))
    return off, float(np.rad2deg(abs(wrap_angle(found.theta - true.theta))))


def noisy_fits(target: np.ndarray, pose: Pose2D, sigma: float, n_trials: int, rng: np.random.Generator) -> np.ndarray:
    """Errors `(n_trials, 3)` of x, y [m] and theta [rad] when each point is measured with noise sigma [m]."""
    exact = _seen_from(target, pose)
    errors = np.empty((n_trials, 3))
    for k in range(n_trials):
        found = fit_rigid_2d(exact + rng.normal(0.0, sigma, exact.shape), target)
        errors[k] = found.x - pose.x, found.y - pose.y, wrap_angle(found.theta - pose.theta)
    return errors


def expected_sigmas(target: np.ndarray, pose: Pose2D, sigma: float) -> tuple[float, float]:
    """Standard deviation of the heading [rad], and root mean square of the error of place [m].

    sigma_theta^2 = sigma^2 / sum |b_i|^2;  place: 2 sigma^2 / n + g^2 sigma_theta^2, g from camera to centroid.
    """
    centred = target - target.mean(axis=0)
    of_heading = sigma / np.sqrt((centred**2).sum())
    arm = np.hypot(*(target.mean(axis=0) - [pose.x, pose.y]))
    return float(of_heading), float(np.sqrt(2 * sigma**2 / len(target) + (arm * of_heading) ** 2))


def ring_of_landmarks(n: int) -> np.ndarray:
    """Landmarks `(n, 2)`, evenly on a circle of 2.5 m about (3, 3)."""
    turn = 2 * np.pi * np.arange(n) / n
    return 3.0 + 2.5 * np.column_stack([np.cos(turn), np.sin(turn)])


def mirrored_by_plain_svd(target: np.ndarray, sigma: float, n_trials: int, rng: np.random.Generator) -> float:
    """Share of noisy trials in which U V^T, without the sign, is a reflection and no rotation."""
    exact = target - target.mean(axis=0)
    count = 0
    for _ in range(n_trials):
        source, noisy_map = (exact + rng.normal(0.0, sigma, exact.shape) for _ in range(2))
        u, _, vt = np.linalg.svd((noisy_map - noisy_map.mean(axis=0)).T @ (source - source.mean(axis=0)))
        count += np.linalg.det(u @ vt) < 0
    return count / n_trials


def landmarks_of(arrangement: str) -> np.ndarray:
    """Landmarks `(n, 2)` of one of the panel's arrangements, world, metres."""
    return np.array(_LANDMARKS[arrangement])


def _seen_from(points: np.ndarray, pose: Pose2D) -> np.ndarray:
    """World points in the body frame of a pose."""
    cosine, sine = np.cos(pose.theta), np.sin(pose.theta)
    return (points - [pose.x, pose.y]) @ np.array([[cosine, -sine], [sine, cosine]])


def centred_figure(points: Matched) -> Figure:
    """The measured points, the landmarks, and both about their centroids: only a turn is left."""
    figure, (body, world, both) = figures.new_figure(1, 3, size=(10.4, 3.7))
    a, b = points.source - points.source.mean(axis=0), points.target - points.target.mean(axis=0)
    _numbered(body, points.source, 0, "measured")
    body.plot(0, 0, marker=(3, 0, -90), color=figures.BLACK, markersize=10)
    body.set(title="Measured, body frame", xlabel="forward x [m]", ylabel="left y [m]")
    _numbered(world, points.target, 1, "landmark")
    world.set(title="Landmarks, world frame", xlabel="x [m]", ylabel="y [m]")
    _numbered(both, a, 0, "measured")
    _numbered(both, b, 1, "landmark")
    both.set(title="Both about their centroids", xlabel="x - centroid [m]", ylabel="y - centroid [m]")
    for axes in (body, world, both):
        axes.set(aspect="equal")
    handles, labels = both.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2, frameon=False)
    return figure


def _numbered(axes: Axes, points: np.ndarray, index: int, name: str) -> None:
    style = figures.line_style(index) | {"linestyle": "none", "markersize": 5}
    axes.plot(*points.T, **style, label=name)
    axes.plot(*points.mean(axis=0), "+", color=style["color"], markersize=14, markeredgewidth=2)
    for k, (x, y) in enumerate(points, start=1):
        axes.annotate(str(k), (x, y), (4, 3), textcoords="offset points", fontsize=7, color=style["color"])


def residual_over_heading(source: np.ndarray, target: np.ndarray, headings: np.ndarray) -> np.ndarray:
    """Root mean square residual [m] for each heading [rad], with the best translation for that heading."""
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    dot, cross = np.sum(a * b), np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    squares = np.sum(a**2) + np.sum(b**2) - 2 * (dot * np.cos(headings) + cross * np.sin(headings))
    return np.sqrt(np.maximum(squares, 0.0) / len(a))


def heading_figure(curves: dict[str, tuple[np.ndarray, np.ndarray]]) -> Figure:
    """Residual over heading for several sets of points (source, target)."""
    figure, axes = figures.new_figure(size=(7.4, 3.0))
    headings = np.deg2rad(np.linspace(-180, 180, 361))
    for index, (name, (source, target)) in enumerate(curves.items()):
        style = figures.line_style(index) | {"markevery": 30}
        axes.plot(np.rad2deg(headings), residual_over_heading(source, target, headings), **style, label=name)
    axes.set(title="What is left over, for every heading", xlabel="heading [degrees]", ylabel="RMS residual [m]")
    axes.set(ylim=(0, None), xticks=np.arange(-180, 181, 60))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure


def noise_figure(n_points: list[int], found: np.ndarray, expected: np.ndarray) -> Figure:
    """Spread of the heading (degrees) over the number of points: tried, and by the closed form."""
    figure, axes = figures.new_figure(size=(6.4, 2.8))
    axes.loglog(n_points, expected, **(figures.line_style(1) | {"marker": ""}), label="closed form")
    axes.loglog(n_points, found, **(figures.line_style(0) | {"linestyle": "none"}), label="tried")
    axes.set(title="Spread of the heading", xlabel="number of points n [-]", ylabel="spread [degrees]")
    axes.set_xticks(n_points, [str(n) for n in n_points])
    axes.set_yticks([0.4, 0.8, 1.6], ["0.4", "0.8", "1.6"])
    axes.minorticks_off()
    axes.legend(frameon=False)
    return figure


def scene_of(
    arrangement: str, heading_deg: float, noise: float, seed: int, moved: int, forward: float, left: float
) -> Matched:
    """The panel's points: exact ones, then noise, then one object moved in the body frame (moved counts from 1)."""
    target = landmarks_of(arrangement)
    pose = Pose2D(*_PLACE, float(wrap_angle(np.deg2rad(heading_deg))))
    source = _seen_from(target, pose)
    if arrangement == MIRRORED:
        source = source * [1.0, -1.0]
    source = source + noise * np.random.default_rng(seed).standard_normal(source.shape)
    source[min(moved, len(source)) - 1] += [forward, left]
    return Matched(source, target, pose)


def fit_panel() -> Panel:
    """Move a measured object, add noise, choose an arrangement: the fit, what is left over, and the named errors."""
    figure, (body, world, curve) = figures.new_figure(1, 3, size=(10.8, 3.9))
    numbers = [str(k) for k in range(1, 7)]
    (measured,) = body.plot([], [], "x", color=figures.BLUE, markersize=8, markeredgewidth=2)
    (mover,) = body.plot([], [], "o", mfc="none", color=figures.VERMILION, markersize=15, markeredgewidth=1.6)
    body.plot(0, 0, marker=(3, 0, -90), color=figures.BLACK, markersize=11)
    body.set(title="Measured, body frame", xlabel="forward x [m]", ylabel="left y [m]", aspect="equal")
    body.set(xlim=(-6.5, 6.5), ylim=(-6.5, 6.5))
    (marks,) = world.plot([], [], "s", mfc="none", color=figures.ORANGE, markersize=9, mew=2, label="landmark")
    (landed,) = world.plot([], [], "x", color=figures.BLUE, markersize=8, markeredgewidth=2, label="measured, fitted")
    rests = LineCollection([], colors=figures.VERMILION, linewidths=1.6)
    world.add_collection(rests)
    (truth,) = world.plot([], [], "-o", color=figures.BLACK, markersize=8, linewidth=2, label="true pose", mfc="none")
    (found_pose,) = world.plot([], [], "-D", color=figures.GREEN, markersize=5, linewidth=2, label="fitted pose")
    truth.set_markevery([0])
    found_pose.set_markevery([0])
    world.set(title="World: the fit", xlabel="x [m]", ylabel="y [m]", aspect="equal", xlim=(-1.5, 7.5), ylim=(-1, 8))
    world.legend(loc="upper center", fontsize=7, ncols=2, framealpha=0.95)
    grid = np.deg2rad(np.linspace(-180, 180, 121))
    (rms_line,) = curve.plot(np.rad2deg(grid), 0 * grid, color=figures.BLUE, linewidth=1.8)
    (best,) = curve.plot([], [], "D", color=figures.GREEN, markersize=7, label="fit")
    (true_line,) = curve.plot([], [], "--", color="0.4", linewidth=1.2, label="true")
    curve.set(
        title="Left over, for every heading", xlabel="heading [degrees]", ylabel="RMS residual [m]", ylim=(0, 5.5)
    )
    curve.set(xlim=(-180, 180), xticks=np.arange(-180, 181, 90))
    curve.legend(loc="upper right", fontsize=8)
    texts = [axes.text(0, 0, number, fontsize=8) for axes in (body, world) for number in numbers]
    lines = [measured, mover, marks, landed, rests, truth, found_pose, rms_line, true_line, best]
    live = LiveFigure(figure, lines + texts)

    def draw(
        arrangement: str, moved: float, forward: float, left: float, noise: float, seed: float, heading: float
    ) -> Drawing:
        points = scene_of(arrangement, heading, noise, int(seed), int(moved), forward, left)
        n = len(points.source)
        measured.set_data(*points.source.T)
        mover.set_data(*points.source[min(int(moved), n) - 1][:, None])
        marks.set_data(*points.target.T)
        for k, text in enumerate(texts):
            place = (points.source if k < 6 else points.target)[min(k % 6, n - 1)]
            text.set_position((place[0] + 0.25, place[1] + 0.2))
        truth.set_data(*_arrow(points.pose))
        rms = residual_over_heading(points.source, points.target, grid)
        rms_line.set_ydata(rms)
        true_line.set_data([np.rad2deg(points.pose.theta)] * 2, [0, 5.5])
        try:
            found = fit_rigid_2d(points.source, points.target)
        except RigidFitError as error:
            for artist in (landed, found_pose, best):
                artist.set_data([], [])
            rests.set_segments([])
            summary = f"no pose. {error.reason}: {error}"
        else:
            fitted = found.apply(points.source)
            landed.set_data(*fitted.T)
            rests.set_segments(list(np.stack([fitted, points.target], axis=1)))
            found_pose.set_data(*_arrow(found))
            left_over = float(np.sqrt(((fitted - points.target) ** 2).sum(axis=1).mean()))
            best.set_data([np.rad2deg(found.theta)], [left_over])
            off, turned = pose_error(found, points.pose)
            summary = f"pose off by {off:.2f} m and {turned:.1f} degrees; RMS residual {left_over:.2f} m"
        summary += f"\nresidual over all headings: from {rms.min():.2f} to {rms.max():.2f} m"
        alt = (
            f"Objects {arrangement}, as measured, and on the map with the fitted and the true pose; and the residual "
            f"over the heading. {' '.join(summary.splitlines())}"
        )
        return Drawing(live.png(), alt, summary)

    controls = [
        Choice("arrangement", "objects", tuple(_LANDMARKS), ROOM),
        Slider("moved", "object to move", 1, 6, 3, 1),
        Slider("forward", "move it forward [m]", -3.0, 3.0, 0.0, 0.1),
        Slider("left", "move it left [m]", -3.0, 3.0, 0.0, 0.1),
        Slider("noise", "noise sigma [m]", 0.0, 0.5, 0.1, 0.02),
        Slider("seed", "seed of the noise", 0, 9, 0, 1),
        Slider("heading", "true heading [degrees]", -180, 180, 40, 5),
    ]
    return Panel("16 the fit", controls, draw)


def _arrow(pose: Pose2D) -> np.ndarray:
    """Two points `(2, 2)`, x and y in the rows: the place, and the end of its heading."""
    start = np.array([pose.x, pose.y])
    return np.stack([start, start + _ARROW * np.array([np.cos(pose.theta), np.sin(pose.theta)])], axis=1)


PANELS = {"16 the fit": fit_panel}
