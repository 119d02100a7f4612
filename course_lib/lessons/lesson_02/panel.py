"""Lesson 02's panel: plan a laser survey and see the map that it gives."""

import numpy as np

from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider, Switch
from course_lib.lessons.lesson_02 import small_room
from course_lib.lessons.lesson_02.figures import cut, draw_cut
from course_lib.lessons.lesson_02.small_room import CAMERA, STATIONS, room
from course_lib.plots import figures

VOXELS = {"20 cm": 0.2, "10 cm": 0.1, "7 cm": 0.07}
KEEP = {"all": 1.0, "5 %": 0.05, "1 %": 0.01, "0.2 %": 0.002}
CONTROLS = [
    Slider("stations", "number of stations", 1, 4, 3, 1),
    Slider("noise", "range noise, one sigma [mm]", 0, 50, 1, 1),
    Slider("registration", "registration error, one sigma [mm]", 0, 50, 0, 1),
    Choice("voxel", "size of a voxel", tuple(VOXELS), "10 cm"),
    Choice("keep", "triangles kept by decimation", tuple(KEEP), "all"),
    Switch("door_open", "the door stood open on the survey day, too"),
]


def survey_panel() -> Panel:
    """Survey the room: stations, noise, registration, voxels, decimation, the door; see the map and its numbers."""
    figure, (plan, view, spread) = figures.new_figure(1, 3, size=(10.2, 3.3))
    world = draw_cut(plan, room().mesh(), "0.75", 3.5, "room, survey day")
    mapped = draw_cut(plan, room().mesh(), figures.BLUE, 1.2, "map")
    (spots,) = plan.plot([], [], "s", color=figures.VERMILION, markersize=7, label="stations")
    plan.set(title="From above, cut at 1.2 m", xlabel="x [m]", ylabel="y [m]", aspect="equal")
    plan.set(xlim=(-0.3, 5.3), ylim=(-0.3, 4.3))
    plan.legend(loc="upper center", bbox_to_anchor=(0.5, -0.22), ncols=3, fontsize=7, columnspacing=0.8, frameon=False)
    image = figures.depth_image(view, np.zeros(CAMERA.shape), "What a camera sees of the map", (0, 6))
    figures.colour_bar(figure, image, view)
    edges = np.linspace(0, 100, 41)
    steps = spread.stairs(np.ones(40), edges, fill=True, color=figures.BLUE)
    spread.set(title="Distance from map to room", xlabel="distance [mm] (last bar: all beyond)", ylabel="share [-]")
    spread.set(xlim=(0, 100), ylim=(0, 0.6))
    live = LiveFigure(figure, [world, mapped, spots, image, steps])

    def draw(stations: float, noise: float, registration: float, voxel: str, keep: str, door_open: bool) -> Drawing:
        n = int(stations)
        scene_map = small_room.room_map(n, noise, registration, VOXELS[voxel], KEEP[keep], door_open)
        world.set_segments(cut(room(door_open).mesh()))
        mapped.set_segments(cut(scene_map))
        spots.set_data(*np.array(STATIONS[:n]).T)
        seen = small_room.camera_view(scene_map)
        image.set_data(np.ma.masked_invalid(seen))
        counts = np.histogram(np.minimum(1000 * small_room.distances(scene_map, door_open), 99.9), edges)[0]
        steps.set_data(counts / counts.sum())
        changed = np.abs(np.where(np.isfinite(seen), seen, np.nan) - small_room.true_view(door_open=True)) > 0.1
        numbers = small_room.row(small_room.quality(scene_map, door_open))
        today = f"today the door is open: {changed.mean():.0%} of the camera's pixels are more than 10 cm off the map"
        alt = (
            f"Map of a room from {n} stations, cut from above; what a camera sees of it; its distances "
            f"from the room. Noise {noise:.0f} mm, registration {registration:.0f} mm, voxels {voxel}. {numbers}"
        )
        return Drawing(live.png(), alt, f"{numbers}\n{today}")

    return Panel("02 survey the room", CONTROLS, draw, continuous=False)


PANELS = {"02 survey the room": survey_panel}
