"""Fixtures of all tests."""

import os
import sys
from pathlib import Path

import numpy as np
import pytest

if sys.platform.startswith("linux"):
    os.environ["VTK_DEFAULT_OPENGL_WINDOW"] = os.environ.get("VTK_DEFAULT_OPENGL_WINDOW") or "vtkEGLRenderWindow"

ROOT = Path(__file__).parents[1]


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
