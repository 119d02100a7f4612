"""Paper 2: Onozeki, Iriyama, Ogasa, Pathak, Umeda, "Localization in a 2D semantic map using object recognition from a
spherical stereo camera". An image pair walks through figure 2 in this order; a folder imports only those above it:

    panorama       2.1, 2.4: the sphere behind an image, the rig, and `View`, the record of one image
    detection/     2.2: a network and its files, the seam (figure 3), suppression, colour
    matching/      2.3: features, the epipolar constraint, objects in both views; is a camera turned?
    ranging/       2.4: a distance from two directions, and one from the matched features
    semantic_map/  2.5: the map and its files, eq. (1) and the greedy search
    pose/          2.6: the least-squares fit, whether its residuals contradict it, and the answer
    localizer      the steps themselves

outcomes holds every word with which a step says that it found nothing, and drawn_boxes reads boxes drawn by hand.
Images are BGR uint8 arrays, as OpenCV reads them. Boxes and points on them are in edge coordinates (`panorama`).
"""

# ruff: noqa: F401 - the public names
from course_lib.spherical_stereo.detection.colour import mean_hue_saturation
from course_lib.spherical_stereo.detection.detected_object import Detection
from course_lib.spherical_stereo.detection.detector import Detector, YoloDetector
from course_lib.spherical_stereo.detection.seam import extend_seam
from course_lib.spherical_stereo.drawn_boxes import read_stereo_boxes
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.matching.alignment import SwappedImagesError
from course_lib.spherical_stereo.matching.object_matching import ObjectMatch, match_objects
from course_lib.spherical_stereo.panorama import StereoRig, direction_to_pixel, open_view, pixel_to_direction
from course_lib.spherical_stereo.pose.localization import Localization
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, RigidFitError, fit_covariance, fit_rigid_2d
from course_lib.spherical_stereo.ranging.object_positions import Noise, disparity_distance
from course_lib.spherical_stereo.ranging.triangulation import TriangulationError, triangulate, triangulation_covariance
from course_lib.spherical_stereo.semantic_map.association import (
    Observation,
    PenaltyWeights,
    associate_greedy,
    penalty,
    penalty_table,
)
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap
