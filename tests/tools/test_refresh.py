"""`refresh`: stores what ran to its end, in one form, and leaves the file alone otherwise. And nbval's strictness."""

from __future__ import annotations

import argparse
import os
import signal
import subprocess
import sys
import time

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

from course_lib.paths import REPOSITORY
from tools import refresh
from tools.refresh import RefreshError

SANITIZE = REPOSITORY / "tests" / "nbval_sanitize.cfg"


def written(folder, *sources: str):
    cells = [new_markdown_cell("# A title")] + [new_code_cell(source) for source in sources]
    for index, cell in enumerate(cells):
        cell.id = f"99-{index}"
    path = folder / "99_test.ipynb"
    nbformat.write(new_notebook(cells=cells), path)
    return path


def run_nbval(*paths) -> subprocess.CompletedProcess:
    options = ["--nbval", "--nbval-current-env", "--nbval-sanitize-with", str(SANITIZE), "-p", "no:cacheprovider"]
    options += ["-p", "course_lib.commands.nbval_tolerance"]
    options += ["-c", os.devnull, "--rootdir", str(paths[0].parent)]
    environment = os.environ | {"PYTHONPATH": str(REPOSITORY)}
    command = [sys.executable, "-m", "pytest", "-q", *options, *map(str, paths)]
    return subprocess.run(command, capture_output=True, text=True, env=environment, cwd=paths[0].parent, timeout=1800)


PANEL = """
from course_lib.lessons.kit.panel import Drawing, Panel, Switch
from course_lib.plots import figures
png = figures.png_bytes(figures.new_figure(size=(1, 1))[0])
Panel("test", [Switch("on", "on")], lambda on: Drawing(png, "A small empty picture", "on: 1.25")).show()
"""
PROGRESS = """
import time
from course_lib.lessons import progress
for step in progress(range(6), "six steps"):
    time.sleep(0.12)
print("done:", step + 1)
"""


@pytest.fixture(scope="module")
def refreshed(tmp_path_factory):
    """A notebook with a print, a panel and a progress bar, refreshed."""
    measured = "print('error', 2.04, 'm')  # numbers within 5 %"
    path = written(tmp_path_factory.mktemp("lesson"), "x = 2\nprint('x =', x)", PANEL, PROGRESS, measured)
    seconds, size = refresh.refresh(path)
    assert seconds > 0
    assert size == path.stat().st_size
    return path


def test_outputs_are_stored_without_views_or_state(refreshed):
    notebook = nbformat.read(refreshed, as_version=4)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert [cell.execution_count for cell in code] == [1, 2, 3, 4]
    assert code[0].outputs[0].text == "x = 2\n"
    assert set(code[1].outputs[0].data) == {"text/plain", "text/html"}
    assert notebook.metadata == refresh.METADATA
    assert [cell.id for cell in notebook.cells] == [f"99-{k}" for k in range(5)]


def test_a_progress_bar_leaves_nothing_that_changes(refreshed):
    bar, printed = nbformat.read(refreshed, as_version=4).cells[3].outputs
    assert bar.data == {"text/plain": "progress: six steps", "text/html": ""}
    assert printed.text == "done: 6\n"


SCENE = """
import numpy as np
from course_lib.lessons import show_scene
from course_lib.plots.scenes import body_axes, new_plotter
plotter = new_plotter()
plotter.add_mesh(body_axes(np.zeros(6), 0.5), rgb=True)
show_scene(plotter, "99_axes", title="Three axes", alt="Three axes that meet at the origin")
"""


@pytest.fixture(scope="module")
def refreshed_scene(tmp_path_factory):
    """A notebook with a scene, refreshed; its page is stored beside it."""
    path = written(tmp_path_factory.mktemp("scene"), SCENE)
    refresh.refresh(path)
    return path


def test_refresh_stores_a_scene_and_a_run_of_the_lesson_agrees_and_writes_none(refreshed_scene):
    folder = refreshed_scene.parent / "scenes"
    assert [path.name for path in folder.iterdir()] == ["99_axes.html"]
    assert "1 passed" in run_nbval(refreshed_scene).stdout
    assert [path.name for path in folder.iterdir()] == ["99_axes.html"]


def test_a_run_agrees_where_another_vtk_makes_another_page_but_not_with_another_title(refreshed_scene, tmp_path):
    """Another page than the stored one goes to scenes/yours; only its address may differ."""
    copy = tmp_path / refreshed_scene.name
    copy.write_text(refreshed_scene.read_text())
    assert "1 passed" in run_nbval(copy).stdout
    assert [path.relative_to(tmp_path).as_posix() for path in tmp_path.glob("**/*.html")] == [
        "scenes/yours/99_axes.html"
    ]
    copy.write_text(refreshed_scene.read_text().replace('title=\\"Three axes\\" width', 'title=\\"Two axes\\" width'))
    assert copy.read_text() != refreshed_scene.read_text()
    assert "1 failed" in run_nbval(copy).stdout


def test_a_second_refresh_changes_no_byte(refreshed):
    before = refreshed.read_bytes()
    refresh.refresh(refreshed)
    assert refreshed.read_bytes() == before


CHANGES = {
    "a_printed_text": ("x = 2\n", "x = 3\n"),
    "an_alternative_text": ("A small empty picture", "A small empty pictura"),
    "a_number_under_a_picture": ("on: 1.25", "on: 1.26"),
    "a_number_beyond_its_tolerance": ("error 2.04", "error 2.2"),
}
ALLOWED = {"a_number_within_its_tolerance": ("error 2.04", "error 2.1")}


