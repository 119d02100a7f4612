"""Paper 2: Onozeki, Iriyama, Ogasa, Pathak, Umeda, "Localization in a 2D semantic map using object recognition from a
spherical stereo camera". A module for each step.

    sphere               what is given: equirectangular panoramas of two cameras, one above the other
    detection            2.2: objects in a panorama, the seam, hue and saturation (with darknet, seam, colour, labels)
    stereo_matching      2.3: which object of the upper image is which of the lower one
    triangulation        2.4: from two directions to a place
    semantic_map         the map: class, place, hue and saturation of every object
    association          2.5, eq. (1): observed objects to landmarks of the map
    rigid_fit            2.6: from pairs to a pose
    localizer            figure 2: all of it in order
    evaluation           section 3: tables 1 to 5

Images are BGR uint8 arrays, as OpenCV reads them. Boxes and points on them are in edge coordinates (`sphere`).
"""

from course_lib.spherical_stereo.association import (
    Association,
    AssociationError,
    Observation,
    Penalty,
    PenaltyWeights,
    associate_greedy,
    penalty,
    penalty_table,
)
from course_lib.spherical_stereo.detection import Detection, DetectionError, DetectorError, YoloDetector
from course_lib.spherical_stereo.feature_matching import SwappedImagesError
from course_lib.spherical_stereo.localization import Localization
from course_lib.spherical_stereo.localizer import LocalizerError, SemanticLocalizer
from course_lib.spherical_stereo.rigid_fit import (
    CoincidentPoints,
    MirroredPoints,
    NotFinite,
    Pose2D,
    RigidFitError,
    TooFewPairs,
    UndeterminedRotation,
    fit_covariance,
    fit_rigid_2d,
)
from course_lib.spherical_stereo.seam import extend_seam
from course_lib.spherical_stereo.semantic_map import Landmark, SemanticMap, SemanticMapError
from course_lib.spherical_stereo.sphere import (
    PanoramaError,
    StereoRig,
    direction_to_pixel,
    pixel_to_direction,
    read_panorama,
)
from course_lib.spherical_stereo.stereo_matching import ObjectMatch, match_objects
from course_lib.spherical_stereo.triangulation import (
    TriangulationError,
    triangulate,
    triangulation_covariance,
    triangulation_outcome,
)
from course_lib.spherical_stereo.vertical_disparity import disparity_distance

__all__ = [
    "Association",
    "AssociationError",
    "CoincidentPoints",
    "Detection",
    "DetectionError",
    "DetectorError",
    "Landmark",
    "Localization",
    "LocalizerError",
    "MirroredPoints",
    "NotFinite",
    "ObjectMatch",
    "Observation",
    "PanoramaError",
    "Penalty",
    "PenaltyWeights",
    "Pose2D",
    "RigidFitError",
    "SemanticLocalizer",
    "SemanticMap",
    "SemanticMapError",
    "StereoRig",
    "SwappedImagesError",
    "TooFewPairs",
    "TriangulationError",
    "UndeterminedRotation",
    "YoloDetector",
    "associate_greedy",
    "direction_to_pixel",
    "disparity_distance",
    "extend_seam",
    "fit_covariance",
    "fit_rigid_2d",
    "match_objects",
    "penalty",
    "penalty_table",
    "pixel_to_direction",
    "read_panorama",
    "triangulate",
    "triangulation_covariance",
    "triangulation_outcome",
]
