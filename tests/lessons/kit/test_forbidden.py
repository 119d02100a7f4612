"""A submission may not use the module that it is to write: found wherever its functions import or name it."""

import types

import pytest

from courseware.lessons.kit.forbidden import forbidden_module

OWN = """
import course_lib.spherical_stereo as stereo
from course_lib import geometry
from course_lib.spherical_stereo.pose.rigid_fit import fit_rigid_2d as renamed

def by_name(points):
    return renamed(points, points)

def by_a_helper(points):
    return [by_name(one) for one in points]

def by_attribute(points):
    return stereo.fit_rigid_2d(points, points)

def inside(points):
    def later():
        from course_lib.spherical_stereo.pose import rigid_fit
        return rigid_fit
    return later().fit_rigid_2d(points, points)

class Matcher:
    def match(self, points):
        return by_name(points)

def by_a_class(points):
    return Matcher().match(points)

def allowed(angle):
    return geometry.wrap_angle(angle)
"""
SUBMISSION = types.ModuleType("handed_in")
exec(compile(OWN, "P3.py", "exec"), vars(SUBMISSION))
POSE = "course_lib.spherical_stereo.pose"


@pytest.mark.parametrize("name", ["by_name", "by_a_helper", "by_attribute", "inside", "by_a_class"])
def test_the_library_is_found_where_it_is_used_and_only_there(name):
    assert forbidden_module(getattr(SUBMISSION, name), ("course_lib.beyond", POSE)) == POSE
    assert forbidden_module(SUBMISSION.allowed, ("course_lib.spherical_stereo", "course_lib.geo")) is None
