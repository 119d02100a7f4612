"""`interrupt`: what is whole is told from what is broken; writers in small are killed at the steps of their writing."""

import json
import os
import sys

import numpy as np
import pytest

from course_lib.cli import COMMANDS, main
from course_lib.commands.full_disk import full_disks, why_no_disk
from course_lib.commands.interrupt import shares
from course_lib.commands.interrupt_cases import CASES, Case
from course_lib.commands.interruptions import (
    InterruptionError,
    Staged,
    drawn_ctrl_c,
    drawn_kills,
    interruptions,
)
from course_lib.commands.stopped_runs import Moment
from course_lib.commands.whole_outputs import left_over, state
from course_lib.paths import data_path
from course_lib.unfinished import UNFINISHED

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="it forks")

BY_NAME = {case.name: case for case in CASES}
QUICK = ("made data", "recording", "checkpoint", "sweep rows", "lab settings", "working copies", "bench")
STEPS = 10  # of each, its first and its last among them
OLD = {"a.json": b'{"seed": 1, "time_s": 0.1}', "b.csv": b"x\n1\n"}
NEW = {"a.json": b'{"seed": 2, "time_s": 0.1}', "b.csv": b"x\n2\n"}


@pytest.mark.parametrize(
    ("now", "expected"),
    [
        (OLD, "old"),
        (NEW, "new"),
        (NEW | {"a.json": b'{"seed": 2, "time_s": 0.7}'}, "new"),
        (NEW | {"a.json": b'{"seed": 3, "time_s": 0.1}'}, "broken"),
        (NEW | {"a.json": OLD["a.json"]}, "broken"),
        (OLD | {"b.csv": b"x\n"}, "broken"),
        (OLD | {"c.txt": b""}, "broken"),
        ({}, "broken"),
    ],
)
def test_old_and_new_are_told_from_anything_else(now, expected):
    assert state(now, OLD, NEW) == expected


def test_a_page_of_the_old_among_the_new_is_broken_however_alike_both_are():
    old, new = OLD | {"page.html": b"1</html>"}, NEW | {"page.html": b"2</html>"}
    assert state(new | {"page.html": b"3</html>"}, old, new) == "new", "pages tell the time"
    assert state(new | {"page.html": b"1</html>"}, old, new) == "broken"


def test_file_by_file_whole_ones_of_both_are_between_and_halves_are_not():
    mixed = NEW | {"a.json": OLD["a.json"]}
    assert state(mixed, OLD, NEW, by_file=True) == "between"
    assert state(OLD | {"b.csv": b"x"}, OLD, NEW, by_file=True) == "broken"
    assert state({"b.csv": NEW["b.csv"]}, OLD, NEW, by_file=True) == "broken", "one is gone"


def test_a_picture_that_is_cut_is_broken(tmp_path):
    image = pytest.importorskip("PIL.Image")
    image.fromarray(np.zeros((20, 30, 3), np.uint8)).save(tmp_path / "a.png")
    whole = (tmp_path / "a.png").read_bytes()
    image.fromarray(np.ones((20, 30, 3), np.uint8)).save(tmp_path / "a.png")
    other = (tmp_path / "a.png").read_bytes()
    assert state({"a.png": other}, {}, {"a.png": whole}) == "new"
    assert state({"a.png": other[:-20]}, {}, {"a.png": whole}) == "broken"


def test_what_is_left_is_seen_wherever_it_lies(tmp_path):
    (tmp_path / "out" / "deep").mkdir(parents=True)
    assert left_over(tmp_path, tmp_path / "out") == []
    (tmp_path / "out" / "deep" / f".a{UNFINISHED}x").write_text("")
    (tmp_path / "a.partial").write_text("")
    assert left_over(tmp_path, tmp_path / "out") == ["a.partial", f"out/deep/.a{UNFINISHED}x"]


def test_moments_are_shared_out_and_drawn_from_the_seed():
    assert sum(shares(200, len(CASES))) == 200
    assert min(shares(200, len(CASES))) >= 6
    assert max(shares(200, len(CASES))) <= 7, "alike but for one"
    assert min(shares(5, len(CASES))) == 1

    class Timed:
        steps, seconds = 9, 2.0

    kills = drawn_kills(Timed, 40, np.random.default_rng(3))
    assert kills == drawn_kills(Timed, 40, np.random.default_rng(3))
    assert sum(moment.seconds is not None for moment in kills) == 20
    assert sum(moment.delay > 0 for moment in kills) == 10
    assert all(1 <= moment.step <= 9 for moment in kills if moment.seconds is None)


@pytest.mark.parametrize("name", QUICK)
def test_killed_at_every_step_of_its_writing_a_writer_leaves_the_old_or_the_new(name, tmp_path):
    with Staged(BY_NAME[name], tmp_path.resolve()) as staged:
        steps = sorted({int(step) for step in np.rint(np.linspace(1, staged.steps, STEPS))})
        found = interruptions(staged, [Moment(step=step) for step in steps])
        stopped = interruptions(staged, drawn_ctrl_c(staged, 2, np.random.default_rng(1)))
    assert found["faults"] == stopped["faults"] == []
    assert found["moments"] == min(STEPS, staged.steps) > 2
    assert found["old"] + found["new"] + found["between"] == found["moments"]
    assert found["old"] or found["between"]


