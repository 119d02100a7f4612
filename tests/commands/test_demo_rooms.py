"""`demo room`, `demo rooms` and `demo trouble`: what they print and write of a few poses, or of rows that are kept."""

import contextlib
import io
import json
import re

import pytest

from courseware.cli import main
from courseware.experiments import rooms, trouble
from courseware.experiments.depth_trouble import LENGTHS
from courseware.experiments.rooms import METHODS
from courseware.paths import data_path
from tests.commands.conftest import rows_of
from tests.experiments.test_rooms import entry, record


@pytest.fixture(scope="module")
def demo_room(tmp_path_factory):
    """`demo room` on the first pose of each experiment: its folder, and what it printed."""
    folder, said = tmp_path_factory.mktemp("demo"), io.StringIO()
    with contextlib.redirect_stdout(said):
        words = ["demo", "room", "--poses", "1", "--roll", "640", "--bearing-only"]
        assert main([*words, "--out", str(folder)]) == 0
    return folder, said.getvalue()


@pytest.mark.slow
def test_the_room_has_rates_and_errors_by_experiment_and_method_a_row_a_pose_and_figures(demo_room):
    folder, text = demo_room
    summary = json.loads((folder / "room.json").read_text())
    for experiment in ("experiment_1", "experiment_2"):
        for method in ("greedy", "greedy_weighted", "greedy_exact_boxes", "greedy_weighted_exact_boxes"):
            row = summary[experiment][method]
            assert row["correct_percent"] + row["incorrect_percent"] + row["unable_percent"] == pytest.approx(100)
    for source in ("", "_exact_boxes"):
        alike, weighted = (summary["experiment_2"][f"greedy{kind}{source}"] for kind in ("", "_weighted"))
        assert weighted["correct_percent"] == alike["correct_percent"], "the same associations"
        assert weighted["all"]["mean_dx_m"] != alike["all"]["mean_dx_m"]
    assert summary["poses"] == 1
    assert summary["rolled_images"]["alike"]["n"] == 2, "a pose of two experiments, one number of columns"
    assert summary["stereo_matching"]["seen_in_both"] > 10
    assert 0 < summary["median_relative_range_error_percent"]["exact_boxes"] < 15
    sources = [row["source"] for row in rows_of(folder / "room.csv")]
    assert sources == ["images", "exact_boxes"] * 2
    for name in ("experiment_1.png", "experiment_2.png", "detections.png", "matched_pairs.png"):
        assert (folder / name).read_bytes().startswith(b"\x89PNG")
    for part in (
        *(f"Table {number}" for number in range(1, 6)),
        "paper: correct                                     0.23     0.44         11.94",
        "ours, images, greedy, weighted_fit: correct",
        "experiment 2, ours, exact boxes, weighted_fit",
        "Images rolled by 640 columns",
        "pairs weighted by their covariance",
        "Direction and distance, from images: 2 poses, intervals (95 %) over 1 units",
    ):
        assert part in text


@pytest.fixture
def made(monkeypatch):
    """Rooms are not photographed: the record of every asked room, one pose in four wrong; and what was asked."""
    asked = []

    def note(seed, poses, network, tilt_deg):
        asked.append((seed, poses, tilt_deg))
        seen = [entry(shown=(1, 0, 2) if k == 3 else (0, 1, 2)) | {"experiment": 1 + k % 2} for k in range(4)]
        return record(seed, seen)

    def follow(seed, poses, network, views):
        asked.append((seed, poses, f"{views} views"))
        seen = [{"pose": entry()["pose"], "observations": entry()["sources"]["images"]["observations"]}]
        return [{"experiment": 1, "name": "00", "views": seen}]

    monkeypatch.setattr(rooms, "observe_room", note)
    monkeypatch.setattr(rooms, "observe_views", follow)
    return asked


def test_the_rooms_table_has_the_papers_row_ours_and_their_intervals(made, tmp_path, printed):
    words = ["demo", "rooms", "--seeds", "10001-10002", "--processes", "1", "--out", tmp_path]
    text = printed(*words, "--tilts", "0.3")
    for part in (
        "2 rooms (seeds 10001-10002), 2 poses at each height",
        "Cameras at 1.32 and 1.02 m",
        "65.0 (43 to 82)",
        "exact boxes, weighted_fit",
        "75.0 (41 to 93; 75 to 75)",
        "4 between look-alikes",
        "Lower camera tilted against the upper one",
    ):
        assert part in text
    assert text.count("\n0.3 degrees\n") == 3, "shares, errors of correct poses, errors of all"
    assert made == [(seed, 20, tilt) for tilt in (None, 0.3) for seed in (10001, 10002)]
    assert len(rows_of(tmp_path / "rooms.csv")) == 2 * 4 * 2 * len(METHODS), "rooms, poses, sources, methods"


