"""Rules that every stored notebook keeps (nbval compares the outputs themselves)."""

import ast
import re

from courseware.commands.nbval_tolerance import declared_tolerance
from courseware.commands.saved_panels import WIDGET_VIEW
from courseware.paths import REPOSITORY, foundation_paths, notebook_paths
from tests.notebooks.conftest import read
from tools.refresh import MAX_BYTES, METADATA

FORBIDDEN_WIDGETS = {"Output", "interact", "interactive", "interactive_output", "interact_manual", "Play"}
MAX_SCENE_BYTES, MAX_SCENES_BYTES = 1_300_000, 15_000_000
OPT_OUT = re.compile("nbval.(ignore.output|skip|raises.exception)|validate.ignore.output|raises-exception", re.I)
"""By what nbval does not compare a cell's output, in a comment or as a tag."""
LESSONS = [read(path) for path in [*notebook_paths(), *foundation_paths()]]
SHOWN_TYPES = {"text/plain", "text/html", "text/markdown", "text/latex"}


def test_outputs_are_what_was_shown_and_printed_no_error_and_no_bare_object(lesson):
    for output in lesson.outputs:
        assert output.output_type not in ("error", "execute_result")
        assert output.get("name") != "stderr"
        assert set(output.get("data", {})) <= SHOWN_TYPES
    for cell in lesson.code_cells:
        last = ast.parse(cell.source).body[-1] if cell.source.strip() else None
        if isinstance(last, ast.Expr) and not cell.source.rstrip().endswith(";"):
            assert isinstance(last.value, ast.Call), f"{cell.id} ends in a bare object"


def test_lines_fit_the_page(lesson):
    assert [line for cell in lesson.code_cells for line in cell.source.splitlines() if len(line) > 120] == []


def test_what_only_the_tests_need_is_out_of_the_readers_sight(lesson):
    for cell in lesson.visible_code_cells:
        assert not re.search("numbers within|nbval", cell.source, re.I), f"{cell.id}: say it in the cell's metadata"
        declared_tolerance(cell)


def test_few_cells_opt_out_of_comparison_and_each_says_why():
    cells = [cell for lesson in LESSONS for cell in lesson.code_cells]
    opted_out = [cell for cell in cells if OPT_OUT.search(" ".join([cell.source, *cell.metadata.get("tags", [])]))]
    assert len(opted_out) <= 0.01 * len(cells)
    for cell in opted_out:
        assert len(cell.metadata.get("because", "")) > 10, f"{cell.id} says no reason in its metadata"


def test_the_file_is_small_run_from_top_to_bottom_and_stores_no_widget_state(lesson):
    assert [cell.execution_count for cell in lesson.code_cells] == list(range(1, len(lesson.code_cells) + 1))
    ids = {cell.id for cell in lesson.cells}
    assert len(ids) == len(lesson.cells)
    assert all(re.fullmatch(rf"{lesson.number}-[a-z0-9-]+", one) for one in ids)
    assert lesson.path.stat().st_size <= MAX_BYTES
    assert WIDGET_VIEW not in lesson.path.read_text(encoding="utf-8")
    assert lesson.notebook.metadata == METADATA


def test_every_picture_has_alternative_text_which_is_told_out_of_sight(lesson):
    text = "\n".join([*lesson.html, lesson.markdown])
    images = [re.search(r'\balt="([^"]*)"|$', image)[1] or "" for image in re.findall(r"<img\b[^>]*>", text)]
    images += re.findall(r"!\[([^\]]*)\]\(", lesson.markdown)
    assert [alt for alt in images if len(alt.split()) < 4] == []
    frames = re.findall(r"<iframe\b[^>]*>", text)
    assert [frame for frame in frames if not re.search(r'\btitle="[^"]{8,}"', frame)] == []
    for cell in [cell for cell in lesson.visible_code_cells if not cell.metadata.get("exercise")]:
        assert not [n for n in ast.walk(ast.parse(cell.source)) if isinstance(n, ast.keyword) and n.arg == "alt"], (
            cell.id
        )


