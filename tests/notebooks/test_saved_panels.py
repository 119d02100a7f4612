"""A lesson that was run, saved and opened again, or exported: the picture stands where the panel was."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from course_lib.commands.saved_panels import WIDGET_VIEW
from course_lib.paths import notebook_paths
from tests.notebooks.driven_lab import (
    SESSION_IS_IDLE,
    TOKEN,
    first_panel,
    open_lesson,
    run_cells,
    wait_for_a_picture,
)

LESSON = next(path.name for path in notebook_paths() if path.name.startswith("06"))
STILL = "Run this cell to move the controls."
BROKEN = "Error displaying widget"
HEADERS = {"Authorization": f"token {TOKEN}"}
# A question (such as whether a file that changed is to be overwritten) would wait for its answer for ever.
SAVE = """() => new Promise((resolve, reject) => {
    const asked = setInterval(() => {
        const dialog = document.querySelector('.jp-Dialog');
        if (dialog) reject(new Error(`saving asked: ${dialog.textContent}`));
    }, 100);
    window.jupyterapp.commands.execute('docmanager:save').then(() => resolve(true), reject)
        .finally(() => clearInterval(asked));
})"""
# The whole course of an autosave, with 15 s instead of two minutes: something changed, and JupyterLab's timer saves.
# Off at first and not faster: a save that begins while another is on its way finds the file changed, and asks.
# JupyterLab lets its timer and a person do so, and its timer twice; with one second it happened here in one of 20 runs.
AUTOSAVE = "@jupyterlab/docmanager-extension:plugin", '{"autosave": false, "autosaveInterval": 15}'
TOGGLE_AUTOSAVE = "() => window.jupyterapp.commands.execute('docmanager:toggle-autosave').then(() => true)"
IS_SAVED = "() => !window.jupyterapp.shell.currentWidget.context.model.dirty"
ADD_A_CELL = "() => window.jupyterapp.commands.execute('notebook:insert-cell-below').then(() => true)"


@pytest.fixture(scope="module")
def saved(browser, lab, lab_folder) -> Path:
    """Lesson 06 run up to its panel and saved: twice by hand, a slider moved between, and once by itself."""
    page = browser.new_page(viewport={"width": 1400, "height": 1000})
    plugin, settings = AUTOSAVE
    answer = page.request.put(f"{lab}/lab/api/settings/{plugin}", headers=HEADERS, data=json.dumps({"raw": settings}))
    assert answer.ok
    open_lesson(page, lab, LESSON)
    run_cells(page, False)
    panel = first_panel(page)
    page.evaluate(SAVE)
    wait_for_a_picture(page, panel, "keydown", lambda: page.keyboard.press("ArrowRight"))
    page.evaluate(SAVE)
    page.evaluate(ADD_A_CELL)
    assert not page.evaluate(IS_SAVED)
    page.evaluate(TOGGLE_AUTOSAVE)
    page.wait_for_function(IS_SAVED)
    page.evaluate(TOGGLE_AUTOSAVE)
    page.evaluate(SAVE)
    assert page.locator(".jp-Dialog").count() == 0, "no question such as whether a file that changed is overwritten"
    assert panel.locator(".noUi-handle").first.is_visible(), "the panel that is open still moves"
    page.close()
    return lab_folder / "notebooks" / LESSON


def panel_output(path: Path) -> dict:
    """The forms that are stored of the panel's output."""
    for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
        for output in cell.get("outputs", []):
            if "".join(output.get("data", {}).get("text/plain", "")).startswith("Panel '"):
                return output["data"]
    raise AssertionError("no panel was saved")


def looks_right(page) -> bool:
    """Whether the panel's picture, its numbers and the line about its controls are shown, and no error."""
    output = page.locator(".jp-OutputArea-output", has_text=STILL).first
    output.wait_for()
    width = output.locator("img").evaluate("image => image.decode().then(() => image.naturalWidth)")
    return width > 300 and output.locator("pre").count() == 1 and page.get_by_text(BROKEN).count() == 0


def test_a_saved_panel_is_its_picture(saved):
    assert set(panel_output(saved)) == {"text/plain", "text/html"}
    text = saved.read_text(encoding="utf-8")
    assert WIDGET_VIEW not in text
    assert "widgets" not in json.loads(text)["metadata"]


def test_opened_again_the_picture_stands_where_the_panel_was_with_its_kernel_and_without(browser, lab, saved):
    page = browser.new_page(viewport={"width": 1400, "height": 1000})
    open_lesson(page, lab, saved.name)
    assert page.locator(".jp-InputPrompt", has_text="[1]").count() > 0, "it shows what was saved"
    assert looks_right(page)

    sessions = page.request.get(f"{lab}/api/sessions?token={TOKEN}").json()
    assert [session["path"] for session in sessions] == [f"notebooks/{saved.name}"]
    page.close()
    page = browser.new_page(viewport={"width": 1400, "height": 1000})
    for session in sessions:
        assert page.request.delete(f"{lab}/api/sessions/{session['id']}", headers=HEADERS).status == 204
    open_lesson(page, lab, saved.name)
    page.wait_for_function(SESSION_IS_IDLE)
    assert looks_right(page)
    page.close()


@pytest.mark.parametrize("way", ["JupyterLab's own export", "nbconvert"])
def test_exported_the_picture_stands_where_the_panel_was(browser, lab, saved, way):
    page = browser.new_page()
    page.route("**/*", lambda route: route.abort() if route.request.url.startswith("http") else route.continue_())
    if way == "nbconvert":
        from nbconvert import HTMLExporter

        text, _ = HTMLExporter().from_filename(str(saved))
    else:
        answer = page.request.get(f"{lab}/nbconvert/html/notebooks/{saved.name}?token={TOKEN}")
        assert answer.status == 200
        text = answer.text()
    page.set_content(text, wait_until="domcontentloaded")
    assert looks_right(page)
    page.close()
