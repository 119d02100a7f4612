"""Lessons in JupyterLab in a real browser: all cells run; a key on a slider, or a button, brings a new picture."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import time
import urllib.error
import urllib.request
from collections.abc import Callable
from pathlib import Path

import pytest

from course_lib.commands.lab import lab_command
from course_lib.paths import REPOSITORY, notebook_paths

playwright = pytest.importorskip("playwright.sync_api")

# The first lesson and widgets of each paper that are used most: filter stepper (07), penalty weights (15). That other
# panels draw, and draw anew, is tested without a browser (tests/lessons/kit/test_panels.py), their cells by nbval.
LESSONS = [path for path in notebook_paths() if path.name[:2] in ("00", "07", "15")]
# Buttons of a lesson's first panel to press in turn, besides its first slider; each has to bring a new picture.
BUTTONS = {"07": ("Estimate", "Resample", "Propagate", "Weigh"), "15": ("From the start", "Next round", "Back")}
TOKEN = "for-this-test-only"
HANGS_S = 1800  # only what hangs takes so long

SESSION_IS_IDLE = """() => {
    const kernel = window.jupyterapp?.shell.currentWidget?.sessionContext?.session?.kernel;
    return kernel?.connectionStatus === 'connected' && kernel.status === 'idle';
}"""
# Whole runs are nbval's work too: here one is enough, of the others what stands before the first panel's end.
RUN_WHOLLY = ("00",)
# Clears the stored outputs first, with their numbers: what stands there afterwards has been run.
RUN = """wholly => {
    const {commands, shell} = window.jupyterapp, notebook = shell.currentWidget.content;
    const shows = cell => cell.model.type === 'code' && cell.model.outputs.toJSON().some(
        output => [].concat(output.data?.['text/plain'] ?? '').join('').startsWith("Panel '"));
    const panel = notebook.widgets.findIndex(shows);
    return commands.execute('notebook:clear-all-cell-outputs').then(() => {
        notebook.activeCellIndex = panel + 1;
        return commands.execute(wholly ? 'notebook:run-all-cells' : 'notebook:run-all-above');
    }).then(() => true);
}"""
STATES = """() => window.jupyterapp.shell.currentWidget.content.widgets
    .filter(cell => cell.model.type === 'code')
    .map(cell => [cell.model.executionCount, cell.model.outputs.toJSON().some(o => o.output_type === 'error')])"""
# Ends with the first new picture in the panel after the next event of a kind (a key, a click), decoded, ready to paint.
EVENT_TO_PICTURE = """([panel, event]) => new Promise((resolve, reject) => {
    const old = panel.querySelector('img').src;
    let happened = false;
    new MutationObserver((_, observer) => {
        const image = panel.querySelector('img');
        if (!happened || !image || image.src === old) return;
        observer.disconnect();
        image.decode().then(() => resolve(true), reject);
    }).observe(panel, {subtree: true, childList: true, attributes: true});
    document.addEventListener(event, () => { happened = true; }, {once: true, capture: true});
    window.courseIsWatching = true;
})"""


def chromium() -> str | None:
    """Path of a Chromium or Chrome of the system; None where there is none."""
    names = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
    return next((path for name in names if (path := shutil.which(name))), None)


def require_chromium() -> str:
    """The browser's path; without one the test is skipped, and says so, but fails where CI=true."""
    path = chromium()
    if path is None:
        message = "no Chromium or Chrome found (on Debian or Ubuntu: apt-get install chromium): not driven in a browser"
        if os.environ.get("CI", "").lower() == "true":
            pytest.fail(message)
        pytest.skip(message)
    return path


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@pytest.fixture(scope="module")
def lab(tmp_path_factory):
    """Address of the lessons' JupyterLab, on copies of the notebooks, so that no autosave touches the stored ones."""
    require_chromium()
    folder = tmp_path_factory.mktemp("lab")
    shutil.copytree(REPOSITORY / "notebooks", folder / "notebooks", ignore=shutil.ignore_patterns(".*"))
    port = free_port()
    command, environment = lab_command(port, False, f"notebooks/{LESSONS[0].name}", state_folder=folder / "state")
    root = f"--ServerApp.root_dir={REPOSITORY}"
    assert root in command
    command[command.index(root)] = f"--ServerApp.root_dir={folder}"
    command.append("--LabApp.expose_app_in_browser=True")
    log = (folder / "server.log").open("w")
    server = subprocess.Popen(command, env=environment | {"JUPYTER_TOKEN": TOKEN}, stdout=log, stderr=log)
    try:
        wait_for_server(server, port, folder / "server.log")
        yield f"http://127.0.0.1:{port}"
    finally:
        server.terminate()
        try:
            server.wait(300)
        except subprocess.TimeoutExpired:
            server.kill()
        log.close()