def test_the_first_and_the_last_cell_link_to_the_neighbours_and_to_the_series(lesson):
    neighbours = sorted(lesson.path.parent.glob("[0-9FP][0-9]_*.ipynb"))
    here = neighbours.index(lesson.path)
    wanted = {"README.md", *(path.name for path in neighbours[max(here - 1, 0) : here + 2] if path != lesson.path)}
    for cell in (lesson.cells[0], lesson.cells[-1]):
        assert wanted <= {link.rsplit("/")[-1] for link in re.findall(r"\]\(([^)]+)\)", cell.source)}, cell.id


def scene_sources(lesson) -> list[str]:
    return re.findall(r'<iframe\b[^>]*\bsrc="([^"]+)"', "".join([*lesson.html, lesson.markdown]))


def test_every_stored_scene_is_shown_and_all_of_them_are_small():
    shown = {source for lesson in LESSONS for source in scene_sources(lesson)}
    stored = sorted((REPOSITORY / "notebooks" / "scenes").glob("*.html"))
    assert {f"scenes/{path.name}" for path in stored} == shown
    assert sum(path.stat().st_size for path in stored) <= MAX_SCENES_BYTES


def test_scenes_are_small_and_there_and_those_of_pyvista_have_their_picture(lesson):
    for source in scene_sources(lesson):
        assert re.fullmatch(rf"scenes/{lesson.number}_[a-z0-9_]+\.html", source)
        assert (lesson.path.parent / source).stat().st_size <= MAX_SCENE_BYTES
    for cell in lesson.code_cells:
        if "show_scene(" in cell.source:
            html = "".join(output.get("data", {}).get("text/html", "") for output in cell.outputs)
            assert re.search(r"</iframe><details><summary>[^<]+</summary><img alt=", html), cell.id


def test_nearly_every_printed_line_says_what_was_measured_not_whether_it_was_good():
    outputs = [o for lesson in LESSONS for o in lesson.outputs if o.get("name") == "stdout"]
    printed = [line for output in outputs for line in output.text.splitlines()]
    verdicts = [line for line in printed if re.search(r"\b(True|False)\b", line)]
    assert len(printed) >= 500
    assert len(verdicts) <= 10, verdicts


def names_in(source: str) -> set[str]:
    """Every name, attribute and imported name in a piece of code."""
    nodes = list(ast.walk(ast.parse(source)))
    named = {getattr(node, "attr", getattr(node, "id", None)) for node in nodes}
    return named | {node.name for node in nodes if isinstance(node, ast.alias)}


def test_no_lesson_uses_widgets_that_hang_or_global_random_numbers(lesson):
    for cell in lesson.code_cells:
        assert not names_in(cell.source) & FORBIDDEN_WIDGETS, cell.id
        assert not re.search(r"np\.random\.(?!default_rng|Generator)", cell.source), cell.id


def test_cells_call_what_the_lessons_modules_hold_and_no_variable_takes_the_name_of_a_module(lesson):
    nodes = [node for cell in lesson.code_cells for node in ast.walk(ast.parse(cell.source))]
    imported = {
        alias.name: REPOSITORY.joinpath(*node.module.split("."), f"{alias.name}.py")
        for node in nodes
        if isinstance(node, ast.ImportFrom) and node.module.startswith("courseware.lessons.")
        for alias in node.names
    }
    modules = {name: path.read_text(encoding="utf-8") for name, path in imported.items() if path.is_file()}
    for node in nodes:
        if isinstance(node, ast.Attribute) and getattr(node.value, "id", None) in modules:
            at_the_top = rf"^(def |class |(\w+, )*){node.attr}\b"
            assert re.search(at_the_top, modules[node.value.id], re.M), f"{node.value.id}.{node.attr}"
        assert not (isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store) and node.id in modules), node.id


def test_no_plumbing_uses_widgets_that_hang():
    for path in (REPOSITORY / "courseware" / "lessons").glob("**/*.py"):
        assert not names_in(path.read_text(encoding="utf-8")) & FORBIDDEN_WIDGETS, path.name
