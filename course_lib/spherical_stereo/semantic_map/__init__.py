"""Section 2.5: the map of objects, its files, eq. (1), and the matchers that pair observed objects with landmarks."""

from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap, SemanticMapError

__all__ = ["Landmark", "SemanticMap", "SemanticMapError"]
