"""What is built into the corridor, and the clutter that `rng` varies. Metres, all chosen, by the usual building sizes.

Local axes of a wall: along, into (away from the corridor), up; what sticks out has negative `into`.
"""

import numpy as np
from numpy.random import Generator

from courseware.simulation.corridor import materials as m
from courseware.simulation.corridor.mesh_building import MeshBuilder, Placement

CEILING_HEIGHT = 2.6
# Cheeks of openings begin a little in front of the wall, like plaster beads, so that a bowed wall leaves no crack.
BEAD = 0.008


def wall(
    b: MeshBuilder, place: Placement, start: float, end: float, openings: list[tuple[float, float, float, float]]
) -> None:
    """Wall surface from `start` to `end` with rectangular openings (start, end, bottom, top), none overlapping."""
    at = start
    for low, high, bottom, top in [*sorted(openings), (end, end, 0.0, 0.0)]:
        for left, right, height in ((at, low, CEILING_HEIGHT), (low, high, bottom)):
            if right - left > 1e-6 and height > 0:
                b.panel(place, (left, 0, 0), (right - left, 0, 0), (0, 0, height), m.WALL_PAINT)
                b.box(place, (left, -0.012, 0), (right, 0.02, 0.08), m.SKIRTING, bevel=0.004)
        if high > low and top < CEILING_HEIGHT:
            b.panel(place, (low, 0, top), (high - low, 0, 0), (0, 0, CEILING_HEIGHT - top), m.WALL_PAINT)
        at = high


def recess(b: MeshBuilder, place: Placement, low: float, high: float, bottom: float, top: float, depth: float) -> None:
    """The four cheeks of an opening, from the wall surface to `depth`."""
    d, h = depth + BEAD, top - bottom
    for along in (low, high):
        b.panel(place, (along, -BEAD, bottom), (0, d, 0), (0, 0, h), m.WALL_PAINT)
    b.panel(place, (low, -BEAD, top), (high - low, 0, 0), (0, d, 0), m.WALL_PAINT)
    if bottom > 0:
        b.box(place, (low, -0.03, bottom - 0.03), (high, depth, bottom), m.WINDOW_FRAME, bevel=0.005)
    else:
        b.panel(place, (low, -BEAD, 0), (high - low, 0, 0), (0, d, 0), m.LINOLEUM)


def door(b: MeshBuilder, place: Placement, width: float, depth: float, angle_deg: float, hinge_at_end: bool) -> None:
    """Door in a recess around the local origin: cheeks, frame, leaf turned into the room by `angle_deg`."""
    low, high, top = -width / 2 - 0.06, width / 2 + 0.06, 2.06
    recess(b, place, low, high, 0.0, top, depth)
    for side in (low, high - 0.06):
        b.box(place, (side, depth - 0.09, 0), (side + 0.06, depth + 0.03, top), m.METAL_FRAME, bevel=0.006)
    b.box(place, (low, depth - 0.09, top - 0.06), (high, depth + 0.03, top), m.METAL_FRAME, bevel=0.006)
    leaf_height, thick = top - 0.065, 0.042
    if hinge_at_end:
        hinge, turn, sense = place.moved(width / 2, depth - 0.02), -angle_deg, -1.0
    else:
        hinge, turn, sense = place.moved(-width / 2, depth - 0.02), angle_deg, 1.0
    leaf = hinge.moved(turn_deg=turn)
    b.box(leaf, (0, 0, 0.008), (sense * width, thick, leaf_height), m.PAINTED_DOOR, bevel=0.003)
    for side, out in ((0.0, -1.0), (thick, 1.0)):
        grip = sense * (width - 0.07)
        b.box(leaf, (grip - 0.02, side, 0.95), (grip + 0.02, side + out * 0.008, 1.17), m.STEEL, bevel=0.002)
        b.tube(leaf, (grip, side, 1.06), (grip, side + out * 0.055, 1.06), 0.010, m.STEEL)
        b.tube(leaf, (grip, side + out * 0.05, 1.06), (grip - sense * 0.12, side + out * 0.05, 1.06), 0.010, m.STEEL)
    b.box(place, (high + 0.10, -0.012, 1.5), (high + 0.28, 0.0, 1.62), m.PAPER, bevel=0.002)


