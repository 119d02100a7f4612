"""README.md and RESULTS.md quote what the commands print: tables, numbers over seeds; the README's code runs."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from course_lib import cli
from course_lib.cli import find_command
from course_lib.experiments.corridor import table_1
from course_lib.experiments.finale import finale_text
from course_lib.experiments.intervals import wilson_percent
from course_lib.experiments.lost import lost_table, summarize
from course_lib.experiments.six_degrees import six_degrees_table
from course_lib.experiments.trouble import trouble_table
from tools import sweep
from tools.bench_tables import bench_table

ROOT = Path(__file__).parents[1]
README, RESULTS = ((ROOT / name).read_text(encoding="utf-8") for name in ("README.md", "RESULTS.md"))
CORRIDOR_RESULTS = ROOT / "data" / "corridor" / "results"
ROOM_RESULTS = ROOT / "data" / "room" / "results"
SNIPPETS = re.findall(r"```python\n(.*?)```", README, re.S)


def results():
    return [json.loads((CORRIDOR_RESULTS / f"seed_{seed}.json").read_text()) for seed in range(1, 6)]


def test_the_table_is_the_one_that_seed_1_prints():
    printed = [line.rstrip() for line in table_1(results()[0]).splitlines()]
    # Without the line of the times, which differ from machine to machine.
    printed = [line for line in printed if "ms a frame" not in line]
    quoted = [line[4:].rstrip() for line in RESULTS.splitlines() if line.startswith("    ") or not line.strip()]
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
    row = next(line for line in RESULTS.splitlines() if line.startswith(f"| {name} "))
    middle, low, high = (float(v) for v in re.findall(r"\d+\.\d+", row.split("|")[2])[:3])
    expected = np.round([np.median(values), min(values), max(values)], digits)
    assert np.array_equal([middle, low, high], expected)


@pytest.mark.parametrize(
    ("name", "method", "key", "digits"),
    [
        ("nearest-path median", "proposed", "median_m", 3),
        ("sigma", "proposed", "sigma_m", 3),
        ("within 0.30 m", "proposed", "within_3sigma_percent", 1),
        ("timed median", "proposed", "median_timed_m", 3),
        ("Fallon-style (depth, 20 x 15) nearest-path median", "fallon", "median_m", 3),
        ("Fallon-style timed median", "fallon", "median_timed_m", 2),
    ],
)
def test_the_rows_over_recordings_are_the_medians_and_ranges_of_five(name, method, key, digits):
    stored = json.loads((CORRIDOR_RESULTS / "recordings_1-5.json").read_text())
    assert stored["seeds"] == [1, 2, 3, 4, 5]
    row = next(line for line in RESULTS.splitlines() if line.startswith(f"| recordings: {name} |"))
    for part, cell in zip(("methods", "methods_by_hand"), row.split("|")[2:4], strict=True):
        values = [one[part][method][key] for one in stored["recordings"]]
        expected = np.round([np.median(values), min(values), max(values)], digits)
        assert np.array_equal([float(v) for v in re.findall(r"\d+\.\d+", cell)[:3]], expected)


def test_the_table_with_intervals_is_what_the_sweep_prints_of_its_stored_rows(tmp_path, capsys):
    """The command itself, which finds every row finished."""
    stored = (CORRIDOR_RESULTS / "sweep_corridor.jsonl").read_text()
    (tmp_path / "corridor.jsonl").write_text(stored)
    count = len(stored.splitlines()) - 1
    assert count >= 20
    words = ["corridor", "--seeds", str(count), "--out", str(tmp_path)]
    assert cli.call(lambda: sweep, "python -m tools.sweep", words) == 0
    table = capsys.readouterr().out.rstrip()
    assert "\n".join(f"    {line}".rstrip() for line in table.splitlines()) in RESULTS
    assert f"With `--seeds {count}` it prints this" in RESULTS
    assert (tmp_path / "corridor.jsonl").read_text() == stored, "nothing was run"


SIX_DEGREES = [
    *(CORRIDOR_RESULTS / f"kitchen_{name}.json" for name in ("six_degrees", "icp", "ablation")),
    CORRIDOR_RESULTS / "hand_1-5.json",
    ROOM_RESULTS / "walk_10061-10066.json",
    ROOM_RESULTS / "walk_1-10.json",
]


@pytest.mark.parametrize("path", SIX_DEGREES, ids=lambda path: path.stem)
def test_the_tables_in_six_degrees_are_what_the_commands_print_of_their_stored_numbers(path):
    stored = json.loads(path.read_text())
    printed = six_degrees_table(stored["rows"])
    assert "\n".join(f"    {line}".rstrip() for line in printed.splitlines()) in RESULTS


@pytest.mark.parametrize("name", ["lost_kitchen.json", "lost_corridor.json"])
def test_lost_and_found_is_what_the_command_prints_of_its_stored_trials(name):
    stored = json.loads((CORRIDOR_RESULTS / name).read_text())
    again = {"seeds": stored["seeds"], **summarize(stored["trials_in_full"])}
    assert again == {key: stored[key] for key in again}
    assert "\n".join(f"    {line}".rstrip() for line in lost_table(again).splitlines()) in RESULTS


def test_the_finale_is_what_the_command_prints_of_its_stored_numbers():
    stored = json.loads((ROOM_RESULTS / "finale_1-10.json").read_text())
    assert "\n".join(f"    {line}" for line in finale_text(stored).splitlines()) in RESULTS
    low, high = wilson_percent(stored["reached"], stored["places"])
    assert f"of {stored['places']} places {stored['reached']} mean {low:.0f} to {high:.0f} % (Wilson)" in RESULTS


TROUBLE = [
    CORRIDOR_RESULTS / "trouble_wagon.json",
    CORRIDOR_RESULTS / "trouble_hand.json",
    ROOM_RESULTS / "trouble.json",
]


@pytest.mark.parametrize("path", TROUBLE, ids=lambda path: path.stem)
def test_sensor_trouble_is_what_the_command_prints_of_its_stored_numbers(path):
    section = RESULTS.partition("### 4.1 Sensor trouble")[2].partition("\n### ")[0].partition("\n## ")[0]
    stored = json.loads(path.read_text())
    printed = trouble_table(stored)
    assert "\n".join(f"    {line}".rstrip() for line in printed.splitlines()) in section
    wrong = sum(row["confident_wrong"] for row in [stored["undisturbed"], *stored["rows"]])
    assert f"{stored['method']}: {wrong} confident and wrong" in " ".join(section.replace("`", "").split())


def test_the_speed_is_what_the_benchmark_printed():
    stored = json.loads((CORRIDOR_RESULTS / "bench.json").read_text())
    quoted = [line.removeprefix("    ").rstrip() for line in RESULTS.splitlines()]
    assert [line for line in bench_table(stored).splitlines() if line not in quoted] == []
    told = re.search(r"(\d+) ms on two cores .* (\d+) times as fast as Embree", README.replace("\n", " "))
    assert (float(told[1]), float(told[2])) == (round(stored["step_ms"]), round(stored["embree_ratio"]))


def test_the_readme_is_a_front_page():
    assert len(README.splitlines()) <= 130


def test_every_number_of_the_readmes_tables_stands_in_the_results():
    rows = [line for line in README.splitlines() if re.match(r"\| .*\d", line) and "](" not in line]
    assert len(rows) >= 6
    assert [row for row in rows if row not in RESULTS.splitlines()] == []


def test_every_command_that_is_named_exists():
    calls = re.findall(r"python3 course\.py ([a-z][^`#\n]*)", README + RESULTS)
    assert len(calls) >= 10
    assert [call for call in calls if find_command(call.split()) is None] == []


def test_the_first_snippet_of_the_readme_follows_the_wagon(monkeypatch):
    monkeypatch.chdir(ROOT)
    names = {}
    exec(compile(SNIPPETS[0].replace("n_particles=200", "n_particles=20"), "README.md", "exec"), names)
    true = names["run"].camera_to_world[0][:3, 3]
    assert np.linalg.norm(names["estimate"].state[:3] - true) < 0.5


def test_the_second_snippet_of_the_readme_finds_the_rig(monkeypatch):
    monkeypatch.chdir(ROOT)
    names = {}
    exec(compile(SNIPPETS[1], "README.md", "exec"), names)
    found, true = names["found"], names["room"].pairs[0].pose
    assert found.status == "ok"
    assert np.hypot(found.pose.x - true[0], found.pose.y - true[1]) < 0.5


def test_there_are_no_more_snippets():
    assert len(SNIPPETS) == 2


@pytest.mark.parametrize("text", [README, RESULTS], ids=["README", "RESULTS"])
def test_every_local_link_leads_somewhere(text):
    for target in re.findall(r"\]\(([^)#]+)\)", text):
        if not target.startswith("http"):
            assert (ROOT / target).exists(), target


@pytest.mark.parametrize(
    ("name", "method", "keys", "digits"),
    [
        ("correct [%]", "greedy", ("correct_percent",), 0),
        ("incorrect [%]", "greedy", ("incorrect_percent",), 0),
        ("unable [%]", "greedy", ("unable_percent",), 0),
        ("mean error in x when correct [m]", "greedy", ("correct", "mean_dx_m"), 2),
        ("mean error in y when correct [m]", "greedy", ("correct", "mean_dy_m"), 2),
        ("mean error in heading when correct [degrees]", "greedy", ("correct", "mean_dtheta_deg"), 1),
        ("correct from exact boxes [%]", "greedy_exact_boxes", ("correct_percent",), 0),
    ],
)
def test_the_rows_of_the_room_are_the_medians_and_ranges_of_its_stored_results(name, method, keys, digits):
    row = next(line for line in RESULTS.splitlines() if line.startswith(f"| {name} |"))
    for experiment, cell in zip(("experiment_1", "experiment_2"), row.split("|")[2:4], strict=True):
        values = []
        for path in sorted(ROOM_RESULTS.glob("seed_*.json")):
            value = json.loads(path.read_text())[experiment][method]
            for key in keys:
                value = value[key]
            values.append(value)
        assert len(values) == 5
        quoted = [float(number) for number in re.findall(r"\d+(?:\.\d+)?", cell)]
        expected = [float(f"{number:.{digits}f}") for number in (np.median(values), min(values), max(values))]
        assert quoted == expected


def test_the_results_quote_detector_stereo_and_distances_as_stored():
    scores = json.loads((ROOT / "data" / "detector" / "scores.json").read_text())
    stored = json.loads((ROOM_RESULTS / "seed_4.json").read_text())
    errors, matching = stored["median_relative_range_error_percent"], stored["stereo_matching"]
    turns, greatest = stored["rolled_images"], ("greatest_moved_m", "greatest_turned_deg")
    for row, values in (
        ("| detector on the experiment's room", [scores["experiment_room"][k] for k in ("precision", "recall")]),
        ("| detector on 20 rooms", [scores["unseen_rooms"][k] for k in ("precision", "recall")]),
        ("| images rolled by", [turns["alike"][key] for key in greatest]),
        ("| the same, pairs weighted", [turns["by_covariance"][key] for key in greatest]),
        ("| stereo matching", [matching["right_percent"], matching["unmatched_percent"]]),
        (
            "| median relative error of distances",
            [errors[k] for k in ("exact_boxes", "detected_box_centres", "akaze_disparities")],
        ),
    ):
        line = next(line for line in RESULTS.splitlines() if line.startswith(row))
        quoted = [number.strip() for number in line.split("|")[2].split(",")]
        digits = len(quoted[0].split(".")[1])
        assert quoted == [f"{value:.{digits}f}" for value in values]


@pytest.mark.parametrize(
    ("name", "source", "method"),
    [
        ("from images, the paper's method", "images", "paper"),
        ("from images, implausible poses rejected", "images", "library"),
        ("from exact boxes, the paper's method", "exact_boxes", "paper"),
        ("from exact boxes, implausible poses rejected", "exact_boxes", "library"),
        ("from images, eq. (1) as printed", "images", "as_printed"),
        ("from exact boxes, eq. (1) as printed", "exact_boxes", "as_printed"),
    ],
)
def test_the_rows_of_the_rooms_are_the_stored_shares_and_intervals(name, source, method):
    stored = json.loads((ROOM_RESULTS / "rooms_1-20.json").read_text())["both"][source][method]
    row = next(line for line in RESULTS.splitlines() if line.startswith(f"| {name} |"))
    shares = (
        f"{stored[f'{kind}_percent']:.1f} ({stored[f'{kind}_rooms_percent'][0]:.0f} to "
        f"{stored[f'{kind}_rooms_percent'][1]:.0f})"
        for kind in ("correct", "incorrect", "unable")
    )
    assert [cell.strip() for cell in row.split("|")[2:5]] == list(shares)


@pytest.mark.parametrize(
    ("group", "words", "method"),
    [
        ("one_view", "one view", "greedy"),
        ("one_view", "one view", "hungarian"),
        ("one_view", "one view", "consistent"),
        ("several_views", "three views", "odometry"),
        ("several_views", "three views", "no_odometry"),
    ],
)
def test_the_rows_of_the_look_alikes_are_the_stored_shares_and_errors(group, words, method):
    stored = json.loads((ROOM_RESULTS / "rooms_1-20.json").read_text())["answers"][group][method]
    name = f"| {words}, {method.replace('_', ' ')} |"
    row = next(line for line in RESULTS.splitlines() if line.startswith(name))
    cells = [
        "{:.1f} ({:.1f} to {:.1f})".format(stored[f"{kind}_percent"], *stored[f"{kind}_wilson_percent"])
        for kind in ("correct", "wrong", "unanswered")
    ]
    right = stored["all_matches_right_percent"]
    cells.append("-" if right is None else f"{right:.1f}")
    cells.append("{mean_dx_m:.2f}, {mean_dy_m:.2f}, {mean_dtheta_deg:.1f}".format(**stored))
    assert [cell.strip() for cell in row.split("|")[2:7]] == cells


@pytest.mark.parametrize(
    ("name", "method"),
    [
        ("half seen, one view", "1_views_odometry"),
        ("half seen, two views, odometry", "2_views_odometry"),
        ("half seen, two views, no odometry", "2_views_no_odometry"),
        ("half seen, three views, odometry", "3_views_odometry"),
        ("half seen, three views, no odometry", "3_views_no_odometry"),
    ],
)
def test_the_rows_of_the_thinned_views_are_the_stored_shares_and_errors(name, method):
    stored = json.loads((ROOM_RESULTS / "rooms_1-20.json").read_text())["answers"]["thinned_views"][method]
    row = next(line for line in RESULTS.splitlines() if line.startswith(f"| {name} |"))
    cells = [
        "{:.1f} ({:.1f} to {:.1f})".format(stored[f"{kind}_percent"], *stored[f"{kind}_wilson_percent"])
        for kind in ("correct", "wrong", "unanswered")
    ]
    cells.append("{mean_dx_m:.2f}, {mean_dy_m:.2f}, {mean_dtheta_deg:.1f}".format(**stored))
    assert [cell.strip() for cell in row.split("|")[2:6]] == cells


def test_the_rows_of_the_ablation_are_the_stored_shares():
    stored = json.loads((ROOM_RESULTS / "rooms_1-20.json").read_text())["answers"]["ablation"]
    for name, shown in stored["right_map"].items():
        row = next(line for line in RESULTS.splitlines() if line.startswith(f"| {name.replace('_', ' ')} |"))
        shares = [shown[f"{kind}_percent"] for kind in ("correct", "wrong", "unanswered")]
        shares.append(stored["wrong_map"][name]["wrong_percent"])
        assert [cell.strip() for cell in row.split("|")[2:6]] == [f"{share:.1f}" for share in shares]


@pytest.mark.parametrize("source", ["images", "exact_boxes"])
@pytest.mark.parametrize("tilt", ["0", "0.1", "0.3", "1"])
def test_the_rows_of_the_tilts_are_the_stored_shares_and_errors(source, tilt):
    stored = json.loads((ROOM_RESULTS / "tilts_1-10.json").read_text())["tilts"][tilt][source]
    name = f"| from {source.replace('_', ' ')}, {tilt} degrees |"
    row = next(line for line in RESULTS.splitlines() if line.startswith(name))
    errors = (
        ", ".join(
            f"{stored[method]['correct'][f'median_{error}']:.{digits}f}"
            for error, digits in (("dx_m", 2), ("dy_m", 2), ("dtheta_deg", 1))
        )
        for method in ("paper", "weighted_fit")
    )
    shares = f"{stored['paper']['correct_percent']:.0f}", f"{stored['library']['unable_percent']:.0f}"
    assert [cell.strip() for cell in row.split("|")[2:6]] == [*shares, *errors]
