"""A room apart from its listed furniture; small things by its walls let a detector meet what is not of its classes."""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.random import Generator

from courseware.simulation import textures
from courseware.simulation.furniture.solids import box, cylinder, grid_faces, joined, lathe, panel, rod, textured, turn
from courseware.simulation.room.scene import Lamp, Room, RoomObject, clear_of, overlap, rectangle
from courseware.simulation.textures import Meshes, Surface, TexturedMesh, colour, random_colour

WALL_CELL = 0.5  # metres: longest edge of a wall's cell
LIFT = 0.004  # metres between two faces that would otherwise lie in one plane
GAP = 0.06  # metres between two footprints

Pair = Sequence[float]  # x, y


@dataclass(frozen=True)
class Wall:
    """One wall: start: its left end on the floor as seen from inside; along: unit vector to its right end; inward."""

    start: np.ndarray
    along: np.ndarray
    inward: np.ndarray
    length: float

    def pose(self, s: float, z: float = 0.0, out: float = 0.0) -> dict[str, float]:
        """Where turn() puts a thing whose front is +x: s metres along the wall, z up, out metres into the room."""
        x, y = self.start + s * self.along + out * self.inward
        return {"x": float(x), "y": float(y), "z": z, "yaw": float(np.arctan2(self.inward[1], self.inward[0]))}

    def rectangle(self, s: float, out: float, depth: float, width: float) -> np.ndarray:
        """Corners `(4, 2)` of a footprint by the wall, its middle at s and out as in `pose`."""
        pose = self.pose(s, out=out)
        return rectangle(pose["x"], pose["y"], pose["yaw"], depth, width)


def walls_of(low: Pair, high: Pair) -> list[Wall]:
    """The four walls of the rectangle low to high: south (y = low), east, north, west, seen from inside."""
    (x0, y0), (x1, y1) = low, high
    sides = [((x1, y0), (-1, 0), (0, 1), x1 - x0), ((x1, y1), (0, -1), (-1, 0), y1 - y0)]
    sides += [((x0, y1), (1, 0), (0, -1), x1 - x0), ((x0, y0), (0, 1), (1, 0), y1 - y0)]
    return [Wall(*(np.array(vector, float) for vector in vectors), float(length)) for *vectors, length in sides]


def bare_room(
    low: Pair, high: Pair, height: float, papers: Sequence[Surface], floor: Surface, ceiling: Surface, trim: Surface
) -> Meshes:
    """Floor, ceiling, four walls (papers: one surface for each) and skirting boards."""
    (x0, y0), (x1, y1) = low, high
    meshes = [
        panel((x0, y0, 0), (x1 - x0, 0, 0), (0, y1 - y0, 0), floor, cell=WALL_CELL),
        panel((x0, y1, height), (x1 - x0, 0, 0), (0, y0 - y1, 0), ceiling, cell=WALL_CELL),
    ]
    for wall, paper in zip(walls_of(low, high), papers, strict=True):
        start, along = np.append(wall.start, 0.0), np.append(wall.along * wall.length, 0.0)
        meshes.append(panel(start, along, (0, 0, height), paper, cell=WALL_CELL))
        board = box((0.014, wall.length, 0.09), (0.007, 0, 0.045), trim)
        meshes += turn(board, **wall.pose(wall.length / 2))
    return meshes


def window(wall: Wall, s: float, width: float, height: float, sill: float, view: Surface, frame: Surface) -> Meshes:
    """A window with its middle s metres along the wall: a view that shines, a frame with a bar, a sill."""
    parts = [panel((LIFT, -width / 2, 0), (0, width, 0), (0, 0, height), view, fit=True)]
    for y in (-width / 2, 0.0, width / 2):
        parts += box((0.05, 0.05, height + 0.05), (0.02, y, height / 2), frame)
    for z in (0.0, height):
        parts += box((0.05, width + 0.05, 0.05), (0.021, 0, z), frame)
    parts += box((0.14, width + 0.14, 0.03), (0.07, 0, -0.03), frame)
    return turn(parts, **wall.pose(s, sill))


