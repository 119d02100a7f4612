"""The room of the experiment, designed by hand around the paper's ten places, in the frame of the semantic map.

Only their distance from the centroid of all furniture tells three sofas apart. This is development data: the limits
of `make_room` were moved to just beside it (data/room/README.md). Source: paper 2, section 3 (table 1, figure 7)
"""

import numpy as np
from numpy.random import Generator

from courseware.simulation import textures
from courseware.simulation.furniture import pieces as furniture
from courseware.simulation.furniture.solids import Piece, joined
from courseware.simulation.room import shell as room_shell
from courseware.simulation.room.measurement_places import MEASUREMENT_PLACES
from courseware.simulation.room.scene import Lamp, Room
from courseware.simulation.textures import TexturedMesh, cloth, colour, metal, wood

LOW, HIGH = (-0.45, -0.55), (5.65, 5.5)  # metres, map frame: south-west and north-east corner of the floor
HEIGHT = 2.7  # metres
SEED = 20231  # of the textures and the leaves; the layout has no randomness

PLACES = np.array([(place.x, place.y) for place in MEASUREMENT_PLACES])  # metres, map frame: where the rig stands

# Where each piece stands: name, x, y (metres, map frame), the direction its front faces (degrees).
LAYOUT = (
    ("sofa south", 3.25, -0.13, 90.0),
    ("sofa east", 5.00, 2.65, 180.0),
    ("sofa west", -0.02, 4.60, 0.0),
    ("red chair", 2.02, 0.66, 30.0),
    ("green chair", 0.80, 5.14, -90.0),
    ("blue chair", 3.62, 2.10, 90.0),
    ("wooden table", 1.12, 2.10, 0.0),
    ("blue table", 3.82, 3.62, 15.0),
    ("television", 2.42, 5.24, -90.0),
    ("green plant", 0.05, -0.08, 45.0),
    ("purple plant", 5.20, 1.18, 180.0),
    ("refrigerator", 5.31, 5.13, 180.0),
    ("red cabinet", -0.21, 2.15, 0.0),
    ("teal cabinet", 4.78, -0.31, 90.0),
)


def _pieces(rng: Generator) -> dict[str, Piece]:
    """All furniture by the names in LAYOUT; the order of the lines is that of the draws."""
    pieces = {}
    steel, dark = metal(rng, (0.7, 0.72, 0.74), 0.3, 128), metal(rng, (0.13, 0.13, 0.14), 0.4, 128)
    notes = [textures.label(rng, 0.15, 0.2) for _ in range(3)]
    screen = textures.picture(rng, 1.0, 0.5625, emission=0.8, pixels=256)
    for name, hue in (("sofa south", 344.0), ("sofa east", 346.0), ("sofa west", 348.0)):
        cover = cloth(rng, colour(hue, 62, 62), "tartan", size=0.9, pixels=512)
        legs = wood(rng, colour(22, 60, 30), 0.4, 128)
        shape = furniture.Sofa(1.5, 0.8, 0.42, 0.8, "box", arm_width=0.28, arm_height=0.58, leg_height=0.07, seats=2)
        pieces[name] = furniture.build_sofa(shape, cover, cover, legs, cover)
    for name, hue, value, chair in (
        ("red chair", 4, 75, furniture.Chair(0.5, 0.48, 0.45, 0.92, splay=0.0, leg_radius=0.03)),
        ("green chair", 98, 62, furniture.Chair(0.52, 0.5, 0.44, 0.86, splay=0.02, leg_radius=0.029)),
        ("blue chair", 222, 72, furniture.Chair(0.48, 0.48, 0.46, 0.78, back="shell", leg_radius=0.028)),
    ):
        cover = cloth(rng, colour(hue, 78, value), "lattice", size=0.4)
        frame = wood(rng, colour(hue, 72, 0.8 * value), 0.5)
        pieces[name] = furniture.build_chair(chair, frame, cover)
    oak, blue = wood(rng, colour(30, 68, 78), 0.9, 512), wood(rng, colour(208, 60, 55), 0.6)
    spread = cloth(rng, colour(205, 66, 74), "tartan", size=0.7, pixels=512)
    square = furniture.Table(0.8, 1.1, 0.72, base="legs", thickness=0.07, apron=0.17, leg=0.11)
    rounded = furniture.Table(0.85, 0.85, 0.7, round=True, base="pedestal", thickness=0.03, cloth=0.45)
    pieces["wooden table"] = furniture.build_table(square, oak, oak, oak)
    pieces["blue table"] = furniture.build_table(rounded, blue, blue, spread)
    earth = textures.carpet(rng, colour(28, 45, 22), 0.5, 128)
    for name, hue, pot_hue, plant in (
        ("green plant", 104, 120, furniture.Plant("cylinder", 0.26, 0.42, "broad", 1.0, 0.34, 30, 0.075)),
        ("purple plant", 305, 290, furniture.Plant("cone", 0.25, 0.4, "spiky", 0.98, 0.34, 40, 0.07)),
    ):
        skins = [textures.leaves(rng, colour(hue + shift, 70, 55)) for shift in (-6, 6)]
        clay = textures.ceramic(rng, colour(pot_hue, 62, 66), 0.5)
        bark = wood(rng, colour(hue, 50, 35), 0.4, 128)
        pieces[name] = furniture.build_plant(plant, clay, earth, skins, bark, rng)
    brass = metal(rng, colour(45, 45, 75), 0.3, 128)
    mahogany = wood(rng, colour(8, 72, 62), 0.9, 512)
    teal, dark_teal = wood(rng, colour(178, 62, 66), 0.9, 512), wood(rng, colour(182, 66, 50), 0.9)
    books = [textures.book_row(rng, 0.55, 0.28, hue=8) for _ in range(2)]
    shelf = furniture.Cabinet(1.2, 0.4, 0.98, 2, (("door", 1.2), ("open", 1.0)), "knob", board=0.042)
    drawers = furniture.Cabinet(1.1, 0.4, 0.82, 2, (("drawer", 1.0),) * 3, "bar", legs=0.07, board=0.04)
    pieces["red cabinet"] = furniture.build_cabinet(shelf, mahogany, [mahogany], mahogany, brass, books)
    pieces["teal cabinet"] = furniture.build_cabinet(drawers, teal, [teal, dark_teal], teal, brass, [])
    fridge = furniture.Refrigerator(0.6, 0.6, 1.55, (0.4,), handle="bar", radius=0.037)
    body = metal(rng, colour(158, 46, 82), 0.8, 512)
    pieces["refrigerator"] = furniture.build_refrigerator(fridge, body, steel, dark, notes)
    television = furniture.Television(1.0, 0.06, 0.045, "floor", 0.45)
    pieces["television"] = furniture.build_television(television, dark, screen)
    return pieces


