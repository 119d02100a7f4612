"""What the localizer may be asked: sizes, matches and boxes that go together, or a named error."""

from __future__ import annotations

import numpy as np

from course_lib.spherical_stereo.detection.boxes import checked_boxes
from course_lib.spherical_stereo.detection.labels import canonical_label


class LocalizerError(ValueError):
    """A localizer set up, or called, with what cannot go together; the message says what to do."""


def checked_size(size: tuple[int, int]) -> tuple[int, int]:
    """(width, height) in pixels of a panorama; raises `LocalizerError` for a size that is none's."""
    try:
        width, height = (int(value) for value in size)
    except (TypeError, ValueError):
        raise LocalizerError(f"size must be (width, height) in pixels; got {size!r}") from None
    if height < 1 or width != 2 * height:
        raise LocalizerError(f"a panorama is twice as wide as high; got size {width} x {height}")
    return width, height


def checked_matches(matches: list, upper: list, lower: list) -> list[tuple[int, int]]:
    """Indices (upper, lower) of matches, which are `ObjectMatch`es or such pairs.

    Raises `LocalizerError` for a match that names no detection, or one twice, or joins two classes.
    """
    pairs = []
    for match in matches:
        try:
            i, j = (match.upper, match.lower) if hasattr(match, "upper") else match
        except (TypeError, ValueError):
            raise LocalizerError(f"a match is an ObjectMatch or a pair of indices; got {match!r}") from None
        for index, detections, side in ((i, upper, "upper"), (j, lower, "lower")):
            if isinstance(index, bool) or not isinstance(index, (int, np.integer)):
                raise LocalizerError(f"a match names detections by whole numbers; got {index!r}")
            if not 0 <= index < len(detections):
                raise LocalizerError(f"a match names {side} detection {index}; there are {len(detections)}")
        if canonical_label(upper[i].label) != canonical_label(lower[j].label):
            raise LocalizerError(f"a match joins a {upper[i].label} to a {lower[j].label}; match one class at a time")
        pairs.append((int(i), int(j)))
    for side, indices in (("upper", [i for i, _ in pairs]), ("lower", [j for _, j in pairs])):
        if len(set(indices)) < len(indices):
            raise LocalizerError(f"the matches name one {side} detection twice; they must be one-to-one")
    return pairs


def check_boxes_fit(detections: list, width: int, height: int, name: str) -> None:
    """Raises `LocalizerError` for boxes that stick out of a panorama of that size, `BoxError` for what is no box."""
    boxes = checked_boxes([one.box for one in detections], width, f"boxes of the {name} image")
    # A millionth of a pixel: boxes come from sums and remainders, which round.
    low, high = -1e-6, 1e-6
    outside = (boxes[:, 0] < low) | (boxes[:, 0] >= width + high) | (boxes[:, 1] < low) | (boxes[:, 3] > height + high)
    if outside.any():
        raise LocalizerError(
            f"{name} box {boxes[outside][0].tolist()} is not on a panorama of {width} x {height} pixels: "
            "give size=(width, height) of the image it comes from"
        )
