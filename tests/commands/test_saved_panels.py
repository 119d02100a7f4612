"""What is written of a notebook with widgets: their pictures, and a sentence where there is none."""

from __future__ import annotations

import copy

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output

from course_lib.commands import saved_panels
from course_lib.commands.saved_panels import SENTENCE, WIDGET_VIEW, keep_pictures

VIEW = {"model_id": "0123", "version_major": 2, "version_minor": 0}


def saved(data: dict) -> dict:
    """What is left of an output with these forms."""
    notebook = new_notebook(cells=[new_code_cell("x", outputs=[new_output("display_data", data)])])
    model = {"type": "notebook", "content": notebook}
    keep_pictures(model=model, path="a.ipynb", contents_manager=None)
    nbformat.validate(model["content"])
    return dict(model["content"]["cells"][0]["outputs"][0]["data"])


def test_a_panel_keeps_its_picture_and_loses_what_only_its_kernel_knew():
    picture = {"text/plain": "Panel 'x'", "text/html": "<img>"}
    assert saved(picture | {WIDGET_VIEW: VIEW}) == picture


def test_a_widget_without_a_picture_leaves_a_sentence():
    assert saved({"text/plain": "IntSlider(value=0)", WIDGET_VIEW: VIEW})["text/html"] == SENTENCE
    assert saved({WIDGET_VIEW: VIEW}) == {"text/html": SENTENCE}


@pytest.mark.parametrize("form", ["image/png", "text/markdown"])
def test_any_other_form_is_enough(form):
    assert saved({"text/plain": "a", form: "b", WIDGET_VIEW: VIEW}) == {"text/plain": "a", form: "b"}


def test_the_state_of_widgets_is_not_written():
    notebook = new_notebook(metadata={"widgets": {"application/vnd.jupyter.widget-state+json": {}}, "title": "a"})
    keep_pictures(model={"type": "notebook", "content": notebook})
    assert notebook.metadata == {"title": "a"}


def test_what_has_no_widgets_stays_as_it_is():
    cells = [new_markdown_cell("a"), new_code_cell("b", outputs=[new_output("stream", text="c"), new_output("error")])]
    cells[1].outputs.append(new_output("display_data", {"text/plain": "d"}))
    for model in (
        {"type": "notebook", "content": new_notebook(cells=cells)},
        {"type": "notebook"},  # a rename
        {"type": "file", "content": "text", "format": "text"},
        {"type": "directory"},
    ):
        before = copy.deepcopy(model)
        keep_pictures(model=model)
        assert model == before


def test_the_name_for_a_servers_configuration_is_the_function():
    from traitlets.utils.importstring import import_item

    assert import_item(saved_panels.HOOK) is keep_pictures
