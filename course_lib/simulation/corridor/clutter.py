"""What stands in the corridor on the run day and not on the survey day; `rng` varies it. Metres, all chosen."""

from __future__ import annotations

import numpy as np
from numpy.random import Generator

from course_lib.simulation.corridor import materials as m
from course_lib.simulation.corridor.mesh_building import MeshBuilder, Placement


def cartons(b: MeshBuilder, place: Placement, rng: Generator) -> None:
    """Three stacked cartons, each turned a little, one with an open flap."""
    up = 0.0
    for half_x, half_y, height in ((0.30, 0.21, 0.38), (0.26, 0.19, 0.32), (0.18, 0.15, 0.24)):
        turned = place.moved(rng.uniform(-0.03, 0.03), rng.uniform(-0.03, 0.03), up, rng.uniform(-14, 14))
        b.box(turned, (-half_x, -half_y, 0), (half_x, half_y, height), m.CARDBOARD, bevel=0.006)
        b.box(turned, (-half_x, -0.025, height - 0.002), (half_x, 0.025, height + 0.001), m.PAPER)
        up += height + 0.002
    b.box(turned.moved(up=0.24), (0.18, -0.15, 0.0), (0.186, 0.15, 0.13), m.CARDBOARD)


def person(b: MeshBuilder, place: Placement, rng: Generator) -> None:
    """Standing person from ellipsoids and tubes: legs, trunk, arms, neck, head; a reflecting belt, a bag."""
    s = rng.uniform(1.62, 1.82) / 1.75
    dark, light = (m.DARK_CLOTH, m.LIGHT_CLOTH) if rng.random() < 0.5 else (m.LIGHT_CLOTH, m.DARK_CLOTH)
    for side in (-1.0, 1.0):
        hip, knee, foot = (side * 0.10, 0.0, 0.90 * s), (side * 0.11, 0.03, 0.48 * s), (side * 0.12, 0.0, 0.06)
        b.tube(place, hip, knee, 0.078, dark, 16)
        b.tube(place, knee, foot, 0.060, dark, 16)
        b.ellipsoid(place, knee, (0.066, 0.066, 0.07), dark)
        b.ellipsoid(place, (side * 0.12, 0.06, 0.04), (0.05, 0.13, 0.04), m.RUBBER)
        shoulder, elbow = (side * 0.20, 0.0, 1.42 * s), (side * 0.25, 0.02, 1.12 * s)
        hand = (side * 0.23, 0.13, 0.92 * s)
        b.ellipsoid(place, shoulder, (0.065, 0.065, 0.065), light)
        b.tube(place, shoulder, elbow, 0.045, light, 12)
        b.tube(place, elbow, hand, 0.038, light, 12)
        b.ellipsoid(place, hand, (0.04, 0.05, 0.06), m.SKIN)
    b.ellipsoid(place, (0, 0, 0.95 * s), (0.17, 0.125, 0.14), dark)
    b.ellipsoid(place, (0, 0, 1.22 * s), (0.19, 0.125, 0.29), light, 3)
    b.cone(place, (0, 0, 1.10 * s), 0.192, 0.195, 0.05, m.RETROREFLECTIVE_TAPE)
    b.tube(place, (0, 0, 1.45 * s), (0, 0.01, 1.56 * s), 0.055, m.SKIN)
    b.ellipsoid(place, (0, 0.015, 1.64 * s), (0.075, 0.095, 0.115), m.SKIN, 3)
    b.box(place, (0.24, -0.12, 0.86 * s), (0.34, 0.16, 1.12 * s), m.RUBBER, bevel=0.02)


def trolley(b: MeshBuilder, place: Placement, rng: Generator) -> None:
    """Two-deck trolley with a push bar, castors and a box of paper on it."""
    for up in (0.18, 0.62):
        b.box(place, (-0.40, -0.24, up), (0.40, 0.24, up + 0.025), m.STEEL, bevel=0.005)
    for along in (-0.38, 0.38):
        for side in (-0.22, 0.22):
            b.tube(place, (along, side, 0.12), (along, side, 0.92 if along < 0 else 0.66), 0.014, m.STEEL)
            b.tube(place, (along, side - 0.015, 0.06), (along, side + 0.015, 0.06), 0.06, m.RUBBER, 16)
    b.tube(place, (-0.38, -0.22, 0.92), (-0.38, 0.22, 0.92), 0.016, m.RUBBER)
    b.box(place.moved(turn_deg=8.0), (-0.05, -0.16, 0.645), (0.27, 0.08, 0.86), m.PAPER, bevel=0.004)


def plant(b: MeshBuilder, place: Placement, rng: Generator) -> None:
    """Potted plant: a terracotta pot, a stem and 40 thin leaves."""
    b.cone(place, (0, 0, 0), 0.14, 0.19, 0.36, m.TERRACOTTA)
    b.tube(place, (0, 0, 0.34), (0.02, 0.01, 1.05), 0.015, m.BENCH_WOOD)
    for _ in range(40):
        turn, tilt = rng.uniform(0, 360), np.deg2rad(rng.uniform(-10, 60))
        up, length = rng.uniform(0.5, 1.15), rng.uniform(0.22, 0.36)
        leaf = place.moved(0.02, 0.01, up, turn)
        c, s = np.cos(tilt), np.sin(tilt)
        leaf = Placement(leaf.origin, np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]) @ leaf.axes)
        b.ellipsoid(leaf, (0.04 + length / 2, 0, 0), (length / 2, 0.045, 0.003), m.LEAF, 1)


def bin_with_lid(b: MeshBuilder, place: Placement, rng: Generator) -> None:
    """Waste bin, a frustum with a lid."""
    b.cone(place, (0, 0, 0), 0.16, 0.20, 0.62, m.BIN_PLASTIC)
    b.cone(place, (0, 0, 0.62), 0.21, 0.10, 0.10, m.RUBBER)


def chair(b: MeshBuilder, place: Placement, rng: Generator) -> None:
    """Chair: seat, back, four legs."""
    b.box(place, (-0.21, -0.21, 0.43), (0.21, 0.21, 0.46), m.BENCH_WOOD, bevel=0.008)
    b.box(place, (-0.21, 0.19, 0.62), (0.21, 0.215, 0.86), m.BENCH_WOOD, bevel=0.006)
    for along in (-0.19, 0.19):
        b.tube(place, (along, -0.19, 0.0), (along, -0.19, 0.44), 0.012, m.STEEL)
        b.tube(place, (along, 0.20, 0.0), (along, 0.20, 0.84), 0.012, m.STEEL)


def ladder(b: MeshBuilder, place: Placement, rng: Generator) -> None:
    """Folded ladder that leans at the wall (the local `into` direction is towards the wall)."""
    for along in (-0.22, 0.22):
        b.tube(place, (along, 0.0, 0.0), (along, 0.30, 1.95), 0.022, m.STEEL)
    for i in range(1, 7):
        into, up = 0.30 * (i / 7), 1.95 * (i / 7)
        b.box(place, (-0.22, into - 0.03, up), (0.22, into + 0.03, up + 0.02), m.STEEL)


KINDS = {
    "cartons": cartons,
    "person": person,
    "trolley": trolley,
    "plant": plant,
    "bin": bin_with_lid,
    "chair": chair,
    "ladder": ladder,
}
