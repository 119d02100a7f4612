"""Recording a run: the camera is carried along a trajectory through the true world of that day."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
from numpy.random import Generator

from course_lib.depth_mcl.sequence import write_sequence
from course_lib.geometry import optical_pose
from course_lib.simulation.corridor.measurements import frame_counts
from course_lib.simulation.corridor.mesh_building import WorldMesh
from course_lib.simulation.corridor.recorded_runs import FloorSurveyModel, survey_floor_line
from course_lib.simulation.sensors.ray_casting import WorldCaster
from course_lib.simulation.sensors.time_of_flight import TimeOfFlightCamera


def record(
    folder: Path,
    world: WorldMesh,
    camera: TimeOfFlightCamera,
    run: tuple[np.ndarray, np.ndarray],
    floor_survey: FloorSurveyModel,
    rng: Generator,
    progress: Callable[[Iterable], Iterable] = iter,
    frames: int | None = None,
) -> dict[str, int]:
    """Captures a run, states `(T, 6)` and times `(T,)`, and writes it to `folder`; returns counts over its pixels.

    frames: only the first so many images and poses; the line on the floor is always the whole run's.

    What is written is what a user is told: the nominal intrinsics, and as true poses those of the body, where the user
    believes the camera to be.
    """
    states, times = run
    caster = WorldCaster.of(world)
    depths, counts = [], []
    for state in progress(states[:frames]):
        frame = camera.capture(caster, state, rng)
        depths.append(frame.depth)
        counts.append(frame_counts(frame, camera.model))
    path = survey_floor_line(states, floor_survey, rng)
    count = len(depths)
    poses = optical_pose(states[:count])
    write_sequence(folder, camera.camera.matrix, list(range(count)), depths, poses, times[:count], "z", path)
    return {key: sum(c[key] for c in counts) for key in counts[0]}
