"""Fixtures of all tests."""

import os
import signal
import sys
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from hypothesis import HealthCheck, settings

# How long an example takes says nothing about the code: the machine may have other work. The same examples every time.
settings.register_profile("suite", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("suite")

if sys.platform.startswith("linux"):
    os.environ["VTK_DEFAULT_OPENGL_WINDOW"] = os.environ.get("VTK_DEFAULT_OPENGL_WINDOW") or "vtkEGLRenderWindow"

if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    # What a script starts in the background ignores Ctrl-C, and hands that on: tests that send one would wait for ever.
    signal.signal(signal.SIGINT, signal.default_int_handler)

matplotlib.use("Agg")  # not by MPLBACKEND, which the lessons' kernels would inherit

# nbformat's validator imports this grammar of web addresses if it is there: over a second, for what no test checks.
sys.modules["rfc3987_syntax"] = None

ROOT = Path(__file__).parents[1]

# The one walk through JupyterLab in a browser that every run takes: the panel with the most controls.
EVERYDAY_WALK = "test_browser.py::test_a_lesson_runs_and_its_first_panel_answers[07_"


def pytest_collection_modifyitems(items):
    """Mark what drives a browser, and what only `course.py test --all` runs, and put the files that take long first.

    A file stays on one processor: a long one that began last would keep one busy while the others have nothing to do.
    """
    for item in items:
        if {"page", "browser"} & set(getattr(item, "fixturenames", ())):
            item.add_marker("browser")
        walk = item.get_closest_marker("browser") and EVERYDAY_WALK not in item.nodeid
        if walk or (item.path.parent.name == "classroom" and item.get_closest_marker("slow")):
            item.add_marker("release")
    long = {item.path for item in items if any(item.get_closest_marker(name) for name in ("browser", "slow"))}
    long |= {item.path for item in items if item.path.name == "test_all_exercises.py"}
    items.sort(key=lambda item: 0 if item.path in long else 1 if item.path.suffix == ".ipynb" else 2)


@pytest.fixture
def rng():
    """A generator with a fixed seed."""
    return np.random.default_rng(20260)


@pytest.fixture(scope="session")
def corridor_folder():
    """The shipped corridor data."""
    return ROOT / "data" / "corridor"


@pytest.fixture(scope="session")
def kitchen_folder():
    """The real Kinect recording beside the project; tests that need it are skipped where it is absent."""
    folder = ROOT.parent / "shared" / "real" / "kinect_kitchen"
    if not folder.is_dir():
        pytest.skip(f"the real recording is not here ({folder}); it is not part of the repository")
    return folder
