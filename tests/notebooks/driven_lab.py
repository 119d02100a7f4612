"""JupyterLab in a real browser, driven: what the browser tests have in common."""

import os
import shutil
import socket
import subprocess
import time
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from courseware.commands.lab import lab_command
from courseware.paths import REPOSITORY

TOKEN = "for-this-test-only"
HANGS_S = 1800  # only what hangs takes so long

OUTPUTS = ".jp-OutputArea-output"
SESSION_IS_IDLE = """() => {
    const kernel = window.jupyterapp?.shell.currentWidget?.sessionContext?.session?.kernel;
    return kernel?.connectionStatus === 'connected' && kernel.status === 'idle';
}"""
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
AXE = """where => axe.run({include: [[where]]}, {resultTypes: ['violations'], preload: false})
    .then(result => result.violations.flatMap(
    rule => rule.nodes.map(node => [rule.id, rule.impact, node.target.flat().join(' '), node.html.slice(0, 300)])))"""
# Milliseconds from the next event of a kind (a key, a click) to the first new picture in the panel, ready to paint.
EVENT_TO_PICTURE = """([panel, event]) => new Promise((resolve, reject) => {
    const old = panel.querySelector('img').src;
    let began = null;
    new MutationObserver((_, observer) => {
        const image = panel.querySelector('img');
        if (began === null || !image || image.src === old) return;
        observer.disconnect();
        image.decode().then(() => resolve(performance.now() - began), reject);
    }).observe(panel, {subtree: true, childList: true, attributes: true});
    document.addEventListener(event, () => { began = performance.now(); }, {once: true, capture: true});
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


@contextmanager
def served_lab(folder: Path) -> Iterator[str]:
    """Address of the lessons' JupyterLab, on copies of the notebooks below `folder`: no autosave touches ours."""
    shutil.copytree(REPOSITORY / "notebooks", folder / "notebooks", ignore=shutil.ignore_patterns(".*"))
    port = free_port()
    command, environment = lab_command(port, state_folder=folder / "state", root=folder)
    command.append("--LabApp.expose_app_in_browser=True")
    log = (folder / "server.log").open("w")
    server = subprocess.Popen(command, env=environment | {"JUPYTER_TOKEN": TOKEN}, stdout=log, stderr=log)
    try:
        wait_for_server(server, port, folder / "server.log")
        yield f"http://127.0.0.1:{port}"
    finally:
        server.terminate()
        server.wait(HANGS_S)
        log.close()


def wait_for_server(server: subprocess.Popen, port: int, log: Path) -> None:
    for _ in range(5 * HANGS_S):
        assert server.poll() is None, log.read_text()
        try:
            urllib.request.urlopen(f"http://127.0.0.1:{port}/api?token={TOKEN}", timeout=HANGS_S)
            return
        except (urllib.error.URLError, OSError):
            time.sleep(0.2)
    raise TimeoutError(f"JupyterLab never answered: {log.read_text()}")


def open_lesson(page, address: str, name: str) -> None:
    """Opens a notebook and waits for its kernel."""
    page.set_default_timeout(1000 * HANGS_S)
    page.goto(f"{address}/lab/tree/notebooks/{name}?token={TOKEN}&reset")
    page.wait_for_function(SESSION_IS_IDLE)


def run_cells(page, wholly: bool) -> None:
    """Runs all cells, or those up to the first panel's, and waits for the end."""
    page.evaluate(RUN, wholly)
    page.wait_for_function(SESSION_IS_IDLE)


def first_panel(page):
    """The first panel that has a slider, in view, its first slider in focus."""
    panel = page.locator(".jp-OutputArea-output:has(.widget-slider)").first
    panel.scroll_into_view_if_needed()
    panel.locator(".noUi-handle").first.focus()
    return panel


def wait_for_a_picture(page, panel, event: str, act: Callable[[], None]) -> float:
    """Milliseconds from the event ("keydown", "click") that `act` makes to the new picture that it brings."""
    page.evaluate("() => { window.courseIsWatching = false; }")
    element = panel.element_handle()
    page.evaluate("([p, e]) => { window.courseWaits = (" + EVENT_TO_PICTURE + ")([p, e]); }", [element, event])
    page.wait_for_function("() => window.courseIsWatching")
    act()
    return page.evaluate("() => window.courseWaits")


def serious_findings(page, where: str = OUTPUTS) -> list[list[str]]:
    """What axe-core finds there, serious or critical: rule, impact, CSS selector, HTML. Nothing is loaded."""
    base = pytest.importorskip("axe_playwright_python.base")
    page.evaluate(base.AXE_SCRIPT)
    assert page.locator(where).count() > 0
    return [found for found in page.evaluate(AXE, where) if found[1] in ("serious", "critical")]
