"""Paper 2: Onozeki, Iriyama, Ogasa, Pathak, Umeda, "Localization in a 2D semantic map using object recognition from a
spherical stereo camera". A module for each step.

The steps of figure 2, in order:

  2.1 what is given: two panoramas, one camera above the other
    sphere               pixels, directions, angles; images that are no panoramas; the rig
    stereo_recording     a folder of stereo panoramas with the truth beside them
  2.2 objects in each panorama
    detection            the detector: network, seam, and each object's hue and saturation
    detected_object      what it says about one object
    darknet              .cfg, .weights and .names, checked before OpenCV reads them
    darknet_cfg          the text of a cfg
    darknet_network      a Darknet network, run by OpenCV
    onnx_network         an ONNX network, run by OpenCV
    letterbox            an image into the network's input, boxes back again
    suppression          of boxes that show one object, the best one
    seam                 figure 3: every object whole once, and counted once
    boxes                boxes on the circle of columns: wrapping and overlap
    boxes_file           boxes drawn by hand, in place of a network
    labels               one name for one kind of object
    colour               hue and saturation inside a box
  2.3 the same object in both images
    stereo_matching      objects to objects, by their matched features
    features             AKAZE on a panorama
    epipolar             which features may be one point
    feature_matching     whole images: do they belong together, were they swapped
  2.4 from two directions to a place
    triangulation        X = d x_hat, how sure it is, and when there is none
    vertical_disparity   a second distance, from the matched features
    object_distances     both distances side by side
    object_places        the place of every matched object
  2.5 observed objects to landmarks of the map
    semantic_map         the map: class, place, hue and saturation of every object
    semantic_map_files   maps as JSON and CSV
    association          eq. (1), and the greedy search
  2.6 from pairs to a pose
    rigid_fit            the least-squares fit
  all of it
    localizer            figure 2 from images, or from detections, to a pose
    localizer_input      what it may be asked
    localization         what it answers
  3 how good it is
    experiment           the room experiment
    evaluation           tables 2 to 5: correct, incorrect, unable, and errors
    turned_rig           the same place with the images rolled: does the pose stay?
    paper_tables         the paper's own numbers
    detection_scores     precision and recall of a detector, and its threshold
    detector_evaluation  a finished detector on panoramas whose objects are known

Images are BGR uint8 arrays, as OpenCV reads them. Boxes and points on them are in edge coordinates (`sphere`).
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
