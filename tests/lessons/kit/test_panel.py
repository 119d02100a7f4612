"""The panel itself: what its controls do, what it shows and stores, and that no error is lost."""

import base64
import io
import re

import ipywidgets
import pytest
from PIL import Image

from course_lib.lessons.kit.compression import png_bytes
from course_lib.lessons.kit.display import FigureError, Picture
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider, Switch
from course_lib.plots import figures

FIGURE, _AXES = figures.new_figure(size=(1, 1))
PNG = png_bytes(FIGURE)
VIEW = "application/vnd.jupyter.widget-view+json"


def draw(x: float, kind: str, on: bool) -> Drawing:
    if x > 3:
        raise ValueError("x is too large")
    return Drawing(PNG, f"A test picture with x {x:g}, {kind}, {on}", f"x = {x:g} <m>")


def make(**options) -> Panel:
    controls = [Slider("x", "x [m]", 0, 4, 1, 0.5), Choice("kind", "kind", ("a", "b"), "a"), Switch("on", "on")]
    return Panel("test", controls, draw, **options)


def all_widgets(widget) -> list:
    return [widget] + [w for child in getattr(widget, "children", ()) for w in all_widgets(child)]


def widget_of(panel: Panel, kind: type):
    return next(w for w in all_widgets(panel.box) if type(w) is kind)


def test_a_slider_and_its_number_box_move_together():
    panel = make()
    slider, box = widget_of(panel, ipywidgets.FloatSlider), widget_of(panel, ipywidgets.BoundedFloatText)
    slider.value = 2.5
    assert box.value == 2.5
    box.value = 0.5
    assert slider.value == 0.5
    assert panel.values()["x"] == 0.5


def test_what_a_browser_adds_to_a_number_is_dropped_and_draws_once():
    calls = []
    panel = Panel("test", [Slider("x", "x", 0.01, 1, 0.2, 0.05)], lambda **v: calls.append(v["x"]) or _any())
    calls.clear()
    widget_of(panel, ipywidgets.FloatSlider).value = 0.15000000000000002
    assert calls == [0.15]
    assert widget_of(panel, ipywidgets.BoundedFloatText).value == 0.15
    widget_of(panel, ipywidgets.BoundedFloatText).value = 0.61
    assert calls == [0.15, 0.61]
    assert widget_of(panel, ipywidgets.FloatSlider).value == 0.61


def test_a_slider_is_not_told_what_it_said_itself():
    """By the time it hears of it the reader may have moved it on: it would jump back and stay there."""
    panel = Panel("A title", [Slider("a", "a", 0, 1, 0.1, 0.05)], lambda **values: _any())
    slider, box = widget_of(panel, ipywidgets.FloatSlider), widget_of(panel, ipywidgets.BoundedFloatText)
    slider.set_state({"value": 0.15000000000000002})  # a message of the browser
    assert box.value == 0.15
    assert slider.value == 0.15000000000000002
    box.value = 0.123  # typed, finer than the steps
    assert slider.value == box.value == 0.12


def test_a_moved_slider_redraws_picture_and_numbers():
    panel = make()
    slider = widget_of(panel, ipywidgets.FloatSlider)
    slider.value = 2.0
    shown = [w.value for w in all_widgets(panel.box) if isinstance(w, ipywidgets.HTML)]
    assert 'alt="A test picture with x 2, a, False"' in shown[0]
    assert re.fullmatch(r'<pre role="status" style="[^"]+">x = 2 &lt;m&gt;</pre>', shown[1])


def test_several_controls_are_set_with_one_redraw():
    calls = []
    panel = Panel("test", [Slider("x", "x", 0, 4, 1, 1), Switch("on", "on")], lambda **v: calls.append(v) or _any())
    calls.clear()
    panel.set(x=2, on=True)
    assert calls == [{"x": 2, "on": True}]


def _any() -> Drawing:
    return Drawing(PNG, "Some picture for a test", "no numbers")


def test_reset_and_other_buttons_can_be_called_and_clicked():
    panel = make(actions={"Double": lambda values: {"x": 2 * values["x"]}})
    panel.press("Double")
    assert panel.values()["x"] == 2
    panel.set(kind="b", on=True)
    panel.press("Reset")
    assert panel.values() == panel.defaults() == {"x": 1, "kind": "a", "on": False}
    button = next(w for w in all_widgets(panel.box) if getattr(w, "description", "") == "Double")
    button.click()
    assert panel.values()["x"] == 2


