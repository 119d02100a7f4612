"""A lesson's package hands on what its notebook asks for; a notebook imports what there is."""

import ast
import importlib
import json
import re

import pytest

from courseware.lessons.kit.exercises import package_name
from courseware.paths import foundation_paths, notebook_paths

PATHS = [*notebook_paths(), *foundation_paths()]


def code_of(path) -> str:
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    return "\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")


@pytest.mark.parametrize("path", PATHS, ids=lambda path: path.name[:2])
def test_a_package_hands_on_what_its_notebook_asks_for(path):
    name = package_name(path.name[:2])
    package = importlib.import_module(f"courseware.lessons.{name}")
    asked = re.findall(rf"(?<![.\w]){name}\.(\w+)", code_of(path))
    assert [one for one in {*asked, "PANELS"} if not hasattr(package, one)] == []


@pytest.mark.parametrize("path", PATHS, ids=lambda path: path.name[:2])
def test_what_a_notebook_imports_from_the_library_is_there(path):
    for node in ast.walk(ast.parse(code_of(path))):
        if isinstance(node, ast.ImportFrom) and node.module.startswith(("course_lib", "courseware")):
            module = importlib.import_module(node.module)
            for alias in node.names:
                if not hasattr(module, alias.name):
                    importlib.import_module(f"{node.module}.{alias.name}")
