"""Which object of the upper image is which object of the lower one (paper 2, section 2.3).

For every two boxes of one class the AKAZE features inside them are matched under the epipolar constraint. The
combination with most matches is one object, and so on until nothing is left.
"""

import operator
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from course_lib.spherical_stereo.detection.detected_object import DetectionError, boxes_on, canonical_label
from course_lib.spherical_stereo.matching.alignment import Alignment, camera_alignment, check_not_swapped
from course_lib.spherical_stereo.matching.epipolar import EpipolarPairs, allowed_by_rig, best_pairs, epipolar_pairs
from course_lib.spherical_stereo.matching.features import find_features, inside_box
from course_lib.spherical_stereo.outcomes import NoPartner
from course_lib.spherical_stereo.panorama import StereoRig, View, open_pair

MIN_FEATURES = 3  # matched features that make one object; one alone may be an accident (the paper has no number)


@dataclass(frozen=True, eq=False)
class ObjectMatch:
    """One object seen in both images."""

    upper: int  # index into the upper image's detections
    lower: int
    label: str  # its class, canonical
    keypoints_upper: np.ndarray  # `(k, 2)` edge coordinates, pixels, of the features matched inside the two boxes
    keypoints_lower: np.ndarray  # row by row those of `keypoints_upper`

    @property
    def n_matches(self) -> int:
        """Return the number of matched features."""
        return len(self.keypoints_upper)


class Unmatched(NamedTuple):
    """A detection without a partner in the other image."""

    side: str  # "upper" or "lower"
    index: int  # among the detections of its side
    reason: NoPartner


class StereoMatching(NamedTuple):
    """Objects seen in both images, most matched features first; the detections left over; how the cameras stand."""

    matches: list[ObjectMatch]
    unmatched: list[Unmatched]
    alignment: Alignment


def match_objects(
    upper_image: np.ndarray,
    upper_detections: Sequence,
    lower_image: np.ndarray,
    lower_detections: Sequence,
    rig: StereoRig,
) -> list[ObjectMatch]:
    """Return the objects seen in both images. `match_views` also returns the detections left over, and why.

    Images: uint8 BGR `(H, W, 3)`, W = 2 H, one size. Detections: anything with `label` and `box` (edge coordinates).
    Raises `PanoramaError` as `open_pair` does, and what `match_views` raises. Source: paper 2, section 2.3.
    """
    upper, lower = open_pair(upper_image, lower_image)
    upper, lower = upper.replace(detections=upper_detections), lower.replace(detections=lower_detections)
    return match_views(upper, lower, rig).matches


def match_views(
    upper: View, lower: View, rig: StereoRig, min_features: int = 1, check_alignment: bool = False
) -> StereoMatching:
    """Pair the objects of two panoramas: same class, most AKAZE matches under the epipolar constraint, one-to-one.

    min_features: how many matched features make one object. check_alignment: match nothing if the cameras are turned or
    the images of different moments. The paper asks neither. Source: paper 2, section 2.3.
    """
    boxes = boxes_on(upper, "upper"), boxes_on(lower, "lower")
    labels = [[canonical_label(d.label) for d in view.detections] for view in (upper, lower)]
    counts = np.zeros((len(boxes[0]), len(boxes[1])), dtype=int)
    matched: dict[tuple[int, int], EpipolarPairs] = {}
    alignment = Alignment(None, None)
    if counts.size:  # finding features takes a quarter of a second, and without two objects nobody uses them
        upper, lower = find_features(upper), find_features(lower)
        if check_alignment:
            alignment = camera_alignment(upper.features, lower.features)
            if not (alignment.of_one_moment and alignment.is_upright):
                return StereoMatching([], [], alignment)
        pairs = epipolar_pairs(upper.features, lower.features)
        check_not_swapped(best_pairs(pairs).disparity)
        in_upper, in_lower = (
            [inside_box(view.features.keypoints, box, view.width)[index] for box in of_view]
            for view, of_view, index in ((upper, boxes[0], pairs.upper), (lower, boxes[1], pairs.lower))
        )
        for i, j in np.ndindex(counts.shape):
            if labels[0][i] == labels[1][j]:
                best = best_pairs(pairs.where(in_upper[i] & in_lower[j]))
                # After the contest: a feature whose best partner is an impossible one is not given its second best.
                matched[i, j] = best.where(allowed_by_rig(best, rig.baseline))
                counts[i, j] = len(matched[i, j])
    chosen, *tied = pair_by_most_matches(np.where(counts < min_features, 0, counts))
    matches = []
    for i, j in chosen:
        of_upper = upper.features.keypoints[matched[i, j].upper]
        matches.append(ObjectMatch(i, j, labels[0][i], of_upper, lower.features.keypoints[matched[i, j].lower]))
    unmatched = []
    for side, name in enumerate(("upper", "lower")):
        most = counts.max(axis=1 - side, initial=0)
        for index in sorted(set(range(len(labels[side]))) - {pair[side] for pair in chosen}):
            if labels[side][index] not in labels[1 - side]:
                reason = NoPartner.CLASS_NOT_IN_OTHER
            elif index in tied[side]:
                reason = NoPartner.TIE
            elif most[index] < min_features:
                reason = NoPartner.TOO_FEW_FEATURES if most[index] else NoPartner.NO_MATCHES
            else:
                reason = NoPartner.PARTNER_TAKEN
            unmatched.append(Unmatched(name, index, reason))
    return StereoMatching(matches, unmatched, alignment)


def matched_indices(matches: Sequence, upper: View, lower: View) -> list[tuple[int, int]]:
    """Return the indices (upper, lower) of the detections that matches join: `ObjectMatch`es, or such pairs."""
    pairs = [(m.upper, m.lower) if hasattr(m, "upper") else tuple(map(operator.index, m)) for m in matches]
    for i, j in pairs:
        if not (0 <= i < len(upper.detections) and 0 <= j < len(lower.detections)):
            raise DetectionError(f"a match names upper detection {i} and lower detection {j}; there are fewer")
        of_upper, of_lower = upper.detections[i].label, lower.detections[j].label
        if canonical_label(of_upper) != canonical_label(of_lower):
            raise DetectionError(f"a match joins a {of_upper} to a {of_lower}; match one class at a time")
    if any(len(set(indices)) < len(indices) for indices in zip(*pairs, strict=True)):
        raise DetectionError("the matches name one detection twice; they must be one-to-one")
    return pairs


def pair_by_most_matches(counts: np.ndarray) -> tuple[list[tuple[int, int]], set[int], set[int]]:
    """Return one-to-one pairs by repeated maximum of the counts `(n, m)`, and the rows and columns left out by a tie.

    A tie is the largest count twice in one row or column, where any choice is a guess. Source: paper 2, section 2.3.
    """
    counts = np.array(counts, dtype=int)
    pairs, tied_rows, tied_columns = [], set(), set()
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
