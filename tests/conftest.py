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

ROOT = Path(__file__).parents[1]


def pytest_collection_modifyitems(items):
    """Marks what drives a browser, so that a quick run can leave it out, and puts the files that take long first.

    A file stays on one processor: a long one that began last would keep one busy while the others have nothing to do.
    """
    for item in items:
        if {"page", "browser"} & set(getattr(item, "fixturenames", ())):
            item.add_marker("browser")
    long = {item.path for item in items if item.path.suffix == ".ipynb"}
    long |= {item.path for item in items if any(item.get_closest_marker(name) for name in ("browser", "slow"))}
    items.sort(key=lambda item: (item.path not in long, item.path.suffix != ".ipynb"))


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
