"""Further views of the rooms of `rooms`: what the method sees a few steps on from each pose.

The first view of a sequence is a pose of `rooms.observe_room` as it stands there; the ones that follow it are made
here, and kept in files of their own, so that who asks for one view does not wait for three.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from typing import NamedTuple

import numpy as np

from course_lib.experiments.rooms import RoomsOptions, record_of_observations, stored_observations
from course_lib.files import temporary_folder
from course_lib.simulation.room.look_alike_recording import WalkModel, experiment_of, photograph_walks, surveyed_room
from course_lib.simulation.room.measurement_places import CAMERA_HEIGHTS
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.panorama import StereoRig
from course_lib.spherical_stereo.semantic_map.association import Observation


@dataclass(frozen=True)
class ViewsOptions:
    """What the further views of a room depend on, beside its seed. views: of a sequence, the first one counted."""

    rooms: RoomsOptions = field(default_factory=RoomsOptions)
    views: int = 3
    walk: WalkModel = field(default_factory=WalkModel)

    def as_dict(self) -> dict:
        """As JSON reads it back."""
        return json.loads(json.dumps(asdict(self)))


def observe_views(seed: int, options: ViewsOptions, detector) -> dict:
    """Make the room of a seed anew, walk on from each of its poses, and note what is seen there; for JSON."""
    models = options.rooms.models
    room, semantic_map = surveyed_room(seed, models)
    sequences = []
    with temporary_folder() as folder:
        walks = photograph_walks(folder, room, seed, options.rooms.poses, options.views - 1, models, options.walk)
        for k, walk in enumerate(walks):
            upper, lower = CAMERA_HEIGHTS[experiment_of(k)]
            localizer = SemanticLocalizer(
                StereoRig(round(upper - lower, 6), upper),
                semantic_map,
                detector,
                image_size=(models.width, models.width // 2),
                reject_implausible=False,
            )
            views = [
                {
                    "pose": view.pose.tolist(),
                    "observations": record_of_observations(
                        localizer.localize(view.upper_image, view.lower_image).observations
                    ),
                }
                for view in walk
            ]
            sequences.append({"experiment": experiment_of(k), "name": f"{k:02d}", "views": views})
    return {"seed": seed, "options": options.as_dict(), "sequences": sequences}


class ViewSequence(NamedTuple):
    """Views of one room from places near each other, the first one a pose of `rooms`."""

    experiment: int
    name: str
    poses: np.ndarray
    """`(n, 3)` [x, y, heading] where the rig really stood."""
    observations: tuple[list[Observation], ...]
    """What was seen from each."""


def stored_sequences(room: dict, views: dict) -> list[ViewSequence]:
    """The sequences of a room: its record of `rooms.observe_room` and the one of `observe_views` joined."""
    first = {(pose["experiment"], pose["name"]): pose for pose in room["poses"]}
    sequences = []
    for entry in views["sequences"]:
        pose = first[entry["experiment"], entry["name"]]
        poses = [pose["pose"], *(view["pose"] for view in entry["views"])]
        seen = [pose["sources"]["images"], *entry["views"]]
        sequences.append(
            ViewSequence(
                entry["experiment"], entry["name"], np.array(poses), tuple(stored_observations(one) for one in seen)
            )
        )
    return sequences
