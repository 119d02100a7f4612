"""Tables: a level top on legs, a pedestal, two end panels or a box; or under a cloth."""

from __future__ import annotations

from dataclasses import dataclass

from numpy.random import Generator

from course_lib.simulation.furniture.solids import Piece, box, lathe, rod, rounded_box
from course_lib.simulation.textures import CLOTH_PATTERNS, Surface, cloth, colour, metal, random_colour, wood


@dataclass(frozen=True)
class Table:
    """Lengths in metres. base: "legs", "pedestal", "panels" or "box". cloth: how far a cloth hangs down."""

    depth: float = 0.8
    width: float = 1.2
    height: float = 0.74
    round: bool = False
    base: str = "legs"
    thickness: float = 0.035
    apron: float = 0.08
    leg: float = 0.06
    square_legs: bool = True
    shelf: bool = False
    cloth: float = 0.0


def _base(shape: Table, frame: Surface) -> list:
    under = shape.height - shape.thickness
    d, w = shape.depth / 2 - 0.05 - shape.leg / 2, shape.width / 2 - 0.05 - shape.leg / 2
    if shape.round:
        d, w = d * 0.68, w * 0.68
    parts = []
    if shape.base == "pedestal":
        foot = 0.28 * min(shape.depth, shape.width) + 0.06
        profile = [(0, 0), (foot, 0), (foot, 0.02), (0.05, 0.07), (0.04, under * 0.5), (0.06, under - 0.06)]
        return lathe([*profile, (0.2, under - 0.01), (0, under)], (0, 0, 0), frame)
    if shape.base == "panels":
        for y in (-w, w):
            parts += box((shape.depth - 0.1, shape.leg * 0.7, under), (0, y, under / 2), frame)
        return parts + box((0.03, 2 * w, 0.16), (0, 0, under - 0.16), frame)
    if shape.base == "box":
        return box((shape.depth - 0.14, shape.width - 0.14, under), (0, 0, under / 2), frame)
    for x in (-d, d):
        for y in (-w, w):
            if shape.square_legs:
                parts += box((shape.leg, shape.leg, under), (x, y, under / 2), frame)
            else:
                parts += rod([(1.06 * x, 1.06 * y, 0.0), (x, y, under)], shape.leg / 2, frame)
    if shape.apron > 0.02:
        level = under - shape.apron / 2
        for sign in (-1.0, 1.0):
            parts += box((2 * d, 0.022, shape.apron), (0, sign * w, level), frame)
            parts += box((0.022, 2 * w, shape.apron), (sign * d, 0, level), frame)
    if shape.shelf:
        parts += box((2 * d, 2 * w, 0.02), (0, 0, 0.35 * under), frame)
    return parts


def build_table(shape: Table, top: Surface, frame: Surface, cover: Surface) -> Piece:
    """The table's parts: base, top and, if asked, a cloth that hangs over the edge."""
    d, w, high = shape.depth, shape.width, shape.height
    r, low, hem = d / 2, high - shape.thickness, high - shape.cloth
    parts = _base(shape, frame)
    if shape.round:
        edge = [(0, low), (r - 0.01, low), (r, low + 0.01), (r, high - 0.008), (r - 0.008, high), (0, high)]
        parts += lathe(edge, (0, 0, 0), top, 32, (1.0, w / d))
    else:
        parts += rounded_box((d, w, shape.thickness), (0, 0, high - shape.thickness / 2), top, 0.008)
    if shape.cloth and shape.round:
        r = r + 0.012
        hung = [(0, hem), (r + 0.03, hem), (r, high - 0.01), (r - 0.02, high + 0.006), (0, high + 0.006)]
        parts += lathe(hung, (0, 0, 0), cover, 32, (1.0, w / d))
    elif shape.cloth:
        size = (d + 0.024, w + 0.024, shape.cloth)
        parts += rounded_box(size, (0, 0, high + 0.006 - shape.cloth / 2), cover, 0.012)
    return Piece.of("table", parts)


def random_table(rng: Generator) -> Piece:
    """A dining, side or coffee table of any kind that a generated room may have."""
    low = rng.random() < 0.35
    is_round = bool(rng.random() < 0.45)
    width = rng.uniform(0.55, 1.1) if low else rng.uniform(0.7, 1.7)
    depth = width if is_round and rng.random() < 0.7 else rng.uniform(0.5, 0.75) if low else rng.uniform(0.6, 0.95)
    if is_round:
        width = min(width, 1.3)
        depth = min(depth, width)
    shape = Table(
        base=str(rng.choice(["legs", "pedestal"] if is_round else ["legs", "legs", "legs", "panels", "box"])),
        depth=depth,
        width=width,
        height=rng.uniform(0.36, 0.52) if low else rng.uniform(0.68, 0.8),
        round=is_round,
        thickness=rng.uniform(0.02, 0.06),
        apron=rng.choice([0.0, rng.uniform(0.05, 0.14)]),
        leg=rng.uniform(0.035, 0.1),
        square_legs=bool(rng.random() < 0.6),
        shelf=bool(rng.random() < 0.2),
        cloth=rng.uniform(0.12, 0.44) if not low and rng.random() < 0.5 else 0.0,
    )
    natural = colour(rng.uniform(10, 50), rng.uniform(20, 75), rng.uniform(25, 90))
    top = wood(rng, natural if rng.random() < 0.6 else random_colour(rng, (5, 80), (30, 95)), rng.uniform(0.7, 1.1))
    frame = top
    if rng.random() < 0.5:
        is_metal = rng.random() < 0.5
        frame = metal(rng, random_colour(rng, (0, 60), (10, 85))) if is_metal else wood(rng, random_colour(rng))
    second = random_colour(rng) if rng.random() < 0.3 else None
    cover = cloth(rng, random_colour(rng), str(rng.choice(CLOTH_PATTERNS)), second, 0.7)
    return build_table(shape, top, frame, cover)
