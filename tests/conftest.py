"""Fixtures of all tests."""

import functools
import hashlib
import os
import pickle
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
        if walk or (item.path.name == "test_nbgrader.py" and item.get_closest_marker("slow")):
            item.add_marker("release")
    long = {item.path for item in items if any(item.get_closest_marker(name) for name in ("browser", "slow"))}
    long |= {item.path for item in items if "values_once" in getattr(item, "fixturenames", ())}
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


@pytest.fixture(scope="module")
def values_once():
    """All exercises, with references and known mistakes that compute each value once: a module judges many answers."""
    from course_lib.lessons.kit.exercises import Exercise, lesson_exercises, lesson_numbers

    def once(function, key):
        kept = {}

        @functools.wraps(function)
        def kept_or_computed(*arguments):
            name = hashlib.sha256(pickle.dumps(key(*arguments))).digest()
            if name not in kept:
                kept[name] = function(*arguments)
            return kept[name]

        return kept_or_computed

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Exercise, "draw", once(Exercise.draw, lambda self, rng: (self.number, rng.bit_generator.state)))
        for exercise in [exercise for number in lesson_numbers() for exercise in lesson_exercises(number)]:
            patch.setitem(vars(exercise), "reference", once(exercise.reference, lambda *given: given))
            for mistake in exercise.mistakes:
                patch.setitem(vars(mistake), "function", once(mistake.function, lambda *given: given))
                patch.setitem(vars(mistake), "others", tuple(once(one, lambda *given: given) for one in mistake.others))
        yield
