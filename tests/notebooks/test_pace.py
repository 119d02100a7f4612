"""The core path of a lesson states the minutes of the model of tools/pace.py, and it needs no part *More*."""

import ast
import builtins
import re

from tools.pace import core_and_all, tags

HINTS = {0: 3, 8: 2, 15: 1}  # from this lesson on, for an exercise that is no challenge


def test_the_first_cell_states_the_minutes_of_the_model(lesson):
    core, everything = (part.minutes for part in core_and_all(lesson.notebook))
    assert f"**About {core} minutes** ({everything} with" in lesson.cells[0].source


def test_a_part_that_is_more_begins_with_a_folded_heading_and_ends_at_a_heading(lesson):
    for before, cell in zip(lesson.cells, lesson.cells[1:], strict=False):
        if "more" in tags(cell) and "more" not in tags(before):
            assert cell.source.startswith("### ")
            assert cell.metadata["jp-MarkdownHeadingCollapsed"] is True
        if "more" in tags(before) and "more" not in tags(cell):
            assert re.match("###? ", cell.source), f"{cell.id} would be folded, too"


def names(cell, kind: type) -> set[str]:
    return {n.id for n in ast.walk(ast.parse(cell.source)) if isinstance(n, ast.Name) and isinstance(n.ctx, kind)}


def test_the_core_path_needs_no_name_that_a_part_more_defines(lesson):
    known = set(dir(builtins))
    for cell in lesson.code_cells:
        if "more" in tags(cell):
            continue
        tree = ast.parse(cell.source)
        known |= {
            a.asname or a.name for n in ast.walk(tree) if isinstance(n, ast.Import | ast.ImportFrom) for a in n.names
        }
        known |= {n.name for n in ast.walk(tree) if isinstance(n, ast.FunctionDef | ast.ClassDef | ast.ExceptHandler)}
        known |= {n.arg for n in ast.walk(tree) if isinstance(n, ast.arg)} | names(cell, ast.Store)
        assert names(cell, ast.Load) <= known, cell.id


def test_hints_become_fewer_and_a_challenge_has_its_derivation_alone(lesson):
    for number in lesson.exercise_numbers():
        task = lesson.exercise_cells(number, "task")[0].source.partition("\n")[0]
        folds = "".join(c.source for c in lesson.exercise_cells(number, "hint")).count("<details>")
        if task.endswith("challenge"):
            assert folds == 1, number
        elif lesson.number.isdigit():
            wanted = next(n for first, n in reversed(HINTS.items()) if int(lesson.number) >= first)
            assert folds == wanted, f"{number}: hints here, and as many as HINTS asks for"


def test_figures_are_numbered_in_order_and_the_text_refers_to_them(lesson):
    number = lesson.number.removeprefix("0")
    captions = re.findall(r"<em>Figure (\w+)\.(\d+)\. ", "".join(lesson.html))
    assert captions == [(number, str(k + 1)) for k in range(len(captions))]
    assert len(captions) >= core_and_all(lesson.notebook)[1].figures
    for _, k in captions:
        assert re.search(rf"[Ff]igures? (?:\w+\.\d+(?:,| and|, and) )*{number}\.{k}\b", lesson.markdown), (
            f"Figure {number}.{k}"
        )


def test_what_a_paper_says_is_quoted_in_its_own_words(lesson):
    says = re.compile(r"\b[Pp]aper(?: [12])? (?:says|reports|writes|states|claims|names|concludes|suspects)\b")
    claims = [cell for cell in lesson.cells if cell.cell_type == "markdown" and says.search(cell.source)]
    assert [cell.id for cell in claims if "「" not in cell.source] == []
