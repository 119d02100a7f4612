"""Panels: a few controls above one picture that is redrawn at once.

A panel is a list of controls and a function that turns their values into a `Drawing`. The picture is an `HTML` widget
with an `<img alt=...>`, because ipywidgets' `Output` sometimes hung and wrote text into stored notebooks.

`panel.draw(**values)` and the functions in `panel.actions` are plain functions, which tests call directly. The reader
sees an error under the picture, and the picture keeps its last state.

A stored notebook holds a still of the panel: the picture at the defaults, its numbers, and a sentence that says how to
get the controls. The extension of `course.py lab` (courseware/commands/lab_extension) finds panels by their CSS classes
"course-...".
"""

import html
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import cv2
import ipywidgets as widgets
import numpy as np
from IPython.display import display

from courseware.lessons.kit.compression import compress, compress_photograph
from courseware.lessons.kit.display import Picture

VIEW = "application/vnd.jupyter.widget-view+json"
NO_CONTROLS_HERE = "<p>Run this cell to move the controls.</p>"
MIN_LABEL_EM = 14.0  # so that the sliders of most panels start at the same place
EM_PER_LETTER = 0.55  # up to 0.52 measured in JupyterLab, which cuts a label that is too long


class Drawing(NamedTuple):
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


@dataclass(frozen=True)
class Choice:
    """One of a few named options."""

    name: str
    label: str
    options: tuple[str, ...]
    default: str


@dataclass(frozen=True)
class Switch:
    """A check box."""

    name: str
    label: str
    default: bool = False


Control = Slider | Choice | Switch


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
        self.title, self.draw, self.continuous, self.photograph = title, draw, continuous, photograph
        self.controls: dict[str, Control] = {control.name: control for control in controls}
        if len(self.controls) != len(controls) or not controls:
            raise ValueError(f"a panel needs controls with different names; got {[one.name for one in controls]}")
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
        self._summary.value = _numbers(drawing.summary, ' role="status"')

    def say(self, text: str) -> None:
        """Show a line under the picture while an action runs. It stays until `redraw`."""
        self._summary.value = f'<p role="status">{html.escape(text)}</p>'

    def show(self) -> None:
        """Display the panel. Without a kernel, the reader sees the still."""
        display(self)

    def _row(self, control: Control) -> widgets.Widget:
        # Without a tooltip, ipywidgets shows "null".
        label = {"description": control.label, "tooltip": control.label, "value": control.default}
        style = {"description_width": f"{self._label_em:g}em"}
        wide = widgets.Layout(width=f"{self._label_em + 20:g}em", max_width="calc(100% - 4px)")
        if isinstance(control, Choice):
            widget = row = widgets.Dropdown(**label, options=control.options, style=style, layout=wide)
        elif isinstance(control, Switch):
            whole = widgets.Layout(width="auto")  # the default width of 300 px cuts long labels
            widget = row = widgets.Checkbox(
                value=control.default, indent=False, description=control.label, layout=whole
            )
        else:
            label |= {"min": control.minimum, "max": control.maximum, "step": control.step}
            options = {"readout": False, "continuous_update": self.continuous}
            slider = widgets.FloatSlider(**label, **options, style=style, layout=wide)
            # The slider shows the label. The number box has it too, with no width, for readers who use a screen reader.
            hidden = {"description_width": "0px"}
            widget = widgets.BoundedFloatText(**label, style=hidden, layout=widgets.Layout(width="7em"))
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
        drawing = self.draw(**self.defaults())
        rgb = cv2.imdecode(np.frombuffer(drawing.png, np.uint8), cv2.IMREAD_COLOR_RGB)
        data, kind = (compress_photograph(rgb), "webp") if self.photograph else (compress(rgb), "png")
        still = f"{Picture(data, drawing.alt, kind).html()}{_numbers(drawing.summary)}{NO_CONTROLS_HERE}"
        views = {kind: view for kind, view in self.box._repr_mimebundle_().items() if kind == VIEW}
        return {"text/plain": repr(self), "text/html": still, **views}

    def __repr__(self) -> str:
        return f"Panel '{self.title}': {', '.join(control.label for control in self.controls.values())}"


def _pair(slider: widgets.FloatSlider, number: widgets.BoundedFloatText, control: Slider) -> None:
    """Move slider and number box together. A browser's slider says 0.15000000000000002, so the box rounds it to 0.15.

    We do not send the slider's own value back to it. On a slow machine it has moved on, and would jump back.
    """
    digits = max(len(f"{value:.10f}".rstrip("0").partition(".")[2]) for value in (control.step, control.minimum))

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