def curtain(wall: Wall, s: float, width: float, height: float, cover: Surface) -> Meshes:
    """A hanging curtain in folds, its middle s metres along the wall, from just above the floor to height."""
    folds = max(3, round(width / 0.09))
    y = np.linspace(-width / 2, width / 2, 4 * folds + 1)
    x = 0.09 + 0.025 * np.sin(np.linspace(0, 2 * np.pi * folds, 4 * folds + 1))
    parts = []
    for offset, order in ((0.006, 1), (0.0, -1)):
        sheet = np.stack([np.tile(x + offset, 6), np.tile(y, 6), np.repeat(np.linspace(0.06, height, 6), len(y))], 1)
        sheet = sheet.reshape(6, -1, 3)[:, ::order].reshape(-1, 3)
        parts.append(textured(sheet, grid_faces(6, len(y)), sheet[:, 1:] * (1.25, 1.0), cover))
    parts += rod([(0.09, -width / 2 - 0.08, height + 0.02), (0.09, width / 2 + 0.08, height + 0.02)], 0.012, cover)
    return turn(parts, **wall.pose(s))


def door(wall: Wall, s: float, leaf: Surface, frame: Surface, knob: Surface) -> Meshes:
    """A closed door of 0.85 x 2.0 m with panels, a frame and a handle."""
    parts = box((0.03, 0.85, 2.0), (0.015, 0, 1.0), leaf)
    for z, tall in ((0.5, 0.7), (1.4, 0.9)):
        parts += box((0.016, 0.55, tall), (0.034, 0, z), leaf)
    for y in (-0.465, 0.465):
        parts += box((0.05, 0.08, 2.09), (0.025, y, 1.045), frame)
    parts += box((0.05, 0.85, 0.08), (0.025, 0, 2.05), frame)
    parts += rod([(0.075, 0.25, 1.02), (0.075, 0.37, 1.02)], 0.012, knob)
    parts += rod([(0.03, 0.37, 1.02), (0.075, 0.37, 1.02)], 0.01, knob)
    return turn(parts, **wall.pose(s))


def framed_picture(wall: Wall, s: float, z: float, print_: Surface, frame: Surface) -> Meshes:
    """A picture on the wall, its middle s metres along and z metres up; its size is the print's."""
    width, height = print_.size
    parts = box((0.025, width + 0.06, height + 0.06), (0.0125, 0, 0), frame)
    parts.append(panel((0.025 + LIFT, -width / 2, -height / 2), (0, width, 0), (0, 0, height), print_, fit=True))
    return turn(parts, **wall.pose(s, z))


def ceiling_lamp(x: float, y: float, height: float, radius: float, glow: Surface, drop: float = 0.12) -> Meshes:
    """A bowl of light under the ceiling; drop: how far it hangs down, metres."""
    bowl = [(0.0, 0.0), (0.7 * radius, 0.02), (radius, 0.07), (0.9 * radius, 0.1), (0.0, 0.1)]
    meshes = lathe(bowl, (x, y, height - drop), glow, 20)
    return meshes + cylinder(0.012, drop - 0.09, (x, y, height - drop + 0.09), glow)


def rug(x: float, y: float, heading: float, length: float, width: float, cover: Surface) -> Meshes:
    """A flat rug on the floor."""
    return turn(box((length, width, 0.008), (0, 0, 0.005), cover), x=x, y=y, yaw=heading)


def waste_bin(wall: Wall, s: float, radius: float, height: float, side: Surface) -> Meshes:
    """A round bin by the wall, wider at its top."""
    profile = [(0, 0), (0.8 * radius, 0), (radius, height), (0.9 * radius, height), (0.75 * radius, 0.05), (0, 0.05)]
    return turn(lathe(profile, (radius + 0.03, 0, 0), side, 18), **wall.pose(s))


