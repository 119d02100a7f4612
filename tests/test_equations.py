"""Every equation of paper 1 is cited by exactly one function and taught by at least one lesson."""

import ast
import re
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "course_lib"
NOTEBOOKS = Path(__file__).parents[1] / "notebooks"
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


def citations() -> dict[int, list[str]]:
    """Equation number -> functions whose docstring names it as its source ("Source: paper 1, eq. (8)")."""
    found: dict[int, list[str]] = {}
    for path in sorted(PACKAGE.glob("**/*.py")):
        for node in ast.walk(ast.parse(path.read_text())):
            if not isinstance(node, ast.FunctionDef):
                continue
            for numbers in re.findall(r"Source:\s+paper 1,\s+eqs?\.?\s+([(\d), ]+)", ast.get_docstring(node) or ""):
                for number in re.findall(r"\d+", numbers):
                    found.setdefault(int(number), []).append(node.name)
    return found


@pytest.mark.parametrize(("number", "function"), WHERE.items())
def test_every_equation_is_cited_by_exactly_one_function(number, function):
    assert citations().get(number) == [function]


def test_no_other_equation_is_cited():
    assert sorted(citations()) == sorted(WHERE)


@pytest.mark.parametrize("number", WHERE)
def test_every_equation_is_taught_by_at_least_one_lesson(number):
    """A lesson that teaches an equation shows it with its number (LESSONS: the equation with its number)."""
    lessons = [path for path in sorted(NOTEBOOKS.glob("[0-9][0-9]_*.ipynb")) if f"tag{{{number}}}" in path.read_text()]
    assert lessons, f"no lesson shows equation ({number}) with \\tag{{{number}}}"
