"""Paper 1: Hatakeyama, Kanai, Date, "3D Monte Carlo localization with a depth camera". A module for each step.

    sequence         recordings on disk; sequence_files reads and checks each of their files
    likelihood       3.3.3 and 3.3.4, eqs (8) to (11): A-2, as one part of the filter that can be exchanged
    motion           3.2, eq. (5): A-1, as printed and in the body's axes
    particle_filter  3.1 and 3.4, eqs (3), (4), (12): start, A-3
    localizer        figure 1: all of it in order
    uncertainty      how far off the estimate may be, which the paper's weights cannot say
    status           the four words for how far a pose can be believed, and who says them
    one_at_a_time    two calls at once are refused
    fallon           the method that table 1 compares with
    evaluation       section 4: table 1

The camera, the map, eq. (6), a depth image of the map for every particle, and eq. (7), the camera's own points made
comparable, are in `course_lib.rendering`.
State vectors and particle sets, eqs (1) and (2), are in `course_lib.geometry`. What the paper leaves open is in
`course_lib.beyond`.
"""

# ruff: noqa: F401 - the public names
from course_lib.depth_mcl.evaluation import nearest_path_error, timed_error
from course_lib.depth_mcl.likelihood import DepthImageError, likelihood, normalize_likelihood, weights
from course_lib.depth_mcl.localizer import Estimate, MonteCarloLocalizer, NoMeasurementWarning, SlowFilterWarning
from course_lib.depth_mcl.motion import BODY_AXES, TANGENT_SPACE, WORLD_AXES, Motion, propagate
from course_lib.depth_mcl.particle_filter import effective_sample_size, initial_particles, resample, weighted_mean_state
from course_lib.depth_mcl.sequence import read_sequence
from course_lib.depth_mcl.sequence_files import SequenceError
from course_lib.rendering import DepthCamera, DepthRenderer, SceneMap, depth_image_from_points, subsample_depth
from course_lib.rendering.errors import OpenGLError, RendererClosedError, SceneMapError
