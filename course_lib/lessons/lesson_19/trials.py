"""Measured in the lesson: how far off a start may be, and what a few places give; stored: the forty places."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from course_lib.experiments.finale import follow, is_known
from course_lib.lessons.lesson_19.stages import FILTER_SEED, Journey, is_reached, state_error
from course_lib.lessons.lesson_19.world import world
from course_lib.paths import data_path
from course_lib.simulation.room.finale_data import SEED
from course_lib.simulation.room.look_alike_recording import measurement_poses

STORED = "room/results/finale_1-10.json"


class Misplaced(NamedTuple):
    """A depth filter that was started wrong by so much."""

    metres: float
    degrees: float
    reached: bool
    status: str


def random_places(n: int) -> list[tuple[float, float, float]]:
    """The first n random places of the room as the experiment draws them: x, y [m], heading [degrees]."""
    poses = measurement_poses(world().room, 2 * n, SEED)[::2]  # there are two headings at each place
    return [(float(x), float(y), float(np.rad2deg(heading))) for x, y, heading in poses]


def misplaced(
    places: Sequence[Journey], metres: float, degrees: float, repeats: int, rng: np.random.Generator
) -> list[Misplaced]:
    """Filters started wrong, at every place so often: by so many metres in a random direction, and turned to a side."""
    runs = []
    for one in places:
        for _ in range(repeats):
            direction, side = rng.uniform(0, 2 * np.pi), rng.choice([-1.0, 1.0])
            start = one.states[0] + [metres * np.cos(direction), metres * np.sin(direction), 0, 0, 0, 0]
            start[5] += side * np.deg2rad(degrees)
            last = follow(world().renderer, start, one.depths, FILTER_SEED)[-1]
            runs.append(Misplaced(metres, degrees, is_reached(state_error(last.state, one.states[-1])), last.status))
    return runs


def stored_result(path: Path | None = None) -> dict:
    """What `demo finale --seeds 1-10` gave: forty places in ten rooms that nobody here looked at.

    Raises `FileNotFoundError`, naming the cure, where it is not there.
    """
    return json.loads((data_path(STORED) if path is None else path).read_text(encoding="utf-8"))


def turn_and_look(one: Journey) -> tuple[tuple[float, float], int, bool]:
    """The robot turns and looks again until its pose is known: metres and degrees it is off, views, whether it knows.

    The last view of a place that was not known after `VIEWS` is what it is.
    """
    estimate, state, views = world().look_around(one.starts, one.pose)
    return state_error(estimate.state, state), views, is_known(estimate)
