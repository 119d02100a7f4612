"""Trouble pairs of panoramas, and run paper 2's method, with the library's own matcher, on them.

The method has no memory: a good pair has the very answer that it had undisturbed. So it has recovered with the first.
"""

from collections.abc import Sequence
from types import SimpleNamespace

import numpy as np

from course_lib.beyond.guarded_stereo import NO_IMAGE, GuardedRig
from course_lib.beyond.look_alikes.consistent import associate_consistent
from course_lib.files import temporary_folder
from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.outcomes import Status
from course_lib.spherical_stereo.pose.localization import Localization
from courseware.experiments.look_alikes import MAX_ERROR_M, MAX_TURN_DEG
from courseware.experiments.observed_rooms import MODELS, rig_of_walk
from courseware.experiments.room_evaluation import pose_errors
from courseware.experiments.troubled_frames import Arrival, Gate, Spoil, troubles_of
from courseware.simulation.room.look_alike_recording import WalkModel, photograph_walks, surveyed_room

GATE = Gate(MAX_ERROR_M, MAX_TURN_DEG)
PERIOD = 1.0  # s between pairs; chosen: a few decimetres of a slow walk
DARK_NOISE = 2.0  # of 255, one sigma, of a camera that sees nothing; chosen
HOT_PIXELS = 2e-5  # share of a dark image's pixels that shine all the same; chosen
STOPS = 2.0  # by which an exposure jumps, up or down; chosen

Pair = tuple[np.ndarray, np.ndarray]


def one_dark(pair: Pair, earlier: Pair, before: Pair, rng: np.random.Generator) -> Pair:
    """Return a pair of which one image, at random, has the noise of a covered lens and a few hot pixels."""
    images, which = list(pair), int(rng.integers(2))
    noise = np.abs(rng.normal(0.0, DARK_NOISE, images[which].shape))
    images[which] = np.minimum(noise, 255).astype(np.uint8)
    images[which][rng.random(noise.shape[:2]) < HOT_PIXELS] = 255
    return images[0], images[1]


def exposure_jump(pair: Pair, earlier: Pair, before: Pair, rng: np.random.Generator) -> Pair:
    """Return a pair of which one, at random, is `STOPS` stops brighter or darker: multiplied, and clipped at white."""
    images = list(pair)
    which, factor = int(rng.integers(2)), 2.0 ** (STOPS * rng.choice((-1.0, 1.0)))
    images[which] = np.clip(np.rint(images[which] * factor), 0, 255).astype(np.uint8)
    return images[0], images[1]


SPOILS: dict[str, Spoil] = {
    "one camera dark": one_dark,
    "cameras exchanged": lambda pair, earlier, before, rng: (pair[1], pair[0]),
    # The lower image is that of the pair before: the rig has moved between the two.
    "different moments": lambda pair, earlier, before, rng: (pair[0], earlier[1]),
    "repeated": lambda pair, earlier, before, rng: (before[0].copy(), before[1].copy()),
    "exposure jump": exposure_jump,
}
LENGTHS = dict.fromkeys(("dropped", *SPOILS), 1)  # how many pairs one after the other each trouble lasts


def room_trouble(detector: str, seed: int, frames: int, shares: Sequence[float]) -> dict:
    """Return `troubles_of` the localizer, with a network of a folder, on a walk through a seed's room."""
    room, semantic_map = surveyed_room(seed, MODELS)
    with temporary_folder() as folder:
        walk = next(photograph_walks(folder, room, seed, 1, frames, MODELS, WalkModel()))
    network = YoloDetector.load(detector)
    localizer = SemanticLocalizer(rig_of_walk(0), semantic_map, network, association=associate_consistent)
    pairs = [(view.upper_image, view.lower_image) for view in walk]
    return walk_trouble(localizer, pairs, np.array([view.pose for view in walk]), seed, shares)


def walk_trouble(
    localizer: SemanticLocalizer, pairs: Sequence[Pair], true_poses: np.ndarray, seed: int, shares: Sequence[float]
) -> dict:
    """Return `room_trouble` of a walk that was photographed; the localizer is asked once for each pair of arrays."""
    answers = {}

    def localize(upper: np.ndarray, lower: np.ndarray) -> Localization:
        key = id(upper), id(lower)
        if key not in answers:
            # The images are kept with the answer, so that no other array can come to have their identity.
            answers[key] = upper, lower, localizer.localize(upper, lower)
        return answers[key][2]

    def run(arrivals: Sequence[Arrival]) -> list[dict]:
        """Return for every pair that was due: outcome, whether there is a pose, its errors (None without one)."""
        rig, frames = GuardedRig(SimpleNamespace(localize=localize), PERIOD), []
        for arrival, true in zip(arrivals, true_poses, strict=True):
            watched = None if arrival.image is None else rig.localize(*arrival.image, arrival.time)
            outcome = NO_IMAGE if watched is None else watched.outcome
            frame = {"outcome": outcome, "confident": outcome == Status.OK, "position_m": None, "rotation_deg": None}
            if outcome == Status.OK:
                dx, dy, frame["rotation_deg"] = pose_errors(watched.localization.pose, true)
                frame["position_m"] = float(np.hypot(dx, dy))
            frames.append(frame)
        return frames

    return troubles_of(run, LENGTHS, SPOILS, pairs, PERIOD * np.arange(len(pairs)), seed, shares)
