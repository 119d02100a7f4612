"""What the simulated corridor grants and a real one does not, with what each is worth where that was measured."""

from __future__ import annotations

from typing import NamedTuple

from course_lib.simulation.corridor.seeded_recording import Hardship


class Kindness(NamedTuple):
    """One thing that flatters the results."""

    granted: str
    real: str
    hardship: Hardship | None
    """What takes it away in a seed's recording by hand; None: nothing does, its effect is not measured."""


KINDNESSES = (
    Kindness("focal lengths are exactly those told", "wrong by 1 %", "focal length"),
    Kindness("no lens distortion is left over", "half a pixel in the corners", "lens distortion"),
    Kindness("the camera sits exactly where it is told to, z included", "5 mm off on each axis", "mount position"),
    Kindness("roll, pitch and heading of the mount are exact", "0.3 degrees off on each axis", "mount angle"),
    Kindness(
        "the wagon keeps its speed within 1.5 % and its heading within a degree or two",
        "pushed by hand: speed varies by tens of percent, stops, sways with each step",
        "pushed by hand",
    ),
    Kindness("the principal point is exactly that told", "a pixel or two off; acts much like 0.3 degrees", None),
    Kindness("the first pose is exact", "measured with a tape", None),
    Kindness("true poses are exact, and of the very instant of each image", "surveyed and synchronized", None),
    Kindness(
        "the floor is level and flat; wheels lift by at most 2 mm, 0.2 degrees", "thresholds, cables, slopes", None
    ),
    Kindness("people stand still", "they walk, and follow whom they watch", None),
    Kindness("light takes one path", "corners and glossy floors send it over two", None),
    Kindness("an image is taken in an instant", "four exposures, blurred and torn by motion", None),
    Kindness("the camera is warm and its error patterns do not drift", "centimetres in the first half hour", None),
    Kindness("surfaces are Lambertian; glass is not there at all", "gloss, mirrors, glass doors, sunlight", None),
    Kindness("one building and one map, whatever the seed", "every building is another", None),
)

# Median errors of the paper's method on recordings with one hardship each, metres: nearest point of the path, and same
# frame; the median over tuning seeds 10001 to 10003. Made by `demo corridor --kindnesses --backend ray --frames 120`,
# stored in data/corridor/results/kindnesses.json.
MEASURED: dict[str, tuple[float, float]] = {
    "none": (0.0150, 0.0253),
    "focal length": (0.0210, 0.0280),
    "lens distortion": (0.0153, 0.0256),
    "mount position": (0.0159, 0.0286),
    "mount angle": (0.0179, 0.0299),
    "pushed by hand": (0.0158, 0.0280),
    "all": (0.0259, 0.0320),
}


def kindness_table() -> str:
    """The kindnesses as a Markdown section for PARAMETERS.md."""
    none, everything = MEASURED["none"], MEASURED["all"]
    rows = [f"| {k.granted} | {k.real} | {_effect(k.hardship)} |" for k in KINDNESSES]
    return "\n".join(
        [
            "## What the simulation grants",
            "",
            "Median errors of the paper's method (nearest point of the path / same frame) on recordings with one",
            "hardship alone, the median over three tuning seeds at 44 x 36 pixels, 120 frames. With none of them: "
            f"{_millimetres(none)}; with all",
            f"that are measured, as in the second part of table 1: {_millimetres(everything)}.",
            "",
            "| granted | real | median error with it |",
            "|---|---|---|",
            *rows,
            "",
        ]
    )


def _effect(hardship: Hardship | None) -> str:
    return "not measured" if hardship is None else _millimetres(MEASURED[hardship])


def _millimetres(errors: tuple[float, float]) -> str:
    return " / ".join(f"{1000 * error:.0f}" for error in errors) + " mm"
