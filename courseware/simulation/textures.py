"""Seeded pictures of materials, which repeat without a seam, and prints, which are shown once; RGB uint8, in metres.

They carry contrast at 1 to 10 cm for AKAZE. Patterns change the brightness, so hues stay.
"""

from __future__ import annotations

import colorsys
from dataclasses import dataclass, replace

import cv2
import numpy as np
import scipy.fft
from numpy.random import Generator

Colour = tuple[float, float, float]
Pair = tuple[float, float]


@dataclass(frozen=True)
class Surface:
    """A material: one tile of it and what the tile measures."""

    image: np.ndarray  # `(h, w, 3)` uint8, RGB
    size: tuple[float, float]  # metres that the tile covers, (across, up)
    emission: float = 0.0  # as in TexturedMesh

    def turned(self) -> Surface:
        """The same material with its grain turned by 90 degrees."""
        return Surface(np.ascontiguousarray(np.rot90(self.image)), self.size[::-1], self.emission)


@dataclass(frozen=True)
class TexturedMesh:
    """Triangles that share one texture: what the rooms are built of and what the panorama renderer draws."""

    vertices: np.ndarray  # `(n, 3)` float64, metres, world frame (or that of the piece of furniture being built)
    faces: np.ndarray  # `(m, 3)` int64, counter-clockwise seen from outside
    texture_coordinates: np.ndarray  # `(n, 2)` float64, (s, t); repeats beyond [0, 1], t = 0 is the lowest row
    texture: np.ndarray  # `(h, w, 3)` uint8, RGB
    emission: float = 0.0  # 0 = lit by the lamps only, 1 = at full brightness without any lamp (screens, windows)

    def moved(self, pose: np.ndarray) -> TexturedMesh:
        """The same mesh in another frame; pose: `(4, 4)`, old frame to new frame, a rotation and a translation."""
        return replace(self, vertices=np.asarray(self.vertices, float) @ pose[:3, :3].T + pose[:3, 3])


Meshes = list[TexturedMesh]


def colour(hue: float, saturation: float, value: float) -> Colour:
    """RGB 0 to 1 of a hue in degrees, a saturation and a value in percent (HSV)."""
    return colorsys.hsv_to_rgb((hue % 360.0) / 360.0, saturation / 100.0, value / 100.0)


def random_colour(rng: Generator, saturation: Pair = (25.0, 90.0), value: Pair = (40.0, 95.0)) -> Colour:
    """A colour from anywhere on the hue circle; saturation and value in percent, drawn from the two ranges."""
    return colour(rng.uniform(0.0, 360.0), rng.uniform(*saturation), rng.uniform(*value))


def band_noise(rng: Generator, pixels: int, wavelength: float, stretch: Pair = (1.0, 1.0)) -> np.ndarray:
    """Noise `(pixels, pixels)` that repeats, mean 0, deviation 1; wavelength, pixels; stretch of blobs (across, up)."""
    spectrum = scipy.fft.rfft2(rng.standard_normal((pixels, pixels), dtype=np.float32))
    across = np.fft.rfftfreq(pixels).astype(np.float32)[None, :] * stretch[0]
    up = np.fft.fftfreq(pixels).astype(np.float32)[:, None] * stretch[1]
    frequency = np.sqrt(across**2 + up**2) * wavelength
    frequency[0, 0] = 1e-6
    noise = scipy.fft.irfft2(spectrum * np.exp(-(np.log(frequency) ** 2) / 0.5), s=(pixels, pixels))
    return ((noise - noise.mean()) / (noise.std() + 1e-12)).astype(np.float32)


def shaded(rgb: Colour | np.ndarray, brightness: np.ndarray) -> np.ndarray:
    """A colour times a brightness `(h, w)`, as uint8; above full scale the whole pixel is scaled, so the hue stays."""
    image = np.asarray(rgb, np.float32) * np.maximum(brightness, 0.05)[..., None]
    image /= np.maximum(image.max(axis=2, keepdims=True), 1.0)
    return np.round(image * 255.0).astype(np.uint8)


def _coordinates(pixels: int) -> tuple[np.ndarray, np.ndarray]:
    """(across, up), both 0 to 1, of the pixel centres."""
    line = (np.arange(pixels, dtype=np.float32) + 0.5) / pixels
    return line[None, :], line[:, None]


