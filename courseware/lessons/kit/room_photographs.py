"""Load the experiment's room: its map, its two recordings, and a pair of panoramas with a sofa across the seam."""

import functools

import numpy as np

from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap
from courseware.paths import data_path
from courseware.simulation.room.stereo_recording import StereoPair, StereoRecording, read_stereo_recording


@functools.cache
def room_map() -> SemanticMap:
    """Return the surveyed map of the room."""
    return SemanticMap.load(data_path("room/semantic_map.json"))


@functools.cache
def room_recording(experiment: int) -> StereoRecording:
    """Return the 20 pairs of panoramas of experiment 1 or 2."""
    return read_stereo_recording(data_path(f"room/experiment_{experiment}"))


def pair_of(recording: StereoRecording, name: str) -> StereoPair:
    """Return the pair of this name, such as "09_a". Raises `KeyError` if there is none."""
    return {pair.name: pair for pair in recording.pairs}[name]


def the_pair() -> StereoPair:
    """Return the pair of panoramas that lessons 11 and 12 show. A sofa lies across its seam."""
    return room_recording(1).pairs[9]


@functools.cache
def the_image() -> np.ndarray:
    """Return the upper panorama of `the_pair`, `(640, 1280, 3)` uint8 BGR."""
    return the_pair().images()[0]
