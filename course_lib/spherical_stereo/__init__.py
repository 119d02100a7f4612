"""Paper 2: Onozeki, Iriyama, Ogasa, Pathak, Umeda, "Localization in a 2D semantic map using object recognition from a
spherical stereo camera". A module for each step.

The walk of an image, figure 2 in order; each folder imports only those above it:

  panorama             2.1, 2.4. The door. Two images come in and are looked at once: panoramas, in colour, of one size?
                       From here on each is a `View`, a record of the image and of what is found in it.
  detection/           2.2. `find_objects` gives the view its detections.
    detector, detected_object, labels
    darknet, darknet_cfg, darknet_network, onnx_network, letterbox, suppression: one network and its files
    seam               figure 3: every object whole once, and counted once
    colour             hue and saturation inside a box
    boxes, boxes_file  boxes on the circle of columns; boxes drawn by hand, in place of a network
  matching/            2.3. `find_features` gives the view its features, and `match_views` leaves two views with pairs.
    features, epipolar, feature_matching, object_matching
    alignment          was the lower camera turned against the upper one? Asked at the door of this folder
  ranging/             2.4. `place_objects` takes pairs of boxes; from here on there are places, and no image.
    triangulation      X = d x_hat, how sure it is, and when there is none
    vertical_disparity a second distance, from the matched features
    object_places      the place of every matched object
  semantic_map/        2.5. The map, its files, eq. (1) and the greedy search: observations to landmarks
    assignment         for comparison: the assignment of least cost on class and colour alone
  pose/                2.6. The least-squares fit, whether its residuals contradict it, and what is answered
  localizer            the walk itself

Beside it: recording, a folder of stereo panoramas with the truth beside them.

Images are BGR uint8 arrays, as OpenCV reads them. Boxes and points on them are in edge coordinates (`panorama`).
"""

from course_lib.spherical_stereo.detection.boxes import DetectionError
from course_lib.spherical_stereo.detection.detected_object import Detection
from course_lib.spherical_stereo.detection.detector import DetectorError, YoloDetector
from course_lib.spherical_stereo.detection.seam import extend_seam
from course_lib.spherical_stereo.localizer import LocalizerError, SemanticLocalizer
from course_lib.spherical_stereo.matching.feature_matching import SwappedImagesError
from course_lib.spherical_stereo.matching.object_matching import ObjectMatch, match_objects
from course_lib.spherical_stereo.panorama import (
    PanoramaError,
    StereoRig,
    View,
    direction_to_pixel,
    open_pair,
    open_view,
    pixel_to_direction,
    read_panorama,
)
from course_lib.spherical_stereo.pose.localization import Localization
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, RigidFitError, fit_covariance, fit_rigid_2d
from course_lib.spherical_stereo.ranging.triangulation import (
    TriangulationError,
    triangulate,
    triangulation_covariance,
    triangulation_outcome,
)
from course_lib.spherical_stereo.ranging.vertical_disparity import disparity_distance
from course_lib.spherical_stereo.semantic_map.association import (
    Association,
    AssociationError,
    Observation,
    Penalty,
    PenaltyWeights,
    associate_greedy,
    penalty,
    penalty_table,
)
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap, SemanticMapError

__all__ = [
    "Association",
    "AssociationError",
    "Detection",
    "DetectionError",
    "DetectorError",
    "Landmark",
    "Localization",
    "LocalizerError",
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
    "TriangulationError",
    "View",
    "YoloDetector",
    "associate_greedy",
    "direction_to_pixel",
    "disparity_distance",
    "extend_seam",
    "fit_covariance",
    "fit_rigid_2d",
    "match_objects",
    "open_pair",
    "open_view",
    "penalty",
    "penalty_table",
    "pixel_to_direction",
    "read_panorama",
    "triangulate",
    "triangulation_covariance",
    "triangulation_outcome",
]