def _mottled(rng: Generator, base: float | np.ndarray, size: float, pixels: int, *layers: tuple) -> np.ndarray:
    """A brightness with layers of noise on it, each (strength, wavelength in metres, and how it is stretched)."""
    for strength, metres, *stretch in layers:
        base = base + strength * band_noise(rng, pixels, metres / size * pixels, *stretch)
    return base


def _stained(rng: Generator, size: float, pixels: int, count: int, radius: Pair) -> np.ndarray:
    """Filled discs, wrapped at the edges: `(pixels, pixels)` float32, 0 outside, 0.4 to 1 inside; radius: metres."""
    low, high = radius[0] / size * pixels, radius[1] / size * pixels
    mask = np.zeros((pixels, pixels), np.float32)
    for _ in range(count):
        column, row = rng.integers(0, pixels, 2)
        reach, strength = max(1, round(rng.uniform(low, high))), float(rng.uniform(0.4, 1.0))
        for shift in ((0, 0), (pixels, 0), (-pixels, 0), (0, pixels), (0, -pixels)):
            centre = int(column + shift[0]), int(row + shift[1])
            cv2.circle(mask, centre, reach, strength, -1, cv2.LINE_AA)
    return mask


# The patterns that generated rooms draw from; "tartan" and "lattice" are left to the room of the experiment.
CLOTH_PATTERNS = ("plain", "stripes", "checks", "dots", "herringbone", "blotches", "windowpane", "waves")


def cloth(
    rng: Generator, rgb: Colour, pattern="plain", second: Colour | None = None, size: float = 0.8, pixels: int = 256
) -> Surface:
    """Woven cloth: threads, worn patches and a pattern; second: the pattern's colour (None: the same hue, darker)."""
    across, up = _coordinates(pixels)
    threads = np.sin(2 * np.pi * 64 * across) * np.sin(2 * np.pi * 64 * up)
    brightness = _mottled(rng, 1.0 + 0.06 * threads, size, pixels, (0.13, 0.07), (0.11, 0.025))
    repeats = int(rng.integers(4, 11))
    if pattern == "stripes":
        mask = np.broadcast_to((np.sin(2 * np.pi * repeats * across) > rng.uniform(-0.3, 0.6)), (pixels, pixels))
    elif pattern == "checks":
        mask = (np.sin(2 * np.pi * repeats * across) > 0) ^ (np.sin(2 * np.pi * repeats * up) > 0)
    elif pattern == "dots":
        mask = _stained(rng, size, pixels, 60, (0.012, 0.03)) > 0
    elif pattern == "herringbone":
        mask = np.sin(2 * np.pi * (2 * repeats * across + repeats * np.abs(2 * ((up * 4) % 1) - 1))) > 0
    elif pattern == "windowpane":
        mask = (((repeats * across) % 1.0) < 0.18) | (((repeats * up) % 1.0) < 0.18)
    elif pattern == "waves":
        mask = np.sin(2 * np.pi * (repeats * up + 0.5 * np.sin(2 * np.pi * repeats * across))) > 0.2
    elif pattern == "tartan":
        bands = [(np.sin(2 * np.pi * (repeats * line + 0.4 * np.sin(2 * np.pi * line))) > 0.5) for line in (across, up)]
        mask = 0.5 * bands[0] + 0.5 * bands[1]
    elif pattern == "lattice":
        slant = [np.abs(((repeats * (across + sign * up)) % 1.0) - 0.5) < 0.09 for sign in (1, -1)]
        mask = slant[0] | slant[1]
    elif pattern == "blotches":
        mask = band_noise(rng, pixels, 0.09 / size * pixels) > 0.6
    else:
        mask = _stained(rng, size, pixels, 40, (0.004, 0.012)) > 0.5
    weight = mask.astype(np.float32)[..., None]
    other = np.asarray(np.asarray(rgb) * 0.62 if second is None else second, np.float32)
    tint = np.asarray(rgb, np.float32) * (1 - weight) + other * weight
    return Surface(shaded(tint, brightness), (size, size))


def leather(rng: Generator, rgb: Colour, size: float = 0.8, pixels: int = 256) -> Surface:
    """Leather: creases, grain and patches of wear."""
    creases = np.abs(band_noise(rng, pixels, 0.06 / size * pixels))
    brightness = _mottled(rng, 0.85 + 0.22 * np.minimum(creases, 1.2), size, pixels, (0.1, 0.02), (0.1, 0.2))
    return Surface(shaded(rgb, brightness), (size, size))


