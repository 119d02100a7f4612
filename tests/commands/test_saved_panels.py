"""What is written of a notebook with widgets: their pictures, and a sentence where there is none."""

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_notebook, new_output

from courseware.commands.saved_panels import SENTENCE, WIDGET_VIEW, keep_pictures

VIEW = {WIDGET_VIEW: {"model_id": "0123", "version_major": 2, "version_minor": 0}}


@pytest.mark.parametrize(
    ("shown", "kept"),
    [
        ({"text/plain": "Panel 'x'", "text/html": "<img>"}, {"text/plain": "Panel 'x'", "text/html": "<img>"}),
        ({"text/plain": "IntSlider(value=0)"}, {"text/plain": "IntSlider(value=0)", "text/html": SENTENCE}),
        ({}, {"text/html": SENTENCE}),
        ({"text/plain": "a", "image/png": "b"}, {"text/plain": "a", "image/png": "b"}),
    ],
)
def test_a_widget_keeps_its_picture_or_leaves_a_sentence(shown, kept):
    notebook = new_notebook(cells=[new_code_cell("x", outputs=[new_output("display_data", shown | VIEW)])])
    notebook.metadata["widgets"] = {"application/vnd.jupyter.widget-state+json": {}}
    keep_pictures(model={"type": "notebook", "content": notebook}, path="a.ipynb", contents_manager=None)
    nbformat.validate(notebook)
    assert dict(notebook["cells"][0]["outputs"][0]["data"]) == kept
    assert "widgets" not in notebook.metadata
