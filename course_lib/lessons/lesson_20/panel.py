"""Lesson 20's panel: read a recording in one wrong way after the other."""

import numpy as np

from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider
from course_lib.lessons.lesson_20.figures import compared_axes
from course_lib.lessons.lesson_20.readings import READINGS, STAND_IN_FRAMES, Checker, Recording, recording


def reading_panel(given: Recording | None = None) -> Panel:
    """Read a recording in one wrong way after the other: what the picture and the two numbers say."""
    checker = Checker(given or recording())
    last = min(STAND_IN_FRAMES, len(checker.given.sequence)) - 1
    figure, drawn = compared_axes(checker(0), (9.4, 2.7))
    live = LiveFigure(figure, drawn)

    def draw(reading: str, frame: float, shift: float) -> Drawing:
        frame = min(int(frame), last)  # of a single frame too the slider has two ends
        compared = checker(frame, reading, shift)
        for image, values in zip(drawn, (compared.measured, compared.seen, compared.difference), strict=True):
            image.set_data(np.ma.masked_invalid(values))
        numbers = f"{compared.hits:.0%} of the measured pixels hit the map"
        if np.isfinite(compared.median):
            numbers = f"median |z - z_map| = {compared.median:.3f} m;  {numbers}"
        alt = f"Frame {frame}, read with {reading}: the measured depth, the map, and their difference. {numbers}."
        return Drawing(live.png(), alt, f"{reading}, camera moved by {shift:.2f} m\n{numbers}")

    controls = [
        Choice("reading", "how the files are read", tuple(READINGS), next(iter(READINGS))),
        Slider("frame", "frame [-]", 0, max(1, last), 0, 1),
        Slider("shift", "camera moved to the right [m]", -0.3, 0.3, 0.0, 0.01),
    ]
    return Panel("20 read it wrongly", controls, draw)


PANELS = {"20 read it wrongly": reading_panel}
