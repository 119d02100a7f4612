"""Project P1: what a submission is given, how it is measured, and what stands beside it."""

from collections.abc import Callable

import numpy as np

from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.attempt import attempt
from course_lib.lessons.kit.projects import AnswerError, Project, Result, Rival, Task
from course_lib.lessons.project_1.recordings import (
    CAMERA,
    FRAMES,
    PARTICLES,
    RENDERS_A_FRAME,
    CountedRenderer,
    recording,
)
from course_lib.lessons.project_1.rivals import paper_filter, refined_filter

FIRST_FRAMES = 10
"""Frames of the run without later ones."""


def prepare(seed: int) -> Task:
    """Renderer, camera, frames, start, number of particles and generator; the truth is the recording's."""
    run = recording(seed)
    renderer = CountedRenderer(RENDERS_A_FRAME * FRAMES)
    rng = np.random.default_rng([seed, 3])
    arguments = (renderer, CAMERA, run.frames.copy(), run.start.copy(), PARTICLES, rng)
    return Task(arguments, (run.states, renderer))


def measure(task: Task, answer: object) -> Result:
    """Median over the frames of the horizontal distance between estimate and truth of the same frame, millimetres."""
    states, renderer = task.truth
    try:
        found = np.asarray(answer, dtype=np.float64)
    except (TypeError, ValueError):
        raise AnswerError("returns no array of numbers; return the estimates, one row of six a frame") from None
    if found.shape != states.shape:
        raise AnswerError(f"returns shape {found.shape}; return one estimate of six numbers a frame, {states.shape}")
    if not np.isfinite(found).all():
        raise AnswerError(f"returns NaN or infinity in frame {int(np.flatnonzero(~np.isfinite(found).all(axis=1))[0])}")
    errors = np.linalg.norm(found[:, :2] - states[:, :2], axis=1)
    heading = np.rad2deg(np.abs(wrap_angle(found[:, 5] - states[:, 5])))
    remark = f"worst frame {1000 * errors.max():.1f} mm; heading {np.median(heading):.2f} deg; "
    return Result(1000 * float(np.median(errors)), remark + f"{renderer.renders / len(states):.0f} renders a frame")


def no_later_frames(seed: int, function: Callable, answer: object) -> None:
    """Run the function without the later frames. Raises `AnswerError` if its estimates of the first ones change."""
    arguments, _ = prepare(seed)
    frames = arguments[2][:FIRST_FRAMES]
    again = attempt(function, (*arguments[:2], frames, *arguments[3:])).value
    kept = np.asarray(answer, dtype=np.float64)[:FIRST_FRAMES]
    if np.shape(again) != kept.shape or not np.allclose(again, kept, rtol=0, atol=1e-6):
        raise AnswerError(
            f"gives other estimates for the first {FIRST_FRAMES} frames when it is not given the later ones: an "
            "estimate may use the frames up to its own only, and random numbers of `rng` only"
        )


PROJECT = Project(
    name="P1",
    title=f"median horizontal error of the estimates with at most {RENDERS_A_FRAME} renders a frame",
    unit="mm",
    better="lower",
    digits=1,
    function="localize",
    seeds=(5101, 5102, 5103, 5104, 5105, 5106, 5107, 5108),
    prepare=prepare,
    measure=measure,
    rivals=(
        Rival("paper", "the paper's method", paper_filter),
        Rival("ours", "ours", refined_filter),
    ),
    forbidden=("course_lib.depth_mcl", "course_lib.beyond", "course_lib.lessons"),
    rule=no_later_frames,
)
