"""The shipped data. Without embreex no world can be ray-cast, and the tests are left out."""

from importlib.util import find_spec
from pathlib import Path

import pytest

from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap
from courseware.simulation.room.stereo_recording import read_stereo_recording

collect_ignore_glob = [] if find_spec("embreex") else ["test_*.py"]
DATA = Path(__file__).resolve().parents[2] / "data"


@pytest.fixture(scope="session")
def recordings():
    """The room's two recordings, by the number of the experiment."""
    return {number: read_stereo_recording(DATA / "room" / f"experiment_{number}") for number in (1, 2)}


@pytest.fixture(scope="session")
def semantic_map():
    return SemanticMap.load(DATA / "room" / "semantic_map.json")


@pytest.fixture(scope="session")
def detector():
    return YoloDetector.load(DATA / "detector")
