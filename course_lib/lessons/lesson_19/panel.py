"""The panel of lesson 19: the reader puts the robot anywhere, and it finds out where it is."""

import cv2
import numpy as np

from course_lib.experiments.finale import mean_score
from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Drawing, Panel, Slider, Switch
from course_lib.lessons.lesson_19.figures import draw_room, ellipse
from course_lib.lessons.lesson_19.stages import Journey, journey, state_error
from course_lib.lessons.lesson_19.world import world
from course_lib.plots import figures
from course_lib.simulation.room.scene import free_places

STORY = {"x": 3.35, "y": 3.3, "heading": 65.0, "hidden": 0.0, "cap": False}
"""Where the lesson's robot stands, and the panel's at first."""
_WIDE, _HIGH = 640, 320  # pixels of the panorama as drawn
_VIEW = np.deg2rad(21.8)  # half of what the depth camera sees
_ZOOM = 25.0  # cm to each side of the true place


def anywhere_panel() -> Panel:
    """Robot, heading and what is covered are the reader's; "Locate" runs both methods. While a slider moves, the map
    alone is redrawn: what was seen from the last place is taken away."""
    figure = figures.new_figure(size=(9.0, 6.0))[0]
    figure.clear()
    grid = figure.add_gridspec(2, 3, height_ratios=[1.0, 1.1])
    above, plan = figure.add_subplot(grid[0, :]), figure.add_subplot(grid[1, 0])
    zoom, image = figure.add_subplot(grid[1, 1]), figure.add_subplot(grid[1, 2])
    picture = above.imshow(np.full((_HIGH, _WIDE, 3), 225, np.uint8), extent=(0, 1280, 640, 0))
    above.set(title="Upper panorama and what was found on it", xlabel="column u [pixels]", ylabel="row v [pixels]")
    (boxes,) = above.plot([], [], color=figures.VERMILION, linewidth=1.2)
    above.set(xlim=(0, 1280), ylim=(640, 0))
    draw_room(plan, "The room from above")
    for text in plan.texts:
        text.set_fontsize(5)
    (cone,) = plan.plot([], [], color=figures.BLACK, linewidth=1.0)
    (robot,) = plan.plot([], [], "o", color=figures.BLACK, markersize=5)
    (arrow,) = plan.plot([], [], color=figures.BLACK, linewidth=2.2)
    (starts,) = plan.plot([], [], "s", color=figures.ORANGE, markerfacecolor="none", markersize=8)
    zoom.plot(0, 0, "x", color=figures.BLACK, markersize=9, markeredgewidth=2, label="true")
    (semantic,) = zoom.plot([], [], "s", color=figures.ORANGE, label="panoramas")
    (semantic_ring,) = zoom.plot([], [], "--", color=figures.ORANGE)
    (filtered,) = zoom.plot([], [], "o", color=figures.BLUE, label="depth filter")
    (filtered_ring,) = zoom.plot([], [], color=figures.BLUE)
    zoom.set(title="How far off", xlabel="x [cm]", ylabel="y [cm]", xlim=(-_ZOOM, _ZOOM), ylim=(-_ZOOM, _ZOOM))
    zoom.set_aspect("equal")
    zoom.legend(fontsize=7, loc="lower left")
    depth = figures.depth_image(image, np.full((144, 176), np.nan), "Depth image, near is dark", (0.0, 5.0))
    lines = [boxes, cone, robot, arrow, starts, semantic, semantic_ring, filtered, filtered_ring]
    live = LiveFigure(figure, [picture, depth, *lines])
    located: dict[tuple, Journey] = {}

    def draw(x: float, y: float, heading: float, hidden: float, cap: bool) -> Drawing:
        key = (x, y, heading, hidden, cap)
        if key == tuple(STORY.values()) and key not in located:
            located[key] = _locate(*key)
        one, angle = located.get(key), np.deg2rad(heading)
        robot.set_data([x], [y])
        arrow.set_data([x, x + 0.5 * np.cos(angle)], [y, y + 0.5 * np.sin(angle)])
        sides = angle + np.array([-_VIEW, _VIEW])
        cone.set_data(
            [x + 2 * np.cos(sides[0]), x, x + 2 * np.cos(sides[1])],
            [y + 2 * np.sin(sides[0]), y, y + 2 * np.sin(sides[1])],
        )
        for line in (boxes, *lines[4:]):
            line.set_data([], [])
        picture.set_data(np.full((_HIGH, _WIDE, 3), 225, np.uint8))
        depth.set_data(np.ma.masked_invalid(np.full((144, 176), np.nan)))
        if one is not None:
            _show(one)
        place = world().where(x, y)
        text = [f"robot at ({x:.2f}, {y:.2f}) m, heading {heading:.0f} degrees: {place}", *_told(one, place)]
        alt = f"The room from above with the robot, what it saw, and how far off it is. {text[1]}"
        return Drawing(live.png(), alt, "\n".join(text))

    def _show(one: Journey) -> None:
        picture.set_data(cv2.resize(one.images[0], (_WIDE, _HIGH), interpolation=cv2.INTER_AREA)[..., ::-1])
        depth.set_data(np.ma.masked_invalid(one.depths[-1]))
        if np.isfinite(one.depths[-1]).any():
            depth.set_clim(*np.nanpercentile(one.depths[-1], [1, 99]))
        boxes.set_data(*_outlines([found.box for found in one.found.upper_detections]))
        starts.set_data([start.x for start in one.starts], [start.y for start in one.starts])
        if one.found.pose is not None:
            off = 100 * (np.array([one.found.pose.x, one.found.pose.y]) - one.pose[:2])
            semantic.set_data(*off[:, None])
            semantic_ring.set_data(*ellipse(1e4 * one.found.covariance[:2, :2], off))
        if one.best is not None:
            off = 100 * (one.best[-1].state[:2] - one.states[-1, :2])
            filtered.set_data(*off[:, None])
            filtered_ring.set_data(*ellipse(1e4 * one.best[-1].error_covariance[:2, :2], off))

    def locate(values: dict) -> dict:
        if not world().where(values["x"], values["y"]).startswith("inside"):
            located[tuple(values.values())] = _locate(**values, say=panel.say)
        return {}

    def somewhere(values: dict) -> dict:
        rng = np.random.default_rng(len(located) + 1)
        (x, y), turn = free_places(world().room, 1, rng)[0], rng.uniform(-180, 180)
        return {"x": round(20 * x) / 20, "y": round(20 * y) / 20, "heading": float(5 * round(turn / 5))}

    width, depth_of_room = world().room.walls.max(axis=0)
    controls = [
        Slider("x", "x [m]", 0.25, round(20 * width) / 20 - 0.25, STORY["x"], 0.05),
        Slider("y", "y [m]", 0.25, round(20 * depth_of_room) / 20 - 0.25, STORY["y"], 0.05),
        Slider("heading", "heading [degrees]", -180, 180, STORY["heading"], 5),
        Slider("hidden", "panoramas hidden [percent]", 0, 100, STORY["hidden"], 10),
        Switch("cap", "lens cap on the depth camera"),
    ]
    actions = {"Locate": locate, "Somewhere": somewhere}
    panel = Panel("19 put the robot anywhere", controls, draw, actions=actions, photograph=True)
    return panel


