"""Arrows between modules point one way: lessons -> depth_mcl -> geometry; no method imports worlds."""

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "course_lib"

# Part of the library -> parts it may import besides itself. commands, cli and datasets may import anything.
ALLOWED = {
    "geometry": set(),
    "depth_mcl": {"geometry"},
    "worlds": {"geometry", "depth_mcl", "spherical_stereo", "datasets"},
    # Lessons show what sensors do, and worlds simulates them; no method imports worlds, and worlds no lesson.
    "lessons": {"geometry", "depth_mcl", "spherical_stereo", "datasets", "worlds"},
    "spherical_stereo": {"geometry"},
    "detector_training": {"geometry", "spherical_stereo", "worlds"},
}


def imported_parts(path):
    """First names below course_lib that a file imports, wherever in the file."""
    for node in ast.walk(ast.parse(path.read_text())):
        names = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path} uses a relative import: write course_lib.… in full"
            names = [f"{node.module}.{alias.name}" for alias in node.names]
        for name in names:
            words = name.split(".")
            if words[0] == "course_lib" and len(words) > 1:
                yield words[1]


@pytest.mark.parametrize("part", ALLOWED)
def test_every_part_imports_only_what_the_design_allows(part):
    paths = [PACKAGE / f"{part}.py"] if (PACKAGE / f"{part}.py").exists() else list((PACKAGE / part).glob("**/*.py"))
    for path in paths:
        strangers = set(imported_parts(path)) - ALLOWED[part] - {part}
        assert not strangers, f"{path.relative_to(PACKAGE)} imports {strangers}"


def test_the_test_sees_an_import_that_is_there():
    assert "depth_mcl" in set(imported_parts(PACKAGE / "datasets.py"))
