"""The true world: a fourth-floor corridor of 40 m along +x (z up, left is +y), on the survey day and on a run day."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.random import Generator

from courseware.simulation.corridor import materials as m
from courseware.simulation.corridor import parts
from courseware.simulation.corridor.mesh_building import MeshBuilder, Placement, WorldMesh

LENGTH = 40.0  # m, chosen
LEFT, RIGHT, RIGHT_NARROW, STEP_AT = 1.2, -1.38, -1.2, 20.4  # m, chosen
JUNCTION = (16.6, 18.8, 5.5)  # m: start and end along x, depth of the side corridor; chosen
STAIRS = (29.3, 32.1)  # m: start and end along x; chosen
BOW_AMPLITUDE = 0.004  # m, chosen: plaster walls are flat to a few millimetres over some metres
JITTER = 0.10  # m, chosen: how far the seed moves each thing along the corridor

# What the seed moves along x, each row by a draw of its own, so the order counts. Metres, from x on.
LAYOUT = {
    # (x, leaf width, recess depth, hinge at the far end, degrees open on survey day, on run day)
    "left doors": (
        (2.3, 0.90, 0.32, False, 0.0, 0.0),
        (7.6, 0.90, 0.24, True, 72.0, 18.0),
        (12.9, 1.00, 0.35, False, 0.0, 65.0),
        (21.9, 0.90, 0.14, True, 30.0, 0.0),
        (26.0, 0.90, 0.30, False, 85.0, 85.0),
        (35.0, 0.95, 0.20, True, 0.0, 40.0),
        (38.3, 0.85, 0.30, False, 12.0, 0.0),
    ),
    "right doors": ((32.7, 0.90, 0.26, False, 0.0, 0.0),),
    # (x, width, out)
    "left pillars": ((6.0, 0.45, 0.22), (19.7, 0.50, 0.28), (27.2, 0.40, 0.20), (36.6, 0.45, 0.25)),
    "right pillars": ((3.5, 0.40, 0.25), (8.1, 0.50, 0.30), (18.9, 0.45, 0.22), (24.2, 0.45, 0.25), (37.8, 0.50, 0.20)),
    "left boards": ((4.4, 1.6, 0.9), (33.5, 1.3, 1.1)),  # (x, length, height)
    "right boards": ((34.3, 1.2, 0.9),),
    "benches": ((10.6, 1.5), (23.9, 1.8)),  # (x, length)
    "portals": ((14.5, 0.14, 0.38, 0.16), (27.85, 0.11, 0.30, 0.14)),  # (x, jamb, drop of the lintel, thickness)
    "soffits": ((5.35, 0.30, 0.16), (11.5, 0.22, 0.24), (20.3, 0.40, 0.20), (33.9, 0.26, 0.18)),  # (x, length, drop)
    "lamps": ((1.4, 1.2), (4.0, 0.6), (6.9, 1.2), (9.4, 1.5), (12.9, 1.2), (16.2, 0.6), (17.9, 1.2), (21.9, 1.5),
              (24.6, 0.6), (26.4, 1.2), (30.2, 1.5), (32.6, 0.6), (35.7, 1.2), (38.6, 1.2)),  # (x, length)
    "extinguishers": ((9.1,), (20.6,), (32.6,)),
}  # fmt: skip
# (start, end in m along x, recess depth in m, shares at which mullions stand, radiator below)
WINDOWS = (
    (1.0, 2.6, 0.22, (0.5,), True),
    (4.4, 6.3, 0.22, (0.33, 0.66), True),
    (8.9, 10.2, 0.30, (), True),
    (12.2, 13.7, 0.22, (0.4,), False),
    (16.1, 17.5, 0.30, (0.5,), True),
    (21.2, 22.9, 0.18, (0.6,), True),
    (25.0, 26.1, 0.26, (), False),
    (29.7, 31.3, 0.18, (0.5,), True),
    (35.5, 36.9, 0.26, (0.3,), True),
    (38.5, 39.5, 0.18, (), False),
)


class Thing(NamedTuple):
    """A piece of clutter: kind (of parts.CLUTTER_KINDS), place in metres, turn in degrees."""

    kind: str
    x: float
    y: float
    turn: float


# Clutter of the shipped data's run day.
CLUTTER = (
    Thing("cartons", 6.9, -1.02, 10.0),
    Thing("chair", 11.2, -1.08, 150.0),
    Thing("person", 15.9, 0.88, 200.0),
    Thing("person", 16.5, 0.62, 40.0),
    Thing("trolley", 19.9, -1.06, 3.0),
    Thing("plant", 23.2, -0.86, 0.0),
    Thing("ladder", 25.12, 0.80, 0.0),
    Thing("bin", 28.95, 0.86, 0.0),
    Thing("cartons", 33.9, 0.86, 80.0),
    Thing("person", 36.0, -0.75, 90.0),
)


class Building(NamedTuple):
    """What both days have in common."""

    layout: dict[str, list[tuple]]  # the rows of LAYOUT, moved along x
    windows: list[tuple]  # rows of WINDOWS, moved
    phases: np.ndarray  # `(6,)` of the walls' bow
    detail_seed: int  # of brackets and papers


class TrueWorld(NamedTuple):
    """The corridor in its two states, as meshes. clutter_boxes: `(n, 2, 2)` [[x, y] low, high], metres."""

    survey_day: WorldMesh
    run_day: WorldMesh
    clutter_boxes: np.ndarray


def make_corridor(rng: Generator) -> TrueWorld:
    """The corridor drawn with `rng`, on the survey day and on the run day of LAYOUT and CLUTTER."""
    building = draw_building(rng)
    doors = building.layout["left doors"]
    survey_angles, run_angles = [row[4] for row in doors], [row[5] for row in doors]
    rooms = [survey > 0 or run > 0 for survey, run in zip(survey_angles, run_angles, strict=True)]
    survey, _ = run_day(building, survey_angles, (), rooms=rooms)
    return TrueWorld(survey, *run_day(building, run_angles, CLUTTER, rooms=rooms))


def draw_building(rng: Generator) -> Building:
    """A building: the seed moves every feature by up to JITTER and draws bow and small parts."""
    moves = iter(rng.uniform(-JITTER, JITTER, 200))
    phases = rng.uniform(0, 2 * np.pi, 6)
    seed = int(rng.integers(2**62))
    layout = {name: [(row[0] + next(moves), *row[1:]) for row in rows] for name, rows in LAYOUT.items()}
    windows = [(low + (move := next(moves)), high + move, *rest) for low, high, *rest in WINDOWS]
    return Building(layout, windows, phases, seed)


def run_day(
    building: Building,
    door_angles: Sequence[float],
    things: Sequence[Thing],
    rng: Generator | None = None,
    rooms: Sequence[bool] | None = None,
) -> tuple[WorldMesh, np.ndarray]:
    """The building with left doors open by `door_angles` (degrees) and things in the way: its mesh, and their boxes.

    rng: varies the things, by default as the building's small parts. rooms: which left doors have a room behind them,
    by default the open ones. The boxes are on the floor plan, `(n, 2, 2)`, metres.
    """
    builder = MeshBuilder(lambda points: _bow(points, building.phases))
    detail = np.random.default_rng(building.detail_seed)
    _shell(builder, building.layout, building.windows)
    _fittings(builder, building.layout, building.windows, detail)
    _doors(builder, building.layout, door_angles, rooms or [angle > 0 for angle in door_angles])
    boxes = []
    for kind, x, y, turn in things:
        piece = MeshBuilder()
        parts.CLUTTER_KINDS[kind](piece, Placement(np.array([x, y, 0.0])).moved(turn_deg=turn), rng or detail)
        builder.take(piece)
        points = piece.build().vertices[:, :2]
        boxes.append([points.min(axis=0), points.max(axis=0)])
    return builder.build(), np.array(boxes).reshape(-1, 2, 2)


def right_side(x: float) -> float:
    """Where the right wall stands at x: y in metres. It steps inward at STEP_AT."""
    return RIGHT if x < STEP_AT else RIGHT_NARROW


def left_wall() -> Placement:
    """Frame of the left wall: along +x, into +y."""
    return Placement(np.array([0.0, LEFT, 0.0]), np.eye(3))


def right_wall(x: float) -> Placement:
    """Frame of the right wall: along +x, into -y."""
    return Placement(np.array([0.0, right_side(x), 0.0]), np.diag([1.0, -1.0, 1.0]))


def _cross_wall(x: float, y: float, sense: float) -> Placement:
    """Frame of a wall across the corridor: along +y, into sense * x."""
    return Placement(np.array([x, y, 0.0]), np.array([[0.0, 1, 0], [sense, 0, 0], [0, 0, 1.0]]))


def _bow(points: np.ndarray, phases: np.ndarray) -> np.ndarray:
    """Smooth displacement of large panels in metres, waves of 2 to 7 m, at most BOW_AMPLITUDE."""
    x, y, z = points.T
    waves = np.sin(2 * np.pi * x / 6.7 + phases[0] + y) + np.sin(2 * np.pi * x / 3.1 + phases[1] + 1.7 * z)
    return BOW_AMPLITUDE / 3 * (waves + np.sin(2 * np.pi * z / 2.3 + phases[2] + 0.9 * y))


def _door_opening(x: float, width: float) -> tuple[float, float, float, float]:
    return x - width / 2 - 0.06, x + width / 2 + 0.06, 0.0, 2.06


def _shell(b: MeshBuilder, layout: dict, windows: list) -> None:
    """Floor, ceiling, walls with their openings, side corridor, stairwell, ends, soffits and portals."""
    h, (start, end, depth) = parts.CEILING_HEIGHT, JUNCTION
    world = Placement()
    b.panel(world, (0, RIGHT - 0.02, 0), (LENGTH, 0, 0), (0, LEFT - RIGHT + 0.04, 0), m.LINOLEUM)
    b.panel(world, (start, LEFT, 0), (end - start, 0, 0), (0, depth, 0), m.LINOLEUM)
    b.box(world, (0.5, -0.7, -0.01), (1.9, 0.7, 0.012), m.DOOR_MAT, bevel=0.004)
    b.panel(world, (0, RIGHT - 0.02, h), (LENGTH, 0, 0), (0, LEFT - RIGHT + 0.04, 0), m.CEILING_PAINT)
    b.panel(world, (start, LEFT, h), (end - start, 0, 0), (0, depth, 0), m.CEILING_PAINT)
    left_openings = [_door_opening(x, width) for x, width, *_ in layout["left doors"]]
    left_openings += [(start, end, 0.0, h), (*STAIRS, 0.0, h)]
    parts.wall(b, left_wall(), 0.0, LENGTH, left_openings)
    right = [(low, high, 0.88, 2.28) for low, high, *_ in windows]
    right += [_door_opening(x, width) for x, width, *_ in layout["right doors"]]
    parts.wall(b, right_wall(0.0), 0.0, STEP_AT, [o for o in right if o[0] < STEP_AT])
    parts.wall(b, right_wall(LENGTH), STEP_AT, LENGTH, [o for o in right if o[0] >= STEP_AT])
    b.panel(world, (STEP_AT, RIGHT - 0.01, 0), (0, RIGHT_NARROW - RIGHT + 0.015, 0), (0, 0, h), m.WALL_PAINT)
    parts.wall(b, _cross_wall(0.0, 0.0, -1.0), RIGHT, LEFT, [(-0.6, 0.6, 0.88, 2.28)])
    parts.window_niche(b, _cross_wall(0.0, 0.0, -1.0), -0.6, 0.6, 0.25, (0.5,))
    parts.wall(b, _cross_wall(LENGTH, 0.0, 1.0), RIGHT_NARROW, LEFT, [_door_opening(0.1, 1.0)])
    for x, sense in ((start, -1.0), (end, 1.0)):
        side = _cross_wall(x, LEFT, sense)
        openings = [_door_opening(3.1, 0.9)] if sense > 0 else [_door_opening(4.2, 0.9)]
        parts.wall(b, side, -parts.BEAD, depth, openings)
    back = left_wall().moved(into=depth)
    parts.wall(b, back, start, end, [(start + 0.5, end - 0.7, 0.88, 2.28)])
    parts.window_niche(b, back, start + 0.5, end - 0.7, 0.24, (0.5,))
    parts.stairwell(b, left_wall().moved(along=(STAIRS[0] + STAIRS[1]) / 2), STAIRS[1] - STAIRS[0])
    for x, jamb, drop, thick in layout["portals"]:
        low = right_side(x)
        parts.portal(b, Placement(np.array([x, (LEFT + low) / 2, 0.0])), (LEFT - low) / 2, jamb, drop, thick)
    for x, length, drop in layout["soffits"]:
        b.box(world, (x, RIGHT, h - drop), (x + length, LEFT, h + 0.03), m.WALL_PAINT, bevel=0.01)


def _fittings(b: MeshBuilder, layout: dict, windows: list, rng: Generator) -> None:
    """Windows, radiators, pillars, boards, benches, lamps, cable tray, signs, cabinet."""
    for low, high, depth, mullions, has_radiator in windows:
        place = right_wall(low)
        parts.window_niche(b, place, low, high, depth, mullions)
        if has_radiator:
            parts.radiator(b, place, low + 0.15, high - 0.2)
    for x, width, out in layout["left pillars"]:
        parts.pillar(b, left_wall().moved(along=x), width, out)
    for x, width, out in layout["right pillars"]:
        parts.pillar(b, right_wall(x).moved(along=x), width, out)
    for x, length, height in layout["left boards"]:
        parts.notice_board(b, left_wall().moved(along=x), length, height, rng)
    for x, length, height in layout["right boards"]:
        parts.notice_board(b, right_wall(x).moved(along=x), length, height, rng)
    for x, length in layout["benches"]:
        parts.bench(b, left_wall().moved(along=x), length)
    parts.notice_board(b, _cross_wall(JUNCTION[1], LEFT, 1.0).moved(along=1.3), 1.2, 0.9, rng)
    parts.bench(b, _cross_wall(JUNCTION[0], LEFT, -1.0).moved(along=2.2), 1.4)
    for (x,) in layout["extinguishers"]:
        parts.extinguisher(b, left_wall().moved(along=x))
    ceiling = Placement(np.array([0.0, 0.0, parts.CEILING_HEIGHT]))
    for i, (x, length) in enumerate(layout["lamps"]):
        parts.lamp(b, ceiling.moved(along=x, into=0.1, turn_deg=90.0 if i % 4 == 1 else 0.0), length)
    parts.lamp(b, ceiling.moved(along=17.6, into=4.2, turn_deg=90.0), 1.2)
    for x in (14.1, 28.6, 39.2):
        parts.exit_sign(b, ceiling.moved(along=x, into=0.1))
    brackets = np.sort(rng.uniform(0.5, LENGTH - 0.5, 27))
    parts.cable_tray(b, ceiling.moved(into=-0.92), 0.02, LENGTH - 0.02, brackets)
    b.box(right_wall(11.2), (10.75, -0.36, 0.03), (11.0, -0.02, 1.35), m.CABINET, bevel=0.01)
    b.tube(left_wall(), (15.95, -0.06, 0.0), (15.95, -0.06, parts.CEILING_HEIGHT), 0.045, m.STEEL, 16)
    b.tube(left_wall(), (34.2, -0.05, 0.0), (34.2, -0.05, parts.CEILING_HEIGHT), 0.03, m.STEEL, 16)


def _doors(b: MeshBuilder, layout: dict, left_angles: Sequence[float], left_rooms: Sequence[bool]) -> None:
    """All doors, the left ones open by degrees `left_angles`, with rooms behind those of `left_rooms`."""
    rows = [(left_wall(), *row) for row in layout["left doors"]]
    rows += [(right_wall(row[0]), *row) for row in layout["right doors"]]
    rows.append((_cross_wall(LENGTH, 0.0, 1.0), 0.1, 1.0, 0.35, False))
    rows.append((_cross_wall(JUNCTION[1], LEFT, 1.0), 3.1, 0.9, 0.16, False))
    rows.append((_cross_wall(JUNCTION[0], LEFT, -1.0), 4.2, 0.9, 0.16, True))
    for number, (frame, along, width, depth, hinge_at_end, *_) in enumerate(rows):
        place, left = frame.moved(along=along), number < len(left_angles)  # all others are closed on every day
        parts.door(b, place, width, depth, left_angles[number] if left else 0.0, hinge_at_end)
        if left and left_rooms[number]:
            parts.room_behind(b, place, width, depth, 1.1 + 0.12 * number)


# How far each kind's middle stands from its wall, in metres; a person up to PERSON_FARTHER more. Chosen, as CLUTTER is.
FROM_WALL = {
    "cartons": 0.35, "person": 0.30, "trolley": 0.32, "chair": 0.30, "plant": 0.36, "ladder": 0.40, "bin": 0.32,
}  # fmt: skip
PERSON_FARTHER = 0.30
# Metres along x that a thing keeps from what is built into its wall.
BESIDE = 0.35


@dataclass(frozen=True)
class DayModel:
    """What changes from one day of recording to the next in one building."""

    as_surveyed: float = 0.3  # probability that a left door stands as on the survey day; chosen, shipped: 2 of 7
    closed: float = 0.4  # probability that any other left door is closed; chosen
    open_deg: tuple[float, float] = (10.0, 90.0)  # degrees by which a door stands open that is not closed; chosen
    things: tuple[int, int] = (8, 12)  # how many things stand in the way, least and most; chosen, 10 in data/corridor
    people: float = 0.3  # probability that a thing is a standing person; chosen, 3 of 10 in data/corridor
    apart: float = 2.1  # m along x between the middles of two things, so that a wagon gets past; chosen
    stretch: tuple[float, float] = (4.5, 37.0)  # m along x where things may stand; chosen
    starts: tuple[float, float] = (1.8, 6.0)  # m along x, from where to where the wagon may start; chosen
    hand_starts: tuple[float, float] = (1.8, 26.0)  # m along x, the same of a camera carried by hand; chosen


def scene_change(building: Building, model: DayModel, rng: Generator) -> tuple[WorldMesh, np.ndarray]:
    """Return the building on a day drawn with `rng`, as `run_day` does: the doors are drawn first, then the things."""
    angles = []
    for *_, surveyed, _shipped in building.layout["left doors"]:
        drawn = 0.0 if rng.random() < model.closed else rng.uniform(*model.open_deg)
        angles.append(surveyed if rng.random() < model.as_surveyed else drawn)
    return run_day(building, angles, _things(building, model, rng), rng)


def _things(building: Building, model: DayModel, rng: Generator) -> list[Thing]:
    """Things along the walls, `model.apart` from each other; a thing that finds no place in 100 draws stays away."""
    kinds = [kind for kind in FROM_WALL if kind != "person"]
    taken = {side: _taken(building, side) for side in (-1, 1)}
    things: list[Thing] = []
    for _ in range(rng.integers(model.things[0], model.things[1] + 1)):
        kind = "person" if rng.random() < model.people else kinds[rng.integers(len(kinds))]
        side = int(rng.choice((-1, 1)))
        for _ in range(100):
            x = rng.uniform(*model.stretch)
            free = all(not low < x < high for low, high in taken[side])
            if free and all(abs(x - other.x) >= model.apart for other in things):
                things.append(_placed(kind, x, side, rng))
                break
    return things


def _placed(kind: str, x: float, side: int, rng: Generator) -> Thing:
    """A thing at its distance from the left (side 1) or right wall, turned as its kind may be."""
    wall = LEFT if side > 0 else right_side(x)
    farther = rng.uniform(0.0, PERSON_FARTHER) if kind == "person" else 0.0
    spread = {"person": 180.0, "chair": 180.0, "plant": 180.0, "cartons": 15.0, "trolley": 5.0}.get(kind, 0.0)
    turn = rng.uniform(-spread, spread)
    turn = 180.0 if kind == "ladder" and side < 0 else turn  # it leans at its wall
    return Thing(kind, x, wall - side * (FROM_WALL[kind] + farther), turn)


def _taken(building: Building, side: int) -> list[tuple[float, float]]:
    """Stretches along x `(low, high)` of the left (side 1) or right wall where nothing can stand."""
    layout, name = building.layout, "left" if side > 0 else "right"
    widths = [(x, width) for x, width, *_ in [*layout[f"{name} doors"], *layout[f"{name} pillars"]]]
    # Leaves of the fire doors stand hooked back behind their portal.
    widths += [(x + 0.5, 1.3) for x, *_ in layout["portals"]]
    if side > 0:
        widths += layout["benches"] + [(x, 0.2) for (x,) in layout["extinguishers"]]
        widths += [(sum(pair) / 2, pair[1] - pair[0]) for pair in (JUNCTION[:2], STAIRS)]
    else:
        widths.append((10.9, 0.3))  # the cabinet
    return [(x - width / 2 - BESIDE, x + width / 2 + BESIDE) for x, width in widths] + [(LENGTH - 1.0, LENGTH)]