def room_behind(b: MeshBuilder, place: Placement, width: float, depth: float, cupboard_height: float) -> None:
    """Stub of a room behind a door: its walls, a desk and a shelf, so that rays through an open door end somewhere."""
    near, far, half = depth - 0.02, depth + 2.4, width / 2 + 0.7
    b.panel(place, (-half, near, 0), (2 * half, 0, 0), (0, far - near, 0), m.LINOLEUM)
    b.panel(place, (-half, near, CEILING_HEIGHT), (2 * half, 0, 0), (0, far - near, 0), m.CEILING_PAINT)
    b.panel(place, (-half, far, 0), (2 * half, 0, 0), (0, 0, CEILING_HEIGHT), m.DADO_PAINT)
    for side in (-half, half):
        b.panel(place, (side, near, 0), (0, far - near, 0), (0, 0, CEILING_HEIGHT), m.DADO_PAINT)
    b.box(place, (-half + 0.02, far - 0.65, 0.70), (half * 0.4, far - 0.02, 0.73), m.BENCH_WOOD, bevel=0.004)
    for along in (-half + 0.05, half * 0.4 - 0.05):
        b.box(place, (along, far - 0.6, 0), (along + 0.03, far - 0.05, 0.70), m.METAL_FRAME)
    b.box(place, (half - 0.36, near + 0.9, 0), (half - 0.02, near + 1.8, cupboard_height), m.CABINET, bevel=0.006)


def window_niche(b: MeshBuilder, place: Placement, low: float, high: float, depth: float, mullions: tuple) -> None:
    """Window over a sill: cheeks, frame and mullions. Its glass is not in the mesh: laser and camera light go out."""
    bottom, top = 0.88, 2.28
    recess(b, place, low, high, bottom, top, depth)
    frame = 0.065
    for along in (low, *(low + (high - low) * share - frame / 2 for share in mullions), high - frame):
        b.box(place, (along, depth - 0.07, bottom), (along + frame, depth, top), m.WINDOW_FRAME, bevel=0.008)
    for up in (bottom, top - frame):
        b.box(place, (low, depth - 0.07, up), (high, depth, up + frame), m.WINDOW_FRAME, bevel=0.008)
    b.tube(place, (high - 0.03, depth - 0.07, 1.45), (high - 0.03, depth - 0.12, 1.45), 0.012, m.STEEL)
    b.box(place, (high - 0.045, depth - 0.135, 1.33), (high - 0.015, depth - 0.115, 1.47), m.STEEL, bevel=0.004)


def radiator(b: MeshBuilder, place: Placement, low: float, high: float) -> None:
    """Panel radiator with fins every 50 mm, a valve and a pipe to the floor."""
    bottom, top = 0.14, 0.72
    b.box(place, (low, -0.055, bottom), (high, -0.045, top), m.RADIATOR_ENAMEL)
    for along in np.arange(low + 0.012, high - 0.012, 0.05):
        fin = (along, -0.115, bottom + 0.01), (along + 0.022, -0.055, top - 0.01)
        b.box(place, *fin, m.RADIATOR_ENAMEL, bevel=0.005)
    for up in (bottom, top - 0.02):
        b.box(place, (low, -0.12, up), (high, -0.04, up + 0.02), m.RADIATOR_ENAMEL, bevel=0.004)
    b.tube(place, (high + 0.05, -0.08, 0.0), (high + 0.05, -0.08, 0.66), 0.011, m.STEEL)
    b.tube(place, (high, -0.08, 0.66), (high + 0.06, -0.08, 0.66), 0.011, m.STEEL)
    b.tube(place, (high + 0.05, -0.08, 0.62), (high + 0.05, -0.15, 0.62), 0.022, m.WINDOW_FRAME)


def pillar(b: MeshBuilder, place: Placement, width: float, out: float) -> None:
    """Concrete pillar before the wall, with a bevel of 20 mm and a steel guard at its foot."""
    b.box(place, (-width / 2, -out, 0), (width / 2, 0.05, CEILING_HEIGHT + 0.03), m.CONCRETE, bevel=0.02)
    b.box(place, (-width / 2 - 0.006, -out - 0.006, 0.0), (width / 2 + 0.006, 0.02, 0.22), m.STEEL, bevel=0.004)


