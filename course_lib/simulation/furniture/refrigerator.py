"""Refrigerators: a smooth upright box with one to four doors, handles, and what sticks on the doors."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from course_lib.simulation.furniture.solids import Piece, box, panel, rod, rounded_box
from course_lib.simulation.prints import label
from course_lib.simulation.textures import Surface, colour, metal, random_colour


@dataclass(frozen=True)
class Refrigerator:
    """Lengths in metres. split: joints between doors, as shares of the height; double: two abreast."""

    width: float = 0.6
    depth: float = 0.6
    height: float = 1.7
    split: tuple[float, ...] = (0.35,)
    double: bool = False
    handle: str = "bar"
    hinge: float = 1.0
    dispenser: bool = False
    radius: float = 0.02


def build_refrigerator(
    shape: Refrigerator, body: Surface, steel: Surface, dark: Surface, notes: list[Surface]
) -> Piece:
    """The refrigerator's parts: body, doors, handles, dispenser, notes; notes stick on the upper half of the front."""
    d, w, h = shape.depth, shape.width, shape.height
    front = d / 2
    parts = box((d - 0.08, w, h - 0.05), (-0.04, 0, (h + 0.05) / 2), body)
    parts += box((d - 0.14, w - 0.04, 0.05), (-0.05, 0, 0.025), dark)
    levels = [0.06, *(share * h for share in shape.split), h]
    columns = [(-w / 2, 0.0), (0.0, w / 2)] if shape.double else [(-w / 2, w / 2)]
    for low, high in itertools.pairwise(levels):
        for left, right in columns:
            size = (0.075, right - left - 0.008, high - low - 0.012)
            parts += rounded_box(size, (front - 0.0375, (left + right) / 2, (low + high) / 2), body, shape.radius)
            side = -np.sign(left + right) if shape.double else shape.hinge
            y = (right - 0.06) if side > 0 else (left + 0.06)
            length = min(0.55, 0.6 * (high - low))
            start = low + 0.08 if low > 0.5 * h else high - 0.08 - length
            if shape.handle == "bar":
                x = front + 0.035
                parts += rod([(x, y, start), (x, y, start + length)], 0.011, steel)
                for z in (start + 0.03, start + length - 0.03):
                    parts += rod([(front - 0.01, y, z), (x, y, z)], 0.008, steel, n=6)
            elif shape.handle == "grip":
                parts += box((0.03, 0.05, 0.16), (front + 0.012, y, start + length / 2), steel)
            else:
                parts += box((0.012, 0.03, length), (front + 0.002, y, start + length / 2), dark)
    if shape.dispenser:
        y = -w / 4 if shape.double else 0.0
        parts += box((0.02, 0.17, 0.28), (front + 0.002, y, 0.62 * h), dark)
        parts += box((0.03, 0.13, 0.05), (front + 0.004, y, 0.7 * h), steel)
    for index, note in enumerate(notes):
        across, up = note.size
        y = -shape.hinge * w * 0.1 + (index % 2 - 0.5) * w * 0.36 - across / 2
        z = h * (0.72 - 0.14 * (index // 2)) - up / 2
        parts.append(panel((front + 0.004, y, z), (0, across, 0), (0, 0, up), note, fit=True))
    return Piece.of("refrigerator", parts)


def random_refrigerator(rng: Generator) -> Piece:
    """A refrigerator of any kind that a generated room may have."""
    double = bool(rng.random() < 0.25)
    height = rng.uniform(0.82, 1.2) if not double and rng.random() < 0.3 else rng.uniform(1.4, 1.88)
    small = height < 1.25
    split = ((), (0.3,), (0.38,), (0.68,), (0.33, 0.52))[int(rng.integers(0, 2) if small else rng.integers(1, 5))]
    shape = Refrigerator(
        width=rng.uniform(0.78, 0.95) if double else rng.uniform(0.5, 0.68),
        depth=rng.uniform(0.54, 0.7),
        height=height,
        split=() if small and rng.random() < 0.5 else split,
        double=double,
        handle=str(rng.choice(["bar", "grip", "slot"])),
        hinge=float(rng.choice([-1.0, 1.0])),
        dispenser=bool(not small and rng.random() < 0.3),
        radius=rng.uniform(0.01, 0.036),
    )
    kind = rng.integers(4)
    if kind == 0:
        tint = colour(rng.uniform(30, 60), rng.uniform(0, 12), rng.uniform(85, 98))
    elif kind == 1:
        tint = colour(rng.uniform(190, 240), rng.uniform(0, 10), rng.uniform(25, 75))
    else:
        tint = random_colour(rng, (20, 85), (40, 95))
    body, steel, dark = metal(rng, tint, 0.8), metal(rng, (0.72, 0.73, 0.75)), metal(rng, (0.12, 0.12, 0.13))
    notes = [label(rng, rng.uniform(0.07, 0.16), rng.uniform(0.08, 0.2)) for _ in range(int(rng.integers(0, 5)))]
    return build_refrigerator(shape, body, steel, dark, notes)