@dataclass
class Plan:
    """A room while it is being made: from the floor's corner low to high `(2,)`, with a ceiling at height, metres."""

    low: np.ndarray
    high: np.ndarray
    height: float
    walls: list[Wall]
    meshes: list[TexturedMesh]
    lamps: list[Lamp] = field(default_factory=list)
    taken: list[np.ndarray] = field(default_factory=list)  # rectangles `(4, 2)` on which nothing else may stand
    # Stretches (from, to) in metres along each of the four walls that windows, the door and pictures cover.
    spans: list[list[tuple[float, float]]] = field(default_factory=lambda: [[], [], [], []])
    ambient: tuple[float, float, float] = (0.35, 0.35, 0.35)
    probes: np.ndarray = field(default_factory=lambda: np.empty((0, 2)))  # some must stay free for a rig
    objects: list[RoomObject] = field(default_factory=list)
    tables: list[np.ndarray] = field(default_factory=list)  # their rectangles

    def fits(self, corners: np.ndarray, gap: float = GAP) -> bool:
        """Whether the rectangle lies inside the walls and apart from all others."""
        inside = (corners.min(axis=0) >= self.low + 0.005).all() and (corners.max(axis=0) <= self.high - 0.005).all()
        return bool(inside) and not any(overlap(corners, other, gap) for other in self.taken)

    def leaves_space(self, corners: np.ndarray) -> bool:
        """Whether one probe in 40 stays free when the rectangle is taken."""
        return clear_of([*self.taken, corners], self.probes, 0.35).sum() * 40 >= len(self.probes)

    def room(self) -> Room:
        """The room with the furniture that the plan holds."""
        (x0, y0), (x1, y1) = self.low, self.high
        walls = np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], float)
        parts = tuple(self.objects), tuple(self.meshes), tuple(self.lamps)
        return Room(walls, self.height, *parts, self.ambient)


def free_stretch(rng: Generator, wall: Wall, spans: list[tuple[float, float]], width: float) -> float | None:
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


def _small_things(rng: Generator, wall: Wall) -> tuple[Meshes, np.ndarray]:
    """One carton, bin or standing lamp by the wall, and the rectangle it stands on."""
    s = float(rng.uniform(0.35, wall.length - 0.35))
    kind = rng.integers(3)
    if kind == 0:
        d, w, h = size = rng.uniform((0.2, 0.25, 0.15), (0.4, 0.5, 0.45))
        brown = textures.cloth(rng, random_colour(rng, (15, 60), (40, 85)), "blotches", size=0.5, pixels=128)
        parts, face = box(size, (d / 2 + 0.02, 0, h / 2), brown), textures.label(rng, 0.2, 0.15)
        parts.append(panel((d + 0.02 + LIFT, -0.3 * w, 0.25 * h), (0, 0.6 * w, 0), (0, 0, 0.5 * h), face, fit=True))
        meshes = turn(parts, **wall.pose(s))
    elif kind == 1:
        side = textures.ceramic(rng, random_colour(rng, (0, 80), (20, 95)), pixels=128)
        meshes = waste_bin(wall, s, float(rng.uniform(0.11, 0.17)), float(rng.uniform(0.22, 0.4)), side)
    else:
        pole = textures.metal(rng, random_colour(rng, (0, 30), (10, 80)), 0.3, 64)
        shade = Surface(textures.cloth(rng, colour(40, 25, 95), size=0.4, pixels=128).image, (0.4, 0.4), 0.75)
        x, height = 0.22, float(rng.uniform(1.2, 1.7))
        parts = cylinder(0.13, 0.03, (x, 0, 0), pole, n=18) + rod([(x, 0, 0.02), (x, 0, height - 0.1)], 0.012, pole)
        parts += lathe([(0, 0), (0.18, 0), (0.11, 0.25), (0, 0.25)], (x, 0, height - 0.25), shade, 20)
        meshes = turn(parts, **wall.pose(s))
    return meshes, wall.rectangle(s, 0.22, 0.45, 0.52)


def _add_window(rng: Generator, plan: Plan, index: int, trim: Surface) -> None:
    """A window, its daylight, and in six of ten cases curtains."""
    wall, width, tall = plan.walls[index], float(rng.uniform(0.9, 1.9)), float(rng.uniform(0.9, 1.3))
    s, sill = float(rng.uniform(1.5, wall.length - 1.5)), float(rng.uniform(0.75, 1.0))
    plan.meshes += window(wall, s, width, tall, sill, textures.window_view(rng, width, tall), trim)
    reach = width / 2 + 0.1
    if rng.random() < 0.6:
        pattern = str(rng.choice(textures.CLOTH_PATTERNS))
        cover = textures.cloth(rng, random_colour(rng), pattern, random_colour(rng))
        for sign in (-1.0, 1.0):
            plan.meshes += curtain(wall, s + sign * (width / 2 + 0.12), 0.4, sill + tall + 0.12, cover)
        reach = width / 2 + 0.42
    plan.spans[index].append((s - reach, s + reach))
    pose = wall.pose(s, sill + tall / 2, out=0.5)
    day = colour(rng.uniform(190, 230), rng.uniform(0, 12), 100)
    plan.lamps.append(Lamp((pose["x"], pose["y"], pose["z"]), day, float(rng.uniform(0.6, 1.6))))


