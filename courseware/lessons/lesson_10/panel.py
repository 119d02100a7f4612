"""The panels of lesson 10: the alarm on a recorded score, and particles that start anywhere, frame by frame."""

import numpy as np

from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.panel import Choice, Drawing, Panel, Slider, Switch
from courseware.lessons.kit.progress_bar import progress
from courseware.lessons.lesson_10.figures import BELOW, BESIDE, EVENT, LIGHT_TO_DARK, draw_camera, draw_hotel, style
from courseware.lessons.lesson_10.hotel_floor import FRAMES, leaving_101
from courseware.lessons.lesson_10.narrowing import MAX_PARTICLES, RUNS, narrow, shares
from courseware.lessons.lesson_10.trials import GOALS, KIDNAPPED, PERSON, alarms, running_mean, traces
from courseware.plots import figures

ALARM_CONTROLS = [
    Slider("ratio", "ratio c [-]", 0.5, 1.0, 0.8, 0.01),
    Slider("short", "share of a frame, short [-]", 0.05, 1.0, 0.4, 0.05),
    Slider("long", "share of a frame, long [-]", 0.0, 0.4, 0.03, 0.01),
    Switch("cannot_be_right", "and the pose cannot be right"),
    Choice("goal", "kidnapped", tuple(GOALS), "to 103"),
]


def alarm_panel() -> Panel:
    """Show both running means, the ratio of the alarm and the alarms on the three recorded scores."""
    figure, axes = figures.new_figure(size=(9.0, 3.2))
    frames = np.arange(len(traces()["to 103"].scores))
    dots, *_ = axes.plot(traces()["to 103"].scores, ".", color="0.45", markersize=5, label="raw score")
    axes.axvspan(PERSON.start - 0.5, PERSON.stop - 0.5, color=figures.YELLOW, alpha=0.3, label="person")
    axes.axvline(KIDNAPPED - 0.5, linewidth=1.4, label="kidnapped", **EVENT)
    short_line, *_ = axes.plot(frames, frames * np.nan, color=figures.BLUE, linewidth=2, label="short mean")
    long_line, *_ = axes.plot(frames, frames * np.nan, color=figures.BLACK, linestyle="--", label="c x long mean")
    raised, *_ = axes.plot([], [], "v", color=figures.VERMILION, markersize=9, label="alarm")
    axes.set(title="Raw score, its two means, and the alarm", xlabel="frame [-]", ylabel="score [-]", ylim=(0.15, 1.02))
    axes.legend(**BESIDE)
    live = LiveFigure(figure, [dots, short_line, long_line, raised])

    def draw(short: float, long: float, ratio: float, cannot_be_right: bool, goal: str) -> Drawing:
        scores = traces()[goal].scores
        alarm, false, late = alarms(traces()[goal], ratio, short, long, cannot_be_right)
        dots.set_ydata(scores)
        short_line.set_ydata(running_mean(scores, short))
        long_line.set_ydata(ratio * running_mean(scores, long))
        raised.set_data(frames[alarm], np.full(int(alarm.sum()), 0.98))
        delay = "never" if late is None else f"after {late} frames"
        summary = f"false alarms: {false} of {KIDNAPPED} frames in peace; kidnapping noticed: {delay}"
        alt = f"Raw score over {len(frames)} frames with its short and long running means. {summary}"
        return Drawing(live.png(), alt, summary)

    return Panel("10 alarm", ALARM_CONTROLS, draw)


ANYWHERE_CONTROLS = [
    Slider("frame", "frame", 0, FRAMES - 1, 2, 1),
    Slider("run", "run (another seed)", min(RUNS), max(RUNS), 1, 1),
    Switch("directions", "show where they look"),
]
ANYWHERE_ACTIONS = {
    "Back": lambda values: values | {"frame": max(values["frame"] - 1, 0)},
    "Next frame": lambda values: values | {"frame": min(values["frame"] + 1, FRAMES - 1)},
}


def anywhere_panel() -> Panel:
    """Step through the frames of runs that start anywhere: the particles from above, and their number."""
    runs = {number: narrow(number) for number in progress(RUNS, "runs that start anywhere")}
    figure, (plan, count) = figures.new_figure(1, 2, size=(10.6, 3.7))
    plan.get_gridspec().set_width_ratios([2.0, 1.0])
    draw_hotel(plan, "Particles from above, and where they look")
    dots = plan.scatter([], [], c=[], cmap=LIGHT_TO_DARK, vmin=0, vmax=1, linewidths=0)
    arrows = plan.quiver(*np.zeros((4, MAX_PARTICLES)), color=figures.ORANGE, scale=45, width=0.0016)
    star, double = draw_camera(plan, leaving_101().states[0])
    figure.colorbar(dots, ax=plan, label="weight / greatest [-]", shrink=0.7)
    plan.legend(ncols=2, **BELOW)
    line, *_ = count.plot([], [], **style(0, 3))
    now, *_ = count.plot([], [], "o", mfc="none", mec=figures.VERMILION, markersize=10, mew=2)
    count.set(title="How many KLD-sampling takes", xlabel="frame [-]", ylabel="particles n [-]")
    count.set(yscale="log", xlim=(-1, FRAMES), ylim=(80, 4000))
    live = LiveFigure(figure, [dots, arrows, star, double, line, now])

    def draw(frame: float, run: float, directions: bool) -> Drawing:
        rounds, k = runs[int(run)], int(frame)
        one, state = rounds[k], leaving_101().states[k]
        order = np.argsort(one.weights, kind="stable")
        xy, yaw = one.particles[order, :2], one.particles[order, 5]
        share = one.weights[order] / one.weights.max()
        dots.set(offsets=xy, array=share, sizes=6 + 60 * share)
        ends = np.zeros((4, MAX_PARTICLES))
        if directions:
            ends[:, : len(xy)] = [*xy.T, np.cos(yaw), np.sin(yaw)]
        arrows.set_offsets(ends[:2].T)
        arrows.set_UVC(*ends[2:])
        star.set_data(state[:1], state[1:2])
        double.set_data(state[:1] + 4.0, state[1:2])
        counts = [len(r.particles) for r in rounds[: k + 1]]
        line.set_data(range(k + 1), counts)
        now.set_data([k], counts[-1:])
        right, next_door = shares(rounds)[:, k]
        summary = (
            f"frame {k}: {len(xy)} particles in {one.bins} bins once resampled\n"
            f"weight within 1 m of the camera {right:.2f}, of its double {next_door:.2f}"
        )
        alt = f"The hotel from above with the particles of run {int(run)}. {' '.join(summary.splitlines())}"
        return Drawing(live.png(), alt, summary)

    return Panel("10 start anywhere", ANYWHERE_CONTROLS, draw, actions=ANYWHERE_ACTIONS)


PANELS = {"10 alarm": alarm_panel, "10 start anywhere": anywhere_panel}
