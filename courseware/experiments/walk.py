"""Carry a depth camera by hand through generated rooms: errors in six degrees of freedom, and being lost.

Every `--every`-th frame, from every offset, is as if the camera had been moved so much faster.
"""

from collections.abc import Sequence

from course_lib.depth_mcl.sequence import read_sequence
from course_lib.files import temporary_folder
from course_lib.rendering.scene_map import SceneMap
from courseware.experiments.runner import Outcome, Runner
from courseware.experiments.six_degrees import NAMES, pooled, require_methods, run_frames, six_degrees_table, thinnings
from courseware.simulation.room.depth_world import record_walk


def room_walk(seed: int, methods: Sequence[str], everies: Sequence[int]) -> list[dict]:
    """Run each method on a seed's recording, thinned from every offset: {"method", "every", "run"} each."""
    with temporary_folder() as temporary:
        folder = temporary / "walk"
        record_walk(folder, seed)
        recording, scene_map = read_sequence(folder), SceneMap.load(folder / "map.ply")
        return [
            {"method": name, "every": every, "run": run_frames(name, scene_map, recording.thinned(every, offset), seed)}
            for name, every, offset in thinnings(methods, everies)
        ]


def run(runner: Runner, *, seed: int, seeds: list[int] | None, every: list[int], methods: str) -> Outcome:
    """Run `demo walk`: the rooms that are missing, then the frames of all rooms together."""
    seeds, names = seeds or [seed], require_methods(methods)
    points = [{"seed": one, "methods": names, "everies": every} for one in seeds]
    runs: dict[str, list[dict]] = {}
    for walk in runner.rows(room_walk, points, "walk", "room"):
        for one in walk:
            thinned = "" if one["method"] == "floor" else f", every {one['every']}"
            runs.setdefault(NAMES.get(one["method"], one["method"]) + thinned, []).append(one["run"])
    rows = {name: pooled(own) for name, own in runs.items()}
    result = {"seeds": seeds, "rows": rows}
    return Outcome(result, six_degrees_table(rows), {"walk.json": (result, None)}, "covariance", runs)
