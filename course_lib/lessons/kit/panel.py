"""Panels: a few controls above one picture that is redrawn at once.

A panel is a list of controls and a function that turns their values into a `Drawing`. The picture is an `HTML` widget
with an `<img alt=...>`. We do not use ipywidgets' `Output`, because it sometimes hung and wrote text into stored
notebooks.

`panel.draw(**values)` and the functions in `panel.actions` are plain functions. Tests call them directly, so an error
is never lost in a widget's callback. The reader sees an error under the picture, and the picture keeps its last state.

A stored notebook holds a still of the panel: the picture at the defaults, its numbers, and a sentence that says how to
get the controls. The extension of `course.py lab` (course_lib/commands/lab_extension) finds panels by their CSS classes
"course-...".
"""

import html
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import cv2
import ipywidgets as widgets
import numpy as np
from IPython.display import display

from course_lib.lessons.kit.compression import compress, compress_photograph
from course_lib.lessons.kit.display import Picture


@dataclass(frozen=True)
class Drawing:
    """The result of one redraw: a PNG, its alternative text, and one or two lines of numbers."""

    png: bytes
    alt: str
    summary: str


@dataclass(frozen=True)
class Slider:
    """A number from `minimum` to `maximum` in steps of `step`, with a number box beside the slider."""

    name: str
    label: str
    minimum: float
    maximum: float
    default: float
    step: float

    def test_values(self) -> tuple:
        """Return the smallest, the default and the largest value."""
        return self.minimum, self.default, self.maximum


@dataclass(frozen=True)
class Choice:
    """One of a few named options."""

    name: str
    label: str
    options: tuple[str, ...]
    default: str

    def test_values(self) -> tuple:
        """Return all options."""
        return self.options


@dataclass(frozen=True)
class Switch:
    """A check box."""

    name: str
    label: str
    default: bool = False

    def test_values(self) -> tuple:
        """Return both values."""
        return False, True


Control = Slider | Choice | Switch

NO_CONTROLS_HERE = "<p>Run this cell to move the controls.</p>"
MIN_LABEL_EM = 14.0  # so that the sliders of most panels start at the same place
EM_PER_LETTER = 0.55  # up to 0.52 measured in JupyterLab, which cuts a label that is too long


def _pair(slider: widgets.FloatSlider, number: widgets.BoundedFloatText, control: Slider) -> None:
    """Move slider and number box together. A browser's slider says 0.15000000000000002, so the box rounds it to 0.15.

    We do not send the slider's own value back to it. On a slow machine it has moved on, and would jump back.
    """
    digits = max(_decimals(control.step), _decimals(control.minimum))

    def to_number(change: dict) -> None:
        number.value = round(change["new"], digits)

    def to_slider(change: dict) -> None:
        if round(slider.value, digits) != change["new"]:
            slider.value = round(change["new"], digits)

    slider.observe(to_number, names="value")
    number.observe(to_slider, names="value")


def _numbers(text: str, role: str = "") -> str:
    """Return the HTML of a panel's numbers. Long lines break between words, so that no unit is cut."""
    return f'<pre{role} style="white-space: pre-wrap; word-break: normal">{html.escape(text)}</pre>'


def _decimals(value: float) -> int:
    """Return how many decimals a number needs, such as 2 for 0.05 and 0 for 15."""
    return len(f"{value:.10f}".rstrip("0").partition(".")[2])


