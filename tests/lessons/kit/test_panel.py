"""The panel itself: what its controls do, what it shows and stores, and that no error is lost."""

import base64
import io
import re

import ipywidgets
import pytest
from PIL import Image

from courseware.lessons.kit.compression import png_bytes
from courseware.lessons.kit.display import FigureError
from courseware.lessons.kit.panel import VIEW, Choice, Drawing, Panel, Slider, Switch
from courseware.plots import figures

PNG = png_bytes(figures.new_figure(size=(1, 1))[0])
CONTROLS = [Slider("x", "x [m]", 0.01, 4, 1, 0.05), Choice("kind", "kind", ("a", "b"), "a"), Switch("on", "on")]


@pytest.fixture
def drawn():
    """The values that a panel of `make` was drawn with since this list was cleared."""
    return []


@pytest.fixture
def make(drawn):
    def draw(x: float, **others) -> Drawing:
        drawn.append({"x": x, **others})
        if x > 3:
            raise ValueError("x is too large")
        return Drawing(PNG, f"A test picture with x {x:g}, {others}", f"x = {x:g} <m>")

    def made(*controls, **options) -> Panel:
        panel = Panel("test", controls or CONTROLS, draw, **options)
        drawn.clear()
        return panel

    return made


def all_widgets(widget) -> list:
    return [widget] + [w for child in getattr(widget, "children", ()) for w in all_widgets(child)]


def widget_of(panel: Panel, kind: type):
    return next(w for w in all_widgets(panel.box) if type(w) is kind)


def test_a_slider_and_its_number_box_move_together_and_draw_once(make, drawn):
    panel = make(CONTROLS[0])
    slider, box = widget_of(panel, ipywidgets.FloatSlider), widget_of(panel, ipywidgets.BoundedFloatText)
    slider.value = 0.15000000000000002  # as a browser says it
    assert box.value == panel.values()["x"] == 0.15
    box.value = 0.61
    assert slider.value == 0.61
    assert drawn == [{"x": 0.15}, {"x": 0.61}]
    box.value = 0.123  # typed, finer than the steps
    assert slider.value == box.value == 0.12


def test_a_slider_is_not_told_what_it_said_itself(make):
    """By the time it hears of it the reader may have moved it on: it would jump back and stay there."""
    panel = make(CONTROLS[0])
    slider = widget_of(panel, ipywidgets.FloatSlider)
    slider.set_state({"value": 0.15000000000000002})  # a message of the browser
    assert slider.value == 0.15000000000000002
    assert panel.values()["x"] == 0.15


def test_a_moved_control_redraws_picture_and_numbers_and_several_are_set_with_one_redraw(make, drawn):
    panel = make()
    widget_of(panel, ipywidgets.FloatSlider).value = 2.0
    assert "A test picture with x 2, {&#x27;kind&#x27;: &#x27;a&#x27;" in panel._picture.value
    assert re.fullmatch(r'<pre role="status" style="[^"]+">x = 2 &lt;m&gt;</pre>', panel._summary.value)
    drawn.clear()
    panel.set(kind="b", on=True)
    assert drawn == [{"x": 2, "kind": "b", "on": True}]


def test_buttons_set_values_say_what_they_are_doing_and_reset_goes_back(make):
    said = []

    def double(values: dict) -> dict:
        panel.say("1 of 2: <looking>")
        said.append(panel._summary.value)
        return {"x": 2 * values["x"], "on": True}

    panel = make(actions={"Double": double})
    picture = panel._picture.value
    next(w for w in all_widgets(panel.box) if getattr(w, "description", "") == "Double").click()
    assert said == ['<p role="status">1 of 2: &lt;looking&gt;</p>']
    assert panel.values() == {"x": 2, "kind": "a", "on": True}
    panel.press("Reset")
    assert panel.values() == panel.defaults() == {"x": 1, "kind": "a", "on": False}
    assert panel._picture.value == picture


def test_an_error_is_raised_shown_and_the_old_picture_stays(make):
    panel = make()
    old = panel._picture.value
    with pytest.raises(ValueError, match="too large"):
        panel.set(x=4)
    assert panel._picture.value == old
    assert "This panel failed" in panel._summary.value
    assert isinstance(panel.error, ValueError)
    panel.set(x=2)
    assert panel.error is None
    assert "failed" not in panel._summary.value


@pytest.mark.parametrize(("photograph", "kind"), [(False, "png"), (True, "webp")])
def test_the_bundle_carries_the_defaults_as_a_still_whatever_the_controls_say(make, photograph, kind):
    panel = make(photograph=photograph)
    panel.set(x=3)
    bundle = panel._repr_mimebundle_()
    assert bundle.keys() == {"text/plain", "text/html", VIEW}
    assert bundle["text/plain"] == "Panel 'test': x [m], kind, on"
    assert "A test picture with x 1, " in bundle["text/html"]
    assert bundle["text/html"].endswith("<p>Run this cell to move the controls.</p>")
    assert bundle[VIEW]["model_id"] == panel.box.model_id
    data = re.search(rf'src="data:image/{kind};base64,([^"]+)"', bundle["text/html"])[1]
    assert Image.open(io.BytesIO(base64.b64decode(data))).format.lower() == kind


def test_only_plain_widgets_are_used_each_with_a_name_and_no_tooltip_that_reads_null(make):
    panel = make()
    labels = {"FloatSlider", "BoundedFloatText", "Dropdown"}
    for widget in all_widgets(panel.box):
        kind = type(widget).__name__
        assert kind in {"VBox", "HBox", "Checkbox", "Button", "HTML"} | labels
        assert kind not in {"Checkbox"} | labels or widget.description in ("x [m]", "kind", "on")
        assert kind not in labels or widget.tooltip == widget.description  # None is written as title="null"
    assert widget_of(panel, ipywidgets.BoundedFloatText).style.description_width == "0px"  # heard, not seen twice


@pytest.mark.parametrize("letters", [5, 40])
def test_a_long_label_gets_the_room_that_it_needs_and_a_slow_panel_redraws_on_release(make, letters):
    panel = make(Slider("x", "x" * letters, 0, 4, 1, 0.5), Switch("on", "o" * 60), continuous=letters < 40)
    slider = widget_of(panel, ipywidgets.FloatSlider)
    assert slider.continuous_update is (letters < 40)
    label_em = float(slider.style.description_width.removesuffix("em"))
    assert label_em == pytest.approx(max(14, 0.55 * letters))  # 0.52 em a letter was measured in JupyterLab
    assert float(slider.layout.width.removesuffix("em")) == pytest.approx(label_em + 20)
    assert widget_of(panel, ipywidgets.Checkbox).layout.width == "auto"  # else it is 300 px wide, and its label cut


def test_controls_need_names_of_their_own_and_pictures_words():
    for controls in ([Switch("a", "one"), Switch("a", "two")], []):
        with pytest.raises(ValueError, match="different names"):
            Panel("test", controls, lambda **values: None)
    with pytest.raises(FigureError):
        Panel("test", CONTROLS[2:], lambda on: Drawing(PNG, "", "nothing"))
