"""Which object of the upper image is which of the lower one (paper 2, 2.3).

For every two boxes of one class the AKAZE features inside them are matched under the epipolar constraint, in all
combinations; the combination with most matches is one object. Repeating that until nothing is left pairs the objects
one-to-one. What has no match, or two partners with equally many, is left unmatched and says why.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from course_lib.spherical_stereo.detection.boxes import checked_boxes
from course_lib.spherical_stereo.detection.labels import canonical_label
from course_lib.spherical_stereo.matching.epipolar import (
    EPIPOLAR_TOLERANCE,
    EpipolarPairs,
    allowed_by_rig,
    best_pairs,
    epipolar_pairs,
)
from course_lib.spherical_stereo.matching.feature_matching import RATIO, check_not_swapped, check_same_size
from course_lib.spherical_stereo.matching.features import PanoramaFeatures, detect_features, inside_box
from course_lib.spherical_stereo.panorama import StereoRig, check_panorama_pair

# Reasons why an object has no partner.
CLASS_NOT_IN_OTHER = "class not in the other image"
NO_MATCHES = "no matches"
TIE = "tie"
PARTNER_TAKEN = "partner taken"


@dataclass(frozen=True, eq=False)
class ObjectMatch:
    """One object seen in both images.

    upper, lower: indices into the two lists of detections. label: its class, canonical.
    keypoints_upper, keypoints_lower: `(k, 2)` edge coordinates (pixels) of the features matched inside the two boxes;
    row i of one belongs to row i of the other.
    """

    upper: int
    lower: int
    label: str
    keypoints_upper: np.ndarray
    keypoints_lower: np.ndarray

    @property
    def n_matches(self) -> int:
        """Number of matched features."""
        return len(self.keypoints_upper)


@dataclass(frozen=True)
class Unmatched:
    """A detection without partner: side ("upper" or "lower"), its index there, and the reason.

    The reason is `CLASS_NOT_IN_OTHER`; `NO_MATCHES` (no feature in common with any object of its class); `TIE` (two
    partners with equally many matches); or `PARTNER_TAKEN` (all with which it shares features went to better ones).
    """

    side: str
    index: int
    reason: str


@dataclass(frozen=True)
class StereoMatching:
    """Objects seen in both images, most matched features first, and the detections left over."""

    matches: list[ObjectMatch]
    unmatched: list[Unmatched]


def match_objects(
    upper_image: np.ndarray,
    upper_detections: Sequence,
    lower_image: np.ndarray,
    lower_detections: Sequence,
    rig: StereoRig,
    tolerance: float = EPIPOLAR_TOLERANCE,
) -> list[ObjectMatch]:
    """The objects seen in both images; `stereo_matching` says what is left over, and why.

    Raises what `stereo_matching` raises. Source: paper 2, section 2.3.
    """
    return stereo_matching(upper_image, upper_detections, lower_image, lower_detections, rig, tolerance).matches


def stereo_matching(
    upper_image: np.ndarray,
    upper_detections: Sequence,
    lower_image: np.ndarray,
    lower_detections: Sequence,
    rig: StereoRig,
    tolerance: float = EPIPOLAR_TOLERANCE,
) -> StereoMatching:
    """Pairs the objects of two panoramas: same class, most AKAZE matches under the epipolar constraint, one-to-one.

    Images: uint8 BGR `(H, W, 3)`, W = 2 H, one size. Detections: anything with `label` and `box` (edge coordinates);
    "couch" and "sofa" are one class.
    tolerance: radians on the sphere by which a match may miss its epipolar half-circle. The features are found once per
    image, however many boxes there are. No detections, no matches: the result is then empty.
    Raises `check_panorama_pair`'s errors, `BoxError` for a box that is none, and `SwappedImagesError`.
    Source: paper 2, section 2.3.
    """
    check_panorama_pair(upper_image, lower_image)
    if len(upper_detections) == 0 or len(lower_detections) == 0:
        # Nothing to pair: the features, a quarter of a second, would not be used.
        empty = PanoramaFeatures(np.zeros((0, 2)), np.zeros((0, 61), np.uint8), upper_image.shape[1], len(upper_image))
        return match_detections(empty, upper_detections, empty, lower_detections, rig, tolerance)
    upper, lower = detect_features(upper_image), detect_features(lower_image)
    return match_detections(upper, upper_detections, lower, lower_detections, rig, tolerance)


def match_detections(
    upper: PanoramaFeatures,
    upper_detections: Sequence,
    lower: PanoramaFeatures,
    lower_detections: Sequence,
    rig: StereoRig,
    tolerance: float = EPIPOLAR_TOLERANCE,
) -> StereoMatching:
    """`stereo_matching` from the features of both images on. Source: paper 2, section 2.3."""
    check_same_size(upper, lower)
    upper_boxes = checked_boxes([d.box for d in upper_detections], upper.width, "boxes of the upper image")
    lower_boxes = checked_boxes([d.box for d in lower_detections], lower.width, "boxes of the lower image")
    pairs = epipolar_pairs(upper, lower, tolerance)
    check_not_swapped(best_pairs(pairs, RATIO).disparity)
    in_upper = [inside_box(upper.keypoints, box, upper.width)[pairs.upper] for box in upper_boxes]
    in_lower = [inside_box(lower.keypoints, box, lower.width)[pairs.lower] for box in lower_boxes]
    upper_labels, lower_labels = (
        [canonical_label(d.label) for d in detections] for detections in (upper_detections, lower_detections)
    )
    matched: dict[tuple[int, int], EpipolarPairs] = {}
    counts = np.zeros((len(upper_boxes), len(lower_boxes)), dtype=int)
    for i, j in np.ndindex(counts.shape):
        if upper_labels[i] == lower_labels[j]:
            best = best_pairs(pairs.where(in_upper[i] & in_lower[j]), RATIO)
            # After the contest: a feature whose best partner is an impossible one is not given its second best.
            matched[i, j] = best.where(allowed_by_rig(best, rig.baseline))
            counts[i, j] = len(matched[i, j])
    chosen, tied_upper, tied_lower = pair_by_most_matches(counts)
    matches = [
        ObjectMatch(i, j, upper_labels[i], upper.keypoints[matched[i, j].upper], lower.keypoints[matched[i, j].lower])
        for i, j in chosen
    ]
    rows, columns = {i for i, _ in chosen}, {j for _, j in chosen}
    return StereoMatching(
        matches,
        _left_over("upper", upper_labels, lower_labels, rows, tied_upper, counts.any(axis=1))
        + _left_over("lower", lower_labels, upper_labels, columns, tied_lower, counts.any(axis=0)),
    )


def pair_by_most_matches(counts: np.ndarray) -> tuple[list[tuple[int, int]], set[int], set[int]]:
    """One-to-one pairs by repeated maximum of the counts `(n, m)`, and the rows and columns left out by a tie.

    The largest count among the rows and columns still free makes a pair, and both leave; zero pairs nothing. Where the
    largest count stands twice in one row or column, all rows and columns joined by such counts are left out: any choice
    among them would be a guess. The order of rows and columns has no influence. Source: paper 2, section 2.3.
    """
    counts = np.array(counts, dtype=int)
    pairs: list[tuple[int, int]] = []
    tied_rows: set[int] = set()
    tied_columns: set[int] = set()
    while counts.size and counts.max() > 0:
        largest = counts == counts.max()
        crowded = largest & ((largest.sum(axis=1) > 1)[:, None] | (largest.sum(axis=0) > 1)[None, :])
        # A pair that shares its row or column with another largest count is part of a tie; the others stand alone.
        alone = largest & ~crowded
        pairs += [(int(i), int(j)) for i, j in np.argwhere(alone)]
        tied_rows |= {int(i) for i in np.flatnonzero(crowded.any(axis=1))}
        tied_columns |= {int(j) for j in np.flatnonzero(crowded.any(axis=0))}
        counts[largest.any(axis=1)] = 0
        counts[:, largest.any(axis=0)] = 0
    return pairs, tied_rows, tied_columns


def _left_over(side, labels, other_labels, paired, tied, has_matches) -> list[Unmatched]:
    """The detections of one image that have no partner, each with its reason."""
    left = []
    for index, label in enumerate(labels):
        if index in paired:
            continue
        if label not in other_labels:
            reason = CLASS_NOT_IN_OTHER
        elif index in tied:
            reason = TIE
        else:
            reason = PARTNER_TAKEN if has_matches[index] else NO_MATCHES
        left.append(Unmatched(side, index, reason))
    return left