def wood(rng: Generator, rgb: Colour, size: float = 0.8, pixels: int = 256, boards: int = 0) -> Surface:
    """Wood with its grain across the tile: rings, streaks, knots and, if asked, the joints of boards."""
    across, up = _coordinates(pixels)
    warp = band_noise(rng, pixels, 0.25 / size * pixels, (3.0, 1.0))
    rings = np.sin(2 * np.pi * (rng.integers(6, 13) * up) + 1.6 * warp)
    grain = (0.1, 0.02, (8.0, 1.0)), (0.08, 0.04, (2.0, 1.0))
    brightness = _mottled(rng, 0.95 + 0.13 * rings, size, pixels, *grain)
    knots = _stained(rng, size, pixels, int(rng.integers(3, 9)), (0.006, 0.018))
    brightness *= 1.0 - 0.5 * cv2.GaussianBlur(knots, (0, 0), 1.0)
    if boards:
        board = np.floor(up * boards).astype(int)
        brightness *= 1.0 + rng.uniform(-0.18, 0.18, boards).astype(np.float32)[board]
        joints = (up * boards) % 1.0 < 0.05
        ends = (((across + rng.uniform(0, 1, boards).astype(np.float32)[board]) * 1.0) % 1.0) < 0.008
        brightness *= np.where(joints | ends, 0.55, 1.0)
    return Surface(shaded(rgb, brightness), (size, size))


def metal(rng: Generator, rgb: Colour, size: float = 0.6, pixels: int = 256) -> Surface:
    """Brushed or painted metal: fine streaks, faint clouds and some stains."""
    brightness = _mottled(rng, 0.95, size, pixels, (0.05, 0.012, (12.0, 1.0)), (0.04, 0.12), (0.03, 0.04))
    brightness *= 1.0 - 0.25 * _stained(rng, size, pixels, 25, (0.003, 0.009))
    return Surface(shaded(rgb, brightness), (size, size))


def ceramic(rng: Generator, rgb: Colour, size: float = 0.5, pixels: int = 256) -> Surface:
    """Glazed clay: runs of glaze, speckles and a few bands."""
    _, up = _coordinates(pixels)
    brightness = _mottled(rng, 0.95, size, pixels, (0.14, 0.06, (0.6, 1.4)))
    brightness *= 1.0 - 0.5 * _stained(rng, size, pixels, 90, (0.003, 0.009))
    if rng.random() < 0.5:
        brightness *= np.where((up * rng.integers(2, 6)) % 1.0 < 0.2, 0.65, 1.0)
    return Surface(shaded(rgb, brightness), (size, size))


def plaster(rng: Generator, rgb: Colour, size: float = 2.0, pixels: int = 512) -> Surface:
    """A painted wall: trowel marks, clouds and small chips, all faint."""
    brightness = _mottled(rng, 0.97, size, pixels, (0.035, 0.3), (0.03, 0.06))
    brightness *= 1.0 - 0.2 * _stained(rng, size, pixels, 60, (0.006, 0.014))
    return Surface(shaded(rgb, brightness), (size, size))


def wallpaper(rng: Generator, rgb: Colour, size: float = 1.2, pixels: int = 512) -> Surface:
    """Wallpaper: a printed figure that repeats in staggered rows, or stripes, a little stronger than its ground."""
    across, up = _coordinates(pixels)
    brightness = _mottled(rng, 0.97, size, pixels, (0.04, 0.1))
    repeats = int(rng.integers(4, 9))
    kind = rng.integers(3)
    if kind == 0:
        mask = np.broadcast_to(np.sin(2 * np.pi * repeats * across) > rng.uniform(0.0, 0.8), (pixels, pixels))
    else:
        row = np.floor(up * repeats)
        x = (across * repeats + 0.5 * (row % 2)) % 1.0 - 0.5
        y = (up * repeats) % 1.0 - 0.5
        angle, radius = np.arctan2(y, x), np.hypot(x, y)
        petals = int(rng.integers(3, 7))
        mask = radius < 0.3 * (0.6 + 0.4 * np.cos(petals * angle))
        if kind == 2:
            mask = mask ^ (np.abs(x) + np.abs(y) > 0.46)
    brightness = brightness * (1.0 - rng.uniform(0.1, 0.3) * mask)
    return Surface(shaded(rgb, brightness), (size, size))


