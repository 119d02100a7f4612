"""The command `fuzz`: a seeded sample of its files, the table, what is kept of a file that fails."""

import json
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from course_lib.cli import main
from course_lib.commands.fuzz import format_names
from course_lib.commands.fuzz_table import fuzz_table
from course_lib.fuzzing import campaign
from course_lib.fuzzing.formats import FORMATS
from course_lib.fuzzing.trial import CLASSES, DEFECTS

ROOT = Path(__file__).parents[2]


def course(*words, **options):
    """The command line in a process of its own: nothing of this one's threads is forked."""
    command = [sys.executable, "-m", "course_lib", *words]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=3000, check=False, **options)


@pytest.fixture(scope="module")
def sample(tmp_path_factory):
    """A seeded sample of the files of every format: what the command printed, and where it wrote."""
    out = tmp_path_factory.mktemp("fuzz") / "out"
    return course("fuzz", "--files", "420", "--seed", "12", "--json", "--out", str(out)), out


def test_a_seeded_sample_of_every_format_shows_no_defect(sample):
    done, out = sample
    result = json.loads(done.stdout)
    assert result["defects"] == []
    assert done.returncode == 0, done.stderr
    assert set(result["formats"]) == set(FORMATS)
    assert result["files"] == 420
    assert {one: result["all"][one] for one in DEFECTS} == dict.fromkeys(DEFECTS, 0)
    assert result["all"]["refused"] > 150
    assert result["all"]["changed"] == sum(result["explained"].values()) > 20
    assert 0 < result["peak_mb"] < 1_000
    assert json.loads((out / "fuzz.json").read_text())["formats"] == result["formats"]
    assert not (out / "failing.txt").exists()


def test_the_table_has_every_count(sample):
    result = json.loads(sample[0].stdout)
    table = fuzz_table(result)
    for name, counts in result["formats"].items():
        row = next(line.split() for line in table.splitlines() if line.split()[:1] == [name])
        assert row[1:] == [str(number) for number in (sum(counts.values()), *(counts[one] for one in CLASSES))]
    assert f"{result['files']}" in next(line for line in table.splitlines() if line.startswith("all "))


def test_the_same_seed_gives_the_same_counts_in_two_processes(tmp_path):
    words = ("fuzz", "--formats", "poses,boxes,up", "--files", "30", "--seed", "5", "--json", "--out")
    one, two = (course(*words, str(tmp_path / n), "--processes", n) for n in ("1", "2"))
    first, second = (json.loads(done.stdout) for done in (one, two))
    for result in (first, second):
        assert result.pop("peak_mb") > 0
        assert result.pop("slowest_s") > 0
    assert first == second


def test_a_file_that_fails_is_kept_and_can_be_read_again(tmp_path, monkeypatch, capsys):
    """A reader that forgets the file's name."""

    def forgetful(path):
        try:
            return poses.read(path)
        except ValueError as error:
            raise type(error)("something is wrong") from None

    poses = FORMATS["poses"]
    monkeypatch.setitem(campaign.FORMATS, "poses", type(poses)(**{**vars(poses), "read": forgetful}))
    out = tmp_path / "out"
    assert main(["fuzz", "--formats", "poses", "--files", "12", "--seed", "5", "--out", str(out)]) == 1
    printed = capsys.readouterr().out
    result = json.loads((out / "fuzz.json").read_text())
    assert result["all"]["unnamed"] == len(result["defects"]) > 3
    assert f"{len(result['defects'])} files show defects" in printed
    told = (out / "failing.txt").read_text()
    again = [shlex.split(line)[2:] for line in told.splitlines() if line.startswith("    python3 course.py")]
    assert len(again) == len(result["defects"])
    kept = [words for words in again if Path(words[2]).is_file()]
    assert main(kept[0]) == 1
    assert "unnamed" in capsys.readouterr().out
    monkeypatch.undo()
    assert main(kept[0]) == 0
    assert "refused" in capsys.readouterr().out


def test_a_valid_file_of_ones_own_may_be_tried(capsys):
    path = ROOT / "data" / "room" / "semantic_map.json"
    assert main(["fuzz", "--read", str(path), "--format", "semantic-json"]) == 0
    assert "changed: payload" in capsys.readouterr().out


def test_seconds_end_a_run(tmp_path, capsys):
    words = ["fuzz", "--formats", "up", "--seconds", "0.001", "--json", "--out", str(tmp_path / "out")]
    assert main(words) == 0
    assert json.loads(capsys.readouterr().out)["files"] == 1


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--formats", "ply,docx"], "docx is not known"),
        (["--files", "0"], "--files must be at least 1"),
        (["--processes", "0"], "--processes must be at least 1"),
        (["--processes", "10000"], "--processes must be at most "),
        (["--seconds", "-1"], "--seconds must be a positive number"),
        (["--seed", "-1"], "--seed must be 0 or more"),
        (["--read", "map.ply"], "--format says what"),
        (["--read", "nowhere.ply", "--format", "ply"], "there is no nowhere.ply"),
    ],
)
def test_what_makes_no_sense_is_refused(words, told, capsys, tmp_path):
    assert main(["fuzz", *words, "--out", str(tmp_path / "out")]) == 2
    assert told in capsys.readouterr().err


def test_formats_are_taken_once_and_in_order():
    assert format_names("up,poses,up") == ["up", "poses"]
    assert format_names(None) == list(FORMATS)
