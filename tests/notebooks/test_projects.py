"""Projects: stages that are exercises, a score at the end, a rubric, hours, and a model solution apart that does it."""

import ast
import importlib
import importlib.util
import re

import pytest

from courseware.classroom.points import BY_HAND, SCORE_POINTS, most_of
from courseware.lessons.kit.exercises import find_exercise, judge, lesson_exercises
from courseware.lessons.kit.forbidden import forbidden_module
from courseware.lessons.kit.projects import find_project, is_better, one_outcome, project_names, stored_rivals
from courseware.paths import REPOSITORY, project_paths
from tests.notebooks.test_exercise_cells import SEEDS, functions_of, only, require_unsolved_stub, stub_of

SOLUTIONS = REPOSITORY / "notebooks" / "projects" / "solutions"


def model_solution(project):
    """The module notebooks/projects/solutions/P1_model_solution.py."""
    path = SOLUTIONS / f"{project.number}_model_solution.py"
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_title_promises_and_says_how_long_and_how_it_is_marked_and_no_hidden_seed_is_told(project):
    names = [path.name[:2] for path in project_paths()]
    assert names == project_names() == sorted(path.name[:2] for path in SOLUTIONS.glob("*_model_solution.py"))
    numbers = set(re.findall(r"\d+", project.path.read_text(encoding="utf-8")))
    assert not numbers & {str(seed) for seed in find_project(project.number).seeds}
    title = project.cells[0].source
    assert re.match(rf"# {project.number} · \S", title)
    assert project.minutes > 0
    rubric = project.markdown.split("## Rubric")[1]
    points = [int(p) for p in re.findall(r"\|\s*(\d+)\s*\|$", rubric, re.M)]
    stages = sum(most_of(exercise.number) for exercise in lesson_exercises(project.number))
    assert points == [stages, SCORE_POINTS, BY_HAND], "one scale, that of `course.py grade`"
    assert re.search(rf"\*\*{sum(points)} points\*\*", rubric), "the rubric says the sum of its points"


def test_the_stages_are_complete_and_the_library_knows_them(project):
    numbers = project.exercise_numbers()
    assert len(numbers) >= 4
    assert numbers == [exercise.number for exercise in lesson_exercises(project.number)]
    for number in numbers:
        assert only(project.exercise_cells(number, "task")).source.startswith(f"### {number} ")
        hints = "".join(cell.source for cell in project.exercise_cells(number, "hint"))
        assert 2 <= hints.count("<details>") == hints.count("</details>") <= 3
        assert "?" in hints.split("</details>")[0], "the first hint is a question"
        assert "```" not in hints, "a hint is not the code"
        assert not project.exercise_cells(number, "solution"), "the model solution stands apart"


def test_each_check_calls_the_stub_above_and_says_not_attempted_and_so_does_the_score(project):
    for number in project.exercise_numbers():
        require_unsolved_stub(project, number)
    tagged = {tag: cell for cell in project.code_cells for tag in cell.metadata.get("tags", [])}
    cell = tagged["score"]
    ((name, stub),) = functions_of(project, tagged["submission"]).items()
    assert name == find_project(project.number).function
    assert stub.__doc__
    assert ast.unparse(ast.parse(cell.source)) == f"score('{project.number}', {name})"
    assert "".join(o.text for o in cell.outputs).startswith(f"{project.number}: not attempted")


def test_the_model_solution_passes_every_stage_without_what_is_forbidden(project):
    module, scored = model_solution(project), find_project(project.number)
    assert forbidden_module(getattr(module, scored.function), scored.forbidden) is None
    for number in project.exercise_numbers():
        (name,) = stub_of(project, number)
        for seed in SEEDS:
            verdict = judge(find_exercise(number), getattr(module, name), seed)
            assert verdict.status == "right", f"{number}: {verdict.message}"


def test_the_package_hands_on_what_the_notebook_names(project):
    package = importlib.import_module(f"courseware.lessons.project_{project.number[1:]}")
    code = "\n".join(cell.source for cell in project.code_cells)
    assert set(re.findall(rf"\bproject_{project.number[1:]}\.(\w+)", code)) <= set(dir(package))


@pytest.mark.slow
def test_on_a_hidden_seed_the_model_solution_beats_the_paper_and_rivals_are_as_stored(project):
    found = find_project(project.number)
    outcome = one_outcome(found, getattr(model_solution(project), found.function), found.seeds[0])
    assert not outcome.failed, outcome.remark
    stored = stored_rivals(found)
    assert is_better(found, outcome.value, stored["paper"][1][0])
    for rival in found.rivals:
        outcome = one_outcome(found, rival.function, found.seeds[0])
        assert outcome.value == pytest.approx(stored[rival.key][1][0], rel=0.05)
