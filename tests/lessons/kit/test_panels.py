"""Every control of every panel at its least, default and greatest value, moved a little at a time, and its buttons."""

import importlib
import re

import cv2
import numpy as np
import pytest

from courseware.lessons.kit.panel import Choice, Panel, Slider
from courseware.paths import REPOSITORY, foundation_paths, notebook_paths

PATHS = [*notebook_paths(), *foundation_paths()]
FILES = sorted((REPOSITORY / "courseware" / "lessons").glob("*_*/*.py"))
NAMES = [
    f"courseware.lessons.{one.parent.name}.{one.stem}" for one in FILES if "\nPANELS = {" in one.read_text("utf-8")
]
MAKERS = {title: maker for name in NAMES for title, maker in importlib.import_module(name).PANELS.items()}


@pytest.fixture(scope="module", params=list(MAKERS), ids=lambda title: title.replace(" ", "-"))
def panel(request) -> Panel:
    """A panel that draws the same values once: that they give the same picture again is a test below."""
    panel, drawn = MAKERS[request.param](), {}
    assert panel.title == request.param

    def draw(**values):
        key = repr(sorted(values.items()))
        if key not in drawn:
            drawn[key] = panel.draw_anew(**values)
        return drawn[key]

    panel.draw_anew, panel.draw = panel.draw, draw
    return panel


def values_of(control) -> tuple:
    """The smallest, the default and the largest value of a slider, or all values of another control."""
    if isinstance(control, Slider):
        return control.minimum, control.default, control.maximum
    return control.options if isinstance(control, Choice) else (False, True)


def is_picture(png: bytes) -> bool:
    return cv2.imdecode(np.frombuffer(png, np.uint8), cv2.IMREAD_COLOR) is not None


def test_every_panel_in_a_notebook_is_registered_and_the_other_way_round():
    assert {one for path in PATHS for one in re.findall(r"\"Panel '([^']+)'", path.read_text())} == set(MAKERS)


def test_every_control_works_at_its_ends_and_changes_what_is_shown(panel):
    for name, control in panel.controls.items():
        shown = set()
        for value in values_of(control):
            drawing = panel.draw(**(panel.defaults() | {name: value}))
            assert is_picture(drawing.png), f"{name} = {value}"
            assert len(drawing.alt.split()) >= 4
            assert drawing.summary.strip()
            shown.add((drawing.png, drawing.summary))
            panel.set(**{name: value})
            assert panel.values()[name] == value, f"{name} cannot be set to {value}"
        assert len(shown) > 1, f"{name} changes nothing"
        panel.set(**panel.defaults())


def test_all_controls_at_their_ends_together(panel):
    for end in (0, -1):
        values = {name: values_of(control)[end] for name, control in panel.controls.items()}
        assert is_picture(panel.draw(**values).png)


def test_every_button_does_its_work(panel):
    for label in [*panel.actions, "Reset"]:
        panel.press(label)
        assert panel.error is None
    assert panel.values() == panel.defaults()


def test_the_same_values_give_the_same_picture(panel):
    assert panel.draw_anew(**panel.defaults()) == panel.draw(**panel.defaults())


def test_a_slider_that_is_dragged_shows_each_place(panel):
    sliders = [one for one in panel.controls.values() if isinstance(one, Slider) and panel.continuous]
    for one in sliders:
        for share in (0.3, 0.6):
            value = one.minimum + round(share * (one.maximum - one.minimum) / one.step) * one.step
            panel.set(**{one.name: value})
            assert panel.values()[one.name] == pytest.approx(value)
            assert panel.error is None
    panel.press("Reset")
