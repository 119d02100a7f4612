"""Lessons in JupyterLab in a real browser: all cells run; a key on a slider, or a button, brings a new picture."""

import pytest

from courseware.paths import notebook_paths
from tests.notebooks import driven_lab
from tests.notebooks.driven_lab import STATES, open_lesson, wait_for_a_picture

# The first lesson and widgets of each paper that are used most: filter stepper (07), penalty weights (15). That other
# panels draw, and draw anew, is tested without a browser (tests/lessons/kit/test_panels.py), their cells by nbval.
LESSONS = [path for path in notebook_paths() if path.name[:2] in ("00", "07", "15")]
# Buttons of a lesson's first panel to press in turn, besides its first slider; each has to bring a new picture.
BUTTONS = {"07": ("Estimate", "Resample", "Propagate", "Weigh"), "15": ("From the start", "Next round", "Back")}
# Whole runs are nbval's work too: here one is enough, of the others what stands before the first panel's end.
RUN_WHOLLY = ("00",)


@pytest.mark.parametrize("path", LESSONS, ids=lambda path: path.stem)
def test_a_lesson_runs_and_its_first_panel_answers(browser, lab, path):
    page = browser.new_page(viewport={"width": 1400, "height": 1000})
    errors: list[str] = []
    page.on("console", lambda message: errors.append(message.text) if message.type == "error" else None)
    page.on("pageerror", lambda error: errors.append(str(error)))
    open_lesson(page, lab, path.name)
    pictures = page.locator(".jp-OutputArea-output img[alt]")
    assert pictures.count() > 0, "stored pictures, with their alternative text, are there before anything runs"

    wholly = path.name[:2] in RUN_WHOLLY
    driven_lab.run_cells(page, wholly)
    states = page.evaluate(STATES)
    counts = [count for count, _ in states if wholly or count]
    assert counts == list(range(1, len(counts) + 1))
    assert counts
    assert not any(failed for _, failed in states)
    assert page.locator(".jp-OutputArea-output img:not([alt])").count() == 0

    panel = driven_lab.first_panel(page)
    for key in ("ArrowRight", "ArrowLeft"):
        wait_for_a_picture(page, panel, "keydown", lambda key=key: page.keyboard.press(key))
    for label in BUTTONS.get(path.name[:2], ()):
        button = panel.get_by_role("button", name=label, exact=True)
        wait_for_a_picture(page, panel, "click", button.click)
    assert "This panel failed" not in panel.inner_text()
    assert driven_lab.serious_findings(page) == []
    assert errors == []
    page.close()
