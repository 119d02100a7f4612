"""Arguments on their way into the sandbox: what can be called stays here, and tells no more than it is asked."""

import io
import pickle

import numpy as np
import pytest

from course_lib.classroom.answers import decode, encode
from course_lib.classroom.packed_arguments import packed, server
from course_lib.classroom.sandbox_process import record
from course_lib.lessons.kit.exercises import find_exercise
from course_lib.lessons.project_1.recordings import CountedRenderer
from course_lib.lessons.project_2.project import Rig


class Unpacked(pickle.Unpickler):
    """What arrives, with the numbers of what stayed."""

    def persistent_load(self, kept):
        return kept


def call(number, name="", *given, **named):
    return {
        "call": number,
        "name": name,
        "given": encode(given),
        "named": {key: encode(value) for key, value in named.items()},
    }


def test_a_function_stays_with_its_secret_and_is_called_over_the_line():
    arguments = find_exercise("00.3").draw(np.random.default_rng(0))
    content, kept = packed(arguments)
    assert b"exercises" not in content
    assert b"Score" not in content
    arrived = Unpacked(io.BytesIO(content)).load()
    assert len(arrived) == len(arguments)
    number = next(one[0] for one in arrived[0] if isinstance(one, tuple))
    pose = np.array([1.0, 2.0, 0.3])
    assert decode(server(kept)(call(number, "", pose))["value"]) == pytest.approx(kept[number](pose))


@pytest.mark.parametrize("name", ["truth", "measured", "__class__", "__init__"])
def test_a_function_is_called_and_never_looked_into(name):
    content, kept = packed(find_exercise("00.3").draw(np.random.default_rng(0))[:1])
    (arrived,) = Unpacked(io.BytesIO(content)).load()
    number = next(one[0] for one in arrived if isinstance(one, tuple))
    reply = server(kept)(call(number, name, np.zeros(3)))
    assert "error" in reply or isinstance(decode(reply["value"]), float)  # called all the same: a score, no secret


def test_an_object_of_a_lesson_tells_its_public_names_alone():
    renderer = CountedRenderer(budget=7)
    content, kept = packed([(renderer, 3)])
    ((arrived, three),) = Unpacked(io.BytesIO(content)).load()
    assert arrived == (0, ("render",), ("budget", "renders"))
    assert three == 3
    serve = server(kept)
    assert decode(serve(call(0, "budget"))["value"]) == 7
    for name in ("__class__", "__dict__", "_secret", "nothing"):
        assert "error" in serve(call(0, name))
    assert serve(call(1))["error"][1] == "nothing that can be called"
    assert serve(call(-2))["error"][1] == "nothing that can be called"
    assert "error" in serve({"call": 0})


def test_a_record_of_a_project_arrives_without_its_module():
    content, _ = packed([(Rig(0.6, 640, 320),)])
    assert b"project_2" not in content
    ((rig,),) = Unpacked(io.BytesIO(content)).load()
    assert (rig.baseline, rig.width, rig.height) == (0.6, 640, 320)
    assert record("Rig", ("a",), (1,)).a == 1
