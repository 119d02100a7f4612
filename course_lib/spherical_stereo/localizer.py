"""All of paper 2 in the order of its figure 2: an image pair walks from the panorama to a pose on the map.

Each step adds its part to the record. If the images give no pose, the record has status "unable" and a reason.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from course_lib.spherical_stereo.detection.colour import coloured
from course_lib.spherical_stereo.detection.detected_object import boxes_on, canonical_label
from course_lib.spherical_stereo.detection.detector import Detector, find_objects
from course_lib.spherical_stereo.drawn_boxes import StereoBoxes
from course_lib.spherical_stereo.matching.alignment import MAX_TURN
from course_lib.spherical_stereo.matching.object_matching import MIN_FEATURES, match_views, matched_indices
from course_lib.spherical_stereo.outcomes import ObjectOutcome, Reason, Status
from course_lib.spherical_stereo.panorama import StereoRig, View, open_pair
from course_lib.spherical_stereo.pose import rigid_fit
from course_lib.spherical_stereo.pose.localization import Localization, PlacedObject
from course_lib.spherical_stereo.pose.rigid_fit import fit_rigid_2d
from course_lib.spherical_stereo.ranging.object_positions import DISTANCES, Distance, Noise, max_range, position_objects
from course_lib.spherical_stereo.semantic_map.association import (
    Association,
    Observation,
    PenaltyWeights,
    associate_greedy,
)
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

IMAGE_SIZE = (1280, 640)  # Width and height in pixels of the panoramas under data/room.


class LocalizerError(ValueError):
    """Parts or arguments of a localizer that do not go together; the message says what to do."""


class SemanticLocalizer:
    """Pose of a spherical stereo camera on a semantic map.

    detector: a `Detector`, which `localize` asks unless it is given boxes. association: "greedy" (the paper's), or a
    function that is called as `associate_greedy` is. distance: "box_centre", the paper's way, or "disparity", from the
    matched features.
    weights and distance_term: of eq. (1). weighted_fit: True weighs each pair by the covariance of its observation; the
    paper counts all pairs alike. noise: how exact detections are, for covariances and `max_range`. image_size: (width,
    height) of panoramas whose images are not given.
    reject_implausible: False is the paper's method. True also requires that the cameras are aligned, that the two
    images show one moment, that an object has three matched features and is nearer than `max_range`, and that the
    residuals are no larger than those of a right pose can be. Raises `LocalizerError` for a name that does not exist,
    `PanoramaError` for a size that no panorama has. Source: paper 2, figure 2.
    """

    def __init__(
        self,
        rig: StereoRig,
        semantic_map: SemanticMap,
        detector: Detector | None = None,
        association: str | Callable[..., Association] = "greedy",
        distance: Distance = "box_centre",
        weights: PenaltyWeights = PenaltyWeights(),  # noqa: B008 (it cannot change)
        distance_term: str = "absolute",
        weighted_fit: bool = False,
        image_size: tuple[int, int] = IMAGE_SIZE,
        reject_implausible: bool = True,
        noise: Noise = Noise(),  # noqa: B008 (it cannot change)
    ):
        if detector is not None and (isinstance(detector, type) or not isinstance(detector, Detector)):
            expected = "an object with detect(image_bgr) -> list of Detection, such as YoloDetector.load(folder)"
            raise LocalizerError(f"detector must be {expected}; got {detector!r}")
        if association != "greedy" and not callable(association):
            raise LocalizerError(f'association must be "greedy" or called as associate_greedy is; got {association!r}')
        if distance not in DISTANCES:
            raise LocalizerError(f"distance must be one of {DISTANCES}; got {distance!r}")
        self.rig, self.semantic_map, self.detector = rig, semantic_map, detector
        if not (np.isfinite(noise).all() and min(noise) >= 0 and noise[0] > 0):
            raise LocalizerError(f"noise must be Noise(radians, metres, metres), the first above 0; got {noise}")
        self.noise = Noise(*noise)
        self.association = associate_greedy if association == "greedy" else association
        self.distance, self.weights, self.distance_term = distance, PenaltyWeights(*weights), distance_term
        self.weighted_fit, self.reject_implausible = weighted_fit, bool(reject_implausible)
        self.image_size = View(*image_size).size

    def localize(
        self, upper_image: np.ndarray | View, lower_image: np.ndarray | View, boxes: StereoBoxes | None = None
    ) -> Localization:
        """Return the pose from two panoramas: uint8 BGR `(H, W, 3)`, W = 2 H, one size, or views of them.

        boxes: the objects in them, drawn by hand (`read_stereo_boxes`); None: the detector finds them. Raises
        `PanoramaError` for images that are no panoramas (`open_pair`), `SwappedImagesError` for upper and lower
        exchanged, `DetectionError` for boxes of other images, `LocalizerError` without boxes and a detector.
        Source: paper 2, figure 2.
        """
        if boxes is not None:
            upper, lower = boxes.on(upper_image, lower_image)
            return self._walk(Localization(upper=upper, lower=lower), self._match)
        if self.detector is None:
            raise LocalizerError("this localizer has no detector; give it one, or give boxes")
        upper, lower = open_pair(upper_image, lower_image)
        return self._walk(Localization(upper=upper, lower=lower), self._detect)

    def localize_detections(
        self,
        upper_detections: Sequence,
        lower_detections: Sequence,
        matches: Sequence,
        size: tuple[int, int] | None = None,
    ) -> Localization:
        """Return the pose from the detections of two panoramas and their matches: section 2.4 and on.

        matches: `ObjectMatch`es, or pairs of indices (upper, lower), which serve "box_centre" only. size: (width,
        height) of the panoramas; None: `image_size`. Raises `DetectionError` for matches and boxes that cannot be,
        `PanoramaError` for a size that no panorama has. Source: paper 2, sections 2.4 to 2.6.
        """
        size = size or self.image_size
        upper, lower = (coloured(View(*size, detections=side)) for side in (upper_detections, lower_detections))
        boxes_on(upper, "upper"), boxes_on(lower, "lower")
        found = Localization(upper=upper, lower=lower, matches=tuple(matches))
        return self._walk(found, self._range)

    def localize_observations(self, observations: Sequence[Observation]) -> Localization:
        """Return the pose from objects whose positions in the body frame are known: sections 2.5 and 2.6."""
        observations = tuple(observations)
        for i, one in enumerate(observations):
            if canonical_label(one.label) not in self.semantic_map.labels:
                raise LocalizerError(f"observation {i} is a {one.label}, and the map has none: leave it out")
        return self._walk(Localization(observations=observations), self._associate)

    def _walk(self, found: Localization, first: Callable[[Localization], Localization]) -> Localization:
        """Take the record through the steps of figure 2, from the first on that it needs."""
        steps = [self._detect, self._match, self._range, self._associate, self._fit]
        for step in steps[steps.index(first) :]:
            found = step(found)
        if found.upper is None:
            return found
        upper, lower = (replace(view, image=None, features=None) for view in (found.upper, found.lower))
        return replace(found, upper=upper, lower=lower)

    def _detect(self, found: Localization) -> Localization:
        """Detect the objects of each panorama (2.2)."""
        upper, lower = (find_objects(view, self.detector) for view in (found.upper, found.lower))
        return replace(found, upper=upper, lower=lower)

    def _match(self, found: Localization) -> Localization:
        """Find out which object of the upper image is which of the lower one (2.3)."""
        blank = [name for name, view in (("upper", found.upper), ("lower", found.lower)) if view.is_blank]
        if blank:
            return found.unable(Reason.BLANK, f"the {' and the '.join(blank)} image is black: is a lens covered?")
        options = {"min_features": MIN_FEATURES, "check_alignment": True} if self.reject_implausible else {}
        matching = match_views(found.upper, found.lower, self.rig, **options)
        turn, agreeing = matching.alignment
        if not matching.alignment.of_one_moment:
            return found.unable(
                Reason.MOMENTS,
                f"only {agreeing:.0%} of the features matched between the two images agree on how the cameras stand to "
                "each other: were they taken at one moment, with the rig standing still?",
            )
        if not matching.alignment.is_upright:
            roll, pitch, yaw = np.degrees(turn)
            return found.unable(
                Reason.TURNED,
                f"the lower camera is turned against the upper one, by {roll:.1f} degrees of roll, {pitch:.1f} of "
                f"pitch and {yaw:.1f} of yaw; {np.degrees(MAX_TURN):.1f} are allowed: mend or calibrate the rig",
                turn=turn,
            )
        return replace(found, matches=tuple(matching.matches), unmatched=tuple(matching.unmatched), turn=turn)

    def _range(self, found: Localization) -> Localization:
        """Place the matched objects (2.4). Those with a position and a class of the map are the observations."""
        pairs = matched_indices(found.matches, found.upper, found.lower)
        furthest = max_range(self.rig.baseline, self.noise.box_centre) if self.reject_implausible else np.inf
        views = found.upper, found.lower
        positions = position_objects(found.matches, pairs, *views, self.rig, self.distance, self.noise, furthest)
        objects, observations = [], []
        for (i, j), (outcome, position, covariance) in zip(pairs, positions, strict=True):
            one = found.upper.detections[i]
            label, index = canonical_label(one.label), None
            if outcome == ObjectOutcome.OK and label not in self.semantic_map.labels:
                outcome = ObjectOutcome.UNMAPPED
            elif outcome == ObjectOutcome.OK:
                index = len(observations)
                x, y = (float(value) for value in position[:2])
                observations.append(Observation(label, x, y, one.hue, one.saturation, covariance))
            objects.append(PlacedObject(i, j, label, outcome, position, index))
        found = replace(found, objects=tuple(objects), observations=tuple(observations))
        cause = _too_few(found)
        return found if cause is None else found.unable(*cause)

    def _associate(self, found: Localization) -> Localization:
        """Pair the observations with landmarks (2.5)."""
        if not found.observations:
            return found.unable(Reason.TOO_FEW_PAIRS, "there is no observation to match to the map")
        how = {"weights": self.weights, "distance_term": self.distance_term}
        association = self.association(found.observations, self.semantic_map, **how)
        found = replace(found, association=association)
        return found if association.reason is None else found.unable(association.reason, association.explanation)

    def _fit(self, found: Localization) -> Localization:
        """Fit the pose to the pairs of like classes (2.6). A matcher that weighed whole poses has one already."""
        if found.reason is not None:
            return found
        used = [found.observations[i] for i, _ in found.used_pairs]
        source = np.array([[one.x, one.y] for one in used]).reshape(-1, 2)
        target = self.semantic_map.positions[[j for _, j in found.used_pairs]].reshape(-1, 2)
        noise = None if any(one.covariance is None for one in used) else np.array([one.covariance for one in used])
        weighed = found.confidence is not None
        covariances = noise if self.weighted_fit or weighed else None
        try:
            pose = found.alternatives[0].pose if weighed else fit_rigid_2d(source, target, covariances=covariances)
        except rigid_fit.RigidFitError as error:
            return found.unable(error.reason, str(error))
        found = replace(found, residuals=pose.apply(source) - target)
        if noise is not None:
            found = replace(found, statistics=rigid_fit.residual_statistics(pose, source, target, noise, covariances))
        if weighed:
            return replace(found, pose=pose, status=Status.OK, covariance=found.alternatives[0].covariance)
        if noise is None:
            return replace(found, pose=pose, status=Status.OK)
        if self.reject_implausible and found.statistics.contradict_the_pose:
            return found.unable(
                Reason.IMPLAUSIBLE,
                f"the {len(source)} objects miss their landmarks by {found.rms_residual:.2f} m (root mean square), and "
                f"{found.statistics.expected_rms:.2f} m may be expected: wrong pairs, a wrong baseline, or another map",
                rejected_pose=pose,
            )
        covariance = rigid_fit.fit_covariance(pose, source, target, covariances=covariances, noise=noise)
        return replace(found, pose=pose, status=Status.OK, covariance=covariance)


def _too_few(found: Localization) -> tuple[str, str] | None:
    """Return the first step that left fewer than two objects, as a reason and an explanation."""
    n_upper, n_lower = len(found.upper_detections), len(found.lower_detections)
    placed = [one for one in found.objects if np.isfinite(one.position).all()]
    seen = f"{n_upper} objects detected in the upper image, {n_lower} in the lower one"
    if min(n_upper, n_lower) < 2:
        return (Reason.ONE_DETECTION if min(n_upper, n_lower) else Reason.NO_DETECTIONS), seen
    if len(found.objects) < 2:
        return Reason.TOO_FEW_IN_BOTH, f"{seen}; {len(found.objects)} seen in both"
    if all(one.outcome == ObjectOutcome.DIVERGING for one in found.objects):
        return Reason.SWAPPED, (
            f"all {len(found.objects)} objects appear higher to the upper camera than to the lower one: "
            "give the two sides the other way round"
        )
    if len(placed) < 2:
        unplaced = "; ".join(f"{one.label}: {one.outcome}" for one in found.objects if np.isnan(one.position).any())
        return Reason.TOO_FEW_DISTANCES, f"{len(placed)} of {len(found.objects)} objects has a distance ({unplaced})"
    if not found.observations:
        return Reason.UNMAPPED_ONLY, f"the map holds none of: {', '.join(sorted({one.label for one in placed}))}"
    return None
