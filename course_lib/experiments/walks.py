"""A camera carried by hand through generated rooms, in six degrees of freedom: each seed has a room and a walk."""

from __future__ import annotations

from collections.abc import Sequence

from course_lib.depth_mcl.sequence import read_sequence
from course_lib.experiments.six_degrees import run_frames
from course_lib.files import temporary_folder
from course_lib.rendering.scene_map import SceneMap
from course_lib.simulation.room.depth_world import record_walk


def room_walk(seed: int, methods: Sequence[str], everies: Sequence[int]) -> list[dict]:
    """A point of a sweep: a seed's recording by each method, thinned from every offset, as `run_frames` tells it.

    Each: {"method", "every", "run"}. The floor is taken once, of every frame.
    """
    with temporary_folder() as temporary:
        folder = temporary / "walk"
        record_walk(folder, seed)
        recording, scene_map = read_sequence(folder), SceneMap.load(folder / "map.ply")
        return [
            {"method": method, "every": every, "run": run_frames(method, scene_map, thinned, seed)}
            for method in methods
            for every in ([1] if method == "floor" else everies)
            for thinned in (recording.thinned(every, offset) for offset in range(every))
        ]
