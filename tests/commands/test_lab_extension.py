"""The course's extension of JupyterLab by itself: on a page with what ipywidgets draws, and a clock that is moved."""

from __future__ import annotations

import pytest

from course_lib.commands.lab import EXTENSION
from tests.notebooks.driven_lab import require_chromium

ADDRESS = "http://lab.test/"
# What ipywidgets 8.1 draws of a panel with one slider, its number box, a list and its numbers.
PANEL = """
<div class="jupyter-widgets widget-vbox course-panel">
  <div class="jupyter-widgets widget-hbox">
    <div class="jupyter-widgets widget-inline-hbox widget-slider widget-hslider">
      <label class="widget-label" title="null">alpha [m]</label>
      <div><div class="noUi-handle" role="slider" tabindex="0" aria-valuenow="0.1" aria-valuetext="0.15000000000000002">
      </div></div>
    </div>
    <div class="jupyter-widgets widget-inline-hbox widget-text">
      <label class="widget-label" style="display: none"></label><input type="number" class="widget-input" value="0.15">
    </div>
  </div>
  <div class="jupyter-widgets widget-dropdown"><select><option>x</option></select></div>
  <div class="jupyter-widgets widget-html" id="picture" style="width: 300px; overflow: auto">
    <img src="" style="width: 640px; height: 20px"></div>
  <div class="jupyter-widgets widget-html course-numbers" id="numbers"><pre role="status">best 0.5 m</pre></div>
</div>
"""
START = """async () => {
    const module = (await window._JUPYTERLAB['course-lab'].get('./extension'))();
    window.folded = 0;
    module.default.activate({restored: Promise.resolve(), shell: {collapseLeft: () => { window.folded += 1; }}});
}"""
SUPPRESSED = "selector => document.querySelector(selector).hasAttribute('data-lm-suppress-shortcuts')"


@pytest.fixture(scope="module")
def browser():
    path = require_chromium()
    driver = pytest.importorskip("playwright.sync_api").sync_playwright().start()
    browser = driver.chromium.launch(executable_path=path, args=["--no-sandbox"])
    yield browser
    browser.close()
    driver.stop()


@pytest.fixture
def page(browser):
    """The extension in an empty page, its timers at rest; no address is reached."""
    page = browser.new_page(viewport={"width": 1400, "height": 900})

    def answer(route) -> None:
        name = route.request.url.removeprefix(ADDRESS)
        body = (EXTENSION / name).read_text(encoding="utf-8") if name else "<body></body>"
        kinds = {"": "text/html", ".js": "text/javascript", ".css": "text/css"}
        route.fulfill(body=body, content_type=kinds[(EXTENSION / name).suffix] if name else "text/html")

    page.route("**/*", answer)
    page.clock.install()
    page.goto(ADDRESS)
    page.add_script_tag(url=f"{ADDRESS}static/remoteEntry.js")
    yield page
    page.close()


def show_panel(page) -> None:
    """The extension runs, and then a panel appears."""
    page.evaluate(START)
    page.evaluate("html => document.body.insertAdjacentHTML('afterbegin', html)", PANEL)


def attribute(page, selector: str, name: str) -> str | None:
    return page.locator(selector).first.get_attribute(name)


def test_a_slider_and_its_number_box_are_named_and_the_value_is_read_with_its_unit(page):
    show_panel(page)
    assert attribute(page, ".noUi-handle", "aria-label") == "alpha [m]"
    assert attribute(page, "input", "aria-label") == "alpha [m]"
    assert attribute(page, ".noUi-handle", "aria-valuetext") == "0.15 m"
    assert attribute(page, ".noUi-handle", "aria-valuenow") == "0.15"
    assert page.locator('[title="null"]').count() == 0


@pytest.mark.parametrize(
    ("label", "raw", "said"),
    [
        ("z [m]", "-0.21000000000000008", "-0.21 m"),
        ("beta [-]", "0.1", "0.1"),
        ("turn [degrees]", "-1e-17", "0 degrees"),
    ],
)
def test_numbers_are_read_as_people_write_them(page, label, raw, said):
    show_panel(page)
    page.evaluate("label => { document.querySelector('.widget-slider .widget-label').textContent = label; }", label)
    page.locator(".noUi-handle").evaluate("(handle, raw) => handle.setAttribute('aria-valuetext', raw)", raw)
    assert attribute(page, ".noUi-handle", "aria-valuetext") == said
    assert attribute(page, ".noUi-handle", "aria-label") == label


def test_new_numbers_are_said_once_when_they_are_at_rest(page):
    show_panel(page)
    says = page.locator("#course-says")
    assert (says.get_attribute("role"), says.get_attribute("aria-live")) == ("status", "polite")
    for number in (0.6, 0.7, 0.8):
        page.evaluate("html => { numbers.innerHTML = html; }", f'<pre role="status">best {number} m</pre>')
        page.clock.run_for(300)
        assert says.text_content() == "", "not every step of a slider that moves"
    page.clock.run_for(1000)
    assert says.text_content() == "best 0.8 m"
    assert attribute(page, "#numbers pre", "aria-live") == "off", "or it would be said twice"
    page.evaluate("() => { numbers.innerHTML = '<p role=\"alert\">This panel failed</p>'; }")
    page.clock.run_for(1000)
    assert says.text_content() == "best 0.8 m", "an alert is said by the browser itself"


@pytest.mark.parametrize("control", [".noUi-handle", "input"])
def test_plain_keys_belong_to_the_control_that_has_the_focus_and_no_others(page, control):
    show_panel(page)
    keys = [("ArrowDown", {}, True), ("s", {"ctrlKey": True}, False), ("d", {}, True), ("Enter", {}, True)]
    keys += [("Enter", {"shiftKey": True}, False), (" ", {}, True), ("Escape", {}, False)]
    for key, held, own in keys:
        page.locator(control).first.dispatch_event("keydown", {"key": key, "bubbles": True} | held)
        assert page.evaluate(SUPPRESSED, control) is own, key


def test_a_narrow_window_folds_the_file_list_and_what_scrolls_is_reached_by_keyboard(page):
    show_panel(page)
    assert page.evaluate("() => window.folded") == 0
    page.set_viewport_size({"width": 900, "height": 900})
    page.wait_for_function("() => window.folded === 1", polling=50)
    page.evaluate("() => window.dispatchEvent(new Event('resize'))")
    page.clock.run_for(1000)
    assert attribute(page, "#picture", "tabindex") == "0"
    page.evaluate("() => { picture.style.width = '700px'; window.dispatchEvent(new Event('resize')); }")
    page.clock.run_for(1000)
    assert attribute(page, "#picture", "tabindex") is None


VERDICT = """text => document.body.insertAdjacentHTML(
    'beforeend', `<div class="jp-OutputArea-child"><pre>${text}</pre></div>`)"""


def test_the_verdict_of_a_check_is_said_but_not_those_that_were_stored(page):
    page.evaluate(START)
    page.evaluate(VERDICT, "06.1: not attempted yet.")
    page.wait_for_timeout(50)
    assert page.locator("#course-says").text_content() == ""
    page.keyboard.press("Enter")
    page.evaluate(VERDICT, "best 0.5 m")
    page.evaluate(VERDICT, "(your function prints) 3\n06.1: right.")
    page.wait_for_function("() => document.querySelector('#course-says').textContent === '06.1: right.'")
