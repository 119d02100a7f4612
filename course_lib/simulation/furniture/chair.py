"""Chairs: a seat for one person and a back, on four legs, a sledge, or a star with castors."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from course_lib.simulation.furniture.solids import Piece, box, cylinder, rod, rounded_box, swept, turn
from course_lib.simulation.textures import CLOTH_PATTERNS, Surface, cloth, colour, metal, random_colour, wood


@dataclass(frozen=True)
class Chair:
    """Lengths in metres. base: "legs", "sledge" or "star". back: "solid", "ladder", "spindles" or "shell"."""

    width: float = 0.45
    depth: float = 0.45
    seat_height: float = 0.45
    height: float = 0.9
    base: str = "legs"
    back: str = "solid"
    armrests: bool = False
    leg_radius: float = 0.018
    splay: float = 0.03
    round_seat: bool = False


def _base(shape: Chair, frame: Surface) -> list:
    d, w, top, r = shape.depth / 2 - 0.03, shape.width / 2 - 0.03, shape.seat_height - 0.04, shape.leg_radius
    parts = []
    if shape.base == "star":
        parts += cylinder(0.028, top - 0.08, (0, 0, 0.09), frame)
        reach = 0.5 * max(shape.depth, shape.width) + 0.05
        for angle in 2 * np.pi * (np.arange(5) + 0.5) / 5:
            x, y = reach * np.cos(angle), reach * np.sin(angle)
            parts += rod([(0, 0, 0.12), (x, y, 0.075)], 0.022, frame)
            parts += rod([(x - 0.02, y, 0.03), (x + 0.02, y, 0.03)], 0.03, frame, n=10)
    elif shape.base == "sledge":
        for y in (-w, w):
            corners = [(d, y, top), (d + 0.03, y, r), (-d - 0.03, y, r), (-d, y, top)]
            for ends in itertools.pairwise(corners):
                parts += rod(ends, r, frame)
    else:
        for x in (-d, d):
            for y in (-w, w):
                out = 1.0 + shape.splay / max(abs(x), 1e-3)
                parts += rod([(x * out, y * out, 0.0), (x, y, top)], r, frame)
        if shape.splay < 0.02:
            for y in (-w, w):
                parts += rod([(-d, y, 0.2), (d, y, 0.2)], 0.6 * r, frame)
    return parts


def _back(shape: Chair, frame: Surface, cover: Surface) -> list:
    """The back, upright with its foot at the origin; the caller leans it."""
    height, w = shape.height - shape.seat_height, shape.width - 0.04
    if shape.back == "shell":
        angle = np.linspace(-0.9, 0.9, 9)
        path = np.stack([0.5 * w * (1 - np.cos(angle)) * 0.8, 0.56 * w * np.sin(angle), np.full(9, height * 0.55)], 1)
        reach = height * (0.32 + 0.12 * np.cos(angle))
        return swept(path, np.array([0, 0, 1.0]), reach, np.full(9, 0.022), cover, n=10)
    if shape.back == "solid":
        return rounded_box((0.05, w, height * 0.86), (0, 0, height * 0.57), cover, 0.024)
    parts = []
    for sign in (-1.0, 1.0):
        y = sign * (w / 2 - 0.015)
        parts += rod([(0, y, -0.03), (0, y, height)], 0.018, frame)
    if shape.back == "ladder":
        for level in (0.35, 0.62, 0.9):
            parts += rounded_box((0.022, w - 0.03, 0.075), (0, 0, level * height), cover, 0.01)
    else:
        parts += rounded_box((0.03, w, 0.07), (0, 0, height - 0.035), cover, 0.014)
        for y in np.linspace(-w / 2 + 0.06, w / 2 - 0.06, 5):
            parts += rod([(0, y, -0.02), (0, y, height - 0.05)], 0.009, frame)
    return parts


def build_chair(shape: Chair, frame: Surface, cover: Surface) -> Piece:
    """The chair's parts: base, seat, back and, if asked, armrests."""
    d, w, top = shape.depth, shape.width, shape.seat_height
    parts = _base(shape, frame)
    if shape.round_seat:
        parts += cylinder(w / 2 - 0.015, 0.05, (0, 0, top - 0.05), cover, top=w / 2, n=20)
    else:
        parts += rounded_box((d, w, 0.06), (0, 0, top - 0.03), cover, 0.025, bulge=0.012)
    if shape.base == "star":
        parts += box((0.03, 0.07, 0.24), (-d / 2 - 0.01, 0, top + 0.06), frame)
    parts += turn(_back(shape, frame, cover), x=-d / 2 + 0.03, z=top - 0.01, pitch=-0.14)
    if shape.armrests:
        for sign in (-1.0, 1.0):
            y = sign * (w / 2 + 0.015)
            parts += rod([(d * 0.2, y, top - 0.03), (d * 0.2, y, top + 0.2)], 0.014, frame)
            parts += rounded_box((d * 0.66, 0.05, 0.03), (-d * 0.05, y, top + 0.21), frame, 0.012)
    return Piece.of("chair", parts)


def random_chair(rng: Generator) -> Piece:
    """A chair of any kind that a generated room may have."""
    kind = rng.choice(["wooden", "upholstered", "office", "shell", "stool"])
    rgb = random_colour(rng, (10, 95), (25, 95))
    timber = wood(rng, colour(rng.uniform(10, 50), rng.uniform(25, 75), rng.uniform(25, 85)), size=0.6)
    steel = metal(rng, colour(rng.uniform(0, 360), rng.uniform(0, 25), rng.uniform(15, 80)))
    width, depth, seat_height = rng.uniform(0.38, 0.56), rng.uniform(0.38, 0.54), rng.uniform(0.42, 0.5)
    legs = {"leg_radius": rng.uniform(0.012, 0.0275), "splay": rng.uniform(0.0, 0.06)}
    fabric = cloth(rng, rgb, str(rng.choice(CLOTH_PATTERNS)), random_colour(rng) if rng.random() < 0.3 else None, 0.5)
    painted = wood(rng, rgb, size=0.6)
    size = (width, depth, seat_height)
    if kind == "wooden":
        shape = Chair(*size, rng.uniform(0.8, 1.05), back=str(rng.choice(["ladder", "spindles", "solid"])), **legs)
        frame = timber if rng.random() < 0.6 else painted
        return build_chair(shape, frame, frame if rng.random() < 0.6 else painted)
    if kind == "upholstered":
        shape = Chair(*size, rng.uniform(0.8, 1.08), armrests=bool(rng.random() < 0.3), **legs)
        return build_chair(shape, (timber, timber, steel, painted)[int(rng.integers(4))], fabric)
    if kind == "office":
        shape = Chair(*size, rng.uniform(0.85, 1.15), "star", armrests=bool(rng.random() < 0.6), **legs)
        return build_chair(shape, steel, fabric)
    if kind == "shell":
        base = str(rng.choice(["legs", "sledge"]))
        shape = Chair(*size, rng.uniform(0.75, 0.9), base, "shell", **legs)
        frame = (timber, steel, painted)[int(rng.integers(3))]
        return build_chair(shape, frame, painted if rng.random() < 0.5 else fabric)
    seat_height = rng.uniform(0.5, 0.68)
    height = seat_height + rng.uniform(0.2, 0.32)
    shape = Chair(width, width, seat_height, height, back="ladder", round_seat=True, **legs)
    return build_chair(shape, steel if rng.random() < 0.5 else timber, painted)
