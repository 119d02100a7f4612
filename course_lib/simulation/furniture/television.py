"""Televisions: a flat screen in a dark frame on a foot, on a floor stand, or for the wall."""

from __future__ import annotations

from dataclasses import dataclass

from numpy.random import Generator

from course_lib.simulation.furniture.solids import Piece, box, cylinder, panel, rod
from course_lib.simulation.prints import dark_screen, picture
from course_lib.simulation.textures import Surface, colour, metal


@dataclass(frozen=True)
class Television:
    """Lengths in metres. width: of the screen, 16:9. stand: "foot", "floor" or "wall". raised: its lower edge."""

    width: float = 1.0
    thickness: float = 0.05
    bezel: float = 0.015
    stand: str = "foot"
    raised: float = 0.07
    two_feet: bool = False


def build_television(shape: Television, case: Surface, screen: Surface) -> Piece:
    """The television's parts: case, screen, foot or floor stand."""
    w, t, low, b = shape.width, shape.thickness, shape.raised, shape.bezel
    height = w * 9 / 16
    parts = box((t, w, height), (0, 0, low + height / 2), case)
    corner = (t / 2 + 0.002, -w / 2 + b, low + b)
    parts.append(panel(corner, (0, w - 2 * b, 0), (0, 0, height - 2 * b), screen, fit=True, cell=0.2))
    parts += box((0.04, w * 0.5, height * 0.5), (-t / 2 - 0.015, 0, low + height * 0.4), case)
    if shape.stand == "floor":
        parts += box((0.4, w * 0.55, 0.03), (0, 0, 0.015), case)
        parts += box((0.05, 0.1, low + 0.15), (-t / 2 - 0.03, 0, (low + 0.15) / 2 + 0.01), case)
    elif shape.stand == "foot" and shape.two_feet:
        for y in (-w * 0.35, w * 0.35):
            for x in (0.12, -0.12):
                parts += rod([(x, y, 0.008), (0, y, low + 0.01)], 0.01, case)
    elif shape.stand == "foot":
        parts += cylinder(0.13, 0.018, (0, 0, 0), case, top=0.12, n=24)
        parts += box((0.03, 0.08, low + 0.02), (-0.01, 0, (low + 0.02) / 2), case)
    return Piece.of("television", parts)


def random_television(rng: Generator, stand: str | None = None) -> Piece:
    """A television of any kind that a generated room may have; stand: as in Television (None: any)."""
    stand = stand or str(rng.choice(["floor", "foot", "wall"]))
    width = rng.uniform(0.75, 1.05) if stand == "foot" else rng.uniform(0.8, 1.35)
    shape = Television(
        width=width,
        thickness=rng.uniform(0.03, 0.09),
        bezel=rng.uniform(0.008, 0.035),
        stand=stand,
        raised={"floor": rng.uniform(0.5, 0.8), "foot": rng.uniform(0.05, 0.12), "wall": 0.0}[stand],
        two_feet=bool(rng.random() < 0.4),
    )
    case = metal(rng, colour(rng.uniform(0, 360), rng.uniform(0, 12), rng.choice([9.0, 14.0, 22.0, 75.0])))
    if rng.random() < 0.4:
        screen = dark_screen(rng, width, width * 9 / 16)
    else:
        screen = picture(rng, width, width * 9 / 16, emission=float(rng.uniform(0.5, 0.95)))
    return build_television(shape, case, screen)
