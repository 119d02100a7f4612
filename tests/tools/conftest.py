"""A maintainers' tool is run as its command line runs it, in this process."""

import importlib

import pytest

from courseware.cli import call


@pytest.fixture
def run_tool():
    """Run `python -m tools.NAME WORDS` and return its exit code."""

    def run(name, *words):
        return call(lambda: importlib.import_module(f"tools.{name}"), f"python -m tools.{name}", [*map(str, words)])

    return run
