"""Rooms from a seed: `make_room` for training the detector, `make_look_alike_room` for reporting.

The limits for reporting were committed before any such room was drawn. No seed gives one room in both generators.
"""

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from courseware.simulation.furniture.pieces import RANDOM_PIECES, random_cabinet, random_television
from courseware.simulation.furniture.solids import Piece
from courseware.simulation.room.scene import Room, rectangle
from courseware.simulation.room.shell import GAP, Plan, free_stretch, random_shell

MIN_PIECES, MAX_PIECES = 9, 16  # pieces of furniture
# Of each class: how likely it stands with its back to a wall, how likely it is drawn, how many a room has at most.
# Large pieces come first, because later there is less space for them.
CLASSES = {
    "television": (0.85, 0.1, 2),
    "refrigerator": (1.0, 0.09, 2),
    "sofa": (0.8, 0.13, 3),
    "cabinet": (0.97, 0.14, 3),
    "table": (0.3, 0.13, 3),
    "potted plant": (0.75, 0.17, 4),
    "chair": (0.3, 0.24, 5),
}
DRAWN = ("sofa", "chair", "table", "television", "potted plant", "refrigerator", "cabinet")  # in the order of the draws

Spot = tuple[float, float, float]  # x, y in metres, heading in radians


def _by_a_wall(rng: Generator, plan: Plan, size: np.ndarray) -> Spot:
    depth, width, _ = size
    wall = plan.walls[int(rng.integers(4))]
    slack = max(wall.length - width - 0.06, 0.0)
    out = depth / 2 + 0.02 + rng.choice([0.0, rng.uniform(0.0, 0.15)])
    pose = wall.pose(0.03 + width / 2 + rng.uniform(0.0, slack), out=out)
    turned = rng.normal(0.0, 0.05) if rng.random() < 0.3 else 0.0
    return pose["x"], pose["y"], pose["yaw"] + turned


def _anywhere(rng: Generator, plan: Plan, size: np.ndarray) -> Spot:
    reach = 0.5 * np.hypot(size[0], size[1]) + 0.05
    x, y = rng.uniform(plan.low + reach, np.maximum(plan.high - reach, plan.low + reach + 0.01))
    heading = rng.uniform(-np.pi, np.pi) if rng.random() < 0.6 else rng.integers(4) * np.pi / 2
    return float(x), float(y), float(heading)


def _at_a_table(rng: Generator, plan: Plan, size: np.ndarray) -> Spot:
    """Before one side of a table, facing it."""
    corners = plan.tables[int(rng.integers(len(plan.tables)))]
    side = int(rng.integers(4))
    middle = (corners[side] + corners[(side + 1) % 4]) / 2
    outward = middle - corners.mean(axis=0)
    outward /= np.linalg.norm(outward)
    x, y = middle + (size[0] / 2 + rng.uniform(0.02, 0.25)) * outward
    return float(x), float(y), float(np.arctan2(-outward[1], -outward[0]) + rng.normal(0.0, 0.15))


def _find_spot(rng: Generator, plan: Plan, label: str, size: np.ndarray) -> Spot | None:
    """Where a piece of this size fits between what stands already, or None after 60 tries."""
    at_wall = rng.random() < CLASSES[label][0]
    at_table = label == "chair" and bool(plan.tables) and rng.random() < 0.5
    for attempt in range(60):
        if at_table and attempt < 20:
            spot = _at_a_table(rng, plan, size)
        elif at_wall or attempt >= 40:
            spot = _by_a_wall(rng, plan, size)
        else:
            spot = _anywhere(rng, plan, size)
        corners = rectangle(*spot, *size[:2])
        if plan.fits(corners, 0.01 if at_table else GAP) and plan.leaves_space(corners):
            return spot
    return None


def _add_television(rng: Generator, plan: Plan) -> None:
    """A television on its own stand, on the wall, or on a low cabinet, which the map then lists too."""
    stand = str(rng.choice(["floor", "wall", "foot", "foot"]))
    piece = random_television(rng, stand)
    if stand == "wall":
        index = int(rng.integers(4))
        s = free_stretch(rng, plan.walls[index], plan.spans[index], float(piece.size[1]))
        if s is not None:
            pose = plan.walls[index].pose(s, out=piece.size[0] / 2 + 0.01)
            spot = pose["x"], pose["y"], pose["yaw"]
            if plan.fits(rectangle(*spot, *piece.size[:2])):
                plan.taken.append(rectangle(*spot, *piece.size[:2]))
                plan.objects.append(piece.at(*spot, z=float(rng.uniform(0.7, 1.1))))
        return
    under = random_cabinet(rng, "sideboard") if stand == "foot" else None
    size = np.maximum(piece.size, under.size) if under else piece.size
    spot = _find_spot(rng, plan, "television", size)
    if spot is not None:
        plan.objects += [under.at(*spot)] if under else []
        plan.objects.append(piece.at(*spot, z=float(under.size[2]) if under else 0.0))
        plan.taken.append(rectangle(*spot, *size[:2]))


