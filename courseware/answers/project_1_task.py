"""Project P1: the arguments of a submission, its measure, and its rivals."""

from collections.abc import Callable

import numpy as np

from course_lib.geometry import wrap_angle
from courseware.answers.project_1_rivals import paper_filter, refined_filter
from courseware.lessons.kit.attempt import attempt
from courseware.lessons.kit.projects import AnswerError, Project, Result, Rival, Task
from courseware.lessons.kit.values import as_numbers
from courseware.lessons.project_1 import recordings as given

FIRST_FRAMES = 10  # number of frames of the run without the later ones


def prepare(seed: int) -> Task:
    """Return renderer, camera, frames, start, number of particles and generator; the truth is the recording's."""
    run = given.recording(seed)
    renderer, rng = given.CountedRenderer(given.RENDERS_A_FRAME * given.FRAMES), np.random.default_rng([seed, 3])
    arguments = (renderer, given.CAMERA, run.frames.copy(), run.start.copy(), given.PARTICLES, rng)
    return Task(arguments, (run.states, renderer))


def measure(task: Task, answer: object) -> Result:
    """Return the median over the frames of the horizontal distance [mm] of an estimate from the frame's truth."""
    states, renderer = task.truth
    found = as_numbers(answer)
    if found is None:
        raise AnswerError("returns no array of numbers; return the estimates, one row of six a frame")
    if found.shape != states.shape:
        raise AnswerError(f"returns shape {found.shape}; return one estimate of six numbers a frame, {states.shape}")
    if not np.isfinite(found).all():
        raise AnswerError(f"returns NaN or infinity in frame {int(np.flatnonzero(~np.isfinite(found).all(axis=1))[0])}")
    errors = np.linalg.norm(found[:, :2] - states[:, :2], axis=1)
    heading = np.median(np.rad2deg(np.abs(wrap_angle(found[:, 5] - states[:, 5]))))
    told = f"heading {heading:.2f} deg; {renderer.renders / len(states):.0f} renders a frame"
    return Result(1000 * float(np.median(errors)), f"worst frame {1000 * errors.max():.1f} mm; {told}")


def no_later_frames(task: Task, function: Callable, answer: object) -> None:
    """Run the function without the later frames. Raises `AnswerError` if its estimates of the first ones change."""
    renderer, camera, frames, *others = task.arguments
    again = attempt(function, (renderer, camera, frames[:FIRST_FRAMES], *others)).value
    kept = np.asarray(answer, dtype=np.float64)[:FIRST_FRAMES]
    if np.shape(again) != kept.shape or not np.allclose(again, kept, rtol=0, atol=1e-6):
        raise AnswerError(
            f"gives other estimates for the first {FIRST_FRAMES} frames when it is not given the later ones: an "
            "estimate may use the frames up to its own only, and random numbers of `rng` only"
        )


PROJECT = Project(
    name="P1",
    title=f"median horizontal error of the estimates with at most {given.RENDERS_A_FRAME} renders a frame",
    unit="mm",
    better="lower",
    digits=1,
    function="localize",
    seeds=tuple(range(5101, 5109)),
    prepare=prepare,
    measure=measure,
    rivals=(Rival("paper", "the paper's method", paper_filter), Rival("ours", "ours", refined_filter)),
    forbidden=("course_lib.depth_mcl", "course_lib.beyond", "courseware.lessons"),
    rule=no_later_frames,
)
