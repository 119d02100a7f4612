"""`refresh`: stores what ran to its end, in one form, and leaves the file alone otherwise. And nbval's strictness."""

import os
import subprocess
import sys
from dataclasses import replace

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

from courseware.commands.test import nbval_options
from courseware.lessons.kit.exercise import Exercise
from courseware.paths import REPOSITORY
from tools import refresh
from tools.refresh import RefreshError, with_example


def written(folder, *sources: str):
    cells = [new_markdown_cell("# A title", id="99-0")]
    cells += [new_code_cell(source, id=f"99-{k}") for k, source in enumerate(sources, 1)]
    for cell in cells:
        if "2.04" in cell.source:
            cell.metadata["numbers_within"] = "5 %"
    path = folder / "99_test.ipynb"
    nbformat.write(new_notebook(cells=cells), path)
    return path


CELLS = [
    "x = 2\nprint('x =', x)",
    """
from courseware.lessons.kit.panel import Drawing, Panel, Switch
from courseware.lessons.kit.compression import png_bytes
from courseware.plots import figures
png = png_bytes(figures.new_figure(size=(1, 1))[0])
Panel("test", [Switch("on", "on")], lambda on: Drawing(png, "A small empty picture", "on: 1.25")).show()
""",
    """
import time
from courseware.lessons import progress
for step in progress(range(6), "six steps"):
    time.sleep(0.12)
print("done:", step + 1)
""",
    "print('error', 2.04, 'm')",
    """
import numpy as np
from courseware.lessons import show_scene
from courseware.plots.scenes import body_axes, new_plotter
plotter = new_plotter()
plotter.add_mesh(body_axes(np.zeros(6), 0.5), rgb=True)
show_scene(plotter, "99_axes", title="Three axes", alt="Three axes that meet at the origin")
""",
]


@pytest.fixture(scope="module")
def refreshed(tmp_path_factory):
    """A notebook with a print, a panel, a progress bar, a measured number and a scene, refreshed."""
    path = written(tmp_path_factory.mktemp("lesson"), *CELLS)
    assert refresh.refresh(path)[1] == path.stat().st_size
    return path


@pytest.mark.slow
def test_outputs_are_stored_without_views_state_or_a_progress_bar_and_again_in_the_same_bytes(refreshed):
    notebook = nbformat.read(refreshed, as_version=4)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert [cell.execution_count for cell in code] == [1, 2, 3, 4, 5]
    assert code[0].outputs[0].text == "x = 2\n"
    assert set(code[1].outputs[0].data) == {"text/plain", "text/html"}
    bar, printed = code[2].outputs
    assert bar.data == {"text/plain": "progress: six steps", "text/html": ""}
    assert printed.text == "done: 6\n"
    assert notebook.metadata == refresh.METADATA
    assert [path.name for path in (refreshed.parent / "scenes").iterdir()] == ["99_axes.html"]
    before = refreshed.read_bytes()
    refresh.refresh(refreshed)
    assert refreshed.read_bytes() == before


CHANGES = [
    ("x = 2\n", "x = 3\n"),
    ("A small empty picture", "A small empty pictura"),
    ("error 2.04", "error 2.2"),
    ("Three axes that", "Two axes that"),
]


@pytest.mark.slow
def test_nbval_agrees_with_what_was_stored_and_notices_each_changed_output(refreshed):
    """A copy elsewhere writes its scene's page anew: only its address may differ. A number may within its 5 %."""
    elsewhere = refreshed.parent / "elsewhere"
    elsewhere.mkdir()
    text = refreshed.read_text()
    (elsewhere / "allowed.ipynb").write_text(text.replace("error 2.04", "error 2.1"))
    notebook = nbformat.read(refreshed, as_version=4)
    for output in [output for cell in notebook.cells for output in cell.get("outputs", [])]:
        for held, key in ((output, "text"), *((output.get("data", {}), kind) for kind in output.get("data", {}))):
            for old, new in CHANGES if key in held else []:
                held[key] = held[key].replace(old, new)
    nbformat.write(notebook, elsewhere / "changed.ipynb")
    options = [*nbval_options(), "-p", "no:cacheprovider", "-c", os.devnull, "--rootdir", str(refreshed.parent)]
    command = [sys.executable, "-m", "pytest", "-q", *options, "elsewhere/allowed.ipynb", "elsewhere/changed.ipynb"]
    environment = os.environ | {"PYTHONPATH": str(REPOSITORY)}
    done = subprocess.run(command, capture_output=True, text=True, env=environment, cwd=refreshed.parent, check=False)
    failed = [line[7:].split(" - ")[0] for line in done.stdout.splitlines() if line.startswith("FAILED")]
    assert failed == [f"elsewhere/changed.ipynb::Cell {number}" for number in (0, 1, 3, 4)], done.stdout


@pytest.mark.parametrize(
    ("sources", "timeout", "words"),
    [
        (["x = 1", "1 / 0"], 1800, "ZeroDivisionError"),
        (["import time; time.sleep(100_000)"], 0.5, r"longer than 0\.5 s"),
        (["import urllib.request", "urllib.request.urlopen('http://192.0.2.1/')"], 1800, r"no connection to 192\.0"),
        (["print('x' * 900_000)"], 1800, "901 kB"),
    ],
    ids=["error", "time-out", "network", "too large"],
)
@pytest.mark.slow
def test_what_fails_leaves_the_file_as_it_was(tmp_path, sources, timeout, words):
    path = written(tmp_path, *sources)
    before = path.read_bytes()
    with pytest.raises(RefreshError, match=words):
        refresh.refresh(path, cell_timeout=timeout)
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_numbers_choose_lessons_and_what_cannot_be_is_named(run_tool, capsys):
    assert [path.name[:2] for path in refresh.select(["3", "P1"])] == ["03", "P1"]
    assert len(refresh.select([])) >= 17
    assert run_tool("refresh", "03", "77") == 2
    assert "no lesson 77; there are: 00, 01" in capsys.readouterr().err
    assert run_tool("refresh", "--cell-timeout", "nan") == 2
    assert "positive number of seconds" in capsys.readouterr().err


def scaled(values, factor):
    """The values times a factor, and the factor."""
    return values * factor, factor


SCALED = Exercise("99.1", scaled, lambda rng: (), example=(([1, 0.5], 0.25), ([0.25, 0.125], 0.25)))


def test_the_numbers_of_an_example_are_written_and_its_words_stay():
    task = "At `factor` = 7.\n\nFor `values` = [[1], [nan]] m and factor = 3 they are [2, -1e-3] and 9. Not 4."
    numbers = "At `factor` = 7.\n\nFor `values` = [1, 0.5] m and factor = 0.25 they are [0.25, 0.125] and 0.25. Not 4."
    assert with_example(task, SCALED) == numbers
    assert with_example(numbers, SCALED) == numbers
    assert with_example(task, replace(SCALED, example=None)) == task


@pytest.mark.parametrize(
    ("task", "words"),
    [
        ("The values double.", "99.1: the task needs an example that begins with 'For `values` = '"),
        ("For `values` = [1] they are [2] and 2.", "no place for 0.25"),
        ("For `values` = [1] and `factor` = 2 they are doubled.", r"no place for \[0.25, 0.125\]"),
    ],
)
def test_an_example_without_a_place_for_its_numbers_is_refused(task, words):
    with pytest.raises(RefreshError, match=words):
        with_example(task, SCALED)
