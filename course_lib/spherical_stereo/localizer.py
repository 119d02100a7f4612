"""All of paper 2 in order (its figure 2): from two panoramas, or from their detections on, to a pose on the map.

What the world does (nothing detected, too few objects, points that no pose fits) gives status "unable" and a reason.
What the caller does wrong (images that are no panoramas, boxes of another image's size) raises a named error.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from course_lib.spherical_stereo.detection.labels import canonical_label
from course_lib.spherical_stereo.detection.localizer_input import (
    LocalizerError,
    check_boxes_fit,
    checked_matches,
    checked_size,
)
from course_lib.spherical_stereo.matching.object_matching import stereo_matching
from course_lib.spherical_stereo.panorama import StereoRig, check_panorama_pair
from course_lib.spherical_stereo.pose import localization as outcomes
from course_lib.spherical_stereo.pose.localization import OK, UNABLE, Localization, PlacedObject
from course_lib.spherical_stereo.pose.rigid_fit import (
    CoincidentPoints,
    MirroredPoints,
    RigidFitError,
    TooFewPairs,
    UndeterminedRotation,
    fit_covariance,
    fit_rigid_2d,
)
from course_lib.spherical_stereo.ranging.object_places import DISTANCES, place_objects
from course_lib.spherical_stereo.ranging.triangulation import DIVERGING
from course_lib.spherical_stereo.semantic_map.association import (
    ASSOCIATIONS,
    DISTANCE_TERMS,
    Observation,
    PenaltyWeights,
)
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

IMAGE_SIZE = (1280, 640)
"""Width and height in pixels of the panoramas under data/room."""


class SemanticLocalizer:
    """Pose of a spherical stereo camera on a semantic map.

    rig: baseline and heights. semantic_map: where things are. detector: anything with `detect(image_bgr)` giving
    detections, needed by `localize` only. association: "greedy" (the paper's), a name in `ASSOCIATIONS`.
    distance: "box_centre", the paper's way, or "disparity", from the features matched inside the boxes. weights and
    distance_term: of eq. (1). weighted_fit: False, the paper's way, counts all pairs alike; True weighs each by the
    covariance of its observation. image_size: (width, height) of the panoramas that detections given without their
    images come from; boxes are in pixels and mean nothing without it.
    Raises `LocalizerError` for a name that does not exist or a size that is no panorama's.
    Source: paper 2, figure 2.
    """

    def __init__(
        self,
        rig: StereoRig,
        semantic_map: SemanticMap,
        detector=None,
        association: str = "greedy",
        distance: str = "box_centre",
        weights: PenaltyWeights = PenaltyWeights(),  # noqa: B008 (it cannot change)
        distance_term: str = "absolute",
        weighted_fit: bool = False,
        image_size: tuple[int, int] = IMAGE_SIZE,
    ):
        for name, value, allowed in (
            ("association", association, tuple(ASSOCIATIONS)),
            ("distance", distance, DISTANCES),
            ("distance_term", distance_term, DISTANCE_TERMS),
        ):
            if value not in allowed:
                raise LocalizerError(f"{name} must be one of {allowed}; got {value!r}")
        if not isinstance(rig, StereoRig) or not isinstance(semantic_map, SemanticMap):
            raise LocalizerError(
                f"a StereoRig and a SemanticMap are needed; got {type(rig).__name__} and {type(semantic_map).__name__}"
            )
        self.rig, self.semantic_map, self.detector = rig, semantic_map, detector
        self.association, self.distance = association, distance
        self.weights, self.distance_term, self.weighted_fit = PenaltyWeights(*weights), distance_term, weighted_fit
        self.image_size = checked_size(image_size)

    def localize(self, upper_image: np.ndarray, lower_image: np.ndarray) -> Localization:
        """Pose from two panoramas: uint8 BGR `(H, W, 3)`, W = 2 H, one size.

        Raises the errors of `check_panorama_pair` for images that are none, `SwappedImagesError` for upper and lower
        exchanged, `LocalizerError` without a detector. Source: paper 2, figure 2.
        """
        size = check_panorama_pair(upper_image, lower_image)
        if self.detector is None:
            raise LocalizerError("this localizer has no detector; give one, or call localize_detections")
        upper, lower = self.detector.detect(upper_image), self.detector.detect(lower_image)
        matching = stereo_matching(upper_image, upper, lower_image, lower, self.rig)
        found = self.localize_detections(upper, lower, matching.matches, size)
        return replace(found, unmatched=tuple(matching.unmatched))

    def localize_detections(
        self,
        upper_detections: Sequence,
        lower_detections: Sequence,
        matches: Sequence,
        size: tuple[int, int] | None = None,
    ) -> Localization:
        """Pose from the detections of two panoramas and their matches.

        matches: `ObjectMatch`es, or pairs of indices (upper, lower), which carry no features and so serve "box_centre"
        only. size: (width, height) of the panoramas in pixels; None: the localizer's `image_size`.
        Raises `LocalizerError` for matches that name no detection, or one twice, or join two classes, or lack features
        that are asked for, and for boxes that do not fit on a panorama of that size; `BoxError` for boxes that are
        none. Source: paper 2, sections 2.4 to 2.6.
        """
        width, height = self.image_size if size is None else checked_size(size)
        upper, lower, matches = list(upper_detections), list(lower_detections), list(matches)
        pairs = checked_matches(matches, upper, lower)
        for name, detections in (("upper", upper), ("lower", lower)):
            check_boxes_fit(detections, width, height, name)
        objects, observations = self._place(matches, pairs, upper, lower, width, height)
        found = replace(
            self.localize_observations(observations),
            matches=tuple(matches),
            upper_detections=tuple(upper),
            lower_detections=tuple(lower),
            objects=objects,
        )
        return found if found.status == OK else _with_first_cause(found)

    def localize_observations(self, observations: Sequence[Observation]) -> Localization:
        """Pose from objects that have their places already, in the body frame: sections 2.5 and 2.6.

        Observations of classes that the map lacks may not be among them: they would move the centroid of eq. (1)
        (`localize_detections` leaves them out). Raises `AssociationError` for observations that are none,
        `LocalizerError` for a class that the map lacks. Source: paper 2, sections 2.5, 2.6.
        """
        observations = tuple(observations)
        for i, one in enumerate(observations):
            if canonical_label(one.label) not in self.semantic_map.labels:
                raise LocalizerError(f"observation {i} is a {one.label}, and the map has none: leave it out")
        if not observations:
            return Localization(None, UNABLE, outcomes.TOO_FEW_PAIRS, "there is no observation to match to the map")
        association = ASSOCIATIONS[self.association](
            observations, self.semantic_map, weights=self.weights, distance_term=self.distance_term
        )
        found = Localization(None, UNABLE, observations=observations, association=association)
        return self._fit(found)

    def _fit(self, found: Localization) -> Localization:
        used = [found.observations[i] for i, _ in found.used_pairs]
        source = np.array([[one.x, one.y] for one in used]).reshape(-1, 2)
        target = self.semantic_map.positions[[j for _, j in found.used_pairs]].reshape(-1, 2)
        noise = None if any(one.covariance is None for one in used) else np.array([one.covariance for one in used])
        covariances = noise if self.weighted_fit else None
        try:
            pose = fit_rigid_2d(source, target, covariances=covariances)
        except tuple(_REASON_OF_ERROR) as error:
            return replace(found, reason=_REASON_OF_ERROR[type(error)], explanation=str(error))
        covariance = None
        if noise is not None:
            covariance = fit_covariance(pose, source, target, covariances=covariances, noise=noise)
        return replace(
            found, pose=pose, status=OK, reason=None, covariance=covariance, residuals=pose.apply(source) - target
        )

    def _place(
        self, matches: list, pairs: list[tuple[int, int]], upper: list, lower: list, width: int, height: int
    ) -> tuple[tuple[PlacedObject, ...], list[Observation]]:
        """X = d x_hat of every match, and the observations of those with a place and a class of the map."""
        places = place_objects(matches, pairs, upper, lower, self.rig, self.distance, width, height)
        objects, observations = [], []
        for (i, j), (outcome, position, covariance) in zip(pairs, places, strict=True):
            label, index = canonical_label(upper[i].label), None
            if outcome == OK and label not in self.semantic_map.labels:
                outcome = outcomes.UNMAPPED
            elif outcome == OK:
                index = len(observations)
                x, y = (float(value) for value in position[:2])
                observations.append(Observation(label, x, y, upper[i].hue, upper[i].saturation, covariance))
            objects.append(PlacedObject(i, j, label, outcome, position, index))
        return tuple(objects), observations


_REASON_OF_ERROR: dict[type[RigidFitError], str] = {
    TooFewPairs: outcomes.TOO_FEW_PAIRS,
    CoincidentPoints: outcomes.COINCIDENT,
    MirroredPoints: outcomes.MIRRORED,
    UndeterminedRotation: outcomes.UNDETERMINED,
}


def _with_first_cause(found: Localization) -> Localization:
    """The same, with the first step that left fewer than two objects as the reason, if it was not the fit."""
    n_upper, n_lower = len(found.upper_detections), len(found.lower_detections)
    placed = [one for one in found.objects if np.isfinite(one.position).all()]
    unplaced = [f"{one.label}: {one.outcome}" for one in found.objects if not np.isfinite(one.position).all()]
    seen = f"{n_upper} objects detected in the upper image, {n_lower} in the lower one"
    if min(n_upper, n_lower) == 0:
        return replace(found, reason=outcomes.NO_DETECTIONS, explanation=seen)
    if min(n_upper, n_lower) == 1:
        return replace(found, reason=outcomes.ONE_DETECTION, explanation=seen)
    if len(found.objects) < 2:
        return replace(found, reason=outcomes.TOO_FEW_MATCHED, explanation=f"{seen}; {len(found.objects)} seen in both")
    if all(one.outcome == DIVERGING for one in found.objects):
        return replace(
            found,
            reason=outcomes.SWAPPED,
            explanation=f"all {len(found.objects)} objects appear higher to the upper camera than to the lower one: "
            "give the two sides the other way round",
        )
    if len(placed) < 2:
        return replace(
            found,
            reason=outcomes.TOO_FEW_PLACED,
            explanation=f"{len(placed)} of {len(found.objects)} objects has a distance ({'; '.join(unplaced)})",
        )
    if not found.observations:
        labels = ", ".join(sorted({one.label for one in placed}))
        return replace(found, reason=outcomes.UNMAPPED_ONLY, explanation=f"the map holds none of: {labels}")
    return found
