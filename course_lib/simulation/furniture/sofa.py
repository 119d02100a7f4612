"""Sofas: a low, wide seat between two arms before a back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from course_lib.simulation.furniture.solids import Piece, cylinder, rod, rounded_box, turn
from course_lib.simulation.textures import CLOTH_PATTERNS, Surface, cloth, colour, leather, metal, random_colour, wood

BACK_DEPTH = 0.2  # metres


@dataclass(frozen=True)
class Sofa:
    """Lengths in metres. arm: "box", "roll" or "slope". pillows: how many loose ones lie on it."""

    width: float = 1.7
    depth: float = 0.85
    seat_height: float = 0.42
    back_height: float = 0.8
    arm: str = "box"
    arm_width: float = 0.18
    arm_height: float = 0.6
    leg_height: float = 0.08
    seats: int = 2
    loose_back: bool = True
    pillows: int = 0
    back_lean: float = 0.12


def _arm(shape: Sofa, y: float, cover: Surface) -> list:
    d, wide, low = shape.depth, shape.arm_width, shape.leg_height
    height = shape.arm_height - low
    if shape.arm == "roll":
        parts = rounded_box((d, wide * 0.8, height - 0.06), (0, y, low + (height - 0.06) / 2), cover, 0.03)
        radius = wide * 0.56
        path = [(x, y, shape.arm_height - radius) for x in np.linspace(-d / 2 + 0.01, d / 2 + 0.02, 3)]
        return parts + rod(path, radius, cover, n=14)
    if shape.arm == "slope":
        parts = rounded_box((d * 0.97, wide, height * 0.72), (0, y, low + height * 0.36), cover, 0.05)
        slope = rounded_box((d * 0.62, wide, height * 0.5), (0, 0, 0), cover, 0.06)
        return parts + turn(slope, x=-d * 0.14, y=y, z=low + height * 0.72, pitch=0.18)
    return rounded_box((d, wide, height), (0, y, low + height / 2), cover, 0.045)


def build_sofa(shape: Sofa, cover: Surface, seat: Surface, legs: Surface, pillow: Surface) -> Piece:
    """The sofa's parts: frame, arms, seat and back cushions, legs, pillows."""
    d, w, low = shape.depth, shape.width, shape.leg_height
    inner = w - 2 * shape.arm_width
    base = shape.seat_height - 0.14
    parts = rounded_box((d - 0.02, w - 0.02, base - low), (0.0, 0.0, (base + low) / 2), cover, 0.025)
    tall = shape.back_height - base
    back = rounded_box((BACK_DEPTH, inner + 0.06, tall), (0, 0, tall / 2), cover, 0.06)
    parts += turn(back, x=-d / 2 + BACK_DEPTH / 2 + 0.06, z=base - 0.01, pitch=-shape.back_lean)
    for sign in (-1.0, 1.0):
        parts += _arm(shape, sign * (w - shape.arm_width) / 2, cover)
    each = inner / shape.seats
    for index in range(shape.seats):
        y = -inner / 2 + (index + 0.5) * each
        size = (d - BACK_DEPTH - 0.02, each - 0.012, 0.15)
        parts += rounded_box(size, (BACK_DEPTH / 2 + 0.02, y, base + 0.075), seat, 0.045, bulge=0.03)
        if shape.loose_back:
            height = shape.back_height - shape.seat_height + 0.02
            cushion = rounded_box((0.15, each - 0.02, height), (0, 0, height / 2), seat, 0.06)
            lean = shape.back_lean + 0.08
            parts += turn(cushion, x=-d / 2 + BACK_DEPTH + 0.16, y=y, z=shape.seat_height - 0.01, pitch=-lean)
    if low > 0.02:
        for x in (-d / 2 + 0.09, d / 2 - 0.09):
            for y in (-w / 2 + 0.1, w / 2 - 0.1):
                parts += cylinder(0.022, low + 0.01, (x, y, 0.0), legs, top=0.03, n=10)
    for index in range(shape.pillows):
        sign = 1.0 if index % 2 == 0 else -1.0
        y = sign * (inner / 2 - 0.22 - 0.3 * (index // 2))
        cushion = rounded_box((0.13, 0.4, 0.38), (0, 0, 0.19), pillow, 0.064)
        parts += turn(cushion, x=-0.02, y=y, z=shape.seat_height + 0.02, pitch=-0.35, yaw=-0.2 * sign)
    return Piece.of("sofa", parts)


def random_sofa(rng: Generator) -> Piece:
    """A sofa of any kind that a generated room may have."""
    width = rng.uniform(1.25, 2.15)
    leg = rng.choice([0.0, rng.uniform(0.04, 0.16)])
    seat_height = rng.uniform(0.38, 0.47)
    shape = Sofa(
        width=width,
        depth=rng.uniform(0.75, 0.98),
        seat_height=seat_height,
        back_height=rng.uniform(0.68, 0.95),
        arm=str(rng.choice(["box", "roll", "slope"])),
        arm_width=rng.uniform(0.1, 0.27),
        arm_height=seat_height + rng.uniform(0.06, 0.24),
        leg_height=leg,
        seats=int(rng.integers(2, 4)) if width > 1.6 else int(rng.integers(1, 3)),
        loose_back=bool(rng.random() < 0.7),
        pillows=int(rng.choice([0, 0, 1, 2, 3])),
        back_lean=rng.uniform(0.05, 0.2),
    )
    rgb = random_colour(rng, (8, 95), (25, 95))
    if rng.random() < 0.3:
        cover = leather(rng, rgb, size=rng.uniform(0.7, 1.0))
    else:
        second = random_colour(rng) if rng.random() < 0.3 else None
        cover = cloth(rng, rgb, str(rng.choice(CLOTH_PATTERNS)), second, rng.uniform(0.7, 1.0))
    seat = cover if rng.random() < 0.65 else cloth(rng, random_colour(rng, (8, 95), (25, 95)), size=0.8)
    if rng.random() < 0.7:
        legs = wood(rng, colour(rng.uniform(15, 45), 55, rng.uniform(20, 70)))
    else:
        legs = metal(rng, (0.7, 0.7, 0.72))
    pillow = cloth(rng, random_colour(rng), str(rng.choice(CLOTH_PATTERNS)), random_colour(rng), 0.45)
    return build_sofa(shape, cover, seat, legs, pillow)