IN_PLACE = """
import sys
from pathlib import Path
with open(Path(sys.argv[1]) / "a.txt", "w") as file:
    file.write(sys.argv[2] * 100_000)
Path(sys.argv[1], "b.txt").write_text(sys.argv[2])
"""
LEAVES = """
import os, sys
from pathlib import Path
part = Path(sys.argv[1]).parent / f"part-{os.getpid()}"
part.write_text(sys.argv[2])
os.chmod(part, 0o600)
os.replace(part, Path(sys.argv[1]) / "a.txt")
"""


def test_a_writer_that_writes_in_place_is_found_out(tmp_path):
    with Staged(Case("bad", "{out} {which}", IN_PLACE), tmp_path.resolve()) as staged:
        found = interruptions(staged, [Moment(step=step) for step in range(1, staged.steps + 1)])
    assert found["broken"] == len(found["faults"]) > 0


def test_a_writer_that_never_clears_is_found_out(tmp_path):
    with Staged(Case("bad", "{out} {which}", LEAVES), tmp_path.resolve()) as staged:
        found = interruptions(staged, [Moment(step=step) for step in range(1, staged.steps + 1)])
    assert found["broken"] == 0
    assert found["left"] == len(found["faults"]) > 0


def test_a_run_that_fails_undisturbed_or_makes_the_same_twice_tells_nothing(tmp_path):
    for name, program in (("fails", "raise SystemExit(3)"), ("same", "open('out/a', 'w').close()")):
        (tmp_path / name).mkdir()
        with pytest.raises(InterruptionError, match=name), Staged(Case(name, "", program), (tmp_path / name).resolve()):
            pass


@pytest.mark.skipif(why_no_disk() is not None, reason=f"no disk can be filled here: {why_no_disk()}")
@pytest.mark.parametrize("name", ["made data", "sweep rows", "working copies"])
def test_on_every_size_of_disk_the_old_or_the_new_is_whole_and_the_disk_is_named(name, tmp_path):
    with Staged(BY_NAME[name], tmp_path.resolve()) as staged:
        found = full_disks(staged)
    assert found["faults"] == []
    assert found["new"], "the largest disk is large enough"
    assert found["old"] or found["between"]


def test_the_command_prints_a_table_and_stores_what_it_found(tmp_path, capsys):
    words = ["interrupt", "--moments", "4", "--only", "semantic map", "--no-disk", "--out", str(tmp_path / "out")]
    assert main(words) == 0
    printed = capsys.readouterr().out
    assert "semantic map" in printed
    stored = json.loads((tmp_path / "out" / "interrupt.json").read_text())
    assert stored["sum"]["kill"]["moments"] == 4
    assert stored["sum"]["kill"]["broken"] == 0
    assert stored["no_disk"] == "not asked for"


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--only", "nothing"], "there is no such command here"),
        (["--moments", "0"], "--moments must be a positive number"),
        (["--seed", "-1"], "--seed must be 0 or more"),
    ],
)
def test_what_cannot_be_asked_is_refused(words, told, capsys):
    assert main(["interrupt", *words]) == 2
    assert told in capsys.readouterr().err


REFUSED = {
    "ambiguity": "ambiguity --map {data}/room/semantic_map.json",
    "bench": "bench --no-tools --quick",
    "compare": "compare --map {data}/corridor/map.ply --sequence {data}/corridor/wagon",
    "demo corridor": "demo corridor",
    "demo finale": "demo finale",
    "demo lost": "demo lost",
    "demo room": "demo room",
    "demo rooms": "demo rooms",
    "demo trouble": "demo trouble",
    "demo walk": "demo walk",
    "fuzz": "fuzz --files 10",
    "grade": "grade {data}/room",
    "handout": "handout 03",
    "interrupt": "interrupt",
    "localize": "localize --map {data}/corridor/map.ply --sequence {data}/corridor/wagon",
    "locate": "locate --upper {a} --lower {b} --baseline 0.3 --map {data}/room/semantic_map.json",
    "make-data corridor": "make-data corridor",
    "make-data finale": "make-data finale",
    "make-data projects": "make-data projects",
    "make-data room": "make-data room",
    "make-data training-rooms": "make-data training-rooms",
    "stereo": "stereo --upper {a} --lower {b} --baseline 0.3",
    "sweep": "sweep corridor",
    "train-detector": "train-detector --images {data} --validation {data}",
}


@pytest.mark.skipif(not os.path.isdir("/proc/self"), reason="a folder that takes no files, root's included")
@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_written_is_refused_before_the_work(name, capsys, monkeypatch, tmp_path):
    data = data_path("corridor").parent
    places = {
        "data": data,
        "a": f"{data}/room/experiment_1/01_a_upper.jpg",
        "b": f"{data}/room/experiment_1/01_a_lower.jpg",
    }
    monkeypatch.chdir(tmp_path)
    assert main([*REFUSED[name].format(**places).split(), "--out", "/proc/nope"]) == 2
    told = capsys.readouterr()
    assert "/proc/nope" in told.err
    assert told.out == ""


def test_every_command_with_an_out_folder_is_among_those_that_refuse():
    import argparse
    from importlib import import_module

    with_out = []
    for name, (module, _) in COMMANDS.items():
        parser = argparse.ArgumentParser()
        import_module(f"course_lib.commands.{module}").add_arguments(parser)
        with_out += [name] * any("--out" in action.option_strings for action in parser._actions)
    assert set(with_out) - set(REFUSED) == {"progress"}, "its page is written in a second"
