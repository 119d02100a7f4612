"""The seven kinds of furniture that a semantic map lists: for each its shape, its parts, and a random piece."""

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from courseware.simulation import textures
from courseware.simulation.furniture.solids import Piece, box, cylinder, lathe, panel, rod, rounded_box, swept, turn
from courseware.simulation.textures import CLOTH_PATTERNS, Surface, cloth, colour, metal, random_colour, wood

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
        for x, y in itertools.product((-d / 2 + 0.09, d / 2 - 0.09), (-w / 2 + 0.1, w / 2 - 0.1)):
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
        cover = textures.leather(rng, rgb, size=rng.uniform(0.7, 1.0))
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


def _chair_base(shape: Chair, frame: Surface) -> list:
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
        for x, y in itertools.product((-d, d), (-w, w)):
            out = 1.0 + shape.splay / max(abs(x), 1e-3)
            parts += rod([(x * out, y * out, 0.0), (x, y, top)], r, frame)
        if shape.splay < 0.02:
            for y in (-w, w):
                parts += rod([(-d, y, 0.2), (d, y, 0.2)], 0.6 * r, frame)
    return parts


def _chair_back(shape: Chair, frame: Surface, cover: Surface) -> list:
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
    parts = _chair_base(shape, frame)
    if shape.round_seat:
        parts += cylinder(w / 2 - 0.015, 0.05, (0, 0, top - 0.05), cover, top=w / 2, n=20)
    else:
        parts += rounded_box((d, w, 0.06), (0, 0, top - 0.03), cover, 0.025, bulge=0.012)
    if shape.base == "star":
        parts += box((0.03, 0.07, 0.24), (-d / 2 - 0.01, 0, top + 0.06), frame)
    parts += turn(_chair_back(shape, frame, cover), x=-d / 2 + 0.03, z=top - 0.01, pitch=-0.14)
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
        cover = frame if rng.random() < 0.6 else painted
    elif kind == "upholstered":
        shape = Chair(*size, rng.uniform(0.8, 1.08), armrests=bool(rng.random() < 0.3), **legs)
        frame, cover = (timber, timber, steel, painted)[int(rng.integers(4))], fabric
    elif kind == "office":
        shape = Chair(*size, rng.uniform(0.85, 1.15), "star", armrests=bool(rng.random() < 0.6), **legs)
        frame, cover = steel, fabric
    elif kind == "shell":
        base = str(rng.choice(["legs", "sledge"]))
        shape = Chair(*size, rng.uniform(0.75, 0.9), base, "shell", **legs)
        frame = (timber, steel, painted)[int(rng.integers(3))]
        cover = painted if rng.random() < 0.5 else fabric
    else:
        seat_height = rng.uniform(0.5, 0.68)
        height = seat_height + rng.uniform(0.2, 0.32)
        shape = Chair(width, width, seat_height, height, back="ladder", round_seat=True, **legs)
        frame, cover = steel if rng.random() < 0.5 else timber, painted
    return build_chair(shape, frame, cover)


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


def _table_base(shape: Table, frame: Surface) -> list:
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
    for x, y in itertools.product((-d, d), (-w, w)):
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
    parts = _table_base(shape, frame)
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
        for x, y in itertools.product((-d / 2 + 0.05, d / 2 - 0.07), (-w / 2 + 0.06, w / 2 - 0.06)):
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
                low_edge, book = level + 0.4 * t, min(0.88 * tall, 0.34)
                parts.append(panel((0.04 - d / 2, left, low_edge), (0, width, 0), (0, 0, tall), inside))
                if books:
                    size, centre = (d * 0.6, width * 0.94, book), (-0.02, left + width / 2, low_edge + book / 2)
                    parts += box(size, centre, inside, front=books[order % len(books)])
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
    books = [textures.book_row(rng, width / columns, 0.3) for _ in range(3)] if "open" in dict(rows) else []
    return build_cabinet(shape, body, fronts, inside, knob, books)


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
    notes = [
        textures.label(rng, rng.uniform(0.07, 0.16), rng.uniform(0.08, 0.2)) for _ in range(int(rng.integers(0, 5)))
    ]
    return build_refrigerator(shape, body, steel, dark, notes)


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
        for y, x in itertools.product((-w * 0.35, w * 0.35), (0.12, -0.12)):
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
        screen = textures.dark_screen(rng, width, width * 9 / 16)
    else:
        screen = textures.picture(rng, width, width * 9 / 16, emission=float(rng.uniform(0.5, 0.95)))
    return build_television(shape, case, screen)


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


def _leaf(start: np.ndarray, direction: float, rise: float, droop: float, size: tuple, skin: Surface) -> list:
    """A leaf of size (width, length) from start: it leaves at the angle rise above the horizon, and bends by droop."""
    width, length = size
    s = np.linspace(0.0, 1.0, 6)
    angle = rise - droop * s
    step = length / 5
    reach = np.concatenate([[0.0], np.cumsum(step * np.cos(angle[:-1]))])
    up = np.concatenate([[0.0], np.cumsum(step * np.sin(angle[:-1]))])
    path = start + np.stack([reach * np.cos(direction), reach * np.sin(direction), up], 1)
    side = np.array([-np.sin(direction), np.cos(direction), 0.0])
    widths = width / 2 * np.maximum(np.sin(np.pi * (0.12 + 0.86 * s)) ** 0.8, 0.06)
    # One tile spans the leaf's width, so that the midrib runs along its middle.
    return swept(path, side, widths, np.full(6, 0.003), Surface(skin.image, size), n=4)


def build_plant(
    shape: Plant, clay: Surface, earth: Surface, skins: list[Surface], bark: Surface, rng: Generator
) -> Piece:
    """The plant's pot, stems and leaves; rng: scatters the leaves."""
    parts = _pot(shape, clay, earth)
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
        parts += _leaf(start, direction, elevation, droop, (width, length), skins[index % len(skins)])
    return Piece.of("potted plant", parts)


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
    skins = [textures.leaves(rng, green) for green in greens]
    pot_colour = random_colour(rng, (5, 90), (30, 97))
    if rng.random() < 0.35:
        pot_colour = colour(hue + rng.uniform(-25, 25), rng.uniform(30, 85), rng.uniform(30, 90))
    clay = textures.ceramic(rng, pot_colour)
    earth = textures.carpet(rng, colour(28, 45, 22), 0.5, 128)
    bark = wood(rng, colour(rng.uniform(20, 90), 45, rng.uniform(25, 50)), 0.4, 128)
    return build_plant(shape, clay, earth, skins, bark, rng)


RANDOM_PIECES = {
    "sofa": random_sofa,
    "chair": random_chair,
    "table": random_table,
    "television": random_television,
    "potted plant": random_plant,
    "refrigerator": random_refrigerator,
    "cabinet": random_cabinet,
}