def test_asked_for_direction_alone_the_rooms_table_tells_it_beside_the_papers_fit(made, tmp_path, printed, told):
    words = f"demo rooms --seeds 10001-10002 --processes 1 --association greedy --out {tmp_path}".split()
    text, found = printed(*words, "--bearing-only"), told(*words, "--bearing-only")["bearing_only"]
    assert "Direction and distance, from images: 8 poses, intervals (95 %) over 2 units" in text
    assert text.count("  direction alone ") == len(found) == 3
    assert found["true"]["direction alone"]["median_m"] < 1e-6
    assert "bearing_only" not in told(*words)


def test_finished_rooms_are_not_made_again_whatever_is_asked_of_them(made, tmp_path, told):
    words = ["demo", "rooms", "--seeds", "10001", "--poses", "2", "--processes", "1", "--out", tmp_path]
    asked = ([], ["--association", "greedy"], ["--views", "2", "--view-poses", "1", "--ablation"])
    found = [told(*words, *more) for more in asked]
    assert [one["both"]["images"]["paper"]["correct_percent"] for one in found] == [75.0] * 3
    assert made == [(10001, 2, None), (10001, 1, "2 views")]
    answered = [list(one["answers"]["one_view"]) for one in found[:2]]
    assert answered == [["greedy", "hungarian", "consistent"], ["greedy"]]
    assert found[2]["answers"]["n_views"] == 2
    assert set(found[2]["answers"]["ablation"]) == {"right_map", "wrong_map"}
    assert (tmp_path / "risk_coverage.png").stat().st_size > 1000


SHARES = [0.01, 0.2]
TROUBLE = ["demo", "trouble", "--seeds", "10001-10002", "--share", "1,20", "--processes", "1"]


def trouble_rows(troubles, good, bad, n):
    """Rows of a run: one frame troubled, the tenth good one after it off by two metres, and said to be."""
    calm = [{"outcome": good, "confident": True, "position_m": 0.01 * (k % 7), "rotation_deg": 0.1} for k in range(n)]
    frames = [dict(one) for one in calm]
    frames[5] = {"outcome": bad, "confident": False, "position_m": None, "rotation_deg": None}
    frames[15] = {"outcome": "lost", "confident": False, "position_m": 2.0, "rotation_deg": 0.1}
    rows = [
        {"trouble": one, "share": share, "runs": [[5, 6]], "frames": frames} for one in troubles for share in SHARES
    ]
    return {"undisturbed": calm, "troubles": rows}


@pytest.fixture
def finished(tmp_path):
    """The folder of a run of which all rows are kept, so that nothing is run."""
    depth = {"data": str(data_path("corridor").absolute()), "frames": trouble.FRAMES, "dof": "xyyaw"}
    stereo = {"detector": str(data_path("detector").absolute()), "frames": trouble.PAIRS}
    for name, point, result in (
        ("depth_xyyaw", depth, trouble_rows(LENGTHS, "tracked", "repeated", 30)),
        ("stereo", stereo, trouble_rows(["dropped"], "ok", "no image", 24)),
    ):
        points = [{**point, "shares": SHARES, "seed": seed} for seed in (10001, 10002)]
        lines = [json.dumps({"point": one, "result": result}) for one in points]
        (tmp_path / f"{name}.jsonl").write_text("\n".join(lines) + "\n")
    return tmp_path


def test_trouble_has_a_row_for_each_trouble_and_share_of_both_methods(finished, printed):
    text = printed(*TROUBLE, "--out", finished)
    for one in LENGTHS:
        assert len(re.findall(rf"^{one} +(1|20) +60 +2 +0 +100 +0   repeated 2$", text, re.M)) == 2, one
    assert "seeds 10001, 10002, 100 frames each" in text
    assert "undisturbed: tracked 60; 0 confident and wrong; 0 of 60 called troubled" in text
    assert len(re.findall(r"^dropped +(1|20) +48 +2 +0 +100 +0   no image 2$", text, re.M)) == 2
    assert {"depth_xyyaw.json", "stereo.json", "trouble.png"} <= {path.name for path in finished.iterdir()}
    assert trouble.told({"a": 1, "b": 3, "c": 1}) == "b 3, a 1, c 1"