def wait_for_server(server: subprocess.Popen, port: int, log: Path) -> None:
    for _ in range(5 * HANGS_S):
        assert server.poll() is None, log.read_text()
        try:
            urllib.request.urlopen(f"http://127.0.0.1:{port}/api?token={TOKEN}", timeout=HANGS_S)
            return
        except (urllib.error.URLError, OSError):
            time.sleep(0.2)
    pytest.fail(f"JupyterLab never answered: {log.read_text()}")


@pytest.fixture(scope="module")
def browser(lab):
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=require_chromium(), args=["--no-sandbox"])
        yield browser
        browser.close()


@pytest.mark.parametrize("path", LESSONS, ids=lambda path: path.stem)
def test_a_lesson_runs_and_its_first_panel_answers(browser, lab, path):
    page = browser.new_page(viewport={"width": 1400, "height": 1000})
    page.set_default_timeout(1000 * HANGS_S)
    errors: list[str] = []
    page.on("console", lambda message: errors.append(message.text) if message.type == "error" else None)
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.goto(f"{lab}/lab/tree/notebooks/{path.name}?token={TOKEN}&reset")
    page.wait_for_function(SESSION_IS_IDLE)
    pictures = page.locator(".jp-OutputArea-output img[alt]")
    assert pictures.count() > 0, "stored pictures, with their alternative text, are there before anything runs"

    wholly = path.name[:2] in RUN_WHOLLY
    page.evaluate(RUN, wholly)
    page.wait_for_function(SESSION_IS_IDLE)
    states = page.evaluate(STATES)
    counts = [count for count, _ in states if wholly or count]
    assert counts == list(range(1, len(counts) + 1))
    assert counts
    assert not any(failed for _, failed in states)
    assert page.locator(".jp-OutputArea-output img:not([alt])").count() == 0

    panel = page.locator(".jp-OutputArea-output:has(.widget-slider)").first
    panel.scroll_into_view_if_needed()
    panel.locator(".noUi-handle").first.focus()
    for key in ("ArrowRight", "ArrowLeft"):
        wait_for_a_picture(page, panel, "keydown", lambda key=key: page.keyboard.press(key))
    for label in BUTTONS.get(path.name[:2], ()):
        button = panel.get_by_role("button", name=label, exact=True)
        wait_for_a_picture(page, panel, "click", button.click)
    assert "This panel failed" not in panel.inner_text()
    assert errors == []
    page.close()


def wait_for_a_picture(page, panel, event: str, act: Callable[[], None]) -> None:
    """Returns when the event ("keydown", "click") that `act` makes has brought a new picture."""
    page.evaluate("() => { window.courseIsWatching = false; }")
    element = panel.element_handle()
    page.evaluate("([p, e]) => { window.courseWaits = (" + EVENT_TO_PICTURE + ")([p, e]); }", [element, event])
    page.wait_for_function("() => window.courseIsWatching")
    act()
    page.wait_for_function("() => window.courseWaits.then(() => true)")


def test_a_missing_browser_is_said_and_fails_only_where_ci_is_true(monkeypatch):
    monkeypatch.setattr(shutil, "which", lambda name: None)
    monkeypatch.setenv("CI", "")
    with pytest.raises(pytest.skip.Exception, match="no Chromium"):
        require_chromium()
    monkeypatch.setenv("CI", "true")
    with pytest.raises(pytest.fail.Exception, match="no Chromium"):
        require_chromium()