def carpet(rng: Generator, rgb: Colour, size: float = 1.5, pixels: int = 512) -> Surface:
    """Carpet: tufts and flecks."""
    return Surface(shaded(rgb, _mottled(rng, 0.9, size, pixels, (0.12, 0.02), (0.1, 0.08))), (size, size))


def tiles(rng: Generator, rgb: Colour, size: float = 1.6, pixels: int = 512, count: int = 4) -> Surface:
    """Floor tiles with joints; every tile has its own shade and stains."""
    across, up = _coordinates(pixels)
    shades = rng.uniform(0.82, 1.08, (count, count)).astype(np.float32)
    brightness = shades[np.floor(up * count).astype(int), np.floor(across * count).astype(int)]
    brightness = _mottled(rng, brightness, size, pixels, (0.07, 0.1), (0.05, 0.03))
    joints = ((across * count) % 1.0 < 0.03) | ((up * count) % 1.0 < 0.03)
    return Surface(shaded(rgb, brightness * np.where(joints, 0.6, 1.0)), (size, size))


def leaves(rng: Generator, rgb: Colour, size: float = 0.25, pixels: int = 128) -> Surface:
    """A leaf's skin: veins that leave the middle (across = 0.5), patches, lighter and darker."""
    across, up = _coordinates(pixels)
    veins = np.abs(np.sin(np.pi * (8 * up + 6 * np.abs(across - 0.5)))) < 0.15
    brightness = 0.9 + 0.22 * band_noise(rng, pixels, pixels / 5.0)
    brightness *= np.where(veins | (np.abs(across - 0.5) < 0.03), 1.25, 1.0)
    return Surface(shaded(rgb, brightness), (size, size))


def glow(rgb: Colour, emission: float = 1.0) -> Surface:
    """A plain bright surface, for lamps."""
    return Surface(shaded(rgb, np.ones((8, 8), np.float32)), (1.0, 1.0), emission)


def _bytes(rgb: Colour) -> tuple[int, int, int]:
    return tuple(round(255 * channel) for channel in rgb)


def _gradient(top: Colour, bottom: Colour, rows: int, columns: int) -> np.ndarray:
    weight = np.linspace(0.0, 1.0, rows, dtype=np.float32)[:, None, None]
    image = np.asarray(top, np.float32) * (1 - weight) + np.asarray(bottom, np.float32) * weight
    return np.ascontiguousarray(np.round(np.broadcast_to(image, (rows, columns, 3)) * 255).astype(np.uint8))


def _lines_of_print(image: np.ndarray, rng: Generator, box: tuple[int, int, int, int], rgb: Colour) -> None:
    """Writes rows of marks that look like words into the box (left, top, right, bottom), in pixels."""
    left, top, right, bottom = box
    height = int(rng.integers(3, 8))
    for row in range(top, bottom - height, height * 2):
        column = left
        while column < right - 3:
            length = int(rng.integers(2, 10))
            end = min(column + length, right)
            cv2.rectangle(image, (column, row), (end, row + height - 1), _bytes(rgb), -1)
            column = end + int(rng.integers(1, 4))


