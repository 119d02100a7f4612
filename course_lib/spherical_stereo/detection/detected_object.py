"""What a detector says about one object of a panorama: class, confidence, box, hue and saturation (paper 2, 2.2)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from course_lib.spherical_stereo.detection.boxes import DetectionError, wrapped_box
from course_lib.spherical_stereo.detection.labels import canonical_label


@dataclass(frozen=True)
class Detection:
    """One object found in a panorama. Raises DetectionError for values outside their range."""

    label: str
    """Class, kept as its canonical label (`labels`): a "couch" becomes a "sofa"."""
    score: float
    """Confidence, 0 to 1."""
    box: tuple[float, float, float, float]
    """(u_min, v_min, u_max, v_max), pixels, edge coordinates; u_max passes the image's width across the seam."""
    hue: float
    """Degrees in [0, 360); NaN: the object is grey and has none."""
    saturation: float
    """Percent, 0 to 100."""

    def __post_init__(self) -> None:
        try:
            label = canonical_label(self.label)
        except ValueError as error:
            raise DetectionError(str(error)) from None
        try:
            box = tuple(float(edge) for edge in self.box)
        except (TypeError, ValueError):
            box = ()
        if len(box) != 4 or not all(map(math.isfinite, box)):
            raise DetectionError(f"box must be four finite numbers (u_min, v_min, u_max, v_max); got {self.box}")
        if box[0] < 0 or box[1] < 0 or box[2] <= box[0] or box[3] <= box[1]:
            raise DetectionError(f"box must have 0 <= u_min < u_max and 0 <= v_min < v_max; got {box}")
        for name, value in (("label", label), ("box", box)):
            object.__setattr__(self, name, value)
        for name in ("score", "hue", "saturation"):
            try:
                object.__setattr__(self, name, float(getattr(self, name)))
            except (TypeError, ValueError):
                raise DetectionError(f"{name} must be a number; got {getattr(self, name)!r}") from None
        if not 0 <= self.score <= 1:
            raise DetectionError(f"score must be between 0 and 1; got {self.score}")
        if not (math.isnan(self.hue) or 0 <= self.hue < 360):
            raise DetectionError(f"hue must be in degrees, [0, 360), or NaN for grey; got {self.hue}")
        if not 0 <= self.saturation <= 100:
            raise DetectionError(f"saturation must be in percent, 0 to 100; got {self.saturation}")

    @property
    def centre(self) -> tuple[float, float]:
        """(u, v) of the box's centre, pixels, edge coordinates; u may pass the image's width."""
        return ((self.box[0] + self.box[2]) / 2, (self.box[1] + self.box[3]) / 2)

    @property
    def size(self) -> tuple[float, float]:
        """(width, height) of the box in pixels."""
        return (self.box[2] - self.box[0], self.box[3] - self.box[1])

    @property
    def is_grey(self) -> bool:
        """Whether the object has no hue."""
        return math.isnan(self.hue)

    def wrapped(self, width: int) -> Detection:
        """The same detection with its box moved by whole turns to 0 <= u_min < width (the image's, in pixels)."""
        return Detection(self.label, self.score, tuple(wrapped_box(self.box, width)), self.hue, self.saturation)

    def describe(self) -> str:
        """One line for people: label, score, colour (or that it is grey), and where."""
        colour = "grey, no hue" if self.is_grey else f"hue {self.hue:.0f} deg"
        u, v = self.centre
        return f"{self.label} {self.score:.2f}, {colour}, saturation {self.saturation:.0f} %, centre ({u:.0f}, {v:.0f})"
