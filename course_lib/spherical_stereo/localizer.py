"""All of paper 2 in order (its figure 2): from two panoramas, or from their detections on, to a pose on the map.

What the world does (nothing detected, too few objects, points that no pose fits) gives status "unable" and a reason.
What the caller does wrong (images that are no panoramas, boxes of another image's size) raises a named error.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from course_lib.beyond.look_alikes.confidence import LEAST_CONFIDENCE, why_unable
from course_lib.beyond.look_alikes.matchers import ASSOCIATIONS, Matcher
from course_lib.spherical_stereo.detection.boxes import boxes_on
from course_lib.spherical_stereo.detection.detector import find_objects
from course_lib.spherical_stereo.detection.labels import canonical_label
from course_lib.spherical_stereo.matching.alignment import GREATEST_TURN, camera_alignment
from course_lib.spherical_stereo.matching.features import find_features
from course_lib.spherical_stereo.matching.object_matching import match_views, matched_indices
from course_lib.spherical_stereo.panorama import StereoRig, View, open_pair
from course_lib.spherical_stereo.pose import localization as outcomes
from course_lib.spherical_stereo.pose.localization import OK, UNABLE, Localization, PlacedObject
from course_lib.spherical_stereo.pose.plausibility import residual_statistics
from course_lib.spherical_stereo.pose.rigid_fit import TOO_FEW_PAIRS, RigidFitError, fit_covariance, fit_rigid_2d
from course_lib.spherical_stereo.ranging.object_places import DISTANCES, Distance, greatest_range, place_objects
from course_lib.spherical_stereo.ranging.triangulation import DIVERGING
from course_lib.spherical_stereo.ranging.vertical_disparity import FEWEST_MATCHES
from course_lib.spherical_stereo.semantic_map.association import DISTANCE_TERMS, Observation, PenaltyWeights
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

IMAGE_SIZE = (1280, 640)
"""Width and height in pixels of the panoramas under data/room."""


class LocalizerError(ValueError):
    """A localizer set up, or called, with what cannot go together; the message says what to do."""


class SemanticLocalizer:
    """Pose of a spherical stereo camera on a semantic map.

    rig: baseline and heights. semantic_map: where things are. detector: anything with `detect(image_bgr)` giving
    detections, needed by `localize` only. association: "greedy" (the paper's), or another name in `ASSOCIATIONS`;
    "consistent" weighs whole poses against each other, and one less sure than least_confidence, 0 to 1, is not given.
    distance: "box_centre", the paper's way, or "disparity", from the features matched inside the boxes. weights and
    distance_term: of eq. (1). weighted_fit: False, the paper's way, counts all pairs alike; True weighs each by the
    covariance of its observation. image_size: (width, height) of the panoramas that detections given without their
    images come from; boxes are in pixels and mean nothing without it.
    reject_implausible: True, and what the paper does not ask is asked: whether the cameras are turned against each
    other, or their images of different moments (`camera_alignment`), an object has at least three matched features and
    stands nearer than `greatest_range`, and the residuals can be those of a right pose (`residual_statistics`). False
    is the paper's method.
    Raises `LocalizerError` for a name that does not exist or a size that is no panorama's.
    Source: paper 2, figure 2.
    """

    def __init__(
        self,
        rig: StereoRig,
        semantic_map: SemanticMap,
        detector=None,
        association: Matcher = "greedy",
        distance: Distance = "box_centre",
        weights: PenaltyWeights = PenaltyWeights(),  # noqa: B008 (it cannot change)
        distance_term: str = "absolute",
        weighted_fit: bool = False,
        image_size: tuple[int, int] = IMAGE_SIZE,
        reject_implausible: bool = True,
        least_confidence: float = LEAST_CONFIDENCE,
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
        self.image_size = View.of_detections([], image_size).size
        self.reject_implausible = bool(reject_implausible)
        if not 0 <= least_confidence <= 1:
            raise LocalizerError(f"least_confidence must lie between 0 and 1; got {least_confidence!r}")
        self.least_confidence = float(least_confidence)

    def localize(self, upper_image: np.ndarray, lower_image: np.ndarray) -> Localization:
        """Pose from two panoramas: uint8 BGR `(H, W, 3)`, W = 2 H, one size.

        Raises `PanoramaError` for images that are none (`open_pair`), `SwappedImagesError` for upper and lower
        exchanged, `LocalizerError` without a detector. Source: paper 2, figure 2.
        """
        if self.detector is None:
            raise LocalizerError("this localizer has no detector; give one, or call localize_detections")
        upper, lower = open_pair(upper_image, lower_image)
        upper, lower = find_objects(upper, self.detector), find_objects(lower, self.detector)
        return self.localize_views(upper, lower)

    def localize_views(self, upper: View, lower: View) -> Localization:
        """Pose from two panoramas whose objects are known, by a detector or by hand: section 2.3 and what follows.

        Raises `SwappedImagesError`, `DetectionError` for boxes that are none, `PanoramaError` for views of two sizes.
        Source: paper 2, figure 2.
        """
        seen = Localization(None, UNABLE, upper_detections=upper.detections, lower_detections=lower.detections)
        if upper.is_blank or lower.is_blank:
            which = [name for name, view in (("upper", upper), ("lower", lower)) if view.is_blank]
            explanation = f"the {' and the '.join(which)} image is black: is a lens covered?"
            return replace(seen, reason=outcomes.BLANK, explanation=explanation)
        turn = None
        if self.reject_implausible and upper.detections and lower.detections:
            upper, lower = find_features(upper), find_features(lower)
            alignment = camera_alignment(upper.features, lower.features)
            if not alignment.of_one_moment:
                explanation = (
                    f"only {alignment.agreeing:.0%} of the features matched between the two images agree on how the "
                    "cameras stand to each other: were they taken at one moment, with the rig standing still?"
                )
                return replace(seen, reason=outcomes.MOMENTS, explanation=explanation)
            turn = alignment.turn
        if turn is not None and np.linalg.norm(turn) > GREATEST_TURN:
            explanation = (
                "the lower camera is turned against the upper one, by {:.1f} degrees of roll, {:.1f} of pitch and "
                f"{{:.1f}} of yaw; {np.degrees(GREATEST_TURN):.1f} are allowed: mend or calibrate the rig"
            ).format(*np.degrees(turn))
            return replace(seen, reason=outcomes.TURNED, explanation=explanation, turn=turn)
        matching = match_views(upper, lower, self.rig, fewest_features=FEWEST_MATCHES if self.reject_implausible else 1)
        pairs = [(match.upper, match.lower) for match in matching.matches]
        found = self._localize(upper, lower, matching.matches, pairs)
        return replace(found, unmatched=tuple(matching.unmatched), turn=turn)

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
        Raises `DetectionError` for matches that name no detection, or one twice, or join two classes, or lack features
        that are asked for, and for boxes that are none or do not fit on a panorama of that size; `PanoramaError` for a
        size that no panorama has. Source: paper 2, sections 2.4 to 2.6.
        """
        size = self.image_size if size is None else size
        upper, lower = (View.of_detections(side, size) for side in (upper_detections, lower_detections))
        for name, view in (("upper", upper), ("lower", lower)):
            boxes_on(view, name)
        matches = list(matches)
        return self._localize(upper, lower, matches, matched_indices(matches, upper, lower))

    def _localize(self, upper: View, lower: View, matches: list, pairs: list[tuple[int, int]]) -> Localization:
        """Sections 2.4 to 2.6. pairs: indices (upper, lower) of the detections that matches join."""
        furthest = greatest_range(self.rig.baseline) if self.reject_implausible else np.inf
        places = place_objects(matches, pairs, upper, lower, self.rig, self.distance, furthest=furthest)
        objects, observations = self._observations(pairs, places, upper.detections)
        found = replace(
            self.localize_observations(observations),
            matches=tuple(matches),
            objects=objects,
            upper_detections=upper.detections,
            lower_detections=lower.detections,
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
            return Localization(None, UNABLE, TOO_FEW_PAIRS, "there is no observation to match to the map")
        association = ASSOCIATIONS[self.association](
            observations, self.semantic_map, weights=self.weights, distance_term=self.distance_term
        )
        found = Localization(None, UNABLE, observations=observations, association=association)
        return self._fit(found) if association.confidence is None else self._weigh(found)

    def _weigh(self, found: Localization) -> Localization:
        """The pose of a matcher that weighed poses, which is fitted already, or why it is not sure enough."""
        ranked, confidence = found.association.hypotheses, found.association.confidence
        reason = why_unable(len(ranked), len(found.association.pairs), confidence, self.least_confidence)
        if reason is not None:
            others = ", ".join(
                f"({one.pose.x:.2f}, {one.pose.y:.2f}) m at {np.degrees(one.pose.theta):.0f} degrees ({one.share:.0%})"
                for one in ranked
            )
            explanation = f"confidence {confidence:.2f}, {self.least_confidence:.2f} is asked for"
            return replace(found, reason=reason, explanation=explanation + (f"; poses: {others}" if others else ""))
        pose = ranked[0].pose
        source, target, noise = self._used_points(found)
        return replace(
            found,
            pose=pose,
            status=OK,
            covariance=ranked[0].covariance,
            residuals=pose.apply(source) - target,
            statistics=None if noise is None else residual_statistics(pose, source, target, noise, noise),
        )

    def _used_points(self, found: Localization) -> tuple[np.ndarray, np.ndarray, np.ndarray | None]:
        """Points `(n, 2)` of the used pairs in the body frame and on the map, and the first ones' covariances."""
        used = [found.observations[i] for i, _ in found.used_pairs]
        source = np.array([[one.x, one.y] for one in used]).reshape(-1, 2)
        target = self.semantic_map.positions[[j for _, j in found.used_pairs]].reshape(-1, 2)
        noise = None if any(one.covariance is None for one in used) else np.array([one.covariance for one in used])
        return source, target, noise

    def _fit(self, found: Localization) -> Localization:
        source, target, noise = self._used_points(found)
        covariances = noise if self.weighted_fit else None
        try:
            pose = fit_rigid_2d(source, target, covariances=covariances)
        except RigidFitError as error:
            return replace(found, reason=error.reason, explanation=str(error))
        found = replace(found, residuals=pose.apply(source) - target)
        if noise is None:
            return replace(found, pose=pose, status=OK)
        statistics = residual_statistics(pose, source, target, noise, covariances)
        if self.reject_implausible and statistics.contradict_the_pose:
            explanation = (
                f"the {len(source)} objects miss their landmarks by {found.rms_residual:.2f} m (root mean square), and "
                f"{statistics.expected_rms:.2f} m may be expected: wrong pairs, a wrong baseline, or another map"
            )
            return replace(
                found, reason=outcomes.IMPLAUSIBLE, explanation=explanation, statistics=statistics, rejected_pose=pose
            )
        covariance = fit_covariance(pose, source, target, covariances=covariances, noise=noise)
        return replace(found, pose=pose, status=OK, covariance=covariance, statistics=statistics)

    def _observations(
        self, pairs: list[tuple[int, int]], places: list, detections: Sequence
    ) -> tuple[tuple[PlacedObject, ...], list[Observation]]:
        """What became of every match, and the observations: those with a place and a class of the map."""
        objects, observations = [], []
        for (i, j), (outcome, position, covariance) in zip(pairs, places, strict=True):
            one = detections[i]
            label, index = canonical_label(one.label), None
            if outcome == OK and label not in self.semantic_map.labels:
                outcome = outcomes.UNMAPPED
            elif outcome == OK:
                index = len(observations)
                x, y = (float(value) for value in position[:2])
                observations.append(Observation(label, x, y, one.hue, one.saturation, covariance))
            objects.append(PlacedObject(i, j, label, outcome, position, index))
        return tuple(objects), observations


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
