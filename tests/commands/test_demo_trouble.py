"""`demo trouble`: its options, its table, its figure, its one JSON object; runs themselves are tests of experiments."""

import json
import re

import pytest
from course_lib.commands.demo_trouble import FRAMES, PAIRS
from course_lib.commands.trouble_table import told, trouble_table
from course_lib.experiments.sensor_trouble.depth_frames import TROUBLES

from course_lib.cli import main
from course_lib.paths import data_path
from course_lib.plots.trouble_figure import trouble_figure

SHARES = [0.01, 0.2]
WORDS = ["demo", "trouble", "--seeds", "10001-10002", "--share", "1,20", "--processes", "1"]
DEPTH = "course_lib.experiments.sensor_trouble.depth_run.corridor_trouble"
STEREO = "course_lib.experiments.sensor_trouble.stereo_run.room_trouble"


def made(troubles, good, bad, n):
    """Rows of a run: one frame troubled, the tenth good one after it off by two metres, and said to be."""
    calm = [{"outcome": good, "confident": True, "position_m": 0.01 * (k % 7), "rotation_deg": 0.1} for k in range(n)]
    frames = [dict(one) for one in calm]
    frames[5] = {"outcome": bad, "confident": False, "position_m": None, "rotation_deg": None}
    frames[15] = {"outcome": "lost", "confident": False, "position_m": 2.0, "rotation_deg": 0.1}
    rows = [
        {"trouble": trouble, "share": share, "runs": [[5, 6]], "frames": frames}
        for trouble in troubles
        for share in SHARES
    ]
    return {"undisturbed": calm, "troubles": rows}


def store(path, function, point, result):
    """What two seeds of a sweep left behind, so that nothing is run."""
    lines = [{"sweep": function, "version": 1}]
    lines += [{"point": {**point, "shares": SHARES, "seed": seed}, "result": result} for seed in (10001, 10002)]
    path.write_text("".join(json.dumps(line) + "\n" for line in lines))


@pytest.fixture
def finished(tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    point = {"data": str(data_path("corridor").absolute()), "frames": FRAMES, "dof": "xyyaw"}
    store(out / "depth_xyyaw.jsonl", DEPTH, point, made(TROUBLES, "tracked", "repeated", 30))
    point = {"detector": str(data_path("detector").absolute()), "frames": PAIRS}
    store(out / "stereo.jsonl", STEREO, point, made(["dropped"], "ok", "no image", 24))
    return out


def test_it_prints_a_row_for_each_trouble_and_share_of_both_methods(finished, capsys):
    assert main([*WORDS, "--out", str(finished)]) == 0
    text = capsys.readouterr().out
    for trouble in TROUBLES:
        assert len(re.findall(rf"^{trouble} +(1|20) +60 +2 +0 +100 +0   repeated 2$", text, re.M)) == 2, trouble
    assert "seeds 10001, 10002, 100 frames each" in text
    assert "undisturbed: tracked 60; 0 confident and wrong; 0 of 60 called troubled" in text
    assert len(re.findall(r"^dropped +(1|20) +48 +2 +0 +100 +0   no image 2$", text, re.M)) == 2
    assert {"depth_xyyaw.json", "stereo.json", "trouble.png"} <= {path.name for path in finished.iterdir()}


def test_json_is_one_object_and_what_is_stored(finished, capsys):
    assert main([*WORDS, "--out", str(finished), "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert set(printed) == {"depth_xyyaw", "stereo"}
    for name, result in printed.items():
        stored = json.loads((finished / f"{name}.json").read_text())
        assert {key: stored[key] for key in result} == result
        assert stored["versions"]
    assert printed["stereo"]["rows"][0]["outcomes"] == {"no image": 2}


def test_one_method_alone(finished, capsys):
    assert main([*WORDS, "--method", "stereo", "--out", str(finished)]) == 0
    text = capsys.readouterr().out
    assert "Pairs of panoramas" in text
    assert "wagon" not in text


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--share", "21"], "--share must be at most 20 percent; got 21"),
        (["--share", "0"], "--share must be whole numbers"),
        (["--seeds", "x"], "--seeds must be numbers or ranges"),
        (["--frames", "0"], "--frames must be at least 1"),
        (["--processes", "0"], "--processes must be at least 1"),
        (["--processes", "10000"], "--processes must be at most "),
        (["--method", "depth", "--frames", "20"], "take a longer recording or a smaller share"),
        (["--method", "stereo", "--frames", "14"], "take a longer recording or a smaller share"),
        (["--method", "stereo", "--detector", "nowhere"], "nowhere"),
    ],
)
def test_options_that_do_not_fit_are_told_before_anything_is_run(words, said, tmp_path, capsys):
    assert main(["demo", "trouble", "--out", str(tmp_path / "out"), *words]) == 2
    assert said in capsys.readouterr().err
    assert not list(tmp_path.rglob("*.jsonl"))


def test_outcomes_are_told_the_commonest_first():
    assert told({"a": 1, "b": 3, "c": 1}) == "b 3, a 1, c 1"


def test_a_row_without_a_frame_to_judge_has_no_percentage_and_no_bar(finished, capsys):
    main([*WORDS, "--method", "stereo", "--out", str(finished), "--json"])
    result = json.loads(capsys.readouterr().out)["stereo"]
    for row in result["rows"]:
        row["judged"] = row["recovered"] = row["undisturbed"] = 0
    assert re.search(r"^dropped +1 +48 +0 +- +- +0 ", trouble_table(result), re.M)
    assert [len(axes.patches) for axes in trouble_figure({"stereo": result}).axes] == [0]
