"""Seeded pictures that are shown whole, once: posters, screens, labels, book spines, windows and doors; RGB uint8."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.random import Generator

from course_lib.simulation.textures import Colour, Surface, band_noise, colour, random_colour, shaded


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
    columns = pixels
    rows = max(48, round(pixels * height / width))
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
    _lines_of_print(
        image, rng, (left, top, left + columns // 3, min(rows, top + 30)), random_colour(rng, (0, 20), (0, 100))
    )
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
    columns, rows = 192, 192
    image = _gradient(colour(210, 25, 100), colour(205, 8, 100), rows, columns)
    clouds = band_noise(rng, 192, 50.0)[..., None] > 0.7
    image = np.where(clouds, np.uint8(252), image)
    image = np.ascontiguousarray(image)
    for _ in range(int(rng.integers(4, 9))):
        x, top = int(rng.integers(columns)), int(rows * rng.uniform(0.55, 0.85))
        tint = _bytes(random_colour(rng, (10, 45), (50, 85)))
        if rng.random() < 0.5:
            cv2.circle(image, (x, top), int(rng.integers(10, 25)), tint, -1, cv2.LINE_AA)
        cv2.rectangle(image, (x - 14, top), (x + 14, rows), tint, -1)
    return Surface(image, (width, height), emission=0.9)
