"""The panels of lesson 10: the alarm on a recorded score, and particles that start anywhere, frame by frame."""

import numpy as np

from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider, Switch
from course_lib.lessons.kit.progress_bar import progress
from course_lib.lessons.lesson_10.figures import draw_camera, draw_hotel, trace_axes
from course_lib.lessons.lesson_10.narrowing import FRAMES, MAX_PARTICLES, RUNS, leaving_101, narrow, shares
from course_lib.lessons.lesson_10.trials import GOALS, alarms, running_mean, traces
from course_lib.plots import figures


def alarm_panel() -> Panel:
    """Sliders for both running means and the ratio of the alarm, on the three recorded scores."""
    figure, axes = figures.new_figure(size=(9.0, 3.2))
    trace_axes(axes, traces()[0])
    (dots,) = [line for line in axes.lines if line.get_label() == "raw score"]
    frames = np.arange(len(traces()[0].scores))
    (short_line,) = axes.plot(frames, frames * np.nan, color=figures.BLUE, linewidth=2, label="short mean")
    (long_line,) = axes.plot(frames, frames * np.nan, color=figures.BLACK, linestyle="--", label="c x long mean")
    (raised,) = axes.plot([], [], "v", color=figures.VERMILION, markersize=9, label="alarm")
    axes.set(title="Raw score, its two means, and the alarm", xlabel="frame [-]", ylabel="score [-]", ylim=(0.15, 1.02))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)
    live = LiveFigure(figure, [dots, short_line, long_line, raised])

    def draw(short: float, long: float, ratio: float, cannot_be_right: bool, goal: str) -> Drawing:
        trace = traces()[list(GOALS).index(goal)]
        dots.set_data(frames, trace.scores)
        short_line.set_data(frames, running_mean(trace.scores, short))
        long_line.set_data(frames, ratio * running_mean(trace.scores, long))
        alarm = alarms(trace, ratio, short, long, cannot_be_right)
        raised.set_data(frames[alarm], np.full(int(alarm.sum()), 0.98))
        false, late = int(alarm[: trace.kidnapped].sum()), np.flatnonzero(alarm[trace.kidnapped :])
        delay = f"after {late[0]} frames" if len(late) else "never"
        summary = f"false alarms: {false} of {trace.kidnapped} frames in peace; kidnapping noticed: {delay}"
        alt = f"Raw score over {len(frames)} frames with its short and long running means. {summary}"
        return Drawing(live.png(), alt, summary)

    controls = [
        Slider("ratio", "ratio c [-]", 0.5, 1.0, 0.8, 0.01),
        Slider("short", "share of a frame, short [-]", 0.05, 1.0, 0.4, 0.05),
        Slider("long", "share of a frame, long [-]", 0.0, 0.4, 0.03, 0.01),
        Switch("cannot_be_right", "and the pose cannot be right"),
        Choice("goal", "kidnapped", tuple(GOALS), "to 103"),
    ]
    return Panel("10 alarm", controls, draw)


def anywhere_panel() -> Panel:
    """A slider through the frames of runs that start anywhere: their particles from above, and how many there are."""
    runs = {number: narrow(number) for number in progress(RUNS, "runs that start anywhere")}
    figure, (plan, count) = figures.new_figure(1, 2, size=(10.6, 3.7))
    plan.get_gridspec().set_width_ratios([2.0, 1.0])
    draw_hotel(plan, "Particles from above, and where they look")
    dots = plan.scatter([], [], c=[], s=9, cmap="cividis", vmin=0, vmax=1, linewidths=0)
    arrows = plan.quiver(*np.zeros((4, MAX_PARTICLES)), color=figures.BLUE, scale=45, width=0.0016)
    before = len(plan.lines)
    draw_camera(plan, leaving_101().states[0])
    star, double = plan.lines[before:]
    figure.colorbar(dots, ax=plan, label="weight / greatest [-]", shrink=0.7)
    (line,) = count.plot([], [], **(figures.line_style(0) | {"markersize": 3}))
    (now,) = count.plot([], [], "o", mfc="none", mec=figures.VERMILION, markersize=10, mew=2)
    count.set(title="How many KLD-sampling takes", xlabel="frame [-]", ylabel="particles n [-]")
    count.set(yscale="log", xlim=(-1, FRAMES), ylim=(80, 4000))
    live = LiveFigure(figure, [dots, arrows, star, double, line, now])

    def draw(frame: float, run: float, directions: bool) -> Drawing:
        rounds, k = runs[int(run)], int(frame)
        one, state = rounds[k], leaving_101().states[k]
        order = np.argsort(one.weights, kind="stable")
        xy, relative = one.particles[order, :2], one.weights[order] / one.weights.max()
        dots.set_offsets(xy)
        dots.set_array(relative)
        ends = np.zeros((MAX_PARTICLES, 4))
        if directions:
            yaw = one.particles[order, 5]
            ends[: len(xy)] = np.column_stack([xy, np.cos(yaw), np.sin(yaw)])
        arrows.set_offsets(ends[:, :2])
        arrows.set_UVC(*ends[:, 2:].T)
        star.set_data([[state[0]], [state[1]]])
        double.set_data([[state[0] + 4.0], [state[1]]])
        counts = [len(r.particles) for r in rounds[: k + 1]]
        line.set_data(range(k + 1), counts)
        now.set_data([k], [counts[-1]])
        right, next_door = (float(share[k]) for share in shares(rounds))
        summary = (
            f"frame {k}: {len(xy)} particles in {one.bins} bins once resampled\n"
            f"weight within 1 m of the camera {right:.2f}, of its double {next_door:.2f}"
        )
        alt = f"The hotel from above with the particles of run {int(run)}. {' '.join(summary.splitlines())}"
        return Drawing(live.png(), alt, summary)

    def go(by: int):
        return lambda values: values | {"frame": float(np.clip(values["frame"] + by, 0, FRAMES - 1))}

    controls = [
        Slider("frame", "frame", 0, FRAMES - 1, 2, 1),
        Slider("run", "run (another seed)", min(RUNS), max(RUNS), 1, 1),
        Switch("directions", "show where they look"),
    ]
    return Panel("10 start anywhere", controls, draw, actions={"Back": go(-1), "Next frame": go(+1)})


PANELS = {"10 alarm": alarm_panel, "10 start anywhere": anywhere_panel}