def test_an_error_is_raised_shown_and_the_old_picture_stays():
    panel = make()
    picture, summary = (w for w in all_widgets(panel.box) if isinstance(w, ipywidgets.HTML))
    old = picture.value
    with pytest.raises(ValueError, match="too large"):
        panel.set(x=4)
    assert picture.value == old
    assert "This panel failed" in summary.value
    assert isinstance(panel.error, ValueError)
    panel.set(x=2)
    assert panel.error is None
    assert "failed" not in summary.value


def test_a_panel_says_what_it_is_doing_and_keeps_its_picture_till_it_is_done():
    panel = make()
    picture, said = panel._picture.value, []

    def work(values: dict) -> dict:
        panel.say("1 of 2: <looking>")
        said.append((panel._summary.value, panel._picture.value))
        return {"x": 2.0}

    panel.actions["Work"] = work
    panel.press("Work")
    assert said == [('<p role="status">1 of 2: &lt;looking&gt;</p>', picture)]
    assert "x = 2 &lt;m&gt;" in panel._summary.value


def test_the_bundle_carries_the_defaults_as_a_still_whatever_the_controls_say():
    panel = make()
    panel.set(x=3)
    bundle = panel._repr_mimebundle_()
    assert set(bundle) == {"text/plain", "text/html", VIEW}
    assert bundle["text/plain"] == "Panel 'test': x [m], kind, on"
    assert "A test picture with x 1, a, False" in bundle["text/html"]
    assert "Run this cell to move the controls." in bundle["text/html"]
    assert bundle[VIEW]["model_id"] == panel.box.model_id


def test_only_a_panel_of_photographs_is_stored_as_one():
    def still(panel: Panel) -> str:
        data = re.search(r'src="data:image/(png|webp);base64,([^"]+)"', panel._repr_mimebundle_()["text/html"])
        assert Image.open(io.BytesIO(base64.b64decode(data[2]))).format.lower() == data[1]
        return data[1]

    assert still(make()) == "png"
    assert still(make(photograph=True)) == "webp"


def test_every_control_has_a_name_in_any_front_end_and_no_tooltip_that_reads_null():
    panel = make()
    for widget in all_widgets(panel.box):
        if isinstance(widget, ipywidgets.ValueWidget) and not isinstance(widget, ipywidgets.HTML):
            assert widget.description in ("x [m]", "kind", "on")
        if isinstance(widget, ipywidgets.FloatSlider | ipywidgets.Dropdown | ipywidgets.BoundedFloatText):
            assert widget.tooltip == widget.description  # None is written as title="null"
    box = widget_of(panel, ipywidgets.BoundedFloatText)
    assert box.style.description_width == "0px"  # heard, not seen a second time


def test_slow_panels_redraw_on_release():
    assert widget_of(make(), ipywidgets.FloatSlider).continuous_update is True
    assert widget_of(make(continuous=False), ipywidgets.FloatSlider).continuous_update is False


@pytest.mark.parametrize("letters", [5, 40])
def test_a_long_label_gets_the_room_that_it_needs_and_the_slider_keeps_its_own(letters):
    panel = Panel("test", [Slider("x", "x" * letters, 0, 4, 1, 0.5), Switch("on", "o" * 60)], lambda x, on: _any())
    slider, box = widget_of(panel, ipywidgets.FloatSlider), widget_of(panel, ipywidgets.Checkbox)
    label_em = float(slider.style.description_width.removesuffix("em"))
    assert label_em >= max(14, 0.52 * letters)  # 0.52 em a letter was measured in JupyterLab
    assert float(slider.layout.width.removesuffix("em")) == pytest.approx(label_em + 20)
    assert box.layout.width == "auto"  # else a check box is 300 px wide, and its label cut


def test_only_plain_widgets_are_used():
    allowed = {"VBox", "HBox", "FloatSlider", "BoundedFloatText", "Dropdown", "Checkbox", "Button", "HTML"}
    assert {type(w).__name__ for w in all_widgets(make().box)} <= allowed


def test_controls_need_names_of_their_own():
    with pytest.raises(ValueError, match="different names"):
        Panel("test", [Switch("a", "one"), Switch("a", "two")], lambda a: _any())
    with pytest.raises(ValueError, match="different names"):
        Panel("test", [], lambda: _any())


def test_a_picture_without_alternative_text_is_refused():
    with pytest.raises(FigureError):
        Panel("test", [Switch("a", "a")], lambda a: Drawing(PNG, "", "nothing"))
    assert Picture(PNG, "four words will do").alt
