"""What changes from day to day in one building: how the doors stand, and what stands where in the way."""

from __future__ import annotations

from dataclasses import dataclass

from numpy.random import Generator

from course_lib.simulation.corridor import world
from course_lib.simulation.corridor.world import LENGTH, Building, RunDay, Thing, run_day

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


def scene_change(building: Building, model: DayModel, rng: Generator) -> RunDay:
    """Return the building on a day drawn with `rng`: the doors, then the things, and nothing of any other day."""
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
    wall = world.LEFT if side > 0 else world.right_side(x)
    farther = rng.uniform(0.0, PERSON_FARTHER) if kind == "person" else 0.0
    spread = {"person": 180.0, "chair": 180.0, "plant": 180.0, "cartons": 15.0, "trolley": 5.0}.get(kind, 0.0)
    turn = rng.uniform(-spread, spread)
    if kind == "ladder" and side < 0:
        turn = 180.0  # it leans at its wall
    return Thing(kind, x, wall - side * (FROM_WALL[kind] + farther), turn)


def _taken(building: Building, side: int) -> list[tuple[float, float]]:
    """Stretches along x `(low, high)` of the left (side 1) or right wall where nothing can stand."""
    layout, name = building.layout, "left" if side > 0 else "right"
    widths = [(x, width) for x, width, *_ in [*layout[f"{name} doors"], *layout[f"{name} pillars"]]]
    # Leaves of the fire doors stand hooked back behind their portal.
    widths += [(x + 0.5, 1.3) for x, *_ in layout["portals"]]
    if side > 0:
        widths += layout["benches"] + [(x, 0.2) for (x,) in layout["extinguishers"]]
        widths += [(sum(pair) / 2, pair[1] - pair[0]) for pair in (world.JUNCTION[:2], world.STAIRS)]
    else:
        widths.append((10.9, 0.3))  # the cabinet
    return [(x - width / 2 - BESIDE, x + width / 2 + BESIDE) for x, width in widths] + [(LENGTH - 1.0, LENGTH)]
