"""Potted plants: a pot, earth, and leaves that are spiky, bushy or hang like a palm's."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from course_lib.simulation.furniture.solids import Piece, box, lathe, rod, swept
from course_lib.simulation.textures import Surface, carpet, ceramic, colour, leaves, random_colour, wood


@dataclass(frozen=True)
class Plant:
    """Lengths in metres. foliage: "spiky", "bushy", "palm" or "broad". pot: "cone", "bowl", "cylinder" or "cube"."""

    pot: str = "cone"
    pot_radius: float = 0.18
    pot_height: float = 0.32
    foliage: str = "bushy"
    height: float = 1.0
    spread: float = 0.35
    n_leaves: int = 40
    leaf_width: float = 0.04


def _pot(shape: Plant, clay: Surface, earth: Surface) -> list:
    r, h = shape.pot_radius, shape.pot_height
    if shape.pot == "cube":
        return box((2 * r, 2 * r, h), (0, 0, h / 2), clay) + box((1.7 * r, 1.7 * r, 0.02), (0, 0, h), earth)
    outline = {
        "cone": [(0.68, 0.0), (0.95, 0.86), (1.05, 0.87), (1.05, 1.0)],
        "bowl": [(0.5, 0.0), (0.85, 0.2), (1.05, 0.5), (1.05, 0.75), (0.9, 1.0)],
        "cylinder": [(0.96, 0.0), (1.0, 0.03), (1.0, 1.0)],
    }[shape.pot]
    top = r * outline[-1][0] - 0.02
    profile = [(0.0, 0.0), *((r * a, h * b) for a, b in outline), (top, h), (0.0, h - 0.002)]
    soil = [(0, h - 0.01), (top, h - 0.01), (0, h + 0.015)]
    return lathe(profile, (0, 0, 0), clay, 24) + lathe(soil, (0, 0, 0), earth, 14)


def _leaf(
    start: np.ndarray, direction: float, rise: float, droop: float, length: float, width: float, skin: Surface
) -> list:
    """One leaf from start: it leaves at the angle rise above the horizon and bends down by droop along its length."""
    s = np.linspace(0.0, 1.0, 6)
    angle = rise - droop * s
    step = length / 5
    reach = np.concatenate([[0.0], np.cumsum(step * np.cos(angle[:-1]))])
    up = np.concatenate([[0.0], np.cumsum(step * np.sin(angle[:-1]))])
    path = start + np.stack([reach * np.cos(direction), reach * np.sin(direction), up], 1)
    side = np.array([-np.sin(direction), np.cos(direction), 0.0])
    widths = width / 2 * np.maximum(np.sin(np.pi * (0.12 + 0.86 * s)) ** 0.8, 0.06)
    # One tile spans the leaf's width, so that the midrib runs along its middle.
    return swept(path, side, widths, np.full(6, 0.003), Surface(skin.image, (width, length)), n=4)


def _foliage(shape: Plant, skins: list[Surface], bark: Surface, rng: Generator) -> list:
    parts: list = []
    base, rise = shape.pot_height, shape.height - shape.pot_height
    golden = np.pi * (3 - np.sqrt(5))
    stem = 0.0
    if shape.foliage in ("palm", "broad"):
        stem = rise * (0.5 if shape.foliage == "palm" else 0.3)
        lean = rng.uniform(-0.04, 0.04, 2)
        parts += rod([(0, 0, base - 0.02), (*lean * 0.4, base + stem / 2), (*lean, base + stem)], 0.02, bark)
    if shape.foliage == "bushy":
        for angle in rng.uniform(0, 2 * np.pi, 5):
            tip = 0.5 * shape.spread * np.array([np.cos(angle), np.sin(angle)])
            parts += rod([(0, 0, base - 0.02), (*tip, base + 0.7 * rise)], 0.008, bark, n=6)
    for index in range(shape.n_leaves):
        direction = index * golden + rng.uniform(-0.3, 0.3)
        share, width = (index + 0.5) / shape.n_leaves, shape.leaf_width
        cosine, sine = np.cos(direction), np.sin(direction)
        if shape.foliage == "spiky":
            lean = min(0.8, 0.9 * shape.spread / rise)
            elevation = np.arccos(lean * share) * rng.uniform(0.92, 1.05)
            length = rise * rng.uniform(0.75, 1.0)
            start = 0.3 * shape.pot_radius * np.array([cosine, sine, 0]) + (0, 0, base - 0.01)
            droop = rng.uniform(0.0, 0.4)
        elif shape.foliage == "palm":
            start = np.array([0, 0, base + stem])
            length = np.hypot(shape.spread, rise - stem) * rng.uniform(0.85, 1.05)
            elevation, droop = 1.25 - 0.7 * share, rng.uniform(1.2, 2.1)
        elif shape.foliage == "broad":
            start = np.array([0, 0, base + stem * (0.2 + 0.8 * share)])
            length = shape.spread * rng.uniform(0.8, 1.2)
            elevation, droop, width = rng.uniform(0.5, 1.3), rng.uniform(0.4, 1.3), width * 2.6
        else:
            # The bush is an ellipsoid of leaves that point outwards.
            z = rng.uniform(-0.8, 1.0)
            ring = np.sqrt(max(0.0, 1 - z * z)) * rng.uniform(0.55, 0.95)
            x, y = shape.spread * 0.7 * ring * cosine, shape.spread * 0.7 * ring * sine
            start = np.array([x, y, base + rise * 0.52 + 0.36 * rise * z])
            length = 0.13 * rng.uniform(0.7, 1.3) + 0.1 * shape.spread
            elevation, droop, width = rng.uniform(-0.4, 1.2), 0.6, width * 1.6
        parts += _leaf(start, direction, elevation, droop, length, width, skins[index % len(skins)])
    return parts


def build_plant(
    shape: Plant, clay: Surface, earth: Surface, skins: list[Surface], bark: Surface, rng: Generator
) -> Piece:
    """The plant's parts; rng: scatters the leaves."""
    return Piece.of("potted plant", _pot(shape, clay, earth) + _foliage(shape, skins, bark, rng))


