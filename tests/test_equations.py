"""Every equation of both papers is cited by exactly one function; its steps too; lessons teach them all."""

import ast
import functools
import re
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "course_lib"
NOTEBOOKS = Path(__file__).parents[1] / "notebooks"
# Paper, equation -> the function that computes it.
WHERE = {
    (1, 1): "pose_matrix",
    (1, 2): "pose_matrix",
    (1, 3): "initial_particles",
    (1, 4): "initial_particles",
    (1, 5): "propagate",
    (1, 6): "render",
    (1, 7): "depth_image_from_points",
    (1, 8): "likelihood",
    (1, 9): "normalize_likelihood",
    (1, 10): "weights",
    (1, 11): "weights",
    (1, 12): "weighted_mean_state",
    (2, 1): "penalty",
}
# Section of paper 2 -> the functions that do its step, and the lessons that teach it. Lessons 00 to 10 teach paper 1.
STEPS_OF_PAPER_2 = {
    "2.2": (("YoloDetector", "extend_seam"), (11, 12)),
    "2.3": (("match_objects",), (13,)),
    "2.4": (("pixel_to_direction", "triangulate"), (14,)),
    "2.5": (("associate_greedy",), (15,)),
    "2.6": (("fit_rigid_2d",), (16,)),
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


@pytest.mark.parametrize("paper", [1, 2])
def test_every_equation_is_cited_by_exactly_one_function(paper):
    assert citations(paper) == {number: [name] for (where, number), name in WHERE.items() if where == paper}


@pytest.mark.parametrize(("section", "function"), [(s, f) for s, (names, _) in STEPS_OF_PAPER_2.items() for f in names])
def test_every_step_of_paper_2_is_cited_by_the_function_that_does_it(section, function):
    texts = [text for name, text in docstrings() if name == function]
    assert len(texts) == 1, f"{len(texts)} definitions of {function}"
    cited = re.findall(r"Source:\s+paper 2,\s+(?:sections?\s+)([\d., ]+)", texts[0])
    assert section in re.findall(r"\d\.\d", " ".join(cited))


def test_every_equation_and_step_is_taught_by_its_lessons():
    texts = {int(path.name[:2]): path.read_text(encoding="utf-8") for path in NOTEBOOKS.glob("[0-9][0-9]_*.ipynb")}
    of_paper_1 = "".join(texts[lesson] for lesson in range(11))
    assert [number for paper, number in WHERE if paper == 1 and f"tag{{{number}}}" not in of_paper_1] == []
    assert "tag{1}" in texts[15]
    for section, (_, taught_in) in STEPS_OF_PAPER_2.items():
        for lesson in taught_in:
            assert section in texts[lesson], f"lesson {lesson} must name section {section} of paper 2"
