"""`demo room`: tables 1 to 5, figures and JSON, on a few poses of the shipped room."""

import contextlib
import csv
import io
import json

import pytest
from course_lib.commands.room_tables import remarks

from course_lib.cli import main
from course_lib.experiments.paper_tables import PAPER_TABLE_3, PAPER_TABLE_4
from course_lib.simulation.room import data as room_data

ERRORS = {f"{statistic}_{what}" for statistic in ("mean", "std") for what in ("dx_m", "dy_m", "dtheta_deg")}


@pytest.fixture(scope="module")
def demo(tmp_path_factory):
    """The demo on the first two poses of each experiment: its folder, in which `printed` holds what it printed."""
    folder, output = tmp_path_factory.mktemp("demo"), io.StringIO()
    with contextlib.redirect_stdout(output):
        assert main(["demo", "room", "--poses", "2", "--roll", "640", "--out", str(folder)]) == 0
    (folder / "printed").write_text(output.getvalue())
    return folder


@pytest.mark.slow
def test_json_holds_rates_and_errors_by_experiment_and_method(demo):
    summary = json.loads((demo / "room.json").read_text())
    for experiment in ("experiment_1", "experiment_2"):
        for method in ("greedy", "greedy_weighted", "greedy_exact_boxes", "greedy_weighted_exact_boxes"):
            row = summary[experiment][method]
            assert row["correct_percent"] + row["incorrect_percent"] + row["unable_percent"] == pytest.approx(100)
            for kind in ("all", "correct", "incorrect"):
                assert row[kind].keys() >= ERRORS
    assert summary["poses"] == 2
    assert summary["rolled_images"]["alike"]["n"] == 4, "two poses of two experiments, one number of columns"
    assert summary["stereo_matching"]["seen_in_both"] > 20
    assert 0 < summary["median_relative_range_error_percent"]["exact_boxes"] < 15


@pytest.mark.slow
def test_weighted_by_covariance_the_associations_are_the_same_and_the_poses_are_others(demo):
    summary = json.loads((demo / "room.json").read_text())["experiment_2"]
    for source in ("", "_exact_boxes"):
        alike, weighted = summary[f"greedy{source}"], summary[f"greedy_weighted{source}"]
        assert weighted["correct_percent"] == alike["correct_percent"]
        assert weighted["all"]["mean_dx_m"] != alike["all"]["mean_dx_m"]


@pytest.mark.slow
def test_a_row_a_pose_and_every_figure_are_written(demo):
    rows = list(csv.DictReader((demo / "room.csv").open()))
    assert [row["source"] for row in rows] == ["images", "images", "exact_boxes", "exact_boxes"] * 2
    assert {row["outcome"] for row in rows} <= {"correct", "incorrect", "unable"}
    for name in ("experiment_1.png", "experiment_2.png", "detections.png", "matched_pairs.png"):
        assert (demo / name).read_bytes().startswith(b"\x89PNG")
    assert not list(demo.glob("*.partial"))


@pytest.mark.slow
def test_one_json_object_is_printed_and_nothing_else(tmp_path, capsys):
    assert main(["demo", "room", "--poses", "1", "--out", str(tmp_path), "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["experiment_1"]["greedy"]["n"] == 1


@pytest.mark.slow
def test_the_tables_hold_the_papers_numbers_beside_ours(demo):
    text = (demo / "printed").read_text()
    for number in range(1, 6):
        assert f"Table {number}" in text
    for part in (
        "paper: correct                                     0.23     0.44         11.94",
        "ours, images, greedy, weighted_fit: correct",
        "experiment 2, ours, exact boxes, weighted_fit",
        "ours, exact boxes",
        "images, greedy",
        "Images rolled by 640 columns",
        "pairs weighted by their covariance",
    ):
        assert part in text


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--poses", "0"], "--poses must be at least 1"),
        (["--seed", "-1"], "--seed must be 0 or more"),
        (["--roll", "97", "0"], "--roll must not be 0"),
        (["--association", "psychic"], "association must be one of"),
        (["--views", "2"], "--views 2 needs --association consistent"),
        (["--data", "nowhere"], "nowhere"),
        (["--data", "elsewhere", "--seed", "4"], "give one of the two"),
        (["--detector", "nowhere"], "nowhere"),
    ],
)
def test_bad_arguments_are_named_in_one_line(words, message, tmp_path, capsys):
    assert main(["demo", "room", *words, "--out", str(tmp_path)]) == 2
    error = capsys.readouterr().err
    assert message in error
    assert "Traceback" not in error


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--detector", "nowhere"], "no detector folder nowhere"),
        (["--association", "psychic"], "--association must be one of"),
        (["--score-threshold", "2"], "--score-threshold"),
    ],
)
def test_a_bad_argument_is_told_before_another_seed_is_photographed(words, message, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(room_data, "make_room_data", lambda *_, **__: pytest.fail("40 pairs were photographed first"))
    assert main(["demo", "room", "--seed", "7", *words, "--out", str(tmp_path)]) == 2
    assert message in capsys.readouterr().err


def numbers(unable=(0.0, 0.0), share=0.4, wrong=2.0, used=12.0, n=(6, 4)):
    """A summary with these rates; mean errors of the incorrect poses are `share` of the paper's."""
    exact = {"unable_percent": 90.0, "incorrect": {"n": 0}}
    return {
        "incorrect_poses": {"median_wrong_pairs": wrong, "median_used_pairs": used},
        **{
            f"experiment_{k + 1}": {
                "greedy": {
                    "unable_percent": unable[k],
                    "incorrect": {"n": n[k], **{key: share * value for key, value in paper["incorrect"].items()}},
                },
                "greedy_exact_boxes": exact,
            }
            for k, paper in enumerate((PAPER_TABLE_3, PAPER_TABLE_4))
        },
    }


def test_remarks_say_what_the_numbers_show():
    hardly, swapped = remarks(numbers(unable=(5.0, 0.0)))
    assert hardly.startswith("Hardly any pose is unable")
    assert swapped.startswith(
        "One swapped pair among a dozen barely moves the fit: of an incorrect pose's 12 pairs 2 are"
    )


@pytest.mark.parametrize(
    "change",
    [{"share": 0.6}, {"wrong": 4.0}, {"used": 4.0}, {"n": (0, 0), "wrong": None, "used": None}],
    ids=["errors not small", "more than a swap", "few pairs", "none incorrect"],
)
def test_no_remark_on_swapped_pairs_without_the_numbers_for_it(change):
    assert [sentence.split()[0] for sentence in remarks(numbers(**change))] == ["Hardly"]


def test_no_remark_on_unable_poses_where_there_are_some():
    assert remarks(numbers(unable=(0.0, 10.0), share=0.6)) == []
