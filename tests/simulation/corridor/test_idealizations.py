"""What the simulation grants is named, with the effect that was measured."""

import json

import pytest
from course_lib.simulation.corridor.kindnesses import KINDNESSES, MEASURED, kindness_table

from course_lib.simulation.corridor.seeded_recording import HARDSHIPS


def test_every_hardship_takes_one_kindness_away():
    assert sorted(k.hardship for k in KINDNESSES if k.hardship) == sorted(HARDSHIPS)
    assert set(MEASURED) == {"none", *HARDSHIPS, "all"}


def test_effects_are_told_or_called_not_measured():
    rows = [line.split(" | ")[-1] for line in kindness_table().splitlines() if line.startswith("| ")][1:]
    assert len(rows) == len(KINDNESSES)
    for kindness, effect in zip(KINDNESSES, rows, strict=True):
        assert effect.endswith("mm |") == (kindness.hardship is not None)
        assert effect.startswith("not measured") == (kindness.hardship is None)


def test_the_effects_are_those_of_the_stored_measurement(corridor_folder):
    stored = json.loads((corridor_folder / "results" / "kindnesses.json").read_text())
    assert min(stored["seeds"]) >= 10_000
    assert list(stored["hardships"]) == list(MEASURED)
    for name, row in stored["hardships"].items():
        medians = (row["median_m"]["median"], row["median_timed_m"]["median"])
        assert pytest.approx(medians, abs=5e-5) == MEASURED[name]
