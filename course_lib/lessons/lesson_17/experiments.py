"""The poses of both experiments: those from exact boxes, and which of the stored ones fail."""

import functools
from collections.abc import Sequence

from course_lib.experiments.room import PairResult, run_experiment
from course_lib.experiments.room_evaluation import CORRECT, INCORRECT, UNABLE
from course_lib.lessons.kit.room_photographs import room_map, room_recording
from course_lib.lessons.lesson_17.room_runs import StoredRoom
from course_lib.simulation.room.measurement_places import MEASUREMENT_PLACES
from course_lib.spherical_stereo.localizer import SemanticLocalizer

EXPERIMENTS = (1, 2)
KINDS = (CORRECT, INCORRECT, UNABLE)


@functools.cache
def exact_results(experiment: int) -> tuple[PairResult, ...]:
    """All 20 poses from exact boxes; kept, since figure and panel ask again."""
    recorded = room_recording(experiment)
    localizer = SemanticLocalizer(recorded.rig, room_map(), reject_implausible=False)
    return tuple(run_experiment(recorded, localizer, "exact_boxes"))


def table_1() -> str:
    """The paper's ten places, two headings at each, two places a line."""
    cells = [
        f"{p.place:2d}: ({p.x:.2f}, {p.y:.2f}) m {p.headings_deg[0]:4.0f}, {p.headings_deg[1]:4.0f} deg"
        for p in MEASUREMENT_PLACES
    ]
    return "\n".join(f"{left}   {right}" for left, right in zip(cells[:5], cells[5:], strict=True))


def failing_places(runs: Sequence[StoredRoom], experiment: int, source: str) -> dict[str, int]:
    """Pose -> in how many seeds it was not correct, the most often first; poses that never failed are left out."""
    counts: dict[str, int] = {}
    for run in runs:
        for place, found in run.outcomes(experiment, source).items():
            counts[place] = counts.get(place, 0) + (found != CORRECT)
    return {place: n for place, n in sorted(counts.items(), key=lambda item: (-item[1], item[0])) if n}


def live_places(runs: Sequence[StoredRoom], experiment: int, most: int = 2) -> list[str]:
    """Poses to run from images: of the shipped photographs first those that failed when stored, then any others."""
    shipped = [run for run in runs if run.seed == room_recording(experiment).seed] or list(runs[:1])
    failing = failing_places(shipped, experiment, "images")
    others = [pair.name for pair in room_recording(experiment).pairs if pair.name not in failing]
    return [*failing, *others][:most]