def bench(b: MeshBuilder, place: Placement, length: float) -> None:
    """Bench along the wall: five seat slats, two back slats, three steel frames."""
    for i in range(5):
        near = -0.50 + 0.085 * i
        b.box(place, (-length / 2, near, 0.43), (length / 2, near + 0.065, 0.46), m.BENCH_WOOD, bevel=0.006)
    for up in (0.60, 0.74):
        b.box(place, (-length / 2, -0.075, up), (length / 2, -0.05, up + 0.09), m.BENCH_WOOD, bevel=0.006)
    for share in (-0.42, 0.03, 0.42):
        along = share * length
        b.box(place, (along - 0.02, -0.49, 0.40), (along + 0.02, -0.06, 0.43), m.METAL_FRAME)
        b.box(place, (along - 0.02, -0.05, 0.0), (along + 0.02, -0.01, 0.84), m.METAL_FRAME, bevel=0.004)
        b.box(place, (along - 0.02, -0.47, 0.0), (along + 0.02, -0.43, 0.43), m.METAL_FRAME, bevel=0.004)


def notice_board(b: MeshBuilder, place: Placement, length: float, height: float, rng: Generator) -> None:
    """Cork board with a frame, papers that stand off by millimetres, and one leaflet holder."""
    low, high, bottom = -length / 2, length / 2, 1.0
    b.box(place, (low, -0.018, bottom), (high, 0.01, bottom + height), m.CORK)
    for up in (bottom - 0.03, bottom + height):
        b.box(place, (low - 0.03, -0.035, up), (high + 0.03, 0.01, up + 0.03), m.METAL_FRAME, bevel=0.005)
    for along in (low - 0.03, high):
        b.box(place, (along, -0.035, bottom), (along + 0.03, 0.01, bottom + height), m.METAL_FRAME, bevel=0.005)
    for along in np.arange(low + 0.08, high - 0.32, 0.3):
        up = bottom + rng.uniform(0.08, height - 0.42)
        paper = m.PAPER if rng.random() < 0.7 else m.BLUE_PAPER
        off = rng.uniform(0.004, 0.012)
        b.box(place, (along, -0.018 - off, up), (along + 0.21, -0.018 - off + 0.002, up + 0.297), paper)
    b.box(place, (high - 0.24, -0.11, bottom - 0.36), (high, 0.0, bottom - 0.06), m.STEEL, bevel=0.004)


def lamp(b: MeshBuilder, place: Placement, length: float) -> None:
    """Ceiling lamp: a tray with a bevelled cover, along the first local axis, hung from the local origin."""
    b.box(place, (-length / 2, -0.15, -0.035), (length / 2, 0.15, 0.03), m.METAL_FRAME, bevel=0.006)
    b.box(place, (-length / 2 + 0.02, -0.13, -0.085), (length / 2 - 0.02, 0.13, -0.035), m.LAMP_COVER, bevel=0.02)


def portal(b: MeshBuilder, place: Placement, half_width: float, jamb: float, drop: float, thick: float) -> None:
    """Fire-door portal across the corridor: two jambs, a lintel, both leaves hooked back against the walls."""
    for side in (-1.0, 1.0):
        low, high = sorted((side * (half_width - jamb), side * (half_width + 0.05)))
        b.box(place, (0, low, 0), (thick, high, CEILING_HEIGHT), m.METAL_FRAME, bevel=0.012)
        tape = (low + high) / 2 - side * 0.02
        b.box(place, (-0.001, tape - 0.022, 0.35), (0.0, tape + 0.022, 1.15), m.RETROREFLECTIVE_TAPE)
    lintel = (0, -half_width, CEILING_HEIGHT - drop), (thick, half_width, CEILING_HEIGHT + 0.03)
    b.box(place, *lintel, m.METAL_FRAME, bevel=0.012)
    for side in (-1.0, 1.0):
        near = side * (half_width - 0.10)
        face, grip = near - side * 0.045, near - side * 0.10
        b.box(place, (thick, near, 0.01), (thick + 1.0, face, 2.1), m.PAINTED_DOOR, bevel=0.003)
        b.box(place, (thick + 0.15, face, 1.02), (thick + 0.85, grip, 1.06), m.STEEL, bevel=0.01)


def extinguisher(b: MeshBuilder, place: Placement) -> None:
    """Fire-extinguisher on its bracket, with hose and sign."""
    b.tube(place, (0, -0.12, 0.35), (0, -0.12, 0.85), 0.075, m.EXTINGUISHER_RED, n=24)
    b.ellipsoid(place, (0, -0.12, 0.85), (0.075, 0.075, 0.06), m.EXTINGUISHER_RED)
    b.tube(place, (0, -0.12, 0.88), (0, -0.12, 0.98), 0.018, m.STEEL)
    b.box(place, (-0.02, -0.20, 0.95), (0.02, -0.06, 0.99), m.RUBBER, bevel=0.005)
    b.tube(place, (0.05, -0.16, 0.93), (0.10, -0.13, 0.45), 0.012, m.RUBBER)
    b.box(place, (-0.05, -0.05, 0.5), (0.05, 0.0, 0.7), m.STEEL)
    b.box(place, (-0.10, -0.008, 1.45), (0.10, 0.0, 1.65), m.EXTINGUISHER_RED)


