"""`score` on a project made for the test: what it says of every kind of submission."""

import dataclasses
import json

import numpy as np
import pytest

from courseware.lessons.kit import projects
from courseware.lessons.kit.exercises import find_exercise, lesson_numbers
from courseware.lessons.kit.projects import Project, Result, Rival, Task, find_project, one_outcome, project_names

SEEDS = (901, 902, 903, 904, 905, 906)


def prepare(seed: int) -> Task:
    return Task((float(seed),), 0.001 * seed)


def measure(task: Task, answer: object) -> Result:
    if not isinstance(answer, float):
        raise projects.AnswerError(f"returns a {type(answer).__name__}, not a number")
    return Result(abs(answer - task.truth), f"for {task.arguments[0]:g}")


def off_by(amount: float):
    return lambda x: 0.001 * x + amount


TOY = Project(
    "P0", "error of a thousandth", "m", "lower", 2, "thousandth", SEEDS, prepare, measure,
    (Rival("paper", "the paper's own method", off_by(0.5)), Rival("ours", "ours", off_by(-0.2))), seconds=0.5,
)  # fmt: skip
HIGHER = dataclasses.replace(TOY, better="higher")
MANY = dataclasses.replace(
    TOY, many=True, prepare=lambda seed: Task(((1.0,), (2.0,), (3.0,)), None), measure=lambda task, a: Result(sum(a))
)


@pytest.fixture
def lines(monkeypatch, tmp_path, capsys):
    """What `score` prints of a function, for the toy project with its rivals stored."""
    (tmp_path / "courseware" / "answers").mkdir(parents=True)
    monkeypatch.setattr(projects, "REPOSITORY", tmp_path)
    monkeypatch.setattr(projects, "answers_folder", lambda: tmp_path / "courseware" / "answers")
    projects.store_rivals(TOY)

    def printed(function, project=TOY, **options) -> list[str]:
        monkeypatch.setattr(projects, "find_project", lambda name: project)
        projects.score("P0", function, **options)
        return capsys.readouterr().out.splitlines()

    return printed


def stub(x):
    """A task."""
    ...


def never_ends(x):
    while True:
        pass


def fails_on_the_third(x):
    return x / 0 if x == SEEDS[2] else off_by(0.1)(x)


def test_a_stub_is_not_attempted_and_a_value_is_no_function(lines):
    assert lines(stub) == ["P0: not attempted yet. Replace the `...` of stub, then run this cell again."]
    assert lines(0.3) == ["P0: give the function itself, without calling it; this is a float."]
    barred = dataclasses.replace(TOY, forbidden=("numpy",))
    assert lines(np.median, barred) == ["P0: your function uses numpy, which this project asks you to write yourself."]


def test_a_line_a_seed_the_median_and_the_rivals_beside_it(lines):
    assert lines(off_by(0.3)) == [
        "P0: error of a thousandth; lower is better",
        *(f"hidden seed {i + 1}: 0.30 m (for {SEEDS[i]})" for i in range(6)),
        "yours                   median 0.30 m (95 % interval 0.30 to 0.30 over 6 seeds)",
        "the paper's own method  median 0.50 m (95 % interval 0.50 to 0.50 over 6 seeds); yours is better on 6 of 6",
        "ours                    median 0.20 m (95 % interval 0.20 to 0.20 over 6 seeds); yours is better on 0 of 6",
        "To beat next: ours, which is ahead of yours by 0.10 m.",
    ]


@pytest.mark.parametrize(
    ("project", "amount", "last"),
    [
        (TOY, 0.6, "To beat next: the paper's own method, which is ahead of yours by 0.10 m."),
        (TOY, 0.1, "You beat all of them. To beat: your own number; it can always be better."),
        (TOY, np.nan, "To beat: get it to run on every seed first."),
        (HIGHER, 0.3, "To beat next: the paper's own method, which is ahead of yours by 0.20 m."),
        (HIGHER, 0.1, "To beat next: ours, which is ahead of yours by 0.10 m."),
        (HIGHER, 0.6, "You beat all of them. To beat: your own number; it can always be better."),
    ],
)
def test_what_is_to_beat_is_the_nearest_ahead(lines, project, amount, last):
    assert lines(off_by(amount), project)[-1] == last


