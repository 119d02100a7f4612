"""Paper 1: Hatakeyama, Kanai, Date, "3D Monte Carlo localization with a depth camera". A module for each step.

    camera, scene_map    what is given: the depth camera and the mesh map
    rendering/           3.3.1, eq. (6): a depth image of the map for every particle
    sensor               3.3.2, eq. (7): the camera's own points, made comparable
    likelihood           3.3.3 and 3.3.4, eqs (8) to (11): A-2
    compiled_likelihood  eq. (8) once more, in a compiled loop
    weighting            both as a part of the filter that can be exchanged
    motion               3.2, eq. (5): A-1, as printed and in the body's axes
    particle_filter      3.1 and 3.4, eqs (3), (4), (12): start, A-3
    localizer            figure 1: all of it in order
    evaluation           section 4: table 1
    fallon               the method that table 1 compares with
    sequence             recordings on disk; poses, sequence_files: their files, each read and checked
  beyond the paper
    uncertainty          how far off the estimate may be, which the paper's weights cannot say
    tracking             whether the filter still holds the track
    frame_check, watched whether a frame is one to be used, and what becomes of each
    annealed/            section 5: six degrees of freedom
    lost_and_found/      from an unknown start, and after the camera was carried away

State vectors and particle sets, eqs (1) and (2), are in `course_lib.geometry`.
"""

from course_lib.beyond.six_dof.localizer import AnnealedEstimate, AnnealedLocalizer
from course_lib.rendering.camera import DepthCamera
from course_lib.depth_mcl.evaluation import nearest_path_error, timed_error
from course_lib.depth_mcl.likelihood import DepthImageError, likelihood, normalize_likelihood, weights
from course_lib.depth_mcl.localizer import Estimate, MonteCarloLocalizer, NoMeasurementWarning
from course_lib.beyond.lost_and_found.global_search import GlobalSearch, Places
from course_lib.beyond.lost_and_found.recovery import RecoveringLocalizer
from course_lib.depth_mcl.motion import BODY_AXES, TANGENT_SPACE, WORLD_AXES, Motion, propagate
from course_lib.depth_mcl.particle_filter import (
    effective_sample_size,
    initial_particles,
    resample,
    weighted_mean_state,
)
from course_lib.depth_mcl.poses import SequenceError
from course_lib.rendering.renderer import DepthRenderer, OpenGLError, RendererClosedError
from course_lib.rendering.scene_map import SceneMap, SceneMapError
from course_lib.depth_mcl.sensor import depth_image_from_points
from course_lib.depth_mcl.sequence import read_sequence
from course_lib.beyond.guarded_depth import Watched, WatchedLocalizer

__all__ = [
    "BODY_AXES",
    "TANGENT_SPACE",
    "WORLD_AXES",
    "AnnealedEstimate",
    "AnnealedLocalizer",
    "DepthCamera",
    "DepthImageError",
    "DepthRenderer",
    "Estimate",
    "GlobalSearch",
    "MonteCarloLocalizer",
    "Motion",
    "NoMeasurementWarning",
    "OpenGLError",
    "Places",
    "RecoveringLocalizer",
    "RendererClosedError",
    "SceneMap",
    "SceneMapError",
    "SequenceError",
    "Watched",
    "WatchedLocalizer",
    "depth_image_from_points",
    "effective_sample_size",
    "initial_particles",
    "likelihood",
    "nearest_path_error",
    "normalize_likelihood",
    "propagate",
    "read_sequence",
    "resample",
    "timed_error",
    "weighted_mean_state",
    "weights",
]
