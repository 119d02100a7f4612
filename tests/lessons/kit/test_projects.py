"""`score` on a project made for the test: what it says of every kind of submission."""

import dataclasses
import json

import numpy as np
import pytest

from course_lib.lessons.kit import projects
from course_lib.lessons.kit.exercises import find_exercise, lesson_numbers
from course_lib.lessons.kit.projects import (
    AnswerError,
    Project,
    Result,
    Rival,
    Task,
    UnknownProjectError,
    find_project,
    one_outcome,
    project_names,
    score,
    store_rivals,
    stored_rivals,
)

SEEDS = (901, 902, 903, 904, 905, 906)


def prepare(seed: int) -> Task:
    return Task((float(seed),), 0.001 * seed)


def measure(task: Task, answer: object) -> Result:
    if not isinstance(answer, float):
        raise AnswerError(f"returns a {type(answer).__name__}, not a number")
    return Result(abs(answer - task.truth), f"for {task.arguments[0]:g}")


def off_by(amount: float):
    return lambda x: 0.001 * x + amount


TOY = Project(
    "P0", "error of a thousandth", "m", "lower", 2, "thousandth", SEEDS, prepare, measure,
    (Rival("paper", "the paper's own method", off_by(0.5)), Rival("ours", "ours", off_by(-0.2))), seconds=0.5,
)  # fmt: skip


@pytest.fixture
def toy(monkeypatch, tmp_path):
    """The toy project instead of whichever is asked for, its rivals stored."""
    (tmp_path / "data" / "projects").mkdir(parents=True)
    monkeypatch.setattr(projects, "REPOSITORY", tmp_path)
    monkeypatch.setattr(projects, "data_path", lambda relative: tmp_path / "data" / relative)
    monkeypatch.setattr(projects, "find_project", lambda name: TOY)
    store_rivals(TOY)
    return TOY


def printed(capsys, function, **options) -> list[str]:
    score("P0", function, **options)
    return capsys.readouterr().out.splitlines()


def stub(x):
    """A task."""
    ...


def test_a_stub_is_not_attempted_and_a_value_is_no_function(toy, capsys):
    assert printed(capsys, stub) == ["P0: not attempted yet. Replace the `...` of stub, then run this cell again."]
    assert printed(capsys, 0.3) == ["P0: give the function itself, without calling it; this is a float."]


def test_a_line_a_seed_the_median_and_the_rivals_beside_it(toy, capsys):
    lines = printed(capsys, off_by(0.3))
    assert lines[0] == "P0: error of a thousandth; lower is better"
    assert lines[1:7] == [f"hidden seed {i + 1}: 0.30 m (for {SEEDS[i]})" for i in range(6)]
    assert lines[7].endswith("  median 0.30 m (95 % interval 0.30 to 0.30 over 6 seeds)")
    assert "median 0.50 m" in lines[8]
    assert lines[8].endswith("yours is better on 6 of 6")
    assert lines[9].endswith("yours is better on 0 of 6")
    assert lines[10] == "To beat next: ours, which is ahead of yours by 0.10 m."


def test_what_is_to_beat_is_the_nearest_ahead(toy, capsys):
    assert (
        printed(capsys, off_by(0.6))[-1] == "To beat next: the paper's own method, which is ahead of yours by 0.10 m."
    )
    assert printed(capsys, off_by(0.1))[-1].startswith("You beat all of them.")


def test_where_higher_is_better_the_other_way_round(toy, capsys, monkeypatch):
    monkeypatch.setattr(projects, "find_project", lambda name: dataclasses.replace(TOY, better="higher"))
    lines = printed(capsys, off_by(0.3))
    assert lines[-1] == "To beat next: the paper's own method, which is ahead of yours by 0.20 m."
    assert lines[9].endswith("yours is better on 6 of 6")


def quits(x):
    raise SystemExit


def never_ends(x):
    while True:
        pass


def divides(x):
    return x / 0 if x == SEEDS[2] else off_by(0.1)(x)


