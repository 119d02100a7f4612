import pytest

from course_lib.rendering.renderer import DepthRenderer
from tests.rendering.shapes import SMALL, furnished_room


@pytest.fixture(scope="session")
def renderer():
    with DepthRenderer(furnished_room(), SMALL) as opened:
        yield opened