@pytest.mark.parametrize(
    ("function", "line", "words"),
    [
        (quit, 1, "hidden seed 1: Your function calls exit()"),
        (fails_on_the_third, 3, "hidden seed 3: Your function stops with ZeroDivisionError in its line 2"),
        (fails_on_the_third, 4, "hidden seed 4: 0.10 m"),
        (fails_on_the_third, 7, "yours                   median 0.10 m over 6 seeds, 1 of 6 failed"),
        (lambda x: [x], 1, "hidden seed 1: Your function returns a list, not a number."),
        (lambda x: [x], 7, "yours                   no median: 6 of 6 seeds failed"),
        (lambda x: float("nan"), 6, "hidden seed 6: failed: for 906"),
        (never_ends, 1, "hidden seed 1: Your function does not end within"),
        (never_ends, 6, "hidden seed 6: not run: the seed before took too long"),
    ],
)
def test_whatever_a_submission_does_is_a_verdict_with_its_seed(lines, function, line, words):
    assert lines(function)[line].startswith(words)


def test_a_failed_seed_is_the_worst_and_a_task_of_many_calls_is_measured_by_the_list_of_their_answers():
    assert [one_outcome(project, stub, 901).value for project in (TOY, HIGHER)] == [np.inf, -np.inf]
    found = one_outcome(MANY, lambda x: print(x) or 10 * x, 901)
    assert (found.value, found.printed) == (60, "1.0\n")
    assert one_outcome(MANY, lambda x: 1 / (x - 2), 901).remark.startswith("Your function stops with ZeroDivisionError")


def test_seeds_of_ones_own_run_the_rivals_too_and_what_the_first_prints_is_shown(lines):
    found = lines(lambda x: print("frame", x) or off_by(0.3)(x), seeds=[10_001, 10_002])
    assert found[0] == "(your function prints) frame 10001.0"
    assert found[2:4] == ["seed 10001: 0.30 m (for 10001)", "seed 10002: 0.30 m (for 10002)"]
    assert found[5].endswith("median 0.50 m over 2 seeds; yours is better on 2 of 2")
    assert len(lines(off_by(0.3), seeds=[10_001], rivals=False)) == 3


@pytest.mark.parametrize("seeds", [[], [-1], [10_001, 903]])
def test_bad_seeds_and_hidden_ones_are_refused(lines, seeds):
    with pytest.raises(ValueError, match="seeds"):
        lines(off_by(0.3), seeds=seeds)


@pytest.mark.parametrize("change", [{"seeds": [1, 2]}, {"rivals": {}}])
def test_stored_numbers_of_other_seeds_or_rivals_are_refused(lines, tmp_path, change):
    assert projects.stored_rivals(TOY)["ours"] == ("ours", pytest.approx([0.2] * 6))
    path = tmp_path / "courseware" / "answers" / "project_0.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | change))
    with pytest.raises(ValueError, match="other seeds"):
        projects.stored_rivals(TOY)


def test_an_unknown_project_is_named_and_stages_are_found_as_exercises_are():
    with pytest.raises(projects.UnknownProjectError, match="no project 'P9'; there are P1, P2"):
        find_project("P9")
    assert find_exercise("P1.1").number == "P1.1"
    assert {"03", *project_names()} <= set(lesson_numbers())


@pytest.mark.parametrize("name", project_names())
def test_every_project_is_whole(name):
    project = find_project(name)
    assert project.name == name
    assert len(set(project.seeds)) == len(project.seeds) >= 6
    assert all(100 <= seed < 10_000 for seed in project.seeds), "seeds 1 to 99 report, those from 10,000 tune"
    assert {"paper", "ours"} <= {rival.key for rival in project.rivals}
    for _, values in projects.stored_rivals(project).values():
        assert np.isfinite(values).all()
