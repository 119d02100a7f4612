"""Every word with which paper 2's method says what became of a detection, of an object, or of a whole localization.

An enum a level. Each member is its own text, so it is compared, printed and written to JSON as that text.
"""

from enum import StrEnum


class Status(StrEnum):
    """Whether a localization has a pose."""

    OK = "ok"
    UNABLE = "unable"  # There is no pose, and a `Reason` says why.


class NoPartner(StrEnum):
    """Why a detection of one image has no partner in the other (section 2.3)."""

    CLASS_NOT_IN_OTHER = "class not in the other image"
    NO_MATCHES = "no matches"  # It shares no feature with any object of its class.
    TOO_FEW_FEATURES = "too few features in common"  # It shares fewer with each of them than were asked for.
    TIE = "tie"  # Two partners share equally many with it.
    PARTNER_TAKEN = "partner taken"  # All with which it shares features went to better ones.


class ObjectOutcome(StrEnum):
    """What became of an object seen in both images: a position, or why it has none (section 2.4)."""

    OK = "ok"
    PARALLEL = "parallel"  # The two directions hardly differ, or one looks straight up or down.
    DIVERGING = "diverging"  # The upper camera sees the object higher than the lower one does.
    AZIMUTH_GAP = "azimuth gap"  # The two box centres are too far apart sideways to be one object's.
    TOO_FEW_DISPARITIES = "too few disparities"  # Fewer matched features than a median needs.
    TOO_FAR = "too far"  # The parallax is below its own noise.
    UNMAPPED = "class not on the map"  # It has a position, but no landmark has its class.


class Reason(StrEnum):
    """Why a localization has no pose, in the order of the steps. Only `NO_POINTS` is a mistake of the caller."""

    BLANK = "blank image"  # 2.3, on the images
    MOMENTS = "images of different moments"
    TURNED = "cameras turned against each other"
    SWAPPED = "images seem swapped"
    NO_DETECTIONS = "no detections"  # 2.2 to 2.4: the first step that leaves fewer than two objects
    ONE_DETECTION = "one detection"
    TOO_FEW_IN_BOTH = "fewer than two objects in both images"
    TOO_FEW_DISTANCES = "fewer than two objects with a distance"
    UNMAPPED_ONLY = "only unmapped classes"
    NOTHING_AGREES = "no two objects agree on a pose"  # 2.5, from a matcher that weighs whole poses
    TOO_FEW_AGREE = "fewer than three objects agree on a pose"  # Two always do.
    AMBIGUOUS = "ambiguous"  # Another pose, or none at all, explains the observations nearly as well.
    TOO_FEW_PAIRS = "fewer than two pairs"  # 2.6, from the fit: one point gives a place and no heading.
    COINCIDENT = "coincident points"  # All points of one side are the same and give no heading.
    MIRRORED = "mirrored points"  # One side is the mirror image of the other, so the pairs are wrong.
    UNDETERMINED = "undetermined rotation"  # Every heading fits equally badly, so the pairs are wrong.
    NO_POINTS = "not points"  # Arrays of a wrong shape, NaN or infinity.
    IMPLAUSIBLE = "implausible"  # The residuals are larger than those of a right pose can be.
