"""The shell of a generated room from random numbers: its colours, windows, door, pictures, lamps and small things."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.random import Generator

from course_lib.simulation import prints, textures
from course_lib.simulation.furniture.solids import joined
from course_lib.simulation.room import shell as room_shell
from course_lib.simulation.room.footprints import overlap, rectangle
from course_lib.simulation.room.scene import Lamp
from course_lib.simulation.textures import Surface, TexturedMesh, colour, random_colour


@dataclass
class Shell:
    """What random_shell returns, and what its steps fill.

    meshes: of the shell. lamps: the lights. kept_free: rectangles `(4, 2)` without furniture. spans: for each
    of the four walls, the stretches (from, to) in metres along it that windows, the door and pictures cover.
    """

    meshes: list[TexturedMesh]
    lamps: list[Lamp] = field(default_factory=list)
    kept_free: list[np.ndarray] = field(default_factory=list)
    spans: list[list[tuple[float, float]]] = field(default_factory=lambda: [[], [], [], []])
    ambient: tuple[float, float, float] = (0.35, 0.35, 0.35)


def free_stretch(rng: Generator, wall: room_shell.Wall, spans: list[tuple[float, float]], width: float) -> float | None:
    """Where along the wall something of this width fits beside what hangs there already: its middle, or None."""
    half = width / 2 + 0.06
    if wall.length < 2 * half + 0.1:
        return None
    for _ in range(30):
        s = float(rng.uniform(half, wall.length - half))
        if all(s + half <= start or s - half >= end for start, end in spans):
            spans.append((s - half, s + half))
            return s
    return None


def _floor(rng: Generator) -> Surface:
    kind = rng.integers(3)
    if kind == 0:
        timber = colour(rng.uniform(15, 45), rng.uniform(20, 65), rng.uniform(35, 85))
        return textures.wood(rng, timber, 1.6, 512, boards=int(rng.integers(8, 16)))
    if kind == 1:
        return textures.tiles(rng, random_colour(rng, (0, 35), (40, 90)), count=int(rng.integers(2, 6)))
    return textures.carpet(rng, random_colour(rng, (0, 60), (25, 80)))


def _papers(rng: Generator) -> list[Surface]:
    """Four walls: all alike, or one wall that differs."""

    def one() -> Surface:
        rgb = random_colour(rng, (0, 40), (60, 97))
        return textures.wallpaper(rng, rgb) if rng.random() < 0.45 else textures.plaster(rng, rgb)

    papers = [one()] * 4
    if rng.random() < 0.5:
        papers[int(rng.integers(4))] = one()
    return papers


def _small_things(rng: Generator, wall: room_shell.Wall) -> tuple[list[TexturedMesh], np.ndarray]:
    """One carton, bin or standing lamp by the wall, and the rectangle it stands on."""
    s = float(rng.uniform(0.35, wall.length - 0.35))
    kind = rng.integers(3)
    if kind == 0:
        size = rng.uniform((0.2, 0.25, 0.15), (0.4, 0.5, 0.45))
        brown = textures.cloth(rng, random_colour(rng, (15, 60), (40, 85)), "blotches", size=0.5, pixels=128)
        meshes = room_shell.carton(wall, s, size, brown, prints.label(rng, 0.2, 0.15))
    elif kind == 1:
        side = textures.ceramic(rng, random_colour(rng, (0, 80), (20, 95)), pixels=128)
        meshes = room_shell.waste_bin(wall, s, float(rng.uniform(0.11, 0.17)), float(rng.uniform(0.22, 0.4)), side)
    else:
        pole = textures.metal(rng, random_colour(rng, (0, 30), (10, 80)), 0.3, 64)
        shade = Surface(textures.cloth(rng, colour(40, 25, 95), size=0.4, pixels=128).image, (0.4, 0.4), 0.75)
        meshes = room_shell.floor_lamp(wall, s, float(rng.uniform(1.2, 1.7)), pole, shade)
    pose = wall.pose(s, out=0.22)
    return meshes, rectangle(pose["x"], pose["y"], pose["yaw"], 0.45, 0.52)


def _add_window(rng: Generator, shell: Shell, wall: room_shell.Wall, index: int, trim: Surface) -> None:
    """A window, its daylight, and in six of ten cases curtains."""
    width, tall = float(rng.uniform(0.9, 1.9)), float(rng.uniform(0.9, 1.3))
    s, sill = float(rng.uniform(1.5, wall.length - 1.5)), float(rng.uniform(0.75, 1.0))
    shell.meshes += room_shell.window(wall, s, width, tall, sill, prints.window_view(rng, width, tall), trim)
    reach = width / 2 + 0.1
    if rng.random() < 0.6:
        pattern = str(rng.choice(textures.CLOTH_PATTERNS))
        cover = textures.cloth(rng, random_colour(rng), pattern, random_colour(rng))
        for sign in (-1.0, 1.0):
            shell.meshes += room_shell.curtain(wall, s + sign * (width / 2 + 0.12), 0.4, sill + tall + 0.12, cover)
        reach = width / 2 + 0.42
    shell.spans[index].append((s - reach, s + reach))
    pose = wall.pose(s, sill + tall / 2, out=0.5)
    day = colour(rng.uniform(190, 230), rng.uniform(0, 12), 100)
    shell.lamps.append(Lamp((pose["x"], pose["y"], pose["z"]), day, float(rng.uniform(0.6, 1.6))))


def _add_door(rng: Generator, shell: Shell, wall: room_shell.Wall, index: int, trim: Surface) -> None:
    """A door, and the floor before it kept free."""
    s = float(rng.uniform(0.7, wall.length - 0.7))
    leaf = textures.wood(rng, random_colour(rng, (0, 60), (35, 97)), 1.0)
    knob = textures.metal(rng, (0.75, 0.72, 0.6), 0.3, 64)
    shell.meshes += room_shell.door(wall, s, leaf.turned(), trim, knob)
    shell.spans[index].append((s - 0.55, s + 0.55))
    pose = wall.pose(s, out=0.35)
    shell.kept_free.append(rectangle(pose["x"], pose["y"], pose["yaw"], 0.7, 0.9))


def _add_pictures(rng: Generator, shell: Shell, walls: list[room_shell.Wall], trim: Surface) -> None:
    """One to five pictures beside windows and door."""
    for index in rng.integers(0, 4, int(rng.integers(1, 6))):
        width = float(rng.uniform(0.3, 0.9))
        s = free_stretch(rng, walls[int(index)], shell.spans[int(index)], width + 0.06)
        if s is not None:
            print_ = prints.picture(rng, width, float(width * rng.uniform(0.6, 1.4)), pixels=160)
            shell.meshes += room_shell.framed_picture(walls[int(index)], s, float(rng.uniform(1.4, 1.65)), print_, trim)


def _add_ceiling_lamps(rng: Generator, shell: Shell, low: np.ndarray, high: np.ndarray, height: float) -> None:
    """One, two or four lamps that share the light between them."""
    tint = colour(rng.uniform(25, 60), rng.uniform(0, 22), 100)
    glow = textures.glow(tint)
    columns, rows = ((1, 1), (1, 1), (2, 1), (1, 2), (2, 2))[int(rng.integers(5))]
    radius, drop = float(rng.uniform(0.12, 0.28)), float(rng.uniform(0.12, 0.4))
    strength = float(rng.uniform(1.6, 3.2) / np.sqrt(columns * rows))
    for i in range(columns):
        for j in range(rows):
            x, y = (float(v) for v in low + (high - low) * ((i + 0.5) / columns, (j + 0.5) / rows))
            shell.meshes += room_shell.ceiling_lamp(x, y, height, radius, glow, drop)
            shell.lamps.append(Lamp((x, y, height - drop - 0.15), tint, strength))


def _add_rug(rng: Generator, shell: Shell, low: np.ndarray, high: np.ndarray) -> None:
    x, y = (float(v) for v in rng.uniform(low + 1.2, high - 1.2))
    pattern = str(rng.choice(("stripes", "checks", "dots", "blotches")))
    cover = textures.cloth(rng, random_colour(rng), pattern, random_colour(rng), 1.2, 512)
    length, width = (float(v) for v in rng.uniform((1.0, 0.7), (2.0, 1.4)))
    shell.meshes += room_shell.rug(x, y, float(rng.integers(2) * np.pi / 2), length, width, cover)


def random_shell(rng: Generator, low: np.ndarray, high: np.ndarray, height: float) -> Shell:
    """The shell of the room low to high `(2,)`, metres: all that the semantic map does not list."""
    walls = room_shell.walls_of(low, high)
    trim = textures.wood(rng, random_colour(rng, (0, 45), (30, 97)), 0.6, 128)
    ceiling = textures.plaster(rng, random_colour(rng, (0, 8), (85, 98)), 2.0, 256)
    shell = Shell(room_shell.bare_room(low, high, height, _papers(rng), _floor(rng), ceiling, trim))
    order = [int(index) for index in rng.permutation(4)]
    for index in order[: int(rng.integers(1, 3))]:
        _add_window(rng, shell, walls[index], index, trim)
    _add_door(rng, shell, walls[order[2]], order[2], trim)
    _add_pictures(rng, shell, walls, trim)
    _add_ceiling_lamps(rng, shell, low, high, height)
    if rng.random() < 0.6:
        _add_rug(rng, shell, low, high)
    for index in rng.integers(0, 4, int(rng.integers(0, 4))):
        things, corners = _small_things(rng, walls[int(index)])
        if not any(overlap(corners, other) for other in shell.kept_free):
            shell.meshes += things
            shell.kept_free.append(corners)
    warm = np.asarray(colour(rng.uniform(20, 60), rng.uniform(0, 8), 100)) * rng.uniform(0.28, 0.45)
    shell.ambient = tuple(float(channel) for channel in warm)
    shell.meshes = list(joined(shell.meshes))
    return shell
