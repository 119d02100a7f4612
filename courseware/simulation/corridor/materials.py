"""Diffuse reflectivity at 850 nm and colour of what the corridor is made of; chosen in the usual ranges for indoors."""

from typing import NamedTuple


class Material(NamedTuple):
    """What a surface is made of."""

    reflectivity: float
    colour: tuple[int, int, int]  # red, green, blue; 0 to 255


WALL_PAINT = Material(0.72, (226, 222, 210))
DADO_PAINT = Material(0.60, (176, 190, 190))
CEILING_PAINT = Material(0.78, (240, 240, 236))
LINOLEUM = Material(0.38, (128, 116, 104))
DOOR_MAT = Material(0.12, (58, 56, 54))
SKIRTING = Material(0.30, (92, 78, 66))
CONCRETE = Material(0.42, (168, 166, 160))
PAINTED_DOOR = Material(0.62, (110, 138, 150))
METAL_FRAME = Material(0.48, (120, 124, 128))
STEEL = Material(0.55, (186, 188, 190))
RADIATOR_ENAMEL = Material(0.74, (236, 236, 230))
WINDOW_FRAME = Material(0.66, (214, 214, 208))
BENCH_WOOD = Material(0.50, (150, 104, 60))
CORK = Material(0.40, (186, 146, 98))
PAPER = Material(0.85, (246, 246, 242))
BLUE_PAPER = Material(0.60, (120, 160, 214))
LAMP_COVER = Material(0.80, (252, 250, 236))
SIGN_GREEN = Material(0.50, (40, 150, 84))
EXTINGUISHER_RED = Material(0.52, (196, 38, 34))
RUBBER = Material(0.06, (34, 34, 36))
CARDBOARD = Material(0.58, (184, 142, 94))
DARK_CLOTH = Material(0.30, (50, 58, 84))
LIGHT_CLOTH = Material(0.55, (190, 180, 164))
SKIN = Material(0.58, (224, 178, 150))
LEAF = Material(0.50, (64, 128, 62))
TERRACOTTA = Material(0.45, (176, 98, 66))
BIN_PLASTIC = Material(0.35, (70, 92, 128))
# Retroreflective sheeting sends light back where it came from: many times a white wall's; saturates when near.
RETROREFLECTIVE_TAPE = Material(25.0, (240, 232, 120))
CABINET = Material(0.60, (150, 152, 150))
