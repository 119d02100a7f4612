"""Rooms for reporting: furnished from a seed, with three to five look-alike sofas or chairs in each.

The limits below were committed before any room of this generator was drawn; nobody shaped a room. Pieces, shell and
light are those of `make_room`, but no seed gives one room in both generators: the detector has seen none of these.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from course_lib.simulation.furniture import RANDOM_PIECES
from course_lib.simulation.room.furnishing import add_piece, add_television
from course_lib.simulation.room.scene import Room
from course_lib.simulation.room.shell import Plan, random_shell

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


class NoRoomDrawn(ValueError):
    """No room within the limits came of a seed."""


def make_look_alike_room(seed: int, draw: int = 0, limits: LookAlikeLimits = LookAlikeLimits()) -> Room:
    """The room of a seed, its south-west corner at the origin; the look-alikes are its first objects.

    draw: another room of the same seed. A room whose pieces find no place is drawn again; `NoRoomDrawn` at last.
    """
    for rng in np.random.default_rng([STREAM, seed, draw]).spawn(MAX_DRAWS):
        high = rng.uniform(*limits.side, 2)
        plan = random_shell(rng, np.zeros(2), high, float(rng.uniform(*limits.height)))
        if _furnish(rng, plan, limits):
            return plan.room()
    raise NoRoomDrawn(f"seed {seed}: in {MAX_DRAWS} rooms the furniture found no place; ask for fewer or larger ones")


def _furnish(rng: Generator, plan: Plan, limits: LookAlikeLimits) -> bool:
    """Places the look-alikes, then the others; says whether enough of them found a place."""
    kind = str(rng.choice(limits.kinds))
    piece = RANDOM_PIECES[kind](rng)
    for _ in range(int(rng.integers(limits.look_alikes[0], limits.look_alikes[1] + 1))):
        if not add_piece(rng, plan, piece):
            return False
    alike = len(plan.objects)
    classes = sorted(set(RANDOM_PIECES) - {kind}) * limits.most_of_a_class
    n = int(rng.integers(limits.others[0], limits.others[1] + 1))
    for label in rng.permutation(classes)[:n]:
        if label == "television":
            add_television(rng, plan)
        else:
            add_piece(rng, plan, RANDOM_PIECES[str(label)](rng))
    return len(plan.objects) - alike >= limits.fewest_others
