"""PARAMETERS.md of the corridor: every parameter of its data and of the seeds' recordings, and what they grant."""

from __future__ import annotations

from course_lib.simulation.corridor.kindnesses import kindness_table
from course_lib.simulation.corridor.seeded_recording import SeedModels
from course_lib.simulation.parameter_tables import parameter_table, parameter_tables


def corridor_parameters(models: object) -> str:
    """The text for `models`, a `CorridorModels`; what only the recordings of `demo corridor` have follows."""
    seeds = SeedModels()
    own = [parameter_table(model) for model in (seeds.day, seeds.push, seeds.calibration)]
    return "\n".join([parameter_tables(models, "corridor"), *own, kindness_table()])
