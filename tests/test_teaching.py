"""TEACHING.md: plans whose minutes add up, an entry for every lesson, foundation and project, hints that exist, a table
of costs for every notebook, and an example exercise that really is one."""

import re
from dataclasses import replace
from importlib.util import module_from_spec, spec_from_file_location

import numpy as np
import pytest

from courseware.lessons.kit.exercises import find_exercise, judge, lesson_exercises
from courseware.lessons.kit.mistakes import read_hints
from courseware.paths import REPOSITORY, foundation_paths, notebook_paths, project_paths
from tests.notebooks.conftest import read
from tests.notebooks.test_pace import HINTS
from tools.bench_tables import capacity_sentence, lessons_rows
from tools.refresh import solution_cell, stub_cell, with_example

TEACHING = (REPOSITORY / "TEACHING.md").read_text(encoding="utf-8")
PATHS = {path.name[:2]: path for path in [*notebook_paths(), *project_paths()]}
FOUNDATIONS = {path.name[:2]: path for path in foundation_paths()}
PARTS = ["Before", "Together", "After", "Mistakes"]


def minutes_of(number: str) -> int:
    return read((PATHS | FOUNDATIONS)[number]).minutes


def section(heading: str) -> str:
    """Text below a heading that begins so, up to the next heading of its level or above."""
    marks, text = re.search(rf"^(#+) {re.escape(heading)}.*\n((?:.*\n)*)", TEACHING, re.M).groups()
    return re.split(rf"^#{{1,{len(marks)}}} ", text, maxsplit=1, flags=re.M)[0]


def cells_of(rows: list[str]) -> list[list[str]]:
    return [[cell.strip() for cell in row.split("|")[1:-1]] for row in rows]


PLANS = re.findall(r"^### ((\w+) meetings of (\d+) minutes.*)$", TEACHING, re.M)
COUNTS = {"Two": 2, "Eight": 8, "Fifteen": 15}


def rows_of(plan: str) -> list[list[str]]:
    return cells_of(re.findall(r"^\| \d+ \|.*$", section(plan), re.M))


@pytest.mark.parametrize(("plan", "count", "length"), PLANS, ids=lambda value: str(value)[:8])
def test_the_minutes_of_a_plan_add_up_and_it_has_each_lesson_once_and_in_order(plan, count, length):
    assert [COUNTS[count] for _, count, _ in PLANS] == [15, 8, 2]
    rows = rows_of(plan)
    assert [int(row[0]) for row in rows] == list(range(1, COUNTS[count] + 1))
    for _, in_class, lessons, talk, at_home in rows:
        assert sum(minutes_of(number) for number in in_class.split(", ")) == int(lessons)
        assert int(lessons) + int(talk) == int(length)
        for number, minutes in re.findall(r"lesson (\d\d) \((\d+) min\)", at_home):
            assert minutes_of(number) == int(minutes)
        for number, hours in re.findall(r"(P\d) \(([\d.]+) h\)", at_home):
            assert minutes_of(number) == 60 * float(hours)
        for number in re.findall(r"\b\d\d\.\d\b", at_home):
            assert find_exercise(number).level == "challenge"
    lessons = re.findall(r"\b(\d\d)\b(?![.\d])", " ".join(f"{row[1]} {row[4]}" for row in rows))
    lessons = [number for number in lessons if number in PATHS]
    assert len(lessons) == len(set(lessons))
    in_class = [number for row in rows for number in row[1].split(", ")]
    assert in_class == sorted(in_class)
    left_out = re.search(r"^Left out: ([\d, ]+)\.", section(plan), re.M)
    if left_out or count == "Fifteen":
        missing = left_out[1].split(", ") if left_out else []
        in_series = [path.name[:2] for path in notebook_paths()]
        assert sorted(lessons + missing) == in_series, (
            "section 2: the plan has each lesson, or says that it leaves it out"
        )


@pytest.mark.parametrize("number", [*PATHS, *FOUNDATIONS])
def test_every_lesson_foundation_and_project_has_its_entry_with_its_time_and_a_question(number):
    heading = re.search(rf"^### {number} · .* \(([\d.]+) (min|h)\)$", TEACHING, re.M)
    assert heading, "section 3 lacks its entry"
    assert float(heading[1]) * (60 if heading[2] == "h" else 1) == minutes_of(number)
    entry = section(f"{number} · ")
    assert re.findall(r"^\* \*\*(\w+)\.\*\*", entry, re.M) == PARTS
    before = entry.partition("* **Together")[0]
    assert re.search(r"\*[^*]+\?[^*]*\*", before), "the question that opens the lesson stands in italics"
    assert len(re.findall(rf"\b{number}\.\d \"", entry)) >= 2