def _shell(rng: Generator) -> tuple[TexturedMesh, ...]:
    """Parquet, striped walls, two windows, a door, pictures, two lamps, a rug and a bin."""
    south, east, north, west = room_shell.walls_of(LOW, HIGH)
    trim = wood(rng, colour(35, 14, 92), 0.6, 128)
    paper = textures.wallpaper(rng, colour(48, 12, 90), 1.3)
    plain = textures.plaster(rng, colour(40, 10, 88))
    floor = wood(rng, colour(30, 40, 62), 1.8, 512, boards=12)
    ceiling = textures.plaster(rng, colour(45, 4, 80), 2.0, 256)
    meshes = room_shell.bare_room(LOW, HIGH, HEIGHT, [paper, plain, paper, plain], floor, ceiling, trim)
    view = [textures.window_view(rng, 1.6, 1.1) for _ in range(2)]
    meshes += room_shell.window(east, 2.6, 1.6, 1.1, 1.0, view[0], trim)
    meshes += room_shell.window(south, 2.65, 1.4, 1.1, 1.0, view[1], trim)
    leaf = wood(rng, colour(28, 50, 60), 1.0)
    meshes += room_shell.door(west, 1.25, leaf.turned(), trim, metal(rng, (0.75, 0.72, 0.6), 0.3, 64))
    frame = wood(rng, colour(25, 55, 35), 0.4, 128)
    for wall, s, z, width, tall in (
        (north, 1.45, 1.65, 0.7, 0.5),
        (north, 4.7, 1.6, 0.5, 0.7),
        (west, 3.3, 1.7, 0.8, 0.55),
        (east, 5.2, 1.6, 0.55, 0.75),
        (south, 0.9, 1.55, 0.6, 0.6),
        (south, 5.0, 1.6, 0.45, 0.6),
    ):
        meshes += room_shell.framed_picture(wall, s, z, textures.picture(rng, width, tall), frame)
    glow = textures.glow(colour(48, 10, 100))
    for x, y in ((1.6, 2.5), (3.7, 2.5)):
        meshes += room_shell.ceiling_lamp(x, y, HEIGHT, 0.2, glow, 0.25)
    cover = cloth(rng, colour(60, 25, 70), "lattice", size=1.2, pixels=512)
    meshes += room_shell.rug(3.0, 1.05, 0.0, 1.0, 0.6, cover)
    bin_side = textures.ceramic(rng, colour(30, 15, 45), pixels=128)
    meshes += room_shell.waste_bin(north, 2.05, 0.14, 0.3, bin_side)
    return joined(meshes)


def make_experiment_room() -> Room:
    """The room of the experiment, always the same, byte for byte; walls and furniture in the map's frame."""
    furniture_rng, shell_rng = np.random.default_rng(SEED).spawn(2)
    pieces = _pieces(furniture_rng)
    day, warm = colour(210, 6, 100), colour(42, 14, 100)
    return Room(
        walls=np.array([LOW, (HIGH[0], LOW[1]), HIGH, (LOW[0], HIGH[1])], float),
        height=HEIGHT,
        objects=tuple(pieces[name].at(x, y, np.radians(heading)) for name, x, y, heading in LAYOUT),
        shell=_shell(shell_rng),
        lamps=(
            Lamp((1.6, 2.5, 1.95), warm, 1.3),
            Lamp((3.7, 2.5, 1.95), warm, 1.3),
            Lamp((5.1, 2.9, 1.6), day, 0.9),
            Lamp((3.0, 0.0, 1.6), day, 0.8),
        ),
        ambient=(0.4, 0.39, 0.38),
    )
