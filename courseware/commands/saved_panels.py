"""What a saved notebook keeps of its widgets: pictures and words, which show without a kernel.

A saved widget is only the name of an object in a running kernel, so opened on the next day it says "Error displaying
widget". This hook takes it out of what is written; the open document keeps its moving panel. `course.py lab` sets it;
on a hub it is one line of the server's configuration:

    c.FileContentsManager.pre_save_hook = "courseware.commands.saved_panels.keep_pictures"
"""

WIDGET_VIEW = "application/vnd.jupyter.widget-view+json"
HOOK = f"{__name__}.keep_pictures"
# For widgets of other makers: theirs have no picture of their own.
SENTENCE = "<p>Controls were shown here: run this cell again to see them.</p>"


def keep_pictures(model: dict, **_: object) -> None:
    """Server's hook before saving: `drop_widgets` from a notebook about to be written; other files stay as they are."""
    if model.get("type") == "notebook" and isinstance(model.get("content"), dict):
        drop_widgets(model["content"])


def drop_widgets(notebook: dict) -> None:
    """Take widgets' views and state out of a notebook, in place; what then would show nothing says so in a sentence.

    notebook: as JSON, format 4; written by anybody, so parts may be missing.
    """
    notebook.get("metadata", {}).pop("widgets", None)
    for cell in notebook.get("cells", []):
        for output in cell.get("outputs", []):
            data = output.get("data", {})
            if data.pop(WIDGET_VIEW, None) is not None and set(data) <= {"text/plain"}:
                data["text/html"] = SENTENCE