def random_plant(rng: Generator) -> Piece:
    """A potted plant of any kind that a generated room may have."""
    foliage = str(rng.choice(["spiky", "bushy", "palm", "broad"]))
    pot_height = rng.uniform(0.2, 0.45)
    shape = Plant(
        pot=str(rng.choice(["cone", "bowl", "cylinder", "cube"])),
        pot_radius=rng.uniform(0.12, 0.24),
        pot_height=pot_height,
        foliage=foliage,
        height=pot_height + rng.uniform(0.35, 1.05),
        spread=rng.uniform(0.22, 0.45),
        n_leaves={
            "spiky": int(rng.integers(14, 39)),
            "bushy": int(rng.integers(60, 130)),
            "palm": int(rng.integers(10, 24)),
            "broad": int(rng.integers(10, 24)),
        }[foliage],
        leaf_width=rng.uniform(0.03, 0.069),
    )
    # Half of the plants are green; the rest is there so that the shape, not the green, makes a plant.
    hue = rng.choice([rng.uniform(85, 150), rng.uniform(60, 150), rng.uniform(270, 380), rng.uniform(0, 360)])
    greens = (colour(hue + rng.uniform(-12, 12), rng.uniform(40, 85), rng.uniform(25, 80)) for _ in range(2))
    skins = [leaves(rng, green) for green in greens]
    pot_colour = random_colour(rng, (5, 90), (30, 97))
    if rng.random() < 0.35:
        pot_colour = colour(hue + rng.uniform(-25, 25), rng.uniform(30, 85), rng.uniform(30, 90))
    clay = ceramic(rng, pot_colour)
    earth = carpet(rng, colour(28, 45, 22), 0.5, 128)
    bark = wood(rng, colour(rng.uniform(20, 90), 45, rng.uniform(25, 50)), 0.4, 128)
    return build_plant(shape, clay, earth, skins, bark, rng)
