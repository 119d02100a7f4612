"""Every equation of both papers is cited by exactly one function; its steps too; lessons teach them all."""

import ast
import functools
import re
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "course_lib"
NOTEBOOKS = Path(__file__).parents[1] / "notebooks"
# Equation of paper 1 -> the function that computes it.
WHERE = {
    1: "pose_matrix",
    2: "pose_matrix",
    3: "initial_particles",
    4: "initial_particles",
    5: "propagate",
    6: "render",
    7: "depth_image_from_points",
    8: "likelihood",
    9: "normalize_likelihood",
    10: "weights",
    11: "weights",
    12: "weighted_mean_state",
}


# Equation of paper 2 -> the function that computes it; section of paper 2 -> the functions that do its step.
WHERE_IN_PAPER_2 = {1: "penalty"}
STEPS_OF_PAPER_2 = {
    "2.2": ("YoloDetector", "extend_seam"),
    "2.3": ("match_objects",),
    "2.4": ("pixel_to_direction", "triangulate"),
    "2.5": ("associate_greedy",),
    "2.6": ("fit_rigid_2d",),
}
# Lessons 00 to 10 teach paper 1, these teach paper 2 (number of the lesson -> equations, sections).
LESSONS_OF_PAPER_2 = {
    11: ((), ("2.2",)),
    12: ((), ("2.2",)),
    13: ((), ("2.3",)),
    14: ((), ("2.4",)),
    15: ((1,), ("2.5",)),
    16: ((), ("2.6",)),
}


@functools.cache
def docstrings() -> list[tuple[str, str]]:
    """Name and docstring of every function and class of the package; a class answers for its constructor too."""
    found = []
    for path in sorted(PACKAGE.glob("**/*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef):
                found.append((node.name, ast.get_docstring(node) or ""))
            elif isinstance(node, ast.ClassDef):
                inits = [part for part in node.body if isinstance(part, ast.FunctionDef) and part.name == "__init__"]
                found.append((node.name, "\n".join(ast.get_docstring(part) or "" for part in (node, *inits))))
    return found


def citations(paper: int) -> dict[int, list[str]]:
    """Equation number -> functions whose docstring names it as its source ("Source: paper 1, eq. (8)")."""
    found: dict[int, list[str]] = {}
    for name, text in docstrings():
        for numbers in re.findall(rf"Source:\s+paper {paper},\s+eqs?\.?\s+([(\d), ]+)", text):
            for number in re.findall(r"\d+", numbers):
                found.setdefault(int(number), []).append(name)
    return found


def lessons(numbers: range) -> dict[int, str]:
    """Number of a lesson -> its text, for the lessons of these numbers that exist."""
    paths = sorted(NOTEBOOKS.glob("[0-9][0-9]_*.ipynb"))
    return {int(path.name[:2]): path.read_text(encoding="utf-8") for path in paths if int(path.name[:2]) in numbers}


@pytest.mark.parametrize(("number", "function"), WHERE.items())
def test_every_equation_is_cited_by_exactly_one_function(number, function):
    assert citations(1).get(number) == [function]


@pytest.mark.parametrize(("number", "function"), WHERE_IN_PAPER_2.items())
def test_every_equation_of_paper_2_is_cited_by_exactly_one_function(number, function):
    assert citations(2).get(number) == [function]


@pytest.mark.parametrize(("paper", "where"), [(1, WHERE), (2, WHERE_IN_PAPER_2)])
def test_no_other_equation_is_cited(paper, where):
    assert sorted(citations(paper)) == sorted(where)


@pytest.mark.parametrize(("section", "function"), [(s, f) for s, names in STEPS_OF_PAPER_2.items() for f in names])
def test_every_step_of_paper_2_is_cited_by_the_function_that_does_it(section, function):
    texts = [text for name, text in docstrings() if name == function]
    assert len(texts) == 1, f"{len(texts)} definitions of {function}"
    cited = re.findall(r"Source:\s+paper 2,\s+(?:sections?\s+)([\d., ]+)", texts[0])
    assert section in re.findall(r"\d\.\d", " ".join(cited))


@pytest.mark.parametrize("number", WHERE)
def test_every_equation_is_taught_by_at_least_one_lesson(number):
    """A lesson that teaches an equation shows it with its number (LESSONS: the equation with its number)."""
    teaching = [lesson for lesson, text in lessons(range(11)).items() if f"tag{{{number}}}" in text]
    assert teaching, f"no lesson shows equation ({number}) with \\tag{{{number}}}"


def test_the_lessons_of_paper_2_show_its_equation_and_name_its_sections():
    """Of the lessons that exist. Together the planned ones teach every step."""
    planned = {section for _, sections in LESSONS_OF_PAPER_2.values() for section in sections}
    assert planned == set(STEPS_OF_PAPER_2)
    for lesson, text in lessons(range(11, 17)).items():
        equations, sections = LESSONS_OF_PAPER_2[lesson]
        for number in equations:
            assert f"tag{{{number}}}" in text, f"lesson {lesson} must show equation ({number}) of paper 2"
        for section in sections:
            assert section in text, f"lesson {lesson} must name section {section} of paper 2"
