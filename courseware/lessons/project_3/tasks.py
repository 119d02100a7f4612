"""The tasks of project P3: views of a room, each with some of its observations."""

import numpy as np

from courseware.lessons.kit.projects import Task
from courseware.lessons.project_2.rooms import ProjectRoom, room_of

SEEN = 0.5  # share of the observations that a task keeps, each drawn by itself: people stand before the others
DRAWS = 3  # tasks of each view
THINNING_STREAM = 0x7313  # joins a room's seed


def prepare(seed: int) -> Task:
    """Return the task of the practice room of this seed."""
    return task_of(room_of(seed))


def task_of(room: ProjectRoom) -> Task:
    """Return the arguments of `match` for every view of a room, each thinned three times. The truth: poses `(n, 3)`."""
    rng = np.random.default_rng([THINNING_STREAM, room.seed])
    views = [view for view in room.views for _ in range(DRAWS)]
    thinned = [tuple(one for one in view.observations if rng.random() < SEEN) for view in views]
    return Task(tuple((one, room.semantic_map) for one in thinned), np.array([view.pose for view in views]))
