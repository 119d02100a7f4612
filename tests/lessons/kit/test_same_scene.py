"""Which pages show the same scene."""

import pytest

from course_lib.lessons.kit.same_scene import same_scene
from tests.plots.test_scene_page import STATE, axes_page


@pytest.fixture(scope="module")
def page() -> str:
    return axes_page()


def test_pages_that_differ_by_rounding_show_the_same(page):
    moved = axes_page(STATE + 1e-5)
    assert moved != page
    assert same_scene(moved, page)


@pytest.mark.parametrize(
    "change",
    [{"state": STATE + 0.01}, {"colour": "#D55E00"}, {"title": "Other axes"}, {"alt": "The axes of another pose"}],
    ids=["place", "colour", "title", "words"],
)
def test_pages_that_differ_show_something_else(page, change):
    assert not same_scene(axes_page(**change), page)