@pytest.mark.parametrize(("number", "quoted"), re.findall(r"\b(\d\d\.\d|[PF]\d\.\d) \"([^\"]+)\"", TEACHING))
def test_a_quoted_mistake_is_a_hint_of_that_exercise(number, quoted):
    hints = [mistake.hint for mistake in find_exercise(number).known]
    assert any(" ".join(quoted.split()) in hint for hint in hints), hints


def test_points_are_those_of_the_exercises():
    points = {level: int(full) for level, full in re.findall(r"^\| ([a-z-]+) \| (\d) \| \d \| 0 \|$", TEACHING, re.M)}
    assert set(points) == {"warm-up", "core", "challenge"}
    sums = {path.name[:2]: [points[e.level] for e in lesson_exercises(path.name[:2])] for path in notebook_paths()}
    told = re.search(r"(\d+) lessons have (\d+) exercises, (\d+) points", TEACHING).groups()
    counted = [len(sums), sum(map(len, sums.values())), sum(map(sum, sums.values()))]
    assert [int(n) for n in told] == counted, "section 5: lessons, exercises and points"


COSTS = re.search(r"<!-- costs: measured on \S+, \d+ processors, by (.*?) -->\n(.*?)<!-- end", TEACHING, re.S)


def test_the_costs_have_a_row_for_every_lesson_and_project_and_say_where_from():
    assert COSTS[1] == ".venv/bin/python -m tools.bench --lessons"
    lines = re.findall(r"^\|.*$", COSTS[2], re.M)
    _, _, *rows, greatest, together, server = cells_of(lines)
    assert [row[0] for row in rows] == list(PATHS), "section 1: run `python -m tools.bench --lessons NN`, add its row"
    numbers = np.array([[float(cell) for cell in row[1:]] for row in rows])
    assert (numbers[:, 1] < numbers[:, 0]).all(), "the student's own memory is a part of all"
    assert [float(cell) for cell in greatest[1:]] == numbers.max(axis=0).tolist()
    assert [float(cell) for cell in together[1:]] == pytest.approx(numbers.sum(axis=0), abs=len(rows) / 2)
    keys = ("peak_mb", "own_mb", "processor_s")
    named = [dict(zip(keys, map(float, row[1:]), strict=True)) | {"name": row[0]} for row in [*rows, server]]
    printed = lessons_rows({"lessons": named[:-1], "server": named[-1]})
    assert printed[:2] == lines[:2], "the heading is the command's"
    sentences = re.findall(r"^One server of (\d+) GiB and (\d+) processors.*$", COSTS[2], re.M)
    assert len(sentences) >= 1
    for gib, processors in sentences:
        said = capacity_sentence({"lessons": named[:-1], "server": named[-1]}, float(gib), float(processors))
        assert said in COSTS[2]


def test_the_example_exercise_is_one(tmp_path):
    """The code and the cells of section 10: the stub is not passed, the solution is, mistakes get their own hints."""
    code = re.search(r"```python\n(.*?)```", TEACHING, re.S)[1]
    cells = re.split(r"^%% ", re.search(r"```\n(%% .*?)```", TEACHING, re.S)[1], flags=re.M)[1:]
    (tmp_path / "example.hints").write_text(re.search(r"```\n(\[.*?)```", TEACHING, re.S)[1])
    assert [cell.partition("\n")[0] for cell in cells] == ["task", "exercise", "check", "hint", "solution"]
    imports = "import numpy as np\n\nfrom courseware.lessons.kit.exercise import Exercise\n\n\n"
    (tmp_path / "example.py").write_text(imports + code)
    spec = spec_from_file_location("example", tmp_path / "example.py")
    example = module_from_spec(spec)
    spec.loader.exec_module(example)
    ((number, mistakes),) = read_hints(tmp_path / "example.hints").items()
    exercise = replace(example.POLES, mistakes=mistakes)
    assert exercise.number == number
    assert exercise.number not in [known.number for known in lesson_exercises(exercise.number[:2])], "it is an example"
    student: dict = {"np": np}
    exec(stub_cell(exercise), student)
    assert judge(exercise, student["greatest_depth"]).status == "not attempted"
    exec(solution_cell(exercise), student)
    assert judge(exercise, student["greatest_depth_solution"]).status == "right"
    for mistake in exercise.known:
        assert mistake.hint in judge(exercise, mistake.functions[0]).message
    assert f'check("{exercise.number}", greatest_depth)' in cells[2]
    assert cells[3].count("<details>") == HINTS[0]
    assert cells[0] == with_example(cells[0], exercise)
