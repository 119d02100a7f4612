"""Results are written whole or not at all, with the versions inside."""

import csv
import json

import pytest

from course_lib.experiments.results import versions, write_results


def test_results_hold_their_versions_and_rows(tmp_path):
    write_results(tmp_path / "new" / "run.json", {"seed": 3, "error_m": 0.25}, [{"frame": 1, "error_m": 0.5}])
    stored = json.loads((tmp_path / "new" / "run.json").read_text())
    assert (stored["seed"], stored["error_m"]) == (3, 0.25)
    assert stored["versions"] == versions()
    assert list(csv.DictReader((tmp_path / "new" / "run.csv").open())) == [{"frame": "1", "error_m": "0.5"}]


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_a_number_that_json_has_not_is_refused_and_nothing_is_left_behind(tmp_path, value):
    with pytest.raises(ValueError, match="JSON"):
        write_results(tmp_path / "run.json", {"error_m": value}, [{"frame": 1}])
    assert not list(tmp_path.iterdir())
