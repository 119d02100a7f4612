"""Figures of F4: two spheres and a plane, errors of the motion, ellipses of a pose; and the panel of two panoramas."""

import numpy as np
from matplotlib.figure import Figure

from course_lib.geometry import pose_matrix
from courseware.lessons.kit.display import described
from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.panel import Drawing, Panel, Slider
from courseware.plots import figures

BLUE, VERMILION, GREEN = figures.BLUE, figures.VERMILION, figures.GREEN


def circle_about(normal: np.ndarray, n: int = 181) -> np.ndarray:
    """Return the great circle `(n, 3)` whose plane has this normal."""
    first = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    first /= np.linalg.norm(first)
    second = np.cross(normal, first) / np.linalg.norm(normal)
    around = np.linspace(0, 2 * np.pi, n)[:, None]
    return np.cos(around) * first + np.sin(around) * second


def spheres_figure(R: np.ndarray, c: np.ndarray, point: np.ndarray) -> Figure:
    """Draw two unit spheres, the second at c [m] with axes R, a point, and the plane of the three."""
    figure, flat = figures.new_figure(size=(7.6, 4.6))
    flat.remove()
    axes = figure.add_subplot(1, 1, 1, projection="3d", computed_zorder=False)
    u, v = np.mgrid[0 : 2 * np.pi : 40j, 0 : np.pi : 20j]
    ball = np.array([np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v)])
    normal = np.cross(c, point) / np.linalg.norm(np.cross(c, point))
    corners = np.array([-0.3 * c - 0.35 * point, 1.25 * c - 0.35 * point, 1.25 * c + 1.05 * (point - c), 1.2 * point])
    axes.plot_trisurf(*corners.T, triangles=[[0, 1, 2], [0, 2, 3]], color=figures.YELLOW, alpha=0.35, shade=False)
    both = ((np.zeros(3), np.eye(3), BLUE, "first camera"), (c, R, VERMILION, "second camera"))
    for place, frame, colour, name in both:
        axes.plot_surface(*(ball + place[:, None, None]), color="0.8", alpha=0.25, linewidth=0)
        axes.plot(*(place + circle_about(normal)).T, color=colour, linewidth=2)
        axes.plot(*np.transpose([place, point]), color=colour, linestyle="--", linewidth=1.6)
        axes.plot(*(place + (point - place) / np.linalg.norm(point - place)), "o", color=colour)
        for axis in frame.T:
            axes.plot(*np.transpose([place, place + 0.45 * axis]), color="0.35", linewidth=1.2)
        axes.text(*(place - [0, 0, 1.35]), name, color=colour, ha="center")
    axes.plot(*np.transpose([np.zeros(3), c]), color=figures.BLACK, linewidth=2)
    axes.text(*(c / 2 + [0, 0, -0.3]), "c", fontsize=11)
    axes.plot(*np.transpose([np.zeros(3), 1.4 * normal]), color=GREEN, linewidth=2, marker="^", markevery=[1])
    axes.text(*(1.55 * normal), "c × x1", color=GREEN, ha="center")
    axes.plot(*point, "ks")
    axes.text(*(point + 0.12), "point")
    axes.set(title="Two cameras and a point lie in one plane", xlabel="x [m]", ylabel="y [m]")
    axes.set(xlim=(-1, 4), ylim=(-1, 3), zlim=(-1.4, 1.8))
    axes.set_box_aspect((5, 4, 3.2), zoom=1.2)
    axes.locator_params(nbins=4)
    axes.view_init(elev=24, azim=-62)
    alt = "Two spheres around two cameras. The plane of both centres and a point cuts each in a great circle."
    return described(figure, alt)


def motion_figure(n_matches: list[int], errors: dict[str, np.ndarray]) -> Figure:
    """Draw the median error of the direction of c, degrees, over the number of matches, for several estimates."""
    labels = {"title": "Error of the direction of the baseline", "xlabel": "matches [-]", "ylabel": "error [degrees]"}
    figure, axes = figures.curves_figure(np.array(n_matches), errors, (7.6, 3.0), 1, **labels)
    axes.set(xscale="log", yscale="log")
    axes.set_xticks(n_matches, [str(n) for n in n_matches])
    axes.set_yticks([0.2, 0.5, 1, 2, 5, 10, 20, 50], ["0.2", "0.5", "1", "2", "5", "10", "20", "50"])
    axes.minorticks_off()
    alt = "Error over the number of matches. Wrong matches raise the line of eight points far above the other two."
    return described(figure, alt)


def ellipses_figure(objects: np.ndarray, pose: np.ndarray, covariances: dict[str, np.ndarray]) -> Figure:
    """Draw a room with its objects and the camera, and beside it, larger, ellipses of its place (two sigma)."""
    figure, (room, near) = figures.new_figure(1, 2, size=(9.4, 3.8))
    room.plot(*objects.T, "s", color=figures.ORANGE, markersize=9)
    for one in objects:
        room.plot(*np.transpose([pose[:2], one]), ":", color="0.5")
    room.plot(*pose[:2], marker=(3, 0, np.rad2deg(pose[2]) - 90), color=figures.BLACK, markersize=12)
    room.set(title="Objects, and the camera that sees them", xlabel="x [m]", ylabel="y [m]", aspect="equal")
    room.set(xlim=(-0.2, 5.2), ylim=(-0.2, 5.2))
    circle = 2 * np.array([np.cos(np.linspace(0, 2 * np.pi, 90)), np.sin(np.linspace(0, 2 * np.pi, 90))])
    for k, (name, covariance) in enumerate(covariances.items()):
        offsets = np.linalg.cholesky(covariance[:2, :2]) @ circle
        near.plot(*(pose[:2, None] + offsets), **(figures.line_style(k) | {"marker": "", "linewidth": 2}), label=name)
    near.plot(*pose[:2], "+", color=figures.BLACK, markersize=10)
    near.set(title="Where the camera may be (two sigma)", xlabel="x [m]", ylabel="y [m]", aspect="equal")
    near.legend(**figures.BESIDE)
    alt = (
        "Three objects and a camera, and ellipses of its place: large by ranges alone, small by directions or by both."
    )
    return described(figure, alt)


