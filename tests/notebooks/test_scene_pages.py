"""Every page of notebooks/scenes in a real browser, from the disk: no request, no error, and it can be turned."""

import io

import numpy as np
import pytest
from PIL import Image

from courseware.paths import REPOSITORY
from tests.notebooks.driven_lab import require_chromium

playwright = pytest.importorskip("playwright.sync_api")

PAGES = sorted((REPOSITORY / "notebooks" / "scenes").glob("*.html"))
MADE_BY_HAND = ("11_sphere",)  # not with PyVista: its own test drags the point (tests/lessons/test_lesson_11.py)
SIZE = {"width": 800, "height": 500}
# WebGL without a graphics card.
ARGUMENTS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
HANGS_MS = 1_800_000  # only what hangs takes so long
AGAIN = 20
DRAWN = "() => { const canvas = document.querySelector('canvas'); return canvas && canvas.width > 300; }"

# The browser has drawn twenty times: whatever a mouse did before is in the picture, on a slow machine too.
TWENTY_FRAMES = """() => new Promise(resolve => {
    let count = 0;
    const next = () => ++count > 20 ? resolve() : requestAnimationFrame(next);
    requestAnimationFrame(next);
})"""


@pytest.fixture(scope="module")
def browser():
    path = require_chromium()
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=path, args=ARGUMENTS)
        yield browser
        browser.close()


def settled_picture(page) -> np.ndarray:
    """What the page shows `(H, W, 3)`, once two pictures in a row are the same and not empty."""
    page.frames[-1].wait_for_function(DRAWN)
    before = None
    while True:
        picture = np.asarray(Image.open(io.BytesIO(page.screenshot())).convert("RGB")).astype(int)
        coloured = (picture[:-60] < 245).any(axis=2).mean()  # above the line of help
        if before is not None and coloured > 0.01 and np.array_equal(before, picture):
            return picture
        before = picture
        page.evaluate(TWENTY_FRAMES)


def share_changed_by_a_turn(page) -> float:
    """Share of the pixels that differ clearly once the mouse was dragged (again until they do)."""
    before = settled_picture(page)
    for _ in range(AGAIN):
        page.mouse.move(SIZE["width"] / 2, SIZE["height"] / 2)
        page.mouse.down()
        page.mouse.move(SIZE["width"] / 2 + 160, SIZE["height"] / 2 + 40, steps=8)
        page.mouse.up()
        page.evaluate(TWENTY_FRAMES)
        share = float((np.abs(settled_picture(page) - before).max(axis=2) > 30).mean())
        if share > 0.02:
            break
    return share


@pytest.mark.browser
@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.stem)
def test_a_page_opens_offline_draws_and_can_be_turned(browser, path):
    page, errors, requests = browser.new_page(viewport=SIZE), [], []
    page.set_default_timeout(HANGS_MS)
    page.on("console", lambda message: errors.append(message.text) if message.type == "error" else None)
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.on("request", lambda request: requests.append(request.url[:100]))
    page.goto(path.as_uri())
    settled_picture(page)
    assert page.title()
    if path.stem not in MADE_BY_HAND:
        assert page.title() in page.locator("#help").inner_text()
        first = settled_picture(page)
        assert (turned := share_changed_by_a_turn(page)) > 0.02
        page.get_by_role("button", name="Reset view").click()
        page.mouse.move(0, SIZE["height"] - 1)  # off the button, which is drawn otherwise below a mouse
        assert (np.abs(settled_picture(page) - first).max(axis=2) > 30).mean() < turned / 4
    assert errors == []
    assert [url for url in requests if not url.startswith(("data:", "blob:"))] == [path.as_uri()]
    page.close()
