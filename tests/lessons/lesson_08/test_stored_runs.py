"""Stored seeds of the corridor experiment: read back as written, told apart, and summed up in the paper's table."""

import csv
import json

import numpy as np
import pytest

from course_lib.lessons.lesson_08.stored_runs import over_seeds, stored_runs, table_1


def write_seed(folder, seed, frames=4, particles=200, median=0.02):
    rows = {"median_m": median, "sigma_m": 0.04, "within_3sigma_percent": 100.0, "median_timed_m": 0.05}
    fallon = rows | {"name": "Fallon-style", "median_m": 0.2, "median_timed_m": 8.9}
    methods = {"proposed": rows | {"name": "ours"}, "fallon": fallon}
    summary = {"seed": seed, "frames": frames, "n_particles": particles, "methods": methods}
    (folder / f"seed_{seed}.json").write_text(json.dumps(summary))
    with (folder / f"seed_{seed}.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["frame", "proposed_x_m", "proposed_y_m", "proposed_score"])
        writer.writerows([k, 2.0 + 0.1 * k, 0.5 * seed, "nan" if k == 2 else 0.6] for k in range(frames))


def test_seeds_are_read_in_order_whatever_else_lies_there(tmp_path):
    for seed in (10, 2):
        write_seed(tmp_path, seed)
    (tmp_path / "seed_notes.json").write_text("{}")
    runs = stored_runs(tmp_path)
    assert [run.seed for run in runs] == [2, 10]
    np.testing.assert_allclose(runs[0].positions("proposed"), [[2.0, 1], [2.1, 1], [2.2, 1], [2.3, 1]])
    assert np.isnan(runs[0].columns["proposed_score"][2])


def test_no_seed_names_the_command_that_makes_one(tmp_path):
    with pytest.raises(FileNotFoundError, match="demo corridor --seed N"):
        stored_runs(tmp_path)


@pytest.mark.parametrize("other", [{"frames": 5}, {"particles": 100}])
def test_seeds_made_differently_are_refused(tmp_path, other):
    write_seed(tmp_path, 1)
    write_seed(tmp_path, 2, **other)
    with pytest.raises(ValueError, match="make them alike"):
        stored_runs(tmp_path)


def test_the_table_holds_the_median_over_the_seeds_beside_the_papers_rows(tmp_path):
    for seed, median in ((1, 0.01), (2, 0.03), (3, 0.42)):
        write_seed(tmp_path, seed, median=median)
    runs = stored_runs(tmp_path)
    assert over_seeds(runs, "proposed", "median_m").tolist() == [0.01, 0.03, 0.42]
    lines = {line[:36].strip(): line[36:].split() for line in table_1(runs).splitlines()}
    assert lines["paper: proposed method"] == ["0.07", "0.10", "99", "%", "-"]
    assert lines["paper: Fallon et al. [2]"] == ["0.30", "n/a", "90", "%", "-"]
    assert lines["ours"] == ["0.03", "0.04", "100", "%", "0.05"]
    assert lines["Fallon-style"] == ["0.20", "0.04", "100", "%", "8.90"]
