"""The shell of a generated room from random numbers: its colours, windows, door, pictures, lamps and small things."""

from __future__ import annotations

import numpy as np

from course_lib.worlds import prints, room_shell, textures
from course_lib.worlds.footprints import rectangle
from course_lib.worlds.furniture.solids import joined
from course_lib.worlds.room_scene import Lamp
from course_lib.worlds.textured_mesh import TexturedMesh
from course_lib.worlds.textures import Surface, colour, random_colour


def _floor(rng: np.random.Generator) -> Surface:
    kind = rng.integers(3)
    if kind == 0:
        timber = colour(rng.uniform(15, 45), rng.uniform(20, 65), rng.uniform(35, 85))
        return textures.wood(rng, timber, 1.6, 512, boards=int(rng.integers(8, 16)))
    if kind == 1:
        return textures.tiles(rng, random_colour(rng, (0, 35), (40, 90)), count=int(rng.integers(2, 6)))
    return textures.carpet(rng, random_colour(rng, (0, 60), (25, 80)))


def _papers(rng: np.random.Generator) -> list[Surface]:
    """Four walls: all alike, or one wall that differs."""

    def one() -> Surface:
        rgb = random_colour(rng, (0, 40), (60, 97))
        return textures.wallpaper(rng, rgb) if rng.random() < 0.45 else textures.plaster(rng, rgb)

    papers = [one()] * 4
    if rng.random() < 0.5:
        papers[int(rng.integers(4))] = one()
    return papers


def _small_things(rng: np.random.Generator, wall: room_shell.Wall) -> tuple[list[TexturedMesh], np.ndarray]:
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


def random_shell(
    rng: np.random.Generator, low: np.ndarray, high: np.ndarray, height: float
) -> tuple[tuple[TexturedMesh, ...], tuple[Lamp, ...], tuple[float, float, float], list[np.ndarray]]:
    """The shell of the room low to high `(2,)`: meshes, lamps, ambient light, rectangles to keep free of furniture."""
    walls = room_shell.walls_of(low, high)
    trim = textures.wood(rng, random_colour(rng, (0, 45), (30, 97)), 0.6, 128)
    ceiling = textures.plaster(rng, random_colour(rng, (0, 8), (85, 98)), 2.0, 256)
    meshes = room_shell.bare_room(low, high, height, _papers(rng), _floor(rng), ceiling, trim)
    lamps: list[Lamp] = []
    kept_free: list[np.ndarray] = []
    order = rng.permutation(4)
    for index in order[: int(rng.integers(1, 3))]:
        wall = walls[int(index)]
        width, tall = float(rng.uniform(0.9, 1.9)), float(rng.uniform(0.9, 1.3))
        s, sill = float(rng.uniform(1.3, wall.length - 1.3)), float(rng.uniform(0.75, 1.0))
        meshes += room_shell.window(wall, s, width, tall, sill, prints.window_view(rng, width, tall), trim)
        if rng.random() < 0.6:
            cover = textures.cloth(
                rng, random_colour(rng), str(rng.choice(textures.CLOTH_PATTERNS)), random_colour(rng)
            )
            for sign in (-1.0, 1.0):
                meshes += room_shell.curtain(wall, s + sign * (width / 2 + 0.12), 0.4, sill + tall + 0.12, cover)
        pose = wall.pose(s, sill + tall / 2, out=0.5)
        lamps.append(
            Lamp(
                (pose["x"], pose["y"], pose["z"]),
                colour(rng.uniform(190, 230), rng.uniform(0, 12), 100),
                rng.uniform(0.6, 1.6),
            )
        )
    wall = walls[int(order[2])]
    s = float(rng.uniform(0.7, wall.length - 0.7))
    knob = textures.metal(rng, (0.75, 0.72, 0.6), 0.3, 64)
    leaf = textures.wood(rng, random_colour(rng, (0, 60), (35, 97)), 1.0)
    meshes += room_shell.door(wall, s, leaf.turned(), trim, knob)
    pose = wall.pose(s, out=0.35)
    kept_free.append(rectangle(pose["x"], pose["y"], pose["yaw"], 0.7, 0.9))
    for index in rng.integers(0, 4, int(rng.integers(1, 5))):
        wall = walls[int(index)]
        width = float(rng.uniform(0.35, 0.9))
        print_ = prints.picture(rng, width, float(width * rng.uniform(0.6, 1.4)), pixels=160)
        if index in order[:3]:
            # Beside the window or door, near the wall's end, where it hides neither.
            s = float(rng.choice([0.5, wall.length - 0.5]))
        else:
            s = float(rng.uniform(0.6, wall.length - 0.6))
        meshes += room_shell.framed_picture(wall, s, float(rng.uniform(1.4, 1.65)), print_, trim)
    tint = colour(rng.uniform(25, 60), rng.uniform(0, 22), 100)
    glow = textures.glow(tint)
    count = (1, 1) if rng.random() < 0.5 else (2, 1) if rng.random() < 0.6 else (2, 2)
    radius, drop = float(rng.uniform(0.12, 0.28)), float(rng.uniform(0.12, 0.4))
    strength = float(rng.uniform(1.6, 3.2)) / np.sqrt(count[0] * count[1])
    for i in range(count[0]):
        for j in range(count[1]):
            x, y = low + (high - low) * ((i + 0.5) / count[0], (j + 0.5) / count[1])
            meshes += room_shell.ceiling_lamp(x, y, height, radius, glow, drop)
            lamps.append(Lamp((float(x), float(y), height - drop - 0.15), tint, strength))
    if rng.random() < 0.6:
        x, y = rng.uniform(low + 1.2, high - 1.2)
        patterns = ("stripes", "checks", "dots", "blotches")
        cover = textures.cloth(rng, random_colour(rng), str(rng.choice(patterns)), random_colour(rng), 1.2, 512)
        size = rng.uniform((1.0, 0.7), (2.0, 1.4))
        meshes += room_shell.rug(float(x), float(y), float(rng.integers(2) * np.pi / 2), *map(float, size), cover)
    for index in rng.integers(0, 4, int(rng.integers(0, 4))):
        things, corners = _small_things(rng, walls[int(index)])
        meshes += things
        kept_free.append(corners)
    level = float(rng.uniform(0.28, 0.45))
    warm = np.asarray(colour(rng.uniform(20, 60), rng.uniform(0, 8), 100)) * level
    return joined(meshes), tuple(lamps), tuple(float(channel) for channel in warm), kept_free
