"""`demo rooms`: its seeds, its tables, its one JSON object; rooms themselves are made in tests of experiments."""

import csv
import json

import pytest
from course_lib.commands.demo_rooms import detector_identity
from course_lib.experiments.rooms_summary import METHODS

from course_lib.cli import main
from course_lib.commands.arguments import parse_seeds
from course_lib.experiments import rooms as rooms_module
from tests.experiments.test_rooms import entry, record


@pytest.fixture
def made(monkeypatch):
    """Rooms are not photographed: the record of every asked room, one pose in four wrong; and what was asked."""
    asked = []

    def note(seed, options, detector):
        asked.append((seed, options))
        assert hasattr(detector, "detect")
        poses = [entry(shown=(1, 0, 2) if k == 3 else (0, 1, 2)) | {"experiment": 1 + k % 2} for k in range(4)]
        return record(seed, poses) | {"options": options.as_dict()}

    monkeypatch.setattr(rooms_module, "observe_room", note)
    return asked


@pytest.mark.parametrize(
    ("text", "seeds"),
    [("4", [4]), ("1-3", [1, 2, 3]), ("1-3,10000", [1, 2, 3, 10000]), ("2-3, 1-2", [2, 3, 1]), ("0", [0])],
)
def test_seeds_are_numbers_and_ranges(text, seeds):
    assert parse_seeds(text) == seeds


@pytest.mark.parametrize("text", ["", "3-1", "a", "1-", "-1", "1..3"])
def test_other_seeds_are_refused(text):
    with pytest.raises(ValueError, match="numbers or ranges"):
        parse_seeds(text)


def test_so_many_seeds_that_no_memory_holds_them_are_refused():
    assert len(parse_seeds("1-100000")) == 100_000
    with pytest.raises(ValueError, match=r"--seeds must be at most 100,000 seeds; got '1-100001'"):
        parse_seeds("1-100001")


def test_the_table_has_the_papers_row_ours_and_their_intervals(made, tmp_path, capsys):
    assert main(["demo", "rooms", "--seeds", "10001-10002", "--processes", "1", "--out", str(tmp_path)]) == 0
    text = capsys.readouterr().out
    for part in (
        "2 rooms (seeds 10001-10002), 2 poses at each height",
        "Cameras at 1.32 and 1.02 m",
        "Cameras at 1.44 and 1.14 m",
        "65.0 (43 to 82)",
        "exact boxes, weighted_fit",
        "75.0 (41 to 93; 75 to 75)",
        "4 between look-alikes",
    ):
        assert part in text
    assert [seed for seed, _ in made] == [10001, 10002]
    assert all(options.poses == 20 for _, options in made)
    rows = list(csv.DictReader((tmp_path / "rooms.csv").open()))
    assert len(rows) == 2 * 4 * 2 * len(METHODS), "rooms, poses, sources, methods"


def test_one_json_object_is_printed_and_finished_rooms_are_not_made_again(made, tmp_path, capsys):
    words = ["demo", "rooms", "--seeds", "10001", "--poses", "2", "--processes", "1", "--out", str(tmp_path), "--json"]
    for _ in range(2):
        assert main(words) == 0
        summary = json.loads(capsys.readouterr().out)
        assert summary["both"]["images"]["paper"]["correct_percent"] == 75.0
        assert "versions" in json.loads((tmp_path / "rooms.json").read_text())
    assert len(made) == 1


def test_every_tilt_is_a_set_of_rooms_of_its_own(made, tmp_path, capsys):
    words = ["--seeds", "10001", "--processes", "1", "--tilts", "0", "0.3", "--out", str(tmp_path)]
    assert main(["demo", "rooms", *words]) == 0
    assert [options.models.tilt_deg for _, options in made] == [None, 0.0, 0.3]
    text = capsys.readouterr().out
    assert "Lower camera tilted against the upper one" in text
    assert text.count("\n0.3 degrees\n") == 3, "shares, errors of correct poses, errors of all"


def test_the_three_matchers_are_counted_beside_each_other_or_the_named_one_alone(made, tmp_path, capsys):
    words = ["demo", "rooms", "--seeds", "10001", "--poses", "2", "--processes", "1", "--out", str(tmp_path), "--json"]
    assert main(words) == 0
    found = json.loads(capsys.readouterr().out)["answers"]
    assert list(found["one_view"]) == ["greedy", "hungarian", "consistent"]
    assert found["one_view"]["consistent"]["n"] == 4
    assert (tmp_path / "risk_coverage.png").stat().st_size > 1000
    assert main([*words, "--association", "greedy"]) == 0
    assert list(json.loads(capsys.readouterr().out)["answers"]["one_view"]) == ["greedy"]


def test_further_views_are_made_once_and_followed(made, tmp_path, capsys, monkeypatch):
    asked = []

    def walk(seed, options, detector):
        asked.append((seed, options.views, options.rooms.poses))
        views = [{"pose": entry()["pose"], "observations": entry()["sources"]["images"]["observations"]}]
        return {
            "seed": seed,
            "options": options.as_dict(),
            "sequences": [{"experiment": 1, "name": "00", "views": views}],
        }

    monkeypatch.setattr("course_lib.experiments.room_views.observe_views", walk)
    words = ["demo", "rooms", "--seeds", "10001", "--processes", "1", "--out", str(tmp_path)]
    words += ["--poses", "2", "--views", "2", "--view-poses", "1", "--ablation"]
    for _ in range(2):
        assert main(words) == 0
    text = capsys.readouterr().out
    assert asked == [(10001, 2, 1)]
    for part in ("2 views, consistent", "no odometry", "Evidence switched off, wrong map", "all matches right"):
        assert part in text


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--seeds", "3-1"], "--seeds must be"),
        (["--views", "0"], "--views must be at least 1"),
        (["--view-poses", "21"], "--view-poses between 1 and --poses (20)"),
        (["--views", "2", "--association", "greedy"], "--views above 1 and --ablation are of the consistent matcher"),
        (["--poses", "0"], "--poses must be at least 1"),
        (["--processes", "0"], "--processes must be at least 1"),
        (["--tilts", "0", "11"], "--tilts must be between 0 and 10 degrees; got 11"),
        (["--detector", "nowhere"], "no detector folder nowhere"),
    ],
)
def test_bad_arguments_are_named_in_one_line(words, message, tmp_path, made, capsys):
    assert main(["demo", "rooms", *words, "--out", str(tmp_path)]) == 2
    error = capsys.readouterr().err
    assert message in error
    assert "Traceback" not in error
    assert made == []


def test_another_network_is_another_detector(tmp_path):
    from argparse import Namespace

    for name in ("a.cfg", "a.weights", "README.md"):
        (tmp_path / name).write_text("one")
    options = Namespace(detector=tmp_path, input_size=None, score_threshold=None)
    before = detector_identity(options)
    (tmp_path / "README.md").write_text("two")
    assert detector_identity(options) == before
    (tmp_path / "a.weights").write_text("two")
    assert detector_identity(options) != before
    assert detector_identity(Namespace(**vars(options) | {"score_threshold": 0.2})) != detector_identity(options)
