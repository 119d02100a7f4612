"""Which object of the upper image is which of the lower one (paper 2, 2.3).

For every two boxes of one class the AKAZE features inside them are matched under the epipolar constraint, in all
combinations; the combination with most matches is one object. Repeating that until nothing is left pairs the objects
one-to-one. What has no match, or two partners with equally many, is left unmatched and says why.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from course_lib.spherical_stereo.detection.boxes import DetectionError, boxes_on
from course_lib.spherical_stereo.detection.labels import canonical_label
from course_lib.spherical_stereo.matching.epipolar import (
    EPIPOLAR_TOLERANCE,
    EpipolarPairs,
    allowed_by_rig,
    best_pairs,
    epipolar_pairs,
)
from course_lib.spherical_stereo.matching.feature_matching import RATIO, check_not_swapped
from course_lib.spherical_stereo.matching.features import find_features, inside_box
from course_lib.spherical_stereo.panorama import PanoramaError, StereoRig, View, open_pair

# Reasons why an object has no partner.
CLASS_NOT_IN_OTHER = "class not in the other image"
NO_MATCHES = "no matches"
TOO_FEW = "too few matches"
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

    The reason is `CLASS_NOT_IN_OTHER`; `NO_MATCHES` (no feature in common with any object of its class); `TOO_FEW`
    (fewer in common than were asked for); `TIE` (two partners with equally many matches); or `PARTNER_TAKEN` (all with
    which it shares features went to better ones).
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
    """The objects seen in both images; `match_views` says what is left over, and why.

    Images: uint8 BGR `(H, W, 3)`, W = 2 H, one size. Detections: anything with `label` and `box` (edge coordinates).
    Raises `PanoramaError` as `open_pair` does, and what `match_views` raises. Source: paper 2, section 2.3.
    """
    upper, lower = open_pair(upper_image, lower_image)
    upper, lower = upper.having(detections=upper_detections), lower.having(detections=lower_detections)
    return match_views(upper, lower, rig, tolerance).matches


def match_views(
    upper: View, lower: View, rig: StereoRig, tolerance: float = EPIPOLAR_TOLERANCE, fewest_features: int = 1
) -> StereoMatching:
    """Pairs the objects of two panoramas: same class, most AKAZE matches under the epipolar constraint, one-to-one.

    upper, lower: panoramas with their detections; "couch" and "sofa" are one class. Features that they lack are found.
    tolerance: radians on the sphere by which a match may miss its epipolar half-circle. fewest_features: how many
    matched features make one object; the paper asks for no number, and one may be an accident.
    Raises `DetectionError` for a box that is none, `SwappedImagesError`, and `PanoramaError` for unlike sizes or a
    number of features below one. Source: paper 2, section 2.3.
    """
    if upper.size != lower.size:
        raise PanoramaError(f"the two images must have one size; got {upper.size} (upper) and {lower.size} (lower)")
    if fewest_features < 1:
        raise PanoramaError(f"fewest_features must be at least 1; got {fewest_features!r}")
    boxes = boxes_on(upper, "upper"), boxes_on(lower, "lower")
    labels = [[canonical_label(d.label) for d in view.detections] for view in (upper, lower)]
    counts = np.zeros((len(boxes[0]), len(boxes[1])), dtype=int)
    matched: dict[tuple[int, int], EpipolarPairs] = {}
    if counts.size:  # without two objects the features, a quarter of a second, would not be used
        upper, lower = find_features(upper), find_features(lower)
        pairs = epipolar_pairs(upper.features, lower.features, tolerance)
        check_not_swapped(best_pairs(pairs, RATIO).disparity)
        in_upper, in_lower = (
            [inside_box(view.features.keypoints, box, view.width)[index] for box in of_view]
            for view, of_view, index in ((upper, boxes[0], pairs.upper), (lower, boxes[1], pairs.lower))
        )
        for i, j in np.ndindex(counts.shape):
            if labels[0][i] == labels[1][j]:
                best = best_pairs(pairs.where(in_upper[i] & in_lower[j]), RATIO)
                # After the contest: a feature whose best partner is an impossible one is not given its second best.
                matched[i, j] = best.where(allowed_by_rig(best, rig.baseline))
                counts[i, j] = len(matched[i, j])
    chosen, *tied = pair_by_most_matches(np.where(counts < fewest_features, 0, counts))
    matches = []
    for i, j in chosen:
        of_upper, of_lower = (
            upper.features.keypoints[matched[i, j].upper],
            lower.features.keypoints[matched[i, j].lower],
        )
        matches.append(ObjectMatch(i, j, labels[0][i], of_upper, of_lower))
    left = []
    for side, (name, paired) in enumerate((("upper", {i for i, _ in chosen}), ("lower", {j for _, j in chosen}))):
        most = counts.max(axis=1 - side, initial=0)
        left += _left_over(name, labels[side], labels[1 - side], paired, tied[side], most, fewest_features)
    return StereoMatching(matches, left)


def matched_indices(matches: Sequence, upper: View, lower: View) -> list[tuple[int, int]]:
    """Indices (upper, lower) of the detections that matches join; they are `ObjectMatch`es or such pairs.

    Raises `DetectionError` for a match that names no detection, or one twice, or joins two classes.
    """
    pairs = []
    for match in matches:
        try:
            i, j = (match.upper, match.lower) if hasattr(match, "upper") else match
        except (TypeError, ValueError):
            raise DetectionError(f"a match is an ObjectMatch or a pair of indices; got {match!r}") from None
        for index, view, side in ((i, upper, "upper"), (j, lower, "lower")):
            if isinstance(index, bool) or not isinstance(index, (int, np.integer)):
                raise DetectionError(f"a match names detections by whole numbers; got {index!r}")
            if not 0 <= index < len(view.detections):
                raise DetectionError(f"a match names {side} detection {index}; there are {len(view.detections)}")
        of_upper, of_lower = upper.detections[i].label, lower.detections[j].label
        if canonical_label(of_upper) != canonical_label(of_lower):
            raise DetectionError(f"a match joins a {of_upper} to a {of_lower}; match one class at a time")
        pairs.append((int(i), int(j)))
    for side, indices in (("upper", [i for i, _ in pairs]), ("lower", [j for _, j in pairs])):
        if len(set(indices)) < len(indices):
            raise DetectionError(f"the matches name one {side} detection twice; they must be one-to-one")
    return pairs


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


def _left_over(side, labels, other_labels, paired, tied, most, fewest_features) -> list[Unmatched]:
    """The detections of one image that have no partner, each with its reason. most: matches with the best one."""
    left = []
    for index, label in enumerate(labels):
        if index in paired:
            continue
        if label not in other_labels:
            reason = CLASS_NOT_IN_OTHER
        elif index in tied:
            reason = TIE
        elif most[index] < fewest_features:
            reason = TOO_FEW if most[index] else NO_MATCHES
        else:
            reason = PARTNER_TAKEN
        left.append(Unmatched(side, index, reason))
    return left