class Panel:
    """Controls and the picture that they redraw.

    title: short, unique in its lesson. draw: takes every control's value by name and returns a `Drawing`. continuous:
    redraw while a slider moves; False redraws on release, for a `draw` that needs more than 0.15 s (median). actions:
    label -> function of the present values that returns the values to set; each is an extra button. photograph: store
    the still as WebP, because a photograph in the few colours of a palette shows patches.
    """

    def __init__(
        self,
        title: str,
        controls: Sequence[Control],
        draw: Callable[..., Drawing],
        continuous: bool = True,
        actions: dict[str, Callable[[dict], dict]] | None = None,
        photograph: bool = False,
    ) -> None:
        names = [control.name for control in controls]
        if len(set(names)) != len(names) or not names:
            raise ValueError(f"a panel needs controls with different names; got {names}")
        self.title, self.draw, self.continuous, self.photograph = title, draw, continuous, photograph
        self.controls: dict[str, Control] = {control.name: control for control in controls}
        self.actions = {"Reset": lambda values: self.defaults()} | (actions or {})
        self.error: Exception | None = None
        self._held = False
        self._inputs: dict[str, widgets.ValueWidget] = {}
        self._picture = widgets.HTML(tooltip="", layout=widgets.Layout(overflow="auto"))
        self._summary = widgets.HTML(tooltip="")
        self._summary.add_class("course-numbers")
        letters = max((len(control.label) for control in controls if not isinstance(control, Switch)), default=0)
        self._label_em = max(MIN_LABEL_EM, EM_PER_LETTER * letters)
        rows = [self._row(control) for control in controls]
        buttons = [self._button(label) for label in self.actions]
        wraps = widgets.Layout(flex_flow="row wrap")  # in a narrow window the buttons use a second line
        self.box = widgets.VBox([*rows, widgets.HBox(buttons, layout=wraps), self._picture, self._summary])
        self.box.add_class("course-panel")
        self.redraw()

    def defaults(self) -> dict:
        """Return the default value of every control by name."""
        return {name: control.default for name, control in self.controls.items()}

    def values(self) -> dict:
        """Return the present value of every control by name."""
        return {name: widget.value for name, widget in self._inputs.items()}

    def set(self, **values: object) -> None:
        """Set several controls and redraw once."""
        self._held = True
        try:
            for name, value in values.items():
                self._inputs[name].value = value
        finally:
            self._held = False
        self.redraw()

    def press(self, label: str) -> None:
        """Run the action of the button with this label."""
        self.set(**self.actions[label](self.values()))

    def redraw(self) -> None:
        """Draw the picture for the present values. An error is shown under the old picture and raised again."""
        try:
            drawing = self.draw(**self.values())
        except Exception as error:
            self.error = error
            self._summary.value = f'<p role="alert">This panel failed: {html.escape(repr(error))}</p>'
            raise
        self.error = None
        self._picture.value = Picture(drawing.png, drawing.alt).html()
        self._summary.value = _numbers(drawing.summary, role=' role="status"')

    def say(self, text: str) -> None:
        """Show a line under the picture while an action runs. It stays until `redraw`."""
        self._summary.value = f'<p role="status">{html.escape(text)}</p>'

    def show(self) -> None:
        """Display the panel. Without a kernel, the reader sees the still."""
        display(self)

    def _row(self, control: Control) -> widgets.Widget:
        label = {"description": control.label, "style": {"description_width": f"{self._label_em:g}em"}}
        label["tooltip"] = control.label  # without a tooltip, ipywidgets shows "null"
        wide = widgets.Layout(width=f"{self._label_em + 20:g}em", max_width="calc(100% - 4px)")
        if isinstance(control, Choice):
            widget = row = widgets.Dropdown(options=control.options, value=control.default, layout=wide, **label)
        elif isinstance(control, Switch):
            whole = widgets.Layout(width="auto")  # the default width of 300 px cuts long labels
            widget = row = widgets.Checkbox(
                value=control.default, indent=False, description=control.label, layout=whole
            )
        else:
            ends = {"min": control.minimum, "max": control.maximum, "step": control.step, "value": control.default}
            slider = widgets.FloatSlider(**ends, **label, layout=wide, readout=False, continuous_update=self.continuous)
            # The slider shows the label. The number box has it too, with no width, for readers who use a screen reader.
            label["style"] = {"description_width": "0px"}
            widget = widgets.BoundedFloatText(**ends, **label, layout=widgets.Layout(width="7em"))
            _pair(slider, widget, control)
            row = widgets.HBox([slider, widget])
        widget.observe(lambda change: None if self._held else self.redraw(), names="value")
        self._inputs[control.name] = widget
        return row

    def _button(self, label: str) -> widgets.Button:
        button = widgets.Button(description=label, layout=widgets.Layout(width="auto", min_width="9em"))
        button.on_click(lambda _: self.press(label))
        return button

    def _repr_mimebundle_(self, include=None, exclude=None) -> dict:
        view = self.box._repr_mimebundle_().get("application/vnd.jupyter.widget-view+json")
        drawing = self.draw(**self.defaults())
        rgb = cv2.imdecode(np.frombuffer(drawing.png, np.uint8), cv2.IMREAD_COLOR_RGB)
        kept = (compress_photograph(rgb), drawing.alt, "webp") if self.photograph else (compress(rgb), drawing.alt)
        still = f"{Picture(*kept).html()}{_numbers(drawing.summary)}{NO_CONTROLS_HERE}"
        bundle = {"text/plain": repr(self), "text/html": still}
        return bundle if view is None else bundle | {"application/vnd.jupyter.widget-view+json": view}

    def __repr__(self) -> str:
        return f"Panel '{self.title}': {', '.join(control.label for control in self.controls.values())}"