def test_whatever_a_submission_does_is_a_verdict_with_its_seed(toy, capsys):
    assert printed(capsys, quits)[1].startswith("hidden seed 1: Your function calls exit()")
    lines = printed(capsys, divides)
    assert lines[3].startswith("hidden seed 3: Your function stops with ZeroDivisionError in its line 2")
    assert "median 0.10 m over 6 seeds, 1 of 6 failed" in lines[7]
    assert printed(capsys, lambda x: [x])[1] == "hidden seed 1: Your function returns a list, not a number."
    assert printed(capsys, lambda x: [x])[-1] == "To beat: get it to run on every seed first."


def test_an_endless_loop_is_stopped_and_no_other_seed_waits_for_it(toy, capsys):
    lines = printed(capsys, never_ends)
    assert lines[1].startswith("hidden seed 1: Your function does not end within")
    assert lines[2:7] == [f"hidden seed {i}: not run: the seed before took too long" for i in range(2, 7)]


def test_what_it_prints_on_the_first_seed_is_shown(toy, capsys):
    def talks(x):
        print("frame", x)
        return off_by(0.1)(x)

    lines = printed(capsys, talks, seeds=[10_001, 10_002], rivals=False)
    assert lines[0] == "(your function prints) frame 10001.0"
    assert not any("10002.0" in line for line in lines)


def test_a_value_that_is_no_number_fails(toy):
    assert one_outcome(TOY, lambda x: float("nan"), 901).failed
    assert not one_outcome(TOY, off_by(0.0), 901).failed


def test_a_task_of_many_calls_is_measured_by_the_list_of_their_answers(toy):
    many = dataclasses.replace(
        TOY,
        many=True,
        prepare=lambda seed: Task(((1.0,), (2.0,), (3.0,)), None),
        measure=lambda task, answers: Result(sum(answers)),
    )
    assert one_outcome(many, lambda x: 10 * x, 901).value == 60
    assert one_outcome(many, lambda x: 1 / (x - 2), 901).remark.startswith("Your function stops with ZeroDivisionError")


def test_seeds_of_ones_own_run_the_rivals_too(toy, capsys):
    lines = printed(capsys, off_by(0.3), seeds=[10_001, 10_002])
    assert lines[1:3] == ["seed 10001: 0.30 m (for 10001)", "seed 10002: 0.30 m (for 10002)"]
    assert "median 0.50 m over 2 seeds; yours is better on 2 of 2" in lines[4]
    assert len(printed(capsys, off_by(0.3), seeds=[10_001], rivals=False)) == 3


@pytest.mark.parametrize("seeds", [[], [-1], [10_001, 903]])
def test_bad_seeds_and_hidden_ones_are_refused(toy, seeds):
    with pytest.raises(ValueError, match="seeds"):
        score("P0", off_by(0.3), seeds=seeds)


def test_stored_numbers_of_other_seeds_are_refused(toy, tmp_path):
    assert stored_rivals(TOY)["ours"] == ("ours", pytest.approx([0.2] * 6))
    path = tmp_path / "data" / "projects" / "P0.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | {"seeds": [1, 2]}))
    with pytest.raises(ValueError, match="other seeds"):
        stored_rivals(TOY)


def test_an_unknown_project_is_named():
    with pytest.raises(UnknownProjectError, match="no project 'P9'"):
        find_project("P9")


def test_the_stages_of_a_project_are_found_as_exercises_are():
    assert find_exercise("P1.1").number == "P1.1"
    assert {"03", *project_names()} <= set(lesson_numbers())


@pytest.mark.parametrize("name", project_names())
def test_every_project_is_whole(name):
    project = find_project(name)
    assert project.name == name
    assert len(set(project.seeds)) == len(project.seeds) >= 6
    assert min(project.seeds) >= 100, "seeds 1 to 99 report, those from 10,000 tune"
    assert max(project.seeds) < 10_000
    assert {"paper", "ours"} <= {rival.key for rival in project.rivals}
    for _, values in stored_rivals(project).values():
        assert np.isfinite(values).all()
