"""Table 1 of paper 1, section 4: its methods as plain functions of a recording and a seed, and the paper's errors."""

from __future__ import annotations

from typing import NamedTuple

from course_lib.depth_mcl.evaluation import PositionError, nearest_path_error, timed_error
from course_lib.depth_mcl.fallon import fallon_weighting
from course_lib.depth_mcl.likelihood import Weighting
from course_lib.depth_mcl.sequence import DepthSequence
from course_lib.experiments.recordings import Run, run_sequence
from course_lib.rendering.scene_map import SceneMap


class Method(NamedTuple):
    """One row of table 1: which map, how many pixels, which weighting (None: the paper's)."""

    name: str
    planar: bool
    coarse: bool
    weighting: Weighting | None


METHODS = {
    "proposed": Method("proposed method, ours", False, False, None),
    "fallon": Method("Fallon-style, depth, 20 x 15", True, True, fallon_weighting("depth")),
    "fallon_full": Method("Fallon-style, depth, full size", True, False, fallon_weighting("depth")),
    "fallon_disparity": Method("Fallon-style, disparity, 20 x 15", True, True, fallon_weighting("disparity")),
    "fallon_disparity_full": Method("Fallon-style, disparity, full size", True, False, fallon_weighting("disparity")),
}


def run_method(
    method: Method, scene_map: SceneMap, planar_map: SceneMap, sequence: DepthSequence, **options: object
) -> Run:
    """One row of table 1: the recording localized in x, y and yaw by a method."""
    used_map = planar_map if method.planar else scene_map
    return run_sequence(used_map, sequence, weighting=method.weighting, coarse=method.coarse, **options)


def path_errors(run: Run, sequence: DepthSequence) -> tuple[PositionError, PositionError]:
    """The paper's nearest-path error and the timed error of a run; the recording must hold its path on the floor."""
    if sequence.path_on_floor is None:
        raise ValueError(f"{sequence.folder} holds no path_on_floor.txt, which the paper's error needs")
    estimated, true = run.camera_to_world[:, :3, 3], sequence.camera_to_world[: len(run.frames), :3, 3]
    return nearest_path_error(estimated, sequence.path_on_floor), timed_error(estimated, true)
