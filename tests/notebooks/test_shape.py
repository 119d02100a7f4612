"""The shape of one lesson (nine parts in order) and what its text must have."""

import ast
import itertools
import re

import pytest

SECTIONS = ["Predict", "The idea", "The code", "Play", "Measure", "Break it", "Exercises", "Recap"]


def section(lesson, name: str) -> list:
    """Cells from the heading `name` up to the next heading of its level."""
    found, cells = False, []
    for cell in lesson.cells:
        heading = re.match(r"## (.+)", cell.source) if cell.cell_type == "markdown" else None
        if heading:
            found = heading.group(1).strip() == name
        if found:
            cells.append(cell)
    return cells


def text_of(cells: list) -> str:
    return "\n\n".join(cell.source for cell in cells if cell.cell_type == "markdown")


def test_sections_are_all_there_in_order_below_a_title_that_promises_and_says_how_long(lesson):
    assert re.findall(r"^## (.+?)\s*$", lesson.markdown, re.M) == SECTIONS
    levels = [len(marks) for marks in re.findall(r"^(#+) ", lesson.markdown, re.M)]
    assert (levels[0], levels.count(1)) == (1, 1)
    assert all(b - a <= 1 for a, b in itertools.pairwise(levels))
    title = lesson.cells[0].source
    assert re.match(rf"# {lesson.number} · \S", title)
    assert re.findall(r"^\* ", title, re.M), "promises"
    assert lesson.minutes > 0
    assert re.search(r"[Pp]aper", title)


def called(cell, name: str) -> ast.Call | None:
    """The call of the function `name` in a code cell, if there is one."""
    calls = [node for node in ast.walk(ast.parse(cell.source)) if isinstance(node, ast.Call)]
    return next((call for call in calls if isinstance(call.func, ast.Name) and call.func.id == name), None)


def typed_in(answer: ast.expr) -> str:
    """The words of an f-string that stand there as they are, without what is computed and how it is formatted."""
    formats = {node.format_spec for node in ast.walk(answer) if isinstance(node, ast.FormattedValue)}
    strings = [node for node in ast.walk(answer) if isinstance(node, ast.JoinedStr) and node not in formats]
    return "".join(part.value for string in strings for part in string.values if isinstance(part, ast.Constant))


def test_nothing_runs_before_the_prediction_and_every_one_has_a_box_right_below_it(lesson):
    first_code = [cell.cell_type for cell in lesson.cells].index("code")
    assert "## Predict" in text_of(lesson.cells[:first_code])
    assert "?" in text_of(section(lesson, "Predict"))
    text, asked = section(lesson, "Predict")[:2]
    assert asked.cell_type == "code"
    number, *questions = [argument.value for argument in called(asked, "predict").args]
    assert number == lesson.number
    assert len(questions) == len(re.findall(r"^\d+\. ", text.source, re.M))


def test_the_recap_sets_what_was_measured_beside_every_prediction(lesson):
    """The recall is the last code cell: everything that it speaks of was measured before."""
    last = lesson.code_cells[-1]
    asked = next(call for cell in lesson.code_cells if (call := called(cell, "predict")))
    number, *answers = called(last, "recall").args
    assert number.value == lesson.number
    assert len(answers) == len(asked.args) - 1
    for answer in answers:
        assert any(isinstance(node, ast.Name) for node in ast.walk(answer)), "an answer is computed in the lesson"
        assert not re.search(r"\d\.\d", typed_in(answer)), "a number that a cell measured is not typed in"


def test_promised_equations_are_shown_with_their_number_and_symbols(lesson):
    referred = {int(n) for n in re.findall(r"\beqs?\. \((\d+)\)", lesson.markdown)}
    assert referred <= set(range(1, 13)), "paper 1 has equations (1) to (12), paper 2 has (1)"
    promised = re.findall(r"\((\d+)\)", lesson.cells[0].source)
    if not promised:
        pytest.skip("this lesson promises no equation")
    taught = set(re.findall(r"\\tag\{(\d+)\}", lesson.markdown))
    assert set(promised) <= taught
    rows = re.findall(r"^\|.*\|$", text_of(section(lesson, "The idea")), re.M)
    assert len(rows) >= 4, "the idea has a table of symbols"
    assert "unit" in rows[0]


def test_the_idea_has_a_picture_before_its_first_equation(lesson):
    shown = [
        "".join([cell.source, *(o.get("data", {}).get("text/html", "") for o in cell.get("outputs", []))])
        for cell in section(lesson, "The idea")
    ]
    pictures = [k for k, text in enumerate(shown) if re.search(r"!\[[^\]]+\]\(|<img", text)]
    assert not any("$$" in text for text in shown[: pictures[0]]), "the picture comes first, then the equation"


def test_play_has_a_panel_and_asks_measure_and_break_it_print_numbers_as_does_every_figure(lesson):
    cells = section(lesson, "Play")
    shown = [o.data["text/plain"] for cell in cells for o in cell.get("outputs", []) if "data" in o]
    assert any(text.startswith("Panel '") for text in shown)
    assert "?" in text_of(cells)
    for name in ("Measure", "Break it"):
        outputs = [o for cell in section(lesson, name) for o in cell.get("outputs", [])]
        assert any(re.search(r"\d", o.get("text", "")) for o in outputs), name
    for cell in lesson.code_cells:
        shown = [o.data["text/plain"] for o in cell.outputs if "data" in o]
        if any(text.startswith("Picture:") for text in shown):
            printed = "".join(o.text for o in cell.outputs if "text" in o)
            assert re.search(r"\d", printed), f"{cell.id}: print what the figure shows"


def test_the_recap_names_terms_in_both_languages_and_says_what_to_read_next(lesson):
    recap = text_of(section(lesson, "Recap"))
    terms = [row for row in re.findall(r"^\|.*\|$", recap, re.M) if re.search(r"[\u3040-\u30ff\u4e00-\u9fff]", row)]
    assert len(terms) >= 3
    assert re.findall(r"^\d\. ", recap, re.M)
    further = re.search(r"\*\*Further reading\b(.+?)\*\*Next", recap, re.S)
    assert further, "**Further reading** stands before **Next:**"
    assert re.findall(r"\b(?:19|20)\d\d\b", further[1]), "works have their years"