def _add_piece(rng: Generator, plan: Plan, piece: Piece) -> bool:
    """Place the piece where it fits, and say whether it did; without space the room does without it."""
    spot = _find_spot(rng, plan, piece.label, piece.size)
    if spot is None:
        return False
    plan.objects.append(piece.at(*spot))
    plan.taken.append(rectangle(*spot, *piece.size[:2]))
    if piece.label == "table":
        plan.tables.append(plan.taken[-1])
    return True


def _add(rng: Generator, plan: Plan, label: str) -> None:
    """Draw a piece of a class and place it where it fits."""
    if label == "television":
        _add_television(rng, plan)
    else:
        _add_piece(rng, plan, RANDOM_PIECES[label](rng))


def _draw_labels(rng: Generator, n: int) -> list[str]:
    """The classes of n pieces; at least five different ones, so that no room teaches only chairs."""
    share = np.array([CLASSES[name][1] for name in DRAWN])
    labels = [DRAWN[index] for index in rng.permutation(len(DRAWN))[: int(rng.integers(5, 8))]]
    while len(labels) < n:
        name = DRAWN[int(rng.choice(len(DRAWN), p=share / share.sum()))]
        if labels.count(name) < CLASSES[name][2]:
            labels.append(name)
    return sorted(labels, key=list(CLASSES).index)


def make_room(seed: int | Generator) -> Room:
    """A furnished rectangular room, 4.5 to 7.5 m a side, its south-west corner at the origin; a seed gives one room."""
    rng = np.random.default_rng(seed)
    high = rng.uniform(4.5, 7.5, 2)
    plan = random_shell(rng, np.zeros(2), high, float(rng.uniform(2.4, 3.0)))
    n = int(np.clip(round(rng.normal(6 + high.prod() / 6.0, 1.5)), MIN_PIECES, MAX_PIECES - 2))
    for label in _draw_labels(rng, n):
        _add(rng, plan, label)
    for _ in range(60):
        # What found no space is made up for with small pieces.
        if len(plan.objects) >= MIN_PIECES:
            break
        _add(rng, plan, str(rng.choice(["chair", "potted plant"])))
    return plan.room()


STREAM = 0x100A11E  # joins every seed, so that no random number of these rooms is one of make_room's
MAX_DRAWS = 100  # rooms drawn for one seed before giving up; chosen


@dataclass(frozen=True)
class LookAlikeLimits:
    """Between what a room of look-alikes is drawn, uniformly where two numbers stand."""

    side: tuple[float, float] = (5.0, 7.0)  # m, length of either pair of walls; chosen: the paper's room is about 6 x 6
    height: tuple[float, float] = (2.4, 3.0)  # m, of the ceiling; chosen, as in make_room
    kinds: tuple[str, ...] = ("sofa", "chair")  # of which one kind's pieces look alike; the paper's own case is sofas
    look_alikes: tuple[int, int] = (3, 5)  # pieces of one shape and one colour; chosen around the paper's three
    others: tuple[int, int] = (6, 10)  # pieces of the other classes; chosen: the paper's map has about a dozen in all
    most_of_a_class: int = 2  # of the other classes; chosen
    fewest_others: int = 5  # that must have found a place, else the room is drawn again; chosen


def make_look_alike_room(seed: int, draw: int = 0, limits: LookAlikeLimits = LookAlikeLimits()) -> Room:
    """The room of a seed; the look-alikes are its first objects. draw: another room of the same seed."""
    for rng in np.random.default_rng([STREAM, seed, draw]).spawn(MAX_DRAWS):
        high = rng.uniform(*limits.side, 2)
        plan = random_shell(rng, np.zeros(2), high, float(rng.uniform(*limits.height)))
        if _furnish(rng, plan, limits):
            return plan.room()
    raise ValueError(f"seed {seed}: in {MAX_DRAWS} rooms the furniture found no place; ask for fewer or larger ones")


def _furnish(rng: Generator, plan: Plan, limits: LookAlikeLimits) -> bool:
    """Places the look-alikes, then the others; says whether enough of them found a place."""
    kind = str(rng.choice(limits.kinds))
    piece = RANDOM_PIECES[kind](rng)
    for _ in range(int(rng.integers(limits.look_alikes[0], limits.look_alikes[1] + 1))):
        if not _add_piece(rng, plan, piece):
            return False
    alike = len(plan.objects)
    classes = sorted(set(RANDOM_PIECES) - {kind}) * limits.most_of_a_class
    n = int(rng.integers(limits.others[0], limits.others[1] + 1))
    for label in rng.permutation(classes)[:n]:
        _add(rng, plan, str(label))
    return len(plan.objects) - alike >= limits.fewest_others
