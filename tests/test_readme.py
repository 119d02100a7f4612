"""The README quotes what the commands print: its table, its numbers over seeds, its code."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from course_lib.commands.demo_corridor import table_1

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text()
RESULTS = ROOT / "data" / "corridor" / "results"


def results():
    return [json.loads((RESULTS / f"seed_{seed}.json").read_text()) for seed in range(1, 6)]


def test_the_table_is_the_one_that_seed_1_prints():
    printed = [line.rstrip() for line in table_1(results()[0]).splitlines()]
    # Without the line of the times, which differ from machine to machine.
    printed = [line for line in printed if "ms a frame" not in line]
    quoted = [line[4:].rstrip() for line in README.splitlines() if line.startswith("    ") or not line.strip()]
    start = quoted.index(printed[0])
    assert quoted[start : start + len(printed)] == printed


@pytest.mark.parametrize(
    ("name", "key", "digits"),
    [
        ("nearest-path median", "median_m", 3),
        ("sigma", "sigma_m", 3),
        ("within 0.30 m", "within_3sigma_percent", 1),
        ("timed median", "median_timed_m", 3),
        ("Fallon-style (depth, 20 x 15) nearest-path median", "fallon_median_m", 3),
    ],
)
def test_the_rows_over_seeds_are_the_medians_and_ranges_of_the_stored_results(name, key, digits):
    values = [r[key] for r in results()]
    row = next(line for line in README.splitlines() if line.startswith(f"| {name} "))
    middle, low, high = (float(v) for v in re.findall(r"\d+\.\d+", row.split("|")[2])[:3])
    expected = np.round([np.median(values), min(values), max(values)], digits)
    assert np.array_equal([middle, low, high], expected)


def test_the_code_of_the_readme_runs(monkeypatch, capsys):
    monkeypatch.chdir(ROOT)
    code = re.search(r"```python\n(.*?)```", README, re.S).group(1)
    exec(compile(code.replace("n_particles=200", "n_particles=20"), "README.md", "exec"), {})
    assert capsys.readouterr().out.startswith("[")


def test_every_local_link_leads_somewhere():
    for target in re.findall(r"\]\(([^)#]+)\)", README):
        if not target.startswith("http"):
            assert (ROOT / target).exists(), target
