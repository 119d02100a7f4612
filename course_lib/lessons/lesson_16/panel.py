"""Lesson 16's panel: move, disturb and arrange the objects, and see the fit."""

import numpy as np
from matplotlib.collections import LineCollection

from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider
from course_lib.lessons.lesson_16.fits import LANDMARKS, ROOM, pose_error, residual_over_heading, scene_of
from course_lib.plots import figures
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, RigidFitError, fit_rigid_2d

_ARROW = 0.8  # metres, length of a heading


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
        Choice("arrangement", "objects", tuple(LANDMARKS), ROOM),
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