def exit_sign(b: MeshBuilder, place: Placement) -> None:
    """Exit sign that hangs across the corridor from the local origin by two rods."""
    for side in (-0.16, 0.16):
        b.tube(place, (0, side, 0.0), (0, side, -0.2), 0.006, m.STEEL)
    b.box(place, (-0.025, -0.2, -0.38), (0.025, 0.2, -0.2), m.SIGN_GREEN, bevel=0.004)


def cable_tray(b: MeshBuilder, place: Placement, start: float, end: float, brackets: np.ndarray) -> None:
    """Cable tray under the ceiling along the first local axis, with brackets and three cables."""
    b.box(place, (start, -0.15, -0.22), (end, 0.15, -0.215), m.STEEL)
    for side in (-0.15, 0.145):
        b.box(place, (start, side, -0.22), (end, side + 0.005, -0.16), m.STEEL)
    for at in brackets:
        b.box(place, (at, -0.17, -0.25), (at + 0.04, 0.17, -0.22), m.STEEL, bevel=0.003)
        b.tube(place, (at + 0.02, -0.165, -0.22), (at + 0.02, -0.165, 0.02), 0.006, m.STEEL)
    for side, radius in ((-0.08, 0.016), (-0.02, 0.012), (0.07, 0.02)):
        b.tube(place, (start, side, -0.2), (end, side, -0.2), radius, m.RUBBER, n=8)


def stairwell(b: MeshBuilder, place: Placement, width: float) -> None:
    """Stairs behind an opening of the wall: landing, one flight down and one up, strings, a railing with balusters."""
    rise, run, landing, steps, depth = 0.17, 0.28, 1.3, 9, 5.2
    half = width / 2
    b.panel(place, (-half, 0, 0), (width, 0, 0), (0, landing, 0), m.CONCRETE)
    for i in range(steps):
        near = landing + run * i
        down = (-half, near, -rise * (i + 2)), (-0.1, near + run + 0.03, -rise * (i + 1))
        b.box(place, *down, m.CONCRETE, bevel=0.008)
        b.box(place, (0.1, near - 0.03, rise * i), (half, near + run, rise * (i + 1)), m.CONCRETE, bevel=0.008)
    low, high = -rise * (steps + 1), CEILING_HEIGHT + 1.8
    b.panel(place, (-half, landing, low), (width, 0, 0), (0, depth - landing, 0), m.CONCRETE)
    b.panel(place, (-half, depth, low), (width, 0, 0), (0, 0, high - low), m.WALL_PAINT)
    for side in (-half, half):
        b.panel(place, (side, -BEAD, low), (0, depth + BEAD, 0), (0, 0, high - low), m.WALL_PAINT)
    b.panel(place, (-half, -BEAD, CEILING_HEIGHT), (width, 0, 0), (0, landing, 0), m.CEILING_PAINT)
    b.panel(place, (-half, landing, high), (width, 0, 0), (0, depth - landing, 0), m.CEILING_PAINT)
    b.panel(place, (-half, landing, CEILING_HEIGHT), (width, 0, 0), (0, 0, 1.8), m.WALL_PAINT)
    length, drop = run * steps, rise * steps
    for slope, side in ((-1.0, -0.12), (1.0, 0.12)):
        b.tube(place, (side, landing, 0.92), (side, landing + length, 0.92 + slope * drop), 0.022, m.STEEL)
        for i in range(2 * steps + 1):
            share = i / (2 * steps)
            foot, along = slope * drop * share, landing + length * share
            b.tube(place, (side, along, foot), (side, along, foot + 0.92), 0.008, m.STEEL, 8)
    b.tube(place, (-0.12, landing, 0.0), (-0.12, landing, 1.02), 0.03, m.STEEL)
    b.tube(place, (0.12, landing, 0.0), (0.12, landing, 1.02), 0.03, m.STEEL)
    b.tube(place, (-0.12, landing, 0.92), (0.12, landing, 0.92), 0.022, m.STEEL)


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


CLUTTER_KINDS = {
    "cartons": cartons,
    "person": person,
    "trolley": trolley,
    "plant": plant,
    "bin": bin_with_lid,
    "chair": chair,
    "ladder": ladder,
}
