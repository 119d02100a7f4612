"""Every control of every panel at its least, default and greatest value, moved a little at a time, and its buttons."""

import importlib
import pkgutil
import re
from pathlib import Path

import cv2
import nbformat
import numpy as np
import pytest

import course_lib.lessons
from course_lib.lessons.kit.panel import Panel, Slider
from course_lib.paths import notebook_paths


def panel_makers() -> dict:
    """Title -> function that makes the panel, of all lesson modules."""
    folder = Path(course_lib.lessons.__file__).parent
    names = sorted(m.name for m in pkgutil.iter_modules([str(folder)]) if re.fullmatch(r"lesson_\d\d", m.name))
    modules = [importlib.import_module(f"course_lib.lessons.{name}") for name in names]
    return {title: maker for module in modules for title, maker in getattr(module, "PANELS", {}).items()}


MAKERS = panel_makers()


@pytest.fixture(scope="module", params=list(MAKERS), ids=lambda title: title.replace(" ", "-"))
def panel(request) -> Panel:
    """A panel that draws the same values once: that they give the same picture again is a test below."""
    panel, drawn = MAKERS[request.param](), {}

    def draw(**values):
        key = repr(sorted(values.items()))
        if key not in drawn:
            drawn[key] = panel.draw_anew(**values)
        return drawn[key]

    panel.draw_anew, panel.draw = panel.draw, draw
    return panel


def is_picture(png: bytes) -> bool:
    return cv2.imdecode(np.frombuffer(png, np.uint8), cv2.IMREAD_COLOR) is not None


def test_every_panel_in_a_notebook_is_registered_and_the_other_way_round():
    shown = set()
    for path in notebook_paths():
        for cell in nbformat.read(path, as_version=4).cells:
            for output in cell.get("outputs", []):
                text = output.get("data", {}).get("text/plain", "")
                shown.update(re.findall(r"^Panel '([^']+)'", text))
    assert shown == set(MAKERS)


def test_a_panel_bears_its_registered_title(panel):
    assert panel.title in MAKERS


def test_every_control_works_at_its_least_default_and_greatest_value(panel):
    for name, control in panel.controls.items():
        for value in control.test_values():
            drawing = panel.draw(**(panel.defaults() | {name: value}))
            assert is_picture(drawing.png), f"{name} = {value}"
            assert len(drawing.alt.split()) >= 4
            assert drawing.summary.strip()
            panel.set(**{name: value})
            assert panel.values()[name] == value, f"{name} cannot be set to {value}"
        panel.set(**panel.defaults())


def test_all_controls_at_their_ends_together(panel):
    for end in (0, -1):
        values = {name: control.test_values()[end] for name, control in panel.controls.items()}
        assert is_picture(panel.draw(**values).png)


def test_every_control_changes_what_is_shown(panel):
    for name, control in panel.controls.items():
        shown = {
            (d.png, d.summary) for d in (panel.draw(**(panel.defaults() | {name: v})) for v in control.test_values())
        }
        assert len(shown) > 1, f"{name} changes nothing"


def test_every_button_does_its_work(panel):
    for label in panel.actions:
        panel.press(label)
        assert panel.error is None
    panel.press("Reset")
    assert panel.values() == panel.defaults()


def test_the_same_values_give_the_same_picture(panel):
    assert panel.draw_anew(**panel.defaults()) == panel.draw(**panel.defaults())


def test_a_slider_that_is_dragged_shows_each_place(panel):
    if not panel.continuous:
        pytest.skip("redraws on release of the slider")
    for name, control in panel.controls.items():
        if isinstance(control, Slider):
            for share in (0.3, 0.6):
                steps = round(share * (control.maximum - control.minimum) / control.step)
                value = control.minimum + steps * control.step
                panel.set(**{name: value})
                assert panel.values()[name] == pytest.approx(value)
                assert panel.error is None
    panel.press("Reset")
