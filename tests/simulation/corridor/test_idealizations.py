"""What the simulation grants is named, with the effect that was measured."""

import json

import pytest

from course_lib.simulation.corridor.idealizations import MEASURED
from course_lib.simulation.corridor.seeded_recording import HARDSHIPS


def test_the_effects_are_those_of_the_stored_measurement(corridor_folder):
    stored = json.loads((corridor_folder / "results" / "kindnesses.json").read_text())
    assert min(stored["seeds"]) >= 10_000
    assert list(stored["hardships"]) == list(MEASURED) == ["none", *HARDSHIPS, "all"]
    for name, row in stored["hardships"].items():
        medians = (row["median_m"]["median"], row["median_timed_m"]["median"])
        assert pytest.approx(medians, abs=5e-5) == MEASURED[name]
