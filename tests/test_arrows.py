"""Arrows between modules point one way: lessons, plots, experiments, a method, geometry (DESIGN.md, section 3)."""

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "course_lib"

# Part of the library -> parts it may import besides itself. commands and cli stand above all of them, but for lessons.
BELOW = {
    *("child", "frame_order", "geometry", "output_folder", "reading", "scratch", "unfinished", "worker_pool"),
    "writing",
}
METHODS = BELOW | {"depth_mcl", "spherical_stereo"}
ALLOWED = {
    "frame_order": set(),
    "geometry": set(),
    "paths": set(),
    "reading": set(),
    "unfinished": set(),
    "scratch": {"unfinished"},
    "child": {"reading", "scratch"},
    "writing": {"unfinished"},
    "output_folder": {"unfinished", "writing"},
    "processors": set(),
    "worker_pool": set(),
    "depth_mcl": BELOW | {"processors"},
    "spherical_stereo": BELOW,
    "simulation": METHODS,
    "experiments": METHODS | {"processors", "simulation"},
    "plots": METHODS | {"experiments"},
    "lessons": METHODS | {"experiments", "paths", "plots", "simulation"},
    "classroom": METHODS | {"experiments", "lessons", "paths"},
    "detector_training": METHODS | {"experiments", "simulation"},
}

# Paper 2's folders in the order in which an image walks through them; each imports only what stands before it.
WALK = ("panorama", "detection", "matching", "ranging", "semantic_map", "pose", "localizer")


def imported_names(path):
    """Dotted names that a file imports, wherever in the file."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path} uses a relative import: write course_lib.… in full"
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def imported_parts(path, below=("course_lib",)):
    """The words that follow `below` in the names that a file imports."""
    for name in imported_names(path):
        words = tuple(name.split("."))
        if words[: len(below)] == tuple(below) and len(words) > len(below):
            yield words[len(below)]


def modules_of(folder, part):
    """The files of a part, be it one module or a folder."""
    alone = folder / f"{part}.py"
    return [alone] if alone.exists() else sorted((folder / part).glob("**/*.py"))


def test_every_folder_of_the_library_has_its_arrows_drawn():
    folders = {path.name for path in PACKAGE.iterdir() if path.is_dir() and list(path.glob("*.py"))}
    assert folders == (set(ALLOWED) - BELOW - {"paths", "processors"}) | {"commands"}


@pytest.mark.parametrize("part", ALLOWED)
def test_every_part_imports_only_what_the_design_allows(part):
    paths = modules_of(PACKAGE, part)
    assert paths
    for path in paths:
        strangers = set(imported_parts(path)) - ALLOWED[part] - {part}
        assert not strangers, f"{path.relative_to(PACKAGE)} imports {strangers}"


def test_commands_run_without_what_only_the_notebooks_use():
    for path in modules_of(PACKAGE, "commands"):
        assert "lessons" not in set(imported_parts(path)), f"{path.name} imports lessons, and with it IPython"


@pytest.mark.parametrize("part", WALK)
def test_an_image_walks_forward_through_paper_2(part):
    before = set(WALK[: WALK.index(part) + 1])
    paths = modules_of(PACKAGE / "spherical_stereo", part)
    assert paths
    for path in paths:
        strangers = set(imported_parts(path, ("course_lib", "spherical_stereo"))) - before
        assert not strangers, f"{path.relative_to(PACKAGE)} imports {strangers}"


def test_the_test_sees_an_import_that_is_there():
    assert "depth_mcl" in set(imported_parts(PACKAGE / "experiments" / "corridor.py"))
    localizer = PACKAGE / "spherical_stereo" / "localizer.py"
    assert "pose" in set(imported_parts(localizer, ("course_lib", "spherical_stereo")))
