"""Panels: a few controls above one picture that is redrawn at once.

A panel is a list of controls and a function that turns their values into a `Drawing`. Only ipywidgets' own sliders,
number boxes, drop-downs, check boxes, buttons and HTML are used: no `Output`, which was seen to hang and to put text
into stored notebooks. The picture is an `HTML` widget with an `<img alt=...>`.

`panel.draw(**values)` and the functions in `panel.actions` are plain functions: tests call them directly, so an error
is never lost in a widget's callback. For a reader an error appears under the picture, which keeps its last state.

What is stored is a still: the picture at the defaults, its numbers, and how to get the controls back. The classes
"course-..." are what the small extension of `course.py lab` (course_lib/commands/lab_extension) knows a panel by.
"""

from __future__ import annotations

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
    """What a panel shows for one set of values: a PNG, its alternative text, and one or two lines of numbers."""

    png: bytes
    alt: str
    summary: str


@dataclass(frozen=True)
class Slider:
    """A number between `least` and `greatest` in steps of `step`; shown with a number box beside it."""

    name: str
    label: str
    least: float
    greatest: float
    default: float
    step: float

    def test_values(self) -> tuple:
        """Least, default and greatest value."""
        return self.least, self.default, self.greatest


@dataclass(frozen=True)
class Choice:
    """One of a few named options."""

    name: str
    label: str
    options: tuple[str, ...]
    default: str

    def test_values(self) -> tuple:
        """Every option."""
        return self.options


@dataclass(frozen=True)
class Switch:
    """Yes or no."""

    name: str
    label: str
    default: bool = False

    def test_values(self) -> tuple:
        """Both."""
        return False, True


Control = Slider | Choice | Switch

NO_CONTROLS_HERE = "<p>Run this cell to move the controls.</p>"
LEAST_LABEL_EM = 14.0  # so that the sliders of most panels begin at one place
EM_PER_LETTER = 0.55  # measured in JupyterLab: up to 0.52; a label that is longer than its place is cut


def _pair(slider: widgets.FloatSlider, number: widgets.BoundedFloatText, control: Slider) -> None:
    """Slider and number box move together. A browser's slider says 0.15000000000000002: the box holds 0.15.

    The slider is not told what it said itself: on a slow machine it has moved on by then, and would be set back.
    """
    digits = max(_decimals(control.step), _decimals(control.least))

    def to_number(change: dict) -> None:
        number.value = round(change["new"], digits)

    def to_slider(change: dict) -> None:
        if round(slider.value, digits) != change["new"]:
            slider.value = round(change["new"], digits)

    slider.observe(to_number, names="value")
    number.observe(to_slider, names="value")


def _numbers(text: str, role: str = "") -> str:
    """A panel's line or two of numbers; a long one goes on between two words, so that no unit is cut."""
    return f'<pre{role} style="white-space: pre-wrap; word-break: normal">{html.escape(text)}</pre>'


def _decimals(value: float) -> int:
    """Decimals that a number is written with: 2 for 0.05, 0 for 15."""
    return len(f"{value:.10f}".rstrip("0").partition(".")[2])


class Panel:
    """Controls and the picture that they redraw.

    title: short, unique in its lesson. draw: takes every control's value by name, returns a `Drawing`. continuous:
    redraw while a slider moves; False (redraw on release) where `draw` takes longer than 0.15 s in the median. actions:
    extra buttons, label -> function that takes the present values and returns the values to set. photograph: the
    picture is mostly one, which the few colours of a palette would turn into patches: its still is stored as WebP.
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
            raise ValueError(f"a panel needs controls of different names; got {names}")
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
        self._label_em = max(LEAST_LABEL_EM, EM_PER_LETTER * letters)
        rows = [self._row(control) for control in controls]
        buttons = [self._button(label) for label in self.actions]
        wraps = widgets.Layout(flex_flow="row wrap")  # many buttons go on in a second line where the window is narrow
        self.box = widgets.VBox([*rows, widgets.HBox(buttons, layout=wraps), self._picture, self._summary])
        self.box.add_class("course-panel")
        self.redraw()

    def defaults(self) -> dict:
        """Default value of every control."""
        return {name: control.default for name, control in self.controls.items()}

    def values(self) -> dict:
        """Present value of every control."""
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
        """Do what the button does."""
        self.set(**self.actions[label](self.values()))

    def redraw(self) -> None:
        """Show the picture for the present values; an error is shown under the old picture and raised again."""
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
        """A line under the picture while an action works; the picture stays until `redraw`."""
        self._summary.value = f'<p role="status">{html.escape(text)}</p>'

    def show(self) -> None:
        """Display the panel: live where a kernel runs, its picture at the defaults where none does."""
        display(self)

    def _row(self, control: Control) -> widgets.Widget:
        label = {"description": control.label, "style": {"description_width": f"{self._label_em:g}em"}}
        label["tooltip"] = control.label  # without one, ipywidgets says "null"
        wide = widgets.Layout(width=f"{self._label_em + 20:g}em", max_width="calc(100% - 4px)")
        if isinstance(control, Choice):
            widget = row = widgets.Dropdown(options=control.options, value=control.default, layout=wide, **label)
        elif isinstance(control, Switch):
            whole = widgets.Layout(width="auto")  # the default, 300 px, cuts long labels
            widget = row = widgets.Checkbox(
                value=control.default, indent=False, description=control.label, layout=whole
            )
        else:
            ends = {"min": control.least, "max": control.greatest, "step": control.step, "value": control.default}
            slider = widgets.FloatSlider(**ends, **label, layout=wide, readout=False, continuous_update=self.continuous)
            # The slider's label stands beside it; its own, of no width, is for who hears the page.
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
