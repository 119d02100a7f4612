"""Lesson 16's panel: move, disturb and arrange the objects, and see the fit."""

import numpy as np
from matplotlib.collections import LineCollection

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, RigidFitError, fit_rigid_2d
from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.panel import Choice, Drawing, Panel, Slider
from courseware.lessons.kit.room_data import in_body_frame
from courseware.lessons.lesson_16.fits import LANDMARKS, MIRRORED, ROOM, landmarks_of, pose_error, residual_over_heading
from courseware.plots import figures

CONTROLS = [
    Choice("arrangement", "objects", tuple(LANDMARKS), ROOM),
    Slider("moved", "object to move", 1, 6, 3, 1),
    Slider("forward", "move it forward [m]", -3.0, 3.0, 0.0, 0.1),
    Slider("left", "move it left [m]", -3.0, 3.0, 0.0, 0.1),
    Slider("noise", "noise sigma [m]", 0.0, 0.5, 0.1, 0.02),
    Slider("seed", "seed of the noise", 0, 9, 0, 1),
    Slider("heading", "true heading [degrees]", -180, 180, 40, 5),
]


def fit_panel() -> Panel:
    """Move a measured object, add noise, choose an arrangement: the fit, what is left over, and the named errors."""
    figure, (body, world, curve) = figures.new_figure(1, 3, size=(10.8, 3.9))
    (measured,) = body.plot([], [], "x", color=figures.BLUE, markersize=8, markeredgewidth=2)
    (mover,) = body.plot([], [], "o", mfc="none", color=figures.VERMILION, markersize=15, markeredgewidth=1.6)
    body.plot(0, 0, marker=(3, 0, 0), color=figures.BLACK, markersize=11)
    body.set(title="Measured, body frame", xlabel="to the right, -y [m]", ylabel="forward, x [m]", aspect="equal")
    body.set(xlim=(-6.5, 6.5), ylim=(-6.5, 6.5))
    (marks,) = world.plot([], [], "s", mfc="none", color=figures.ORANGE, markersize=9, mew=2, label="landmark")
    (landed,) = world.plot([], [], "x", color=figures.BLUE, markersize=8, markeredgewidth=2, label="measured, fitted")
    rests = world.add_collection(LineCollection([], colors=figures.VERMILION, linewidths=1.6))
    arrow = {"linewidth": 2, "markevery": [0]}
    (truth,) = world.plot([], [], "-o", color=figures.BLACK, markersize=8, mfc="none", label="true pose", **arrow)
    (fitted,) = world.plot([], [], "-D", color=figures.GREEN, markersize=5, label="fitted pose", **arrow)
    world.set(title="World: the fit", xlabel="x [m]", ylabel="y [m]", aspect="equal", xlim=(-1.5, 7.5), ylim=(-1, 8))
    world.legend(loc="upper center", fontsize=7, ncols=2, framealpha=0.95)
    degrees = np.linspace(-180, 180, 121)
    (rms_line,) = curve.plot(degrees, 0 * degrees, color=figures.BLUE, linewidth=1.8)
    (best,) = curve.plot([], [], "D", color=figures.GREEN, markersize=7, label="fit")
    (true_line,) = curve.plot([], [], "--", color="0.4", linewidth=1.2, label="true")
    curve.set(title="Left over, for every heading", xlabel="heading [degrees]", ylabel="RMS residual [m]")
    curve.set(xlim=(-180, 180), xticks=np.arange(-180, 181, 90), ylim=(0, 5.5))
    curve.legend(loc="upper right", fontsize=8)
    numbers = [[axes.text(0, 0, str(k), fontsize=8) for k in range(1, 7)] for axes in (body, world)]
    lines = [measured, mover, marks, landed, rests, truth, fitted, rms_line, true_line, best]
    live = LiveFigure(figure, lines + numbers[0] + numbers[1])

    def draw(arrangement, moved, forward, left, noise, seed, heading) -> Drawing:
        target, pose = landmarks_of(arrangement), Pose2D(2.5, 2.5, float(wrap_angle(np.deg2rad(heading))))
        source, n = in_body_frame(target, pose) * [1, -1 if arrangement == MIRRORED else 1], len(target)
        source += noise * np.random.default_rng(int(seed)).standard_normal(source.shape)
        k = min(int(moved), n) - 1
        source[k] += [forward, left]
        drawn = source[:, ::-1] * [-1, 1]  # forward is up
        measured.set_data(*drawn.T)
        mover.set_data(*drawn[[k]].T)
        marks.set_data(*target.T)
        for texts, places in zip(numbers, (drawn, target), strict=True):
            for text, (x, y) in zip(texts, [*places, *[places[-1]] * (6 - n)], strict=True):
                text.set_position((x + 0.25, y + 0.2))
        truth.set_data(*heading_line(pose))
        rms = residual_over_heading(source, target, np.deg2rad(degrees))
        rms_line.set_ydata(rms)
        true_line.set_data([np.rad2deg(pose.theta)] * 2, [0, 5.5])
        found, summary = Pose2D(np.nan, np.nan, np.nan), ""
        try:
            found = fit_rigid_2d(source, target)
        except RigidFitError as error:
            summary = f"no pose. {error.reason}: {error}"
        landing, (off, turned) = found.apply(source), pose_error(found, pose)
        left_over = np.sqrt(((landing - target) ** 2).sum(axis=1).mean())
        summary = summary or f"pose off by {off:.2f} m and {turned:.1f} degrees; RMS residual {left_over:.2f} m"
        landed.set_data(*landing.T)
        rests.set_segments(np.stack([landing, target], axis=1))
        fitted.set_data(*heading_line(found))
        best.set_data([np.rad2deg(found.theta)], [left_over])
        summary += f"\nresidual over all headings: from {rms.min():.2f} to {rms.max():.2f} m"
        alt = (
            f"Objects {arrangement}, as measured, and on the map with the fitted and the true pose; and the residual "
            f"over the heading. {' '.join(summary.splitlines())}"
        )
        return Drawing(live.png(), alt, summary)

    return Panel("16 the fit", CONTROLS, draw)


def heading_line(pose: Pose2D) -> np.ndarray:
    """Return x and y of the place and of the end of its heading, in rows."""
    return np.array([[pose.x, pose.x + 0.8 * np.cos(pose.theta)], [pose.y, pose.y + 0.8 * np.sin(pose.theta)]])


PANELS = {"16 the fit": fit_panel}
