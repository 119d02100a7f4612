"""Words and values that cannot be are told in one sentence, before any work: one table for all commands."""

import argparse

import cv2
import numpy as np
import pytest

from course_lib.spherical_stereo.detection.detector import YoloDetector
from courseware.cli import main
from courseware.commands.arguments import add_detector_arguments, chosen_detector, parse_seeds
from courseware.paths import data_path
from courseware.simulation.room import data as room_data

PAIR = "--baseline 0.3 --upper {pair}_upper.jpg --lower {pair}_lower.jpg"
# Module of the command -> the words that every call has, and calls with what is said of them.
WRONG = {
    "courseware.commands.ambiguity": (
        "ambiguity --map {data}/room/semantic_map.json --out {out}",
        ("--association best", "association must be one of greedy, hungarian, consistent"),
        ("--step 0", "--step must be a positive number of metres"),
        ("--step 500", "give a smaller --step"),
        ("--draws 0", "--draws must be at least 1; got 0"),
        ("--seed -1", "--seed must be 0 or more; got -1"),
    ),
    "courseware.commands.compare": (
        "compare --map {data}/corridor/map.ply --sequence {data}/corridor/hand --out {out}",
        ("--every 0", "--every must be whole numbers, at least 1"),
        ("--every 900", "no frame is left"),
        ("--seeds 5-1", "--seeds must be"),
    ),
    "courseware.commands.localize": (
        "localize --map {data}/corridor/map.ply --sequence {data}/corridor/wagon --dof xyyaw --frames 2 --out {out}",
        ("--start 1 2 nan 0 0 0", "six finite numbers"),
        ("--start 1 2 3", "six finite numbers"),
        ("--start 500 0 1 0 0 0", "outside the map"),
        ("--start unknown --up unknown --dof 6", "--start unknown needs --up AXIS"),
        ("--depth-scale nan", "--depth-scale"),
        ("--near 5 --far 2", "--near must be below --far"),
        ("--map nowhere.ply", "nowhere.ply is missing"),
        ("--sequence nowhere", "no sequence at"),
        ("--frames -3", "--frames must be at least 1; got -3"),
        ("--particles 1000001", "--particles must be at most 1,000,000; got 1,000,001"),
        ("--sigma-position 10.5", "--sigma-position must be between 0 and 10 m a frame; got 10.5"),
        ("--sigma-rotation 2 --dof 6", "--sigma-rotation goes with --method paper"),
        ("--up unknown", "which way is up in this world is unknown"),
        ("--method annealed", "six degrees of freedom"),
        ("--dof 6 --method paper --recover", "--recover goes with the annealed filter"),
        ("--out {here}", "is a file: give a folder"),
    ),
    "courseware.commands.locate": (
        f"locate --map {{data}}/room/semantic_map.json {PAIR} --out {{out}}",
        ("--upper none.png", "none.png is missing"),
        ("--baseline 300", "Is it in millimetres"),
        ("--baseline=-0.3", "baseline must be a positive number of metres"),
        ("--boxes b.json --detector somewhere", "give one of the two"),
        ("--boxes b.json --score-threshold 0.7", "give one of the two"),
        ("--association best", "association must be one of greedy"),
        ("--out {here}", "is a file: give a folder"),
    ),
    "courseware.commands.stereo": (
        f"stereo {PAIR} --out {{out}}",
        ("--baseline=-0.3", "--baseline must be a positive number"),
        ("--sigma-pixels 0", "--sigma-pixels must be a positive number of pixels; got 0"),
        ("--upper missing.png", "missing.png is missing"),
        ("--upper {pair}_lower.jpg --lower {pair}_upper.jpg", "swapped"),
        ("--lower half.png", "one size"),
    ),
    "courseware.commands.demo": (
        "demo",
        ("corridor --seeds 5-1 --out {out}", "--seeds must be"),
        ("corridor --frames 0 --out {out}", "--frames must be at least 1"),
        ("corridor --methods proposed --out {out}", "--methods goes with --seeds"),
        ("corridor --data nowhere --out {out}", "map.ply"),
        ("corridor --dof 6 --idealizations --out {out}", "--idealizations does not go with --dof 6"),
        ("room --poses 0 --out {out}", "--poses must be at least 1"),
        ("room --data elsewhere --seed 7 --out {out}", "give one of the two"),
        ("room --seed 7 --detector nowhere --out {out}", "folder nowhere must hold exactly one .cfg file"),
        ("room --seed 7 --association psychic --out {out}", "association must be one of"),
        ("room --seed 7 --score-threshold 2 --out {out}", "--score-threshold"),
        ("rooms --views 0 --out {out}", "--views must be at least 1"),
        ("rooms --processes 100000", "--processes must be at most"),
        ("rooms --tilts 0 11 --out {out}", "--tilts must be between 0 and 10 degrees; got 11"),
        ("walk --methods magic --out {out}", "--methods must name annealed, paper, floor"),
        ("trouble --share 21 --out {out}", "--share must be at most 20 percent; got 21"),
        ("trouble --method depth --frames 20 --out {out}", "take a longer recording or a smaller share"),
        ("finale --places 0 --out {out}", "--places must be at least 1"),
    ),
    "courseware.commands.handout": (
        "handout",
        ("99", "no lesson 99"),
        ("06 --seed -1", "--seed must be 0 or more"),
        ("06 --out /", "no handout of ours"),
    ),
}


@pytest.mark.parametrize(
    ("always", "words", "said"), [(always, *call) for always, *calls in WRONG.values() for call in calls]
)
def test_what_does_not_fit_is_told_in_one_line_and_nothing_is_written(
    always, words, said, tmp_path, monkeypatch, capsys
):
    monkeypatch.setattr(room_data, "make_room_data", lambda *_, **__: pytest.fail("40 pairs were photographed first"))
    monkeypatch.chdir(tmp_path)
    cv2.imwrite("half.png", np.zeros((64, 128, 3), np.uint8))
    before = sorted(tmp_path.rglob("*"))
    places = {"data": data_path(""), "out": tmp_path / "out", "here": __file__}
    places["pair"] = data_path("room/experiment_2/03_a_upper.jpg").with_name("03_a")
    assert main(f"{always} {words}".format(**places).split()) == 2
    *_, error = capsys.readouterr().err.strip().splitlines()
    assert error.startswith("error: ")
    assert said in error
    assert "frame/s" not in error
    assert sorted(tmp_path.rglob("*")) == before


def test_seeds_are_numbers_and_ranges():
    assert parse_seeds("2-3, 1-2,10000") == [2, 3, 1, 10000]


def test_what_is_given_reaches_the_detector_and_the_rest_is_left_to_its_folder(tmp_path, monkeypatch):
    def chosen(*words):
        parser = argparse.ArgumentParser()
        add_detector_arguments(parser)
        return chosen_detector(parser.parse_args(words))

    monkeypatch.setattr(YoloDetector, "load", lambda folder, **options: (folder, options))
    assert chosen() == (data_path("detector"), {})
    words = ["--detector", str(tmp_path), "--input-size", "1280", "512", "--score-threshold", "0.7"]
    assert chosen(*words) == (tmp_path, {"input_size": (1280, 512), "score_threshold": 0.7})
    with pytest.raises(ValueError, match="--input-size must be two multiples of 32 above 0; got 1280 500"):
        chosen("--input-size", "1280", "500")
    with pytest.raises(ValueError, match="--score-threshold must be between 0 and 1; got"):
        chosen("--score-threshold", "1.5")