def _locate(x: float, y: float, heading: float, hidden: float, cap: bool, say=None) -> Journey:
    return journey(x, y, heading, hidden / 100, cap, say)


def _outlines(boxes: list) -> tuple[np.ndarray, np.ndarray]:
    """Boxes as one curve with gaps between them; one across the seam is drawn on both sides."""
    corners = []
    for u_min, v_min, u_max, v_max in boxes:
        for turn in (0, -1280) if u_max > 1280 else (0,):
            u = np.array([u_min, u_max, u_max, u_min, u_min, np.nan]) + turn
            corners.append(np.stack([u, [v_min, v_min, v_max, v_max, v_min, np.nan]]))
    return tuple(np.concatenate(corners, axis=1)) if corners else (np.empty(0), np.empty(0))


def _told(one: Journey | None, place: str) -> list[str]:
    """What both methods found, in words and numbers; one line each."""
    if place.startswith("inside"):
        return [f"Nobody can stand {place}. Move the robot."]
    if one is None:
        return ['not looked yet: press "Locate" (some seconds)']
    lines = []
    if one.found.pose is not None:
        metres, degrees = one.semantic_error
        seen = f"{len(one.found.observations)} objects, confidence {one.found.confidence:.2f}"
        lines.append(f"panoramas: {seen}; off by {100 * metres:.0f} cm and {degrees:.1f} degrees")
    else:
        lines.append(f"panoramas: unable ({one.found.reason}); {len(one.starts)} poses are left to the depth camera")
    if one.best is None:
        why = (
            "a lens cap: nothing measured, the semantic pose stays" if one.starts else "not started: nobody knows where"
        )
        return [*lines, f"depth filter: {why}"]
    for k, run in enumerate(one.runs, start=1):
        metres, degrees = state_error(run[-1].state, one.states[-1])
        sigma = np.sqrt(np.diag(run[-1].error_covariance)[:3].max())
        lines.append(
            f"depth filter from pose {k}: score {mean_score(run):.3f}, {run[-1].status}, it says sigma "
            f"{1000 * sigma:.0f} mm; off by {1000 * metres:.0f} mm and {degrees:.1f} degrees"
        )
    return lines


PANELS = {"19 put the robot anywhere": anywhere_panel}