POINTS = np.array([[2.5, 0.6, 0.5], [1.2, -2.0, -0.8], [-1.5, 1.8, 0.9], [-2.0, -1.0, -0.6]])  # m, first frame
CONTROLS = [
    Slider("forward", "second camera: forward [m]", -1.0, 1.0, 0.0, 0.1),
    Slider("left", "left [m]", -1.0, 1.0, 0.0, 0.1),
    Slider("up", "up [m]", -1.0, 1.0, -0.6, 0.1),
    Slider("yaw", "yaw [degrees]", -90, 90, 0, 5),
    Slider("pitch", "pitch [degrees]", -60, 60, 0, 5),
    Slider("roll", "roll [degrees]", -60, 60, 0, 5),
]


def on_panorama(directions: np.ndarray) -> np.ndarray:
    """Return azimuth and elevation [degrees] `(2, n)` of vectors `(n, 3)`, with NaN at the seam and at a pole."""
    x, y, z = directions.T
    angles = np.rad2deg([np.arctan2(y, x), np.arctan2(z, np.hypot(x, y))])
    jumps = np.flatnonzero(np.abs(np.diff(angles[0])) > 90) + 1
    return np.insert(angles, jumps, np.nan, axis=1)


def views_panel() -> Panel:
    """Move the second camera: four points on both panoramas, and the curve on which each of them must lie."""
    figure, (first, second) = figures.new_figure(1, 2, size=(10.6, 3.1))
    for axes, name in ((first, "First panorama"), (second, "Second panorama, with the curve of each point")):
        axes.set(title=name, xlabel="azimuth [degrees]", ylabel="elevation [degrees]", aspect="equal")
        axes.set(xlim=(180, -180), ylim=(-94, 94), xticks=range(-180, 181, 90), yticks=range(-90, 91, 45))
    moving = []
    for k, point in enumerate(POINTS):
        look = figures.line_style(k)
        dot = {"color": look["color"], "marker": look["marker"], "linestyle": "none", "markersize": 8}
        first.plot(*on_panorama(point[None]), **dot)
        whole = second.plot([], [], color=look["color"], linewidth=0.8, linestyle=":")
        arc = second.plot([], [], color=look["color"], linewidth=2, linestyle=look["linestyle"])
        moving.append([*whole, *arc, *second.plot([], [], **dot)])
    others = [
        axes.plot([], [], "X", color=figures.BLACK, ms=9, label="the other camera")[0] for axes in (first, second)
    ]
    first.legend(handles=others[:1], loc="lower left", fontsize=8)
    live = LiveFigure(figure, [*(line for lines in moving for line in lines), *others])
    share = np.linspace(0.001, 1, 121)[:, None]  # 0: at the other camera, 1: infinitely far away

    def draw(forward, left, up, yaw, pitch, roll) -> Drawing:
        c = np.array([forward, left, up])
        R = pose_matrix(np.array([0, 0, 0, *np.deg2rad([roll, pitch, yaw])]))[:3, :3]
        seen = (POINTS - c) @ R
        apart = bool(c.any())
        for point, place, (whole, arc, dot) in zip(POINTS, seen, moving, strict=True):
            normal = R.T @ np.cross(c, point)
            whole.set_data(*(on_panorama(circle_about(normal)) if apart else ([], [])))
            ends = point / np.linalg.norm(point), c / max(np.linalg.norm(c), 1e-9)
            arc.set_data(*(on_panorama((share * ends[0] - (1 - share) * ends[1]) @ R) if apart else ([], [])))
            dot.set_data(*on_panorama(place[None]))
        for line, to in zip(others, (c, -R.T @ c), strict=True):
            line.set_data(*(on_panorama(to[None]) if apart else ([], [])))
        azimuths = [np.rad2deg(np.arctan2(one[:, 1], one[:, 0])) for one in (POINTS, seen)]
        moved = (azimuths[1] - azimuths[0] + 180) % 360 - 180 + 0.0
        columns = "azimuth, second minus first [degrees]: " + ", ".join(f"{value:.0f}" for value in moved)
        E = R.T @ np.cross(np.eye(3), c)
        off = np.abs(np.sum(seen @ E * POINTS, axis=1)).max()
        summary = f"{columns}\nlargest |x2' E x1| of the four points: {off:.1g}"
        summary += "" if apart else "; without a baseline E is zero and forbids nothing"
        alt = f"Four points on two panoramas, and their curves on the second one. {' '.join(summary.split())}"
        return Drawing(live.png(), alt, summary)

    return Panel("F4 two panoramas", CONTROLS, draw)


PANELS = {"F4 two panoramas": views_panel}
