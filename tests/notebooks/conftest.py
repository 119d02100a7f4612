"""The notebooks as the tests see them: every lesson notebooks/NN_title.ipynb, every foundation and every project, so
that a new one is covered at once."""

import ast
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import nbformat
import pytest

from courseware.paths import foundation_paths, notebook_paths, project_paths
from tests.notebooks.driven_lab import require_chromium, served_lab


@dataclass(frozen=True)
class Lesson:
    """One stored notebook."""

    path: Path
    notebook: nbformat.NotebookNode

    @property
    def number(self) -> str:
        return self.path.name[:2]

    @property
    def minutes(self) -> int:
        """Minutes that the first cell states; of a project, whose first cell states hours, 60 for each."""
        number, unit = re.search(r"\*\*(?:About )?([\d.]+) (minutes|hours)", self.cells[0].source).groups()
        return round(float(number) * (60 if unit == "hours" else 1))

    @property
    def cells(self) -> list:
        return self.notebook.cells

    @property
    def code_cells(self) -> list:
        return [cell for cell in self.cells if cell.cell_type == "code"]

    @property
    def visible_code_cells(self) -> list:
        return [cell for cell in self.code_cells if not cell.metadata.get("jupyter", {}).get("source_hidden")]

    @property
    def outputs(self) -> list:
        return [output for cell in self.code_cells for output in cell.outputs]

    @property
    def html(self) -> list[str]:
        """Everything that the lesson shows as HTML: pictures, panels, scenes."""
        return [output.data.get("text/html", "") for output in self.outputs if "data" in output]

    @property
    def markdown(self) -> str:
        return "\n\n".join(cell.source for cell in self.cells if cell.cell_type == "markdown")

    def exercise_cells(self, number: str, tag: str) -> list:
        """Cells of one exercise that bear `tag`."""
        cells = [cell for cell in self.cells if cell.metadata.get("exercise") == number]
        return [cell for cell in cells if tag in cell.metadata.get("tags", [])]

    def exercise_numbers(self) -> list[str]:
        """Numbers of the exercises in the order in which they appear."""
        return list(dict.fromkeys(cell.metadata["exercise"] for cell in self.cells if "exercise" in cell.metadata))

    def imports(self) -> str:
        """All import statements of the lesson, for running one of its cells alone."""
        nodes = [node for cell in self.code_cells for node in ast.parse(cell.source).body]
        return "\n".join(ast.unparse(node) for node in nodes if isinstance(node, ast.Import | ast.ImportFrom))


@cache
def read(path: Path) -> Lesson:
    return Lesson(path, nbformat.read(path, as_version=4))


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if "lesson" in metafunc.fixturenames:
        # Projects have the rules of the lessons, but a shape of their own.
        projects = project_paths() if metafunc.module.__name__.endswith("test_rules") else []
        lessons = [read(path) for path in [*notebook_paths(), *foundation_paths(), *projects]]
        metafunc.parametrize("lesson", lessons, ids=[lesson.path.stem for lesson in lessons])
    if "project" in metafunc.fixturenames:
        projects = [read(path) for path in project_paths()]
        metafunc.parametrize("project", projects, ids=[project.number for project in projects])


@pytest.fixture(scope="module")
def lab(tmp_path_factory):
    """Address of the lessons' JupyterLab on copies of the notebooks, for the tests of one file."""
    require_chromium()
    pytest.importorskip("playwright.sync_api")
    with served_lab(tmp_path_factory.mktemp("lab")) as address:
        yield address


@pytest.fixture(scope="module")
def browser(lab):
    from playwright.sync_api import sync_playwright

    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=require_chromium(), args=["--no-sandbox"])
        yield browser
        browser.close()
