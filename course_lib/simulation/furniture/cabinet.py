"""Cabinets: sideboards, chests of drawers, wardrobes and bookshelves, as a grid of doors, drawers and open bays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from course_lib.simulation.furniture.solids import Piece, box, cylinder, panel, rod
from course_lib.simulation.prints import book_row
from course_lib.simulation.textures import Surface, colour, metal, random_colour, wood


@dataclass(frozen=True)
class Cabinet:
    """Lengths in metres. rows: from below, "door", "drawer" or "open" and a height. legs: 0 = a plinth."""

    width: float = 1.2
    depth: float = 0.4
    height: float = 0.8
    columns: int = 2
    rows: tuple[tuple[str, float], ...] = (("door", 1.0),)
    knob: str = "knob"
    legs: float = 0.0
    board: float = 0.022


def _open_bay(left: float, low: float, width: float, height: float, depth: float, inside: Surface, books: list) -> list:
    """A back wall and, if there are books, a row of them."""
    parts = [panel((0.04 - depth / 2, left, low), (0, width, 0), (0, 0, height), inside)]
    if books:
        tall = min(0.88 * height, 0.34)
        parts += box((depth * 0.6, width * 0.94, tall), (-0.02, left + width / 2, low + tall / 2), inside, front=books)
    return parts


def _closed_bay(
    kind: str, y: float, z: float, width: float, height: float, shape: Cabinet, face: Surface, knob: Surface, hinge: int
) -> list:
    """A door or a drawer with its middle at (y, z), and its knob."""
    front, gap = shape.depth / 2, 0.006
    parts = box((0.02, width - gap, height - gap), (front - 0.002, y, z), face)
    if kind == "door" and min(width, height) > 0.24:
        # A raised field inside the door catches light on its edges.
        parts += box((0.012, width - 0.14, height - 0.14), (front + 0.012, y, z), face)
    x = front + 0.022
    at = (y, z) if kind == "drawer" else (y + hinge * (width / 2 - 0.045), z + 0.12 * height)
    if shape.knob == "knob":
        parts += rod([(x - 0.014, *at), (x + 0.014, *at)], 0.017, knob, n=10)
    elif shape.knob == "bar":
        reach = (0.06, 0.0) if kind == "drawer" else (0.0, 0.07)
        ends = [(x + 0.012, at[0] + s * reach[0], at[1] + s * reach[1]) for s in (-1, 1)]
        parts += rod(ends, 0.009, knob, n=8)
    return parts


def build_cabinet(
    shape: Cabinet, body: Surface, fronts: list[Surface], inside: Surface, knob: Surface, books: list[Surface]
) -> Piece:
    """The cabinet's parts: boards, the bays of its front, legs or plinth. fronts: the doors take them in turn."""
    d, w, h, t = shape.depth, shape.width, shape.height, shape.board
    low = shape.legs if shape.legs else 0.06
    upright = body.turned()
    parts = box((d, w + 0.01, t), (0, 0, h - t / 2), body)
    parts += box((d - 0.02, w, t), (-0.01, 0, low + t / 2), body)
    for y in np.linspace(-w / 2 + t / 2, w / 2 - t / 2, shape.columns + 1):
        parts += box((d - 0.02, t, h - low - t), (-0.01, y, (h + low - t) / 2), upright)
    parts += box((0.02, w - 0.01, h - low), (-d / 2 + 0.012, 0, (h + low) / 2), body)
    if shape.legs:
        for x in (-d / 2 + 0.05, d / 2 - 0.07):
            for y in (-w / 2 + 0.06, w / 2 - 0.06):
                parts += cylinder(0.014, low + 0.005, (x, y, 0), knob, top=0.022, n=8)
    else:
        parts += box((d - 0.05, w - 0.02, low), (-0.02, 0, low / 2), body)
    total = sum(share for _, share in shape.rows)
    space, bay = h - t - low - t, (w - t) / shape.columns
    level, order = low + t, 0
    for kind, share in shape.rows:
        height = space * share / total
        if level > low + t + 0.01:
            parts += box((d - 0.03, w - 2 * t, t * 0.8), (-0.012, 0, level), body)
        for column in range(shape.columns):
            left, width, tall = -w / 2 + t / 2 + column * bay + t / 2, bay - t, height - t
            if kind == "open":
                row = books[order % len(books)] if books else None
                parts += _open_bay(left, level + 0.4 * t, width, tall, d, inside, row)
            else:
                face, hinge = fronts[order % len(fronts)], 1 if order % 2 == 0 else -1
                parts += _closed_bay(kind, left + width / 2, level + tall / 2, width, tall, shape, face, knob, hinge)
            order += 1
        level += height
    return Piece.of("cabinet", parts)


