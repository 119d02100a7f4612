"""Project P4: what a submission is given, how it is measured, and what stands beside it."""

import numpy as np

from courseware.answers.project_4_rivals import as_told, calibrated, pinhole_alone
from courseware.lessons.kit.projects import AnswerError, Project, Result, Rival, Task
from courseware.lessons.project_4.sessions import MAX_RANGE, session

WORST, REFUSED = 0.200, 0.050  # m: what a pixel costs at most, and one that is refused


def prepare(seed: int) -> Task:
    """Return the session's arrays. The truth is the room's depth, and where the camera measured at all."""
    given, secrets = session(seed)
    measured = (given.frames != secrets.invalid).any(axis=1)
    return Task(tuple(array.copy() for array in given), (secrets.depth, measured))


def measure(task: Task, answer: object) -> Result:
    """Return the depth's mean error over the pixels that were measured: at most 200 mm, 50 mm where it is refused."""
    true, measured = task.truth
    try:
        found = np.asarray(answer, dtype=np.float64)
    except (TypeError, ValueError):
        raise AnswerError("returns no array of numbers; return depths in metres") from None
    if found.shape != true.shape:
        raise AnswerError(f"returns shape {found.shape}; return one depth a pixel for each place, {true.shape}")
    if np.isinf(found).any():
        raise AnswerError("returns infinity; refuse a pixel with NaN")
    near, refused, errors = true < MAX_RANGE, np.isnan(found), np.abs(found - true)
    cost = np.where(refused, REFUSED, np.fmin(errors, WORST))
    # A depth where nothing was measured is invented.
    cost = np.where(measured, cost, WORST)[near & (measured | ~refused)]
    errors = errors[near & measured & ~refused]
    median = f"median error {1000 * np.median(errors):.1f} mm" if len(errors) else "no depth at all"
    return Result(1000 * float(cost.mean()), f"{median}; {100 * refused[near & measured].mean():.1f} % refused")


PROJECT = Project(
    name="P4",
    title="mean error of the depth, at most 200 mm a pixel, 50 mm for one that is refused",
    unit="mm",
    better="lower",
    digits=1,
    function="calibrated_depth",
    seeds=(5401, 5402, 5403, 5404, 5405, 5406, 5407, 5408),
    prepare=prepare,
    measure=measure,
    rivals=(
        Rival("none", "no correction", as_told),
        Rival("paper", "the paper's assumption", pinhole_alone),
        Rival("ours", "ours", calibrated),
    ),
)
