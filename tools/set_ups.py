"""Draw how both papers measured, in the simulation's own worlds and sizes: notebooks/pictures/wagon.webp and rig.webp.

    python -m tools.set_ups

Somebody pushes the wagon with the depth camera down the corridor. The rig holds two spherical cameras.
"""

import io
import sys
from argparse import ArgumentParser, Namespace

import numpy as np
from matplotlib.figure import Figure
from PIL import Image

from course_lib.depth_mcl import DepthCamera
from course_lib.files import atomic_write
from courseware.paths import REPOSITORY, data_path
from courseware.plots import scenes
from courseware.plots.figures import BLUE
from courseware.simulation.corridor import materials, parts
from courseware.simulation.corridor.mesh_building import MeshBuilder, Placement, WorldMesh, to_polydata
from courseware.simulation.corridor.recorded_runs import WagonModel
from courseware.simulation.corridor.seeded_recording import building_of_data
from courseware.simulation.corridor.world import CLUTTER, LAYOUT, run_day
from courseware.simulation.room.experiment_room import make_experiment_room
from courseware.simulation.room.measurement_places import CAMERA_HEIGHTS, MEASUREMENT_PLACES

FOLDER = REPOSITORY / "notebooks" / "pictures"
SIZE = 1000, 560  # pixels
WAGON = np.array([12.9, -0.1, WagonModel().height, 0.0, 0.0, 0.03])  # pose of the camera, metres and radians
RIG = MEASUREMENT_PLACES[1]


def add_solids(plotter, world: WorldMesh, below: float, beyond: tuple[float, float, float]) -> None:
    """Draw the triangles below a height [m] whose middle has a y above, and an x between, these numbers [m]."""
    x, y, z = world.vertices[world.faces].mean(axis=1).T
    kept = (z < below) & (y > beyond[0]) & (x > beyond[1]) & (x < beyond[2])
    mesh = to_polydata(world.vertices, world.faces[kept])
    mesh.cell_data["colour"] = (255 * (world.colours[kept] / 255.0) ** 0.7).astype(np.uint8)  # as in daylight
    plotter.add_mesh(mesh, scalars="colour", rgb=True)


def wagon_scene():
    """Return the scene of paper 1, and its labels: words, the point that they name, where they stand (0 to 1)."""
    plotter = scenes.new_plotter((9.2, -4.9, 3.4), (13.9, 0.2, 0.75), SIZE)
    things = [thing for thing in CLUTTER if thing.kind == "person"]
    world, _ = run_day(building_of_data(data_path("corridor")), [row[5] for row in LAYOUT["left doors"]], things)
    add_solids(plotter, world, 2.15, (-0.9, 9.0, 18.5))
    b, rng, (x, y, z, *_, yaw) = MeshBuilder(), np.random.default_rng(2), WAGON
    wagon = Placement(np.array([x - 0.2, y, 0.0])).moved(turn_deg=np.degrees(yaw))
    parts.trolley(b, wagon, rng)
    b.tube(wagon, (0.2, 0, 0.6), (0.2, 0, z - 0.03), 0.02, materials.STEEL)
    b.box(wagon, (0.11, -0.04, z - 0.04), (0.2, 0.04, z + 0.04), materials.RUBBER, bevel=0.005)
    parts.person(b, wagon.moved(-0.75, 0, 0, -90), rng)
    add_solids(plotter, b.build(), 2.3, (-9.0, 0.0, 40.0))
    plotter.add_mesh(scenes.frustum(DepthCamera.sr4000(), WAGON, far=3.0), color=BLUE, line_width=3)
    return plotter, [
        (f"depth camera, {z:.1f} m above the floor", (x, y, z), (0.42, 0.83)),
        ("its view, drawn to 3 m", (x + 2.2, y - 0.83, z - 0.67), (0.78, 0.2)),
        ("somebody pushes the wagon", (x - 1.0, y, 1.55), (0.16, 0.9)),
        ("people in view, who are not on the map", (16.3, 0.62, 1.55), (0.72, 0.93)),
    ]


