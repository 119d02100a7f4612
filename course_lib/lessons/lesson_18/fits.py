"""What an anisotropic fit is worth: the right pairs of every photograph, fitted both ways."""

import numpy as np

from course_lib.beyond.look_alikes.hypotheses import fit_poses, scene_of
from course_lib.lessons.kit.room_observations import room_scenes
from course_lib.lessons.kit.room_photographs import room_map
from course_lib.spherical_stereo.pose.rigid_fit import fit_rigid_2d


def fit_errors() -> dict[str, np.ndarray]:
    """Name of a fit -> distances `(20,)`, metres, from the true place; both fits get the true pairs.

    "plain": `fit_rigid_2d`, the paper's, every error counted alike. "weighed": `fit_poses`, by the stereo covariance.
    """
    errors: dict[str, list[float]] = {"plain": [], "weighed": []}
    for scene in room_scenes().values():
        arrays, targets = scene_of(scene.observations, room_map()), room_map().positions[list(scene.true_landmarks)]
        plain = np.array(fit_rigid_2d(arrays.places, targets))
        weighed = fit_poses(plain[None], arrays.places[None], targets[None], arrays.covariances[None])[0][0]
        for name, pose in (("plain", plain), ("weighed", weighed)):
            errors[name].append(float(np.hypot(*(pose[:2] - scene.pose[:2]))))
    return {name: np.array(values) for name, values in errors.items()}