@pytest.fixture(scope="module")
def compared(refreshed):
    """What nbval prints of the notebook as it was stored, and of copies that differ in one output."""
    paths = [refreshed]
    for name, (old, new) in (CHANGES | ALLOWED).items():
        notebook = nbformat.read(refreshed, as_version=4)
        for cell in notebook.cells:
            for output in cell.get("outputs", []):
                if "text" in output:
                    output.text = output.text.replace(old, new)
                for kind in output.get("data", {}):
                    output.data[kind] = output.data[kind].replace(old, new)
        paths.append(refreshed.with_name(f"{name}.ipynb"))
        nbformat.write(notebook, paths[-1])
        assert paths[-1].read_text() != refreshed.read_text()
    return run_nbval(*paths).stdout


def test_nbval_agrees_with_what_was_stored(compared):
    assert f"{len(CHANGES)} failed, {2 * 4 + 3 * len(CHANGES)} passed" in compared
    assert not [
        line for line in compared.splitlines() if line.startswith(("FAILED 99_test", *map("FAILED ".__add__, ALLOWED)))
    ]


@pytest.mark.parametrize("change", CHANGES)
def test_nbval_notices_a_changed_output(compared, change):
    assert len([line for line in compared.splitlines() if line.startswith(f"FAILED {change}")]) == 1


@pytest.mark.parametrize(
    ("sources", "timeout", "words"),
    [
        (["x = 1", "1 / 0"], 1800, "ZeroDivisionError"),
        (["import time; time.sleep(100_000)"], 2, "longer than 2 s"),
        (["import os; os._exit(3)"], 1800, "(?i)died|dead"),
        (["import urllib.request", "urllib.request.urlopen('http://192.0.2.1/')"], 1800, r"no connection to 192\.0"),
        (["print('x' * 500_000)"], 1800, "501 kB"),
    ],
    ids=["error", "time-out", "dead kernel", "network", "too large"],
)
def test_what_fails_leaves_the_file_as_it_was(tmp_path, sources, timeout, words):
    path = written(tmp_path, *sources)
    before = path.read_bytes()
    with pytest.raises(RefreshError, match=words):
        refresh.refresh(path, cell_timeout=timeout)
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir() if p.suffix == ".part"] == []


def test_a_part_of_a_second_limits_too(tmp_path):
    path = written(tmp_path, "import time\ntime.sleep(600)")
    with pytest.raises(RefreshError, match=r"longer than 0\.5 s"):
        refresh.refresh(path, cell_timeout=0.5)


def test_numbers_choose_lessons_and_unknown_ones_are_named():
    assert [path.name[:2] for path in refresh.select(["3"])] == ["03"]
    assert [path.name[:2] for path in refresh.select(["P1", "07"])] == ["P1", "07"]
    assert len(refresh.select([])) >= 1
    with pytest.raises(ValueError, match=r"no lesson 77; there are: .*03"):
        refresh.select(["03", "77"])


@pytest.mark.parametrize("seconds", [0.0, -5.0, float("nan"), float("inf")])
def test_a_time_out_that_is_none_is_refused(seconds):
    with pytest.raises(ValueError, match="positive number of seconds"):
        refresh.run(argparse.Namespace(lessons=["03"], cell_timeout=seconds))


def test_only_addresses_kernel_paths_and_where_a_scene_lies_are_sanitized():
    lines = [line for line in SANITIZE.read_text().splitlines() if line and not line.startswith("#")]
    assert [line for line in lines if line.startswith("[")] == ["[picture]", "[address]", "[scene]", "[kernel-path]"]
    assert len(lines) == 12


STOPPED = """
import sys
from pathlib import Path
from tools.refresh import refresh
from course_lib.told_to_end import told_to_end
try:
    with told_to_end():
        refresh(Path(sys.argv[1]))
except KeyboardInterrupt:
    sys.exit(3)
"""


@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
@pytest.mark.parametrize("sent", [signal.SIGTERM, signal.SIGKILL])
def test_stopped_in_a_cell_it_leaves_the_file_and_no_kernel_and_nothing_said(sent, tmp_path):
    temporary, lesson = tmp_path / "temporary", tmp_path / "lesson"
    temporary.mkdir()
    lesson.mkdir()
    note = lesson / "kernel"
    path = written(lesson, f"import os, time; open({str(note)!r}, 'w').write(str(os.getpid()) + '.'); time.sleep(600)")
    before = path.read_bytes()
    process = subprocess.Popen(
        [sys.executable, "-c", STOPPED, str(path)],
        cwd=REPOSITORY,
        env=os.environ | {"TMPDIR": str(temporary)},
        stderr=subprocess.PIPE,
        text=True,
    )
    while not (note.exists() and note.read_text().endswith(".")):
        assert process.poll() is None
        time.sleep(0.05)
    process.send_signal(sent)
    told = process.communicate()[1]  # whose end the kernel holds as well: it has ended, too
    assert path.read_bytes() == before
    if sent == signal.SIGTERM:
        assert (process.returncode, told) == (3, "")
        assert list(temporary.iterdir()) == []
    else:
        assert [name.name.startswith("course-scratch-") for name in temporary.iterdir()] == [True]