def rig_scene():
    """Return the scene of paper 2, and its labels as for `wagon_scene`."""
    import pyvista

    plotter, room = scenes.new_plotter((5.6, -3.4, 3.1), (2.6, 2.4, 0.75), SIZE), make_experiment_room()
    furniture = [(False, mesh) for thing in room.objects for mesh in thing.meshes]
    for wall, mesh in [*((True, mesh) for mesh in room.shell), *furniture]:
        x, y, z = mesh.vertices[mesh.faces].mean(axis=1).T
        shown = mesh.faces[(z < 2.3) & (y > 0.05) & (x < 5.9)] if wall else mesh.faces  # two walls are open
        if len(shown):
            data = to_polydata(mesh.vertices, shown)
            data.active_texture_coordinates = np.asarray(mesh.texture_coordinates, np.float32)
            plotter.add_mesh(data, texture=pyvista.numpy_to_texture(np.ascontiguousarray(mesh.texture)))
    b, (upper, lower) = MeshBuilder(), CAMERA_HEIGHTS[1]
    at = Placement(np.array([RIG.x, RIG.y, 0.0]))
    for turn in np.radians((90, 210, 330)):
        b.tube(at, (0.35 * np.cos(turn), 0.35 * np.sin(turn), 0), (0, 0, 0.6), 0.012, materials.RUBBER)
    b.tube(at, (0, 0, 0.55), (0, 0, upper), 0.012, materials.STEEL)
    for height in (upper, lower):
        b.box(at, (-0.024, -0.04, height - 0.1), (0.024, 0.04, height + 0.03), materials.RUBBER, bevel=0.01)
        b.ellipsoid(at, (0, 0, height), (0.05, 0.03, 0.03), materials.DARK_CLOTH)
    add_solids(plotter, b.build(), 2.3, (-9.0, -9.0, 40.0))
    return plotter, [
        (f"upper spherical camera, {upper:.2f} m above the floor", (RIG.x, RIG.y, upper), (0.30, 0.93)),
        (f"lower one, {upper - lower:.2f} m below it (the baseline)", (RIG.x, RIG.y, lower), (0.78, 0.83)),
    ]


def picture(plotter, labels: list) -> bytes:
    """Return the scene with its labels as WebP."""
    width, height = SIZE
    figure = Figure(figsize=(width / 100, height / 100), dpi=100)
    axes = figure.add_axes((0, 0, 1, 1))
    plotter.enable_anti_aliasing("ssaa")
    axes.imshow(plotter.screenshot(return_img=True), extent=(0, 1, 0, 1), aspect="auto")
    axes.set_axis_off()
    matrix = plotter.camera.GetCompositeProjectionTransformMatrix(width / height, -1, 1)
    for words, point, stands in labels:
        *at, _, w = matrix.MultiplyPoint((*point, 1.0))
        ground = {"boxstyle": "round", "facecolor": "white", "edgecolor": BLUE, "alpha": 0.95}
        style = {"bbox": ground, "arrowprops": {"arrowstyle": "-", "color": BLUE, "linewidth": 1.6}}
        axes.annotate(words, 0.5 + np.array(at) / w / 2, stands, fontsize=12, ha="center", **style)
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png")
    small = io.BytesIO()
    Image.open(buffer).convert("RGB").save(small, "WEBP", quality=80, method=6)
    return small.getvalue()


def add_arguments(parser: ArgumentParser) -> None:
    """Declare no options."""


def run(arguments: Namespace) -> int:
    """Write both pictures."""
    for name, scene in (("wagon", wagon_scene), ("rig", rig_scene)):
        path = FOLDER / f"{name}.webp"
        atomic_write(path, picture(*scene()))
        print(f"{path.relative_to(REPOSITORY)}: {path.stat().st_size / 1000:.0f} kB")
    return 0


if __name__ == "__main__":
    from courseware.cli import tool

    sys.exit(tool("tools.set_ups"))
