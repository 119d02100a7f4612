"""Milliseconds from a key on a panel's slider to its new picture, in JupyterLab in the system's Chromium."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from course_lib.paths import REPOSITORY, notebook_paths


def picture_ms(lessons: Sequence[str], presses: int) -> dict[str, float]:
    """Median over so many presses, right and left in turn, for the first panel of each lesson (number "00").

    Raises `RuntimeError` where there is no browser.
    """
    sys.path.insert(0, str(REPOSITORY))
    from playwright.sync_api import sync_playwright

    from tests.notebooks.driven_lab import chromium, first_panel, open_lesson, run_cells, served_lab, wait_for_a_picture

    path, found = chromium(), {}
    if path is None:
        raise RuntimeError("no Chromium or Chrome found")
    with TemporaryDirectory() as folder, served_lab(Path(folder)) as address, sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=path, args=["--no-sandbox"])
        for lesson in [path for path in notebook_paths() if path.name[:2] in lessons]:
            page = browser.new_page(viewport={"width": 1400, "height": 1000})
            open_lesson(page, address, lesson.name)
            run_cells(page, False)
            panel = first_panel(page)
            acts = [partial(page.keyboard.press, ("ArrowRight", "ArrowLeft")[k % 2]) for k in range(presses + 2)]
            milliseconds = [wait_for_a_picture(page, panel, "keydown", act) for act in acts]
            found[lesson.stem] = float(np.median(milliseconds[2:]))
            page.close()
        browser.close()
    return found
