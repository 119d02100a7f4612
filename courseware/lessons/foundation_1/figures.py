"""Figures of F1: what depends on what, beliefs along the corridor, sample sizes, and the panel."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from courseware.lessons.foundation_1 import corridor
from courseware.lessons.foundation_1.corridor import BINS, FRAMES, GRID, HALF_WIDTH, NICHES, WHEN, binned
from courseware.lessons.kit.display import described
from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.panel import Choice, Drawing, Panel, Slider
from courseware.plots import figures

MIDDLES = (BINS[:-1] + BINS[1:]) / 2


def markov_figure() -> Figure:
    """Draw three states in a row, the moves that lead to them, and the measurements that they cause."""
    figure, axes = figures.new_figure(size=(7.6, 3.1))
    axes.set_axis_off()
    axes.set(title="What depends on what: each arrow is one p( ... | ... )", xlim=(-1, 5.2), ylim=(-1.5, 1.5))
    rows = {"u": (1.1, "#F4D9A8", "moves"), "x": (0, "#BFDDF2", "states (hidden)"), "z": (-1.1, "white", "measured")}
    for letter, (y, colour, name) in rows.items():
        axes.text(-0.95, y, name, va="center")
        for k, index in enumerate(("t-1", "t", "t+1")):
            word, here = f"${letter}_{{{index}}}$", (1 + 1.6 * k, y)
            axes.plot(*here, "o", markersize=31, markerfacecolor=colour, markeredgecolor="0.3", zorder=2)
            axes.text(*here, word, ha="center", va="center", fontsize=11, zorder=3)
    arrow = {"arrowstyle": "-|>", "color": "0.2", "shrinkA": 17, "shrinkB": 17, "linewidth": 1.3}
    for k in range(3):
        x = 1 + 1.6 * k
        for start in ((x, 1.1), (x - 1.6 + 0.35 * (k == 0), 0)):
            axes.annotate("", (x, 0), start, arrowprops=arrow)
        axes.annotate("", (x, -1.1), (x, 0), arrowprops=arrow)
    alt = """Three circles for the states in a row; an arrow leads from each state to the next one, from each move
        to its state, and from each state to its measurement. No arrow joins two measurements."""
    return described(figure, alt)


def draw_corridor(axes: Axes, belief: np.ndarray, top: float = 1.0) -> list:
    """Draw an exact belief in shares per half metre, and the niches as bars on the floor; return what may change."""
    bars = axes.bar(MIDDLES, belief, width=0.48, color=figures.SKY_BLUE, label="exact belief")
    for k, niche in enumerate(NICHES):
        span, label = (niche - HALF_WIDTH, niche + HALF_WIDTH), "niche" if k == 0 else None
        axes.plot(span, (-0.03 * top,) * 2, color=figures.ORANGE, linewidth=5, solid_capstyle="butt", label=label)
    axes.set(xlim=(0, 13), ylim=(-0.06 * top, top), xlabel="x along the corridor [m]", ylabel="share per 0.5 m [-]")
    return list(bars)


def beliefs_figure(seed: int, frames: list[int], shares: dict[str, np.ndarray] | None = None) -> Figure:
    """Draw the exact belief after some frames, and the shares (T, bins) of particle filters beside it."""
    figure, axes = figures.new_figure(len(frames), 1, size=(8.0, 1.75 * len(frames)))
    true, exact = corridor.record(seed)[0], binned(corridor.exact_beliefs(seed))
    for a, frame in zip(np.atleast_1d(axes), frames, strict=True):
        draw_corridor(a, exact[frame - 1], 1.1 * max(exact[frame - 1].max(), 0.2))
        for index, (name, one) in enumerate((shares or {}).items()):
            style = figures.line_style(3 * index + 3) | {"linestyle": "none", "markersize": 6}
            a.plot(MIDDLES, one[frame - 1], **style, label=name)
        a.axvline(true[frame - 1], color=figures.BLACK, linestyle="--", linewidth=1.3, label="wagon")
        a.set(title=f"after frame {frame}", xlabel="")
    figure.supxlabel("x along the corridor [m]", fontsize=9)
    np.atleast_1d(axes)[0].legend(loc="upper right", ncols=4, fontsize=8, framealpha=0.95)
    places = ", ".join(f"{GRID[corridor.exact_beliefs(seed)[f - 1].argmax()]:.1f} m" for f in frames)
    alt = f"""Bars along the corridor: the exact belief after the frames {frames}, highest at {places}; a dashed line
        at the wagon{", and markers for " + " and ".join(shares) if shares else ""}."""
    return described(figure, alt)


def sizes_figure(sizes: dict[str, np.ndarray]) -> Figure:
    """Draw the effective sample size over the frames, on a logarithmic axis, for named filters."""
    labels = {"title": "How many of 1,000 particles take part (median of 20 runs)", "xlabel": "frame t [-]"}
    labels |= {"ylabel": "effective sample size [particles]", "yscale": "log", "ylim": (1, 2000)}
    figure, _ = figures.curves_figure(np.arange(1, FRAMES + 1), sizes, (7.6, 3.2), 4, **labels)
    alt = """Effective sample size over 30 frames: without resampling it falls from about 800 to 3; with resampling it
        stays at some hundreds."""
    return described(figure, alt)


CONTROLS = [
    Choice("when", "resample", tuple(WHEN), "never"),
    Slider("n", "number of particles N", 10, 2000, 500, 10),
    Slider("sigma", "sigma of the depth [m]", 0.02, 0.5, 0.1, 0.02),
    Slider("frame", "frame t", 1, FRAMES, 8, 1),
    Slider("seed", "seed", 1, 9, 1, 1),
]


def corridor_panel() -> Panel:
    """Show the particles' belief beside the exact one, and the effective sample size up to the present frame."""
    figure, (above, below) = figures.new_figure(2, 1, size=(9.0, 4.9))
    bars = draw_corridor(above, np.zeros(len(MIDDLES)))
    (dots,) = above.plot([], [], "D", color=figures.VERMILION, markersize=5, label="particles, by weight")
    (wagon,) = above.plot([], [], "--", color=figures.BLACK, linewidth=1.3, label="wagon")
    above.set(title="The belief along the corridor")
    above.legend(loc="upper right", ncols=4, fontsize=8, framealpha=0.95)
    (line,) = below.semilogy([], [], **figures.line_style(0), label="effective sample size")
    (marks,) = below.semilogy([], [], "v", color=figures.VERMILION, markersize=9, label="resampled")
    (all_of,) = below.semilogy([], [], ":", color="0.4", label="N")
    below.set(title="How many particles take part", xlabel="frame t [-]", ylabel="particles [-]")
    below.set(xlim=(0, FRAMES + 1), ylim=(0.8, 4000))
    below.legend(loc="lower left", ncols=3, fontsize=8, framealpha=0.95)
    live = LiveFigure(figure, [*bars, dots, wagon, line, marks, all_of])

    def draw(when: str, n: float, sigma: float, frame: float, seed: float) -> Drawing:
        t, sigma, n, seed = int(frame), round(sigma, 2), int(n), int(seed)
        one, frames = corridor.run(seed, n, WHEN[when], sigma), np.arange(1, t + 1)
        belief, true = corridor.exact_beliefs(seed, sigma)[t - 1], corridor.record(seed, sigma)[0][t - 1]
        for bar, height in zip(bars, binned(belief[None])[0], strict=True):
            bar.set_height(height)
        dots.set_data(MIDDLES, one.shares[t - 1])
        wagon.set_data([true, true], [0, 1])
        line.set_data(frames, one.sizes[:t])
        marks.set_data(frames[one.resampled[:t]], one.sizes[:t][one.resampled[:t]])
        all_of.set_data([0, FRAMES + 1], [n, n])
        wrong = corridor.misplaced(one.shares, seed, sigma)[t - 1]
        summary = (
            f"frame {t}: effective sample size {one.sizes[t - 1]:.1f} of {n}; resampled in {one.resampled[:t].sum()}"
            f" of {t} frames\nbelief in a wrong half metre: {wrong:.0%}; means: exact {belief @ GRID:.2f} m,"
            f" particles {one.shares[t - 1] @ MIDDLES:.1f} m; wagon {true:.2f} m"
        )
        alt = f"The belief of {n} particles beside the exact one, resampled {when}; below it the sample size. {summary}"
        return Drawing(live.png(), alt, summary)

    return Panel("F1 one corridor, two filters", CONTROLS, draw)


PANELS = {"F1 one corridor, two filters": corridor_panel}