def _add_ceiling_lamps(rng: Generator, plan: Plan) -> None:
    """One, two or four lamps that share the light between them."""
    tint = colour(rng.uniform(25, 60), rng.uniform(0, 22), 100)
    glow = textures.glow(tint)
    columns, rows = ((1, 1), (1, 1), (2, 1), (1, 2), (2, 2))[int(rng.integers(5))]
    radius, drop = float(rng.uniform(0.12, 0.28)), float(rng.uniform(0.12, 0.4))
    strength = float(rng.uniform(1.6, 3.2) / np.sqrt(columns * rows))
    for i, j in itertools.product(range(columns), range(rows)):
        x, y = (float(v) for v in plan.low + (plan.high - plan.low) * ((i + 0.5) / columns, (j + 0.5) / rows))
        plan.meshes += ceiling_lamp(x, y, plan.height, radius, glow, drop)
        plan.lamps.append(Lamp((x, y, plan.height - drop - 0.15), tint, strength))


def random_shell(rng: Generator, low: np.ndarray, high: np.ndarray, height: float) -> Plan:
    """A room without furniture, low to high `(2,)`, metres: all that the semantic map does not list."""
    trim = textures.wood(rng, random_colour(rng, (0, 45), (30, 97)), 0.6, 128)
    ceiling = textures.plaster(rng, random_colour(rng, (0, 8), (85, 98)), 2.0, 256)
    bare = bare_room(low, high, height, _papers(rng), _floor(rng), ceiling, trim)
    plan = Plan(low, high, height, walls_of(low, high), bare)
    order = [int(index) for index in rng.permutation(4)]
    for index in order[: int(rng.integers(1, 3))]:
        _add_window(rng, plan, index, trim)
    wall = plan.walls[order[2]]
    s = float(rng.uniform(0.7, wall.length - 0.7))
    leaf = textures.wood(rng, random_colour(rng, (0, 60), (35, 97)), 1.0)
    plan.meshes += door(wall, s, leaf.turned(), trim, textures.metal(rng, (0.75, 0.72, 0.6), 0.3, 64))
    plan.spans[order[2]].append((s - 0.55, s + 0.55))
    plan.taken.append(wall.rectangle(s, 0.35, 0.7, 0.9))  # the floor before the door stays free
    for index in rng.integers(0, 4, int(rng.integers(1, 6))):
        width = float(rng.uniform(0.3, 0.9))
        s = free_stretch(rng, plan.walls[index], plan.spans[index], width + 0.06)
        if s is not None:
            print_ = textures.picture(rng, width, float(width * rng.uniform(0.6, 1.4)), pixels=160)
            plan.meshes += framed_picture(plan.walls[index], s, float(rng.uniform(1.4, 1.65)), print_, trim)
    _add_ceiling_lamps(rng, plan)
    if rng.random() < 0.6:
        x, y = (float(v) for v in rng.uniform(plan.low + 1.2, plan.high - 1.2))
        pattern = str(rng.choice(("stripes", "checks", "dots", "blotches")))
        cover = textures.cloth(rng, random_colour(rng), pattern, random_colour(rng), 1.2, 512)
        length, width = (float(v) for v in rng.uniform((1.0, 0.7), (2.0, 1.4)))
        plan.meshes += rug(x, y, float(rng.integers(2) * np.pi / 2), length, width, cover)
    for index in rng.integers(0, 4, int(rng.integers(0, 4))):
        things, corners = _small_things(rng, plan.walls[int(index)])
        if not any(overlap(corners, other) for other in plan.taken):
            plan.meshes += things
            plan.taken.append(corners)
    warm = np.asarray(colour(rng.uniform(20, 60), rng.uniform(0, 8), 100)) * rng.uniform(0.28, 0.45)
    plan.ambient = tuple(float(channel) for channel in warm)
    plan.meshes = list(joined(plan.meshes))
    plan.probes = rng.uniform(low + 0.5, high - 0.5, (400, 2))
    return plan