def random_cabinet(rng: Generator, kind: str | None = None) -> Piece:
    """A cabinet of any kind; kind: "sideboard", "drawers", "wardrobe" or "shelf" (None: any)."""
    kind = kind or str(rng.choice(["sideboard", "sideboard", "drawers", "drawers", "wardrobe", "shelf"]))
    depth = rng.uniform(0.32, 0.5)
    if kind == "sideboard":
        choices = ((("door", 1.0),), (("door", 2.0), ("drawer", 1.0)), (("door", 1.6), ("open", 1.0)))
        rows = choices[int(rng.integers(3))]
        width, height, columns = rng.uniform(0.9, 1.7), rng.uniform(0.5, 0.95), int(rng.integers(2, 5))
    elif kind == "drawers":
        rows = (("drawer", 1.0),) * int(rng.integers(3, 6))
        width, height, columns = rng.uniform(0.5, 1.3), rng.uniform(0.65, 1.15), int(rng.integers(1, 3))
    elif kind == "wardrobe":
        rows = ((("door", 1.0),), (("drawer", 1.0), ("door", 4.0)))[int(rng.integers(2))]
        width, height, columns = rng.uniform(0.7, 1.5), rng.uniform(1.5, 2.1), int(rng.integers(1, 4))
        depth = rng.uniform(0.42, 0.6)
    else:
        rows = (("open", 1.0),) * int(rng.integers(3, 6))
        if rng.random() < 0.5:
            rows = (("door", 1.6), *rows[1:])
        width, height, columns = rng.uniform(0.6, 1.3), rng.uniform(0.9, 1.95), int(rng.integers(1, 3))
        depth = rng.uniform(0.26, 0.38)
    knob_kind = str(rng.choice(["knob", "bar", "none"]))
    legs = rng.uniform(0.08, 0.2) if kind in ("sideboard", "drawers") and rng.random() < 0.4 else 0.0
    shape = Cabinet(width, depth, height, columns, rows, knob_kind, legs, board=rng.uniform(0.016, 0.038))
    natural = colour(rng.uniform(10, 50), rng.uniform(15, 75), rng.uniform(25, 95))
    hue, saturation, value = rng.uniform(0.0, 360.0), rng.uniform(5.0, 85.0), rng.uniform(25.0, 97.0)
    finish = str(rng.choice(["one", "two shades", "many", "many"]))
    plain = finish != "two shades" and rng.random() < 0.5
    body = wood(rng, natural if plain else colour(hue, saturation, value), 0.9)
    fronts = [body]
    if finish == "two shades":
        shade = colour(hue + rng.uniform(-10, 10), saturation, value * rng.uniform(0.6, 0.9))
        fronts = [body, wood(rng, shade, 0.9)]
    elif finish == "many":
        fronts = [wood(rng, random_colour(rng, (0, 85), (30, 98)), 0.9) for _ in range(int(rng.integers(1, 4)))]
    inside = wood(rng, natural, 0.6, 128)
    knob = metal(rng, random_colour(rng, (0, 40), (10, 85)), 0.3, 128)
    books = [book_row(rng, width / columns, 0.3) for _ in range(3)] if "open" in dict(rows) else []
    return build_cabinet(shape, body, fronts, inside, knob, books)