def picture(rng: Generator, width: float, height: float, emission: float = 0.0, pixels: int = 192) -> Surface:
    """A landscape or a composition of figures with some print; width, height: metres."""
    columns, rows = pixels, max(48, round(pixels * height / width))
    image = _gradient(random_colour(rng, (10, 70), (60, 100)), random_colour(rng, (10, 70), (30, 90)), rows, columns)
    if rng.random() < 0.5:
        x = np.arange(columns)
        for layer in range(4):
            waves = sum(rng.uniform(2, 10) * np.sin(x / rng.uniform(6, 40) + rng.uniform(0, 6)) for _ in range(3))
            line = rows * (0.35 + 0.16 * layer) + waves
            outline = np.concatenate([np.stack([x, line], 1), [[columns, rows], [0, rows]]])
            cv2.fillPoly(image, [np.round(outline).astype(np.int32)], _bytes(random_colour(rng)), cv2.LINE_AA)
    for _ in range(int(rng.integers(8, 22))):
        x, y = int(rng.integers(columns)), int(rng.integers(rows))
        a, b = int(rng.integers(3, columns // 7)), int(rng.integers(3, columns // 7))
        tint = _bytes(random_colour(rng, (0, 95), (15, 100)))
        kind = rng.integers(3)
        if kind == 0:
            cv2.ellipse(image, (x, y), (a, b), float(rng.uniform(0, 180)), 0, 360, tint, -1, cv2.LINE_AA)
        elif kind == 1:
            cv2.rectangle(image, (x - a, y - b), (x + a, y + b), tint, -1)
        else:
            corners = np.stack([[x, y], [x + a, y + b], [x - b, y + a]]).astype(np.int32)
            cv2.fillConvexPoly(image, corners, tint, cv2.LINE_AA)
    left, top = int(columns * rng.uniform(0.05, 0.5)), int(rows * rng.uniform(0.6, 0.8))
    box = (left, top, left + columns // 3, min(rows, top + 30))
    _lines_of_print(image, rng, box, random_colour(rng, (0, 20), (0, 100)))
    return Surface(image, (width, height), emission)


def dark_screen(rng: Generator, width: float, height: float) -> Surface:
    """A screen that is off: nearly black with the faint reflection of a window and dust."""
    rows, columns = 96, 160
    brightness = 0.07 + 0.012 * cv2.resize(band_noise(rng, 128, 9.0), (columns, rows))
    x, y = int(rng.integers(10, 110)), int(rng.integers(5, 50))
    brightness[y : y + 30, x : x + 24] += 0.07
    brightness[y : y + 30, x + 30 : x + 44] += 0.05
    tint = colour(rng.uniform(180, 260), 15.0, 100.0)
    return Surface(shaded(tint, np.maximum(brightness, 0.05)), (width, height))


def label(rng: Generator, width: float, height: float) -> Surface:
    """A printed label or note: a coloured field, a bar, lines of print."""
    columns, rows = 96, max(32, round(96 * height / width))
    image = _gradient(random_colour(rng, (0, 60), (70, 100)), random_colour(rng, (0, 60), (70, 100)), rows, columns)
    cv2.rectangle(image, (0, 0), (columns, rows // 4), _bytes(random_colour(rng)), -1)
    cv2.circle(image, (int(rng.integers(15, 80)), rows // 2), max(4, rows // 8), _bytes(random_colour(rng)), -1)
    _lines_of_print(image, rng, (6, rows // 3, columns - 6, rows - 4), random_colour(rng, (0, 40), (5, 40)))
    return Surface(image, (width, height))


def book_row(rng: Generator, width: float, height: float, hue: float | None = None) -> Surface:
    """A row of book spines of several widths and heights; hue: all spines keep to it within 15 degrees (None: any)."""
    columns, rows = 256, max(48, round(256 * height / width))
    image = np.full((rows, columns, 3), 35, np.uint8)
    column = 0
    while column < columns:
        thickness = int(rng.integers(5, 15))
        top = int(rows * rng.uniform(0.02, 0.35))
        if hue is None:
            tint = random_colour(rng, (10, 90), (25, 95))
        else:
            tint = colour(hue + rng.uniform(-15, 15), rng.uniform(55, 90), rng.uniform(35, 95))
        cv2.rectangle(image, (column, top), (column + thickness - 2, rows), _bytes(tint), -1)
        mark = _bytes(tuple(np.clip(np.asarray(tint) * (1.7 if max(tint) < 0.6 else 0.5), 0, 1)))
        first = int(rng.integers(top + 3, max(top + 4, rows - 15)))
        cv2.rectangle(image, (column + 1, first), (column + thickness - 3, first + int(rng.integers(3, 12))), mark, -1)
        column += thickness
    return Surface(image, (width, height))


def window_view(rng: Generator, width: float, height: float) -> Surface:
    """What is seen through a window by day: sky, clouds, roofs or trees; shines by itself."""
    columns = rows = 192
    image = _gradient(colour(210, 25, 100), colour(205, 8, 100), rows, columns)
    image[band_noise(rng, 192, 50.0) > 0.7] = 252
    for _ in range(int(rng.integers(4, 9))):
        x, top = int(rng.integers(columns)), int(rows * rng.uniform(0.55, 0.85))
        tint = _bytes(random_colour(rng, (10, 45), (50, 85)))
        if rng.random() < 0.5:
            cv2.circle(image, (x, top), int(rng.integers(10, 25)), tint, -1, cv2.LINE_AA)
        cv2.rectangle(image, (x - 14, top), (x + 14, rows), tint, -1)
    return Surface(image, (width, height), emission=0.9)
