"""A lesson by keyboard alone and by ear: names, values with units, what is said after a change; and axe-core."""

import base64
import io
import re
from pathlib import Path

import nbformat
import numpy as np
import pytest
from PIL import Image

from courseware.lessons.kit.compression import compress
from courseware.paths import notebook_paths, numbered_paths
from tests.notebooks.driven_lab import SESSION_IS_IDLE, open_lesson, serious_findings

LESSON = next(path.name for path in notebook_paths() if path.name.startswith("06"))
PANEL_CELL = """() => window.jupyterapp.shell.currentWidget.content.widgets.findIndex(
    cell => cell.model.type === 'code' && cell.model.outputs.toJSON().some(
        output => [].concat(output.data?.['text/plain'] ?? '').join('').startsWith("Panel '")))"""
CELLS = "() => window.jupyterapp.shell.currentWidget.content.widgets.length"
ACTIVE_CELL = "() => window.jupyterapp.shell.currentWidget.content.activeCellIndex"
HAS_FOCUS = "selector => document.activeElement.matches(selector)"
VALUE_IS = "text => document.querySelector('.course-panel .noUi-handle').getAttribute('aria-valuetext') === text"
SAID = "text => document.querySelector('#course-says').textContent.includes(text)"
DESCRIBED = "text => document.querySelector('.course-panel img').alt.includes(text)"
SLIDER, BOX, LIST = ".noUi-handle", ".course-panel input[type=number]", ".course-panel select"
DARK = "() => window.jupyterapp.commands.execute('apputils:change-theme', {theme: 'JupyterLab Dark'}).then(() => true)"

SQUARES = np.array([[[255, 255, 255], [0, 0, 0], [0, 114, 178], [213, 94, 0]]], np.uint8)  # white, black, two colours
SHOW_FIRST = """url => {
    const image = Object.assign(new Image(), {id: 'squares', alt: 'Four squares in a row', src: url});
    document.querySelector('.jp-OutputArea-output').prepend(image);
    return image.decode();
}"""


def tab_to(page, selector: str) -> None:
    """Tab until an element of that kind has the focus, which takes a few keys, not a journey over the page."""
    for _ in range(12):
        page.keyboard.press("Tab")
        if page.evaluate(HAS_FOCUS, selector):
            return
    raise AssertionError(f"twelve times Tab did not reach {selector}")


@pytest.fixture(scope="module")
def page(browser, lab):
    """Lesson 06, run with Shift and Enter up to its panel; the panel's cell is selected."""
    page = browser.new_page(viewport={"width": 1400, "height": 1000})
    open_lesson(page, lab, LESSON)
    for _ in range(page.evaluate(PANEL_CELL) + 1):
        page.keyboard.press("Shift+Enter")
    page.locator(SLIDER).first.wait_for()
    page.wait_for_function(SESSION_IS_IDLE)
    page.keyboard.press("ArrowUp")
    yield page
    page.close()


def test_a_panel_is_worked_by_keyboard_alone_and_says_its_new_numbers(page):
    cell, cells = page.evaluate(ACTIVE_CELL), page.evaluate(CELLS)
    tab_to(page, SLIDER)
    for key, value in (("ArrowRight", "0.11 m"), ("ArrowUp", "0.12 m"), ("ArrowDown", "0.11 m"), ("Home", "0.01 m")):
        page.keyboard.press(key)
        page.wait_for_function(VALUE_IS, arg=value)
    page.wait_for_function(SAID, arg="cameras with w of at least 0.5: ")

    tab_to(page, BOX)
    page.keyboard.press("Control+a")
    page.keyboard.type("0.3")
    page.keyboard.press("Enter")
    page.wait_for_function(VALUE_IS, arg="0.3 m")
    page.wait_for_function(DESCRIBED, arg="eq. (8) for alpha 0.3 m")

    tab_to(page, LIST)
    page.keyboard.press("ArrowDown")
    page.wait_for_function(SAID, arg="along y: the best of")
    for key in ("d", "d"):  # in JupyterLab's own keys: delete the cell
        page.keyboard.press(key)
    tab_to(page, ".course-panel button")
    page.keyboard.press("Enter")
    page.wait_for_function(VALUE_IS, arg="0.1 m")
    page.wait_for_function(SAID, arg="along x: the best of")
    assert (page.evaluate(ACTIVE_CELL), page.evaluate(CELLS)) == (cell, cells), "no key did something to the notebook"


def test_every_control_has_a_name_and_its_values_are_read_with_their_units(page):
    panel = page.locator(".course-panel").first
    for label in ("alpha [m]", "beta [-]", "hidden by a person [share]"):
        assert panel.get_by_role("slider", name=label, exact=True).count() == 1
        assert panel.get_by_role("spinbutton", name=label, exact=True).count() == 1
    assert panel.get_by_role("combobox", name="axis", exact=True).count() == 1
    handles = panel.locator(SLIDER)
    values = handles.evaluate_all("handles => handles.map(handle => handle.getAttribute('aria-valuetext'))")
    assert values == ["0.1 m", "0.01", "0 share"]
    # As a browser leaves a number after many steps.
    for raw, spoken in (("-0.21000000000000008", "-0.21 m"), ("0.15000000000000002", "0.15 m")):
        handles.first.evaluate("(handle, raw) => handle.setAttribute('aria-valuetext', raw)", raw)
        page.wait_for_function(VALUE_IS, arg=spoken)
    assert panel.locator('[title="null"]').count() == 0


def test_nothing_serious_is_found_in_a_lesson_that_was_run_nor_in_the_dark_theme_which_keeps_colours(page):
    assert serious_findings(page) == []
    page.evaluate(DARK)
    page.wait_for_function("() => document.body.dataset.jpThemeLight === 'false'")
    url = "data:image/png;base64," + base64.b64encode(compress(SQUARES.repeat(20, 0).repeat(20, 1))).decode()
    page.evaluate(SHOW_FIRST, url)
    screenshot = Image.open(io.BytesIO(page.locator("#squares").screenshot())).convert("RGB")
    shown = np.asarray(screenshot)[10, 10::20].astype(int)
    assert np.abs(shown[:2] - [[18] * 3, [237] * 3]).max() <= 5, "white paper is dark, black ink is light"
    assert np.abs(shown[2:] - SQUARES[0, 2:]).max() <= 5
    assert serious_findings(page) == []


def test_nothing_serious_is_found_in_what_lessons_and_projects_store(browser):
    page = browser.new_page()
    for path in numbered_paths().values():
        page.set_content(stored_page(path))
        assert serious_findings(page) == [], path.name
    page.close()


def stored_page(path: Path) -> str:
    """A page of all that a notebook stores as HTML; what a picture or a frame holds is left out, which takes time."""
    outputs = [o for cell in nbformat.read(path, as_version=4).cells for o in cell.get("outputs", []) if "data" in o]
    shown = [re.sub(r'(<img|<iframe)([^>]*?) src="[^"]*"', r"\1\2", o.data.get("text/html", "")) for o in outputs]
    body = "".join(f'<div class="jp-OutputArea-output">{html}</div>' for html in shown)
    return f"<!DOCTYPE html><html lang=en><title>{path.stem}</title><main><h1>{path.stem}</h1>{body}</main></html>"
