"""The panel of lesson 19: the reader puts the robot anywhere, and it finds out where it is."""

import cv2
import numpy as np
from matplotlib.collections import LineCollection

from courseware.experiments.finale import mean_score
from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.panel import Drawing, Panel, Slider, Switch
from courseware.lessons.lesson_19.figures import TRUE_PLACE, VIEW, draw_room, ellipse
from courseware.lessons.lesson_19.stages import Journey, journey, state_error, world
from courseware.plots import figures
from courseware.simulation.room.scene import free_places

STORY = {"x": 3.35, "y": 3.3, "heading": 65.0, "hidden": 0.0, "cap": False}
"""Where the lesson's robot stands. The panel starts there."""
OUTLINE = [[0, 1], [2, 1], [2, 3], [0, 3], [0, 1]]  # of a box (u_min, v_min, u_max, v_max)
GREY, NO_DEPTH = np.full((320, 640, 3), 225, np.uint8), np.full((144, 176), np.nan)


def anywhere_panel() -> Panel:
    """Place the robot, cover its sensors, press "Locate". A slider that moves redraws the plan and clears the rest."""
    figure = figures.new_figure(size=(9.0, 6.0))[0]
    figure.clear()
    above, plan, zoom, image = figure.subplot_mosaic("aaa;pzi", height_ratios=[1.0, 1.1]).values()
    picture = above.imshow(GREY, extent=(0, 1280, 640, 0))
    above.set(title="Upper panorama and what was found on it", xlabel="column u [pixels]", ylabel="row v [pixels]")
    boxes = above.add_collection(LineCollection([], colors=figures.VERMILION, linewidths=1.2))
    above.set(xlim=(0, 1280), ylim=(640, 0))
    draw_room(plan, "The room from above")
    for text in plan.texts:
        text.set_fontsize(5)
    (cone,) = plan.plot([], [], color=figures.BLACK, linewidth=1.0)
    (robot,) = plan.plot([], [], "o", color=figures.BLACK, markersize=5)
    (arrow,) = plan.plot([], [], color=figures.BLACK, linewidth=2.2)
    (starts,) = plan.plot([], [], "s", color=figures.ORANGE, markerfacecolor="none", markersize=8)
    zoom.plot(0, 0, **TRUE_PLACE, linestyle="none", label="true")
    semantic = [zoom.plot([], [], look, color=figures.ORANGE)[0] for look in ("s", "--")]
    filtered = [zoom.plot([], [], look, color=figures.BLUE)[0] for look in ("o", "-")]
    semantic[0].set_label("panoramas")
    filtered[0].set_label("depth filter")
    zoom.set(title="How far off", xlabel="x [cm]", ylabel="y [cm]", xlim=(-25, 25), ylim=(-25, 25), aspect="equal")
    zoom.legend(fontsize=7, loc="lower left")
    depth = figures.depth_image(image, NO_DEPTH, "Depth image, near is dark", (0.0, 5.0))
    live = LiveFigure(figure, [picture, depth, boxes, cone, robot, arrow, starts, *semantic, *filtered])
    located: set[tuple] = {tuple(STORY.values())}

    def draw(x: float, y: float, heading: float, hidden: float, cap: bool) -> Drawing:
        key = (x, y, heading, hidden, cap)
        one = journey(x, y, heading, hidden / 100, cap) if key in located else None
        angles = np.deg2rad(heading) + np.array([-VIEW, 0.0, VIEW])
        ends = np.array([x, y])[:, None] + np.array([2.0, 0.5, 2.0]) * [np.cos(angles), np.sin(angles)]
        robot.set_data([x], [y])
        arrow.set_data([x, ends[0, 1]], [y, ends[1, 1]])
        cone.set_data([ends[0, 0], x, ends[0, 2]], [ends[1, 0], y, ends[1, 2]])
        corners = [np.array(found.box)[OUTLINE] for found in one.found.upper_detections] if one else []
        boxes.set_segments([box - [turn, 0] for box in corners for turn in (0, 1280)])  # one may cross the seam
        picture.set_data(
            cv2.resize(one.images[0], (640, 320), interpolation=cv2.INTER_AREA)[..., ::-1] if one else GREY
        )
        depth.set_data(np.ma.masked_invalid(one.depths[-1] if one else NO_DEPTH))
        if one and np.isfinite(one.depths[-1]).any():
            depth.set_clim(*np.nanpercentile(one.depths[-1], [1, 99]))
        starts.set_data(*np.array([start[:2] for start in one.starts] if one else []).reshape(-1, 2).T)
        answers = []
        if one and one.found.pose is not None:
            answers.append((semantic, np.array(one.found.pose[:2]) - one.pose[:2], one.found.covariance))
        if one and one.best is not None:
            last = one.best[-1]
            answers.append((filtered, last.state[:2] - one.states[-1, :2], last.error_covariance))
        for line in (*semantic, *filtered):
            line.set_data([], [])
        for (dot, ring), off, covariance in answers:
            dot.set_data(*100 * off[:, None])
            ring.set_data(*ellipse(1e4 * covariance[:2, :2], 100 * off))
        place = world().where(x, y)
        text = [f"robot at ({x:.2f}, {y:.2f}) m, heading {heading:.0f} degrees: {place}", *_told(one, place)]
        alt = f"The room from above with the robot, what it saw, and how far off it is. {text[1]}"
        return Drawing(live.png(), alt, "\n".join(text))

    def locate(values: dict) -> dict:
        x, y, heading, hidden, cap = values.values()
        if not world().where(x, y).startswith("inside"):
            journey(x, y, heading, hidden / 100, cap, panel.say)
            located.add(tuple(values.values()))
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


def _told(one: Journey | None, place: str) -> list[str]:
    """Return what both methods found, in words and numbers, one line each."""
    if place.startswith("inside"):
        return [f"Nobody can stand {place}. Move the robot."]
    if one is None:
        return ['not looked yet: press "Locate" (some seconds)']
    lines = [f"panoramas: unable ({one.found.reason}); {len(one.starts)} poses are left to the depth camera"]
    if one.found.pose is not None:
        metres, degrees = one.semantic_error
        seen = f"{len(one.found.observations)} objects, confidence {one.found.confidence:.2f}"
        lines = [f"panoramas: {seen}; off by {100 * metres:.0f} cm and {degrees:.1f} degrees"]
    if one.best is None:
        cap, lost = "a lens cap: nothing measured, the semantic pose stays", "not started: nobody knows where"
        return [*lines, f"depth filter: {cap if one.starts else lost}"]
    for k, run in enumerate(one.runs, start=1):
        metres, degrees = state_error(run[-1].state, one.states[-1])
        sigma = np.sqrt(np.diag(run[-1].error_covariance)[:3].max())
        lines.append(
            f"depth filter from pose {k}: score {mean_score(run):.3f}, {run[-1].status}, it says sigma "
            f"{1000 * sigma:.0f} mm; off by {1000 * metres:.0f} mm and {degrees:.1f} degrees"
        )
    return lines


PANELS = {"19 put the robot anywhere": anywhere_panel}
