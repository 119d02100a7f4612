"""The matchers by name; all are called as `associate_greedy` is, and any can stand for another."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

from course_lib.beyond.look_alikes.assignment import associate_hungarian
from course_lib.beyond.look_alikes.consistent import associate_consistent
from course_lib.spherical_stereo.semantic_map.association import Association, associate_greedy

Matcher = Literal["greedy", "hungarian", "consistent"]
ASSOCIATIONS: dict[Matcher, Callable[..., Association]] = {
    "greedy": associate_greedy,
    "hungarian": associate_hungarian,
    "consistent": associate_consistent,
}
