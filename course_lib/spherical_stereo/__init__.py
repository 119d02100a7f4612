"""Paper 2: Onozeki, Iriyama, Ogasa, Pathak, Umeda, "Localization in a 2D semantic map using object recognition from a
spherical stereo camera".

An image pair walks through figure 2 in this order. Each folder imports only those above it:

  panorama        2.1, 2.4. The sphere behind an image, the rig, and `View`, the record of one image.
  detection/      2.2. `find_objects` gives a view its detections.
    detected_object                 class, box and colour of one object; boxes on the circle of columns
    darknet, onnx_network           one network and its files
    detector, suppression, seam     figure 3: every object whole once, and counted once
    colour                          hue and saturation inside a box
    boxes_file                      boxes drawn by hand, in place of a network
  matching/       2.3. `match_views` says which object of one view is which of the other.
    epipolar, features, object_matching
    alignment                       is the lower camera turned against the upper one?
  ranging/        2.4. `position_objects` says where the matched objects are.
    triangulation, vertical_disparity   a distance from two directions, and one from the matched features
    object_positions                the position of every matched object
  semantic_map/   2.5. The map and its files, eq. (1) and the greedy search: observations to landmarks
  pose/           2.6. The least-squares fit, whether its residuals contradict it, and the answer
  localizer       the steps themselves

Beside it: recording, a folder of stereo panoramas with the truth beside them.

Images are BGR uint8 arrays, as OpenCV reads them. Boxes and points on them are in edge coordinates (`panorama`).
"""

# ruff: noqa: F401 - the public names
from course_lib.spherical_stereo.detection.darknet import DetectorError
from course_lib.spherical_stereo.detection.detected_object import Detection, DetectionError
from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.detection.seam import extend_seam
from course_lib.spherical_stereo.localizer import LocalizerError, SemanticLocalizer
from course_lib.spherical_stereo.matching.features import SwappedImagesError
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
