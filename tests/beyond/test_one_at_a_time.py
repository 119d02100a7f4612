"""Two threads in one localizer would mix their images: the second call is refused by name, the first goes on."""

import copy
import pickle
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from course_lib.beyond import AnnealedLocalizer, GlobalSearch, GuardedLocalizer, GuardedRig, RecoveringLocalizer
from course_lib.depth_mcl import MonteCarloLocalizer
from course_lib.depth_mcl.one_at_a_time import one_at_a_time
from course_lib.spherical_stereo import SemanticLocalizer, StereoRig
from tests.spherical_stereo.stereo_scene import BASELINE, KnowingDetector, mapped_scene

START = np.array([-1.0, 0.3, -0.3, 0.0, 0.0, -0.4])
SIGMA = [0.05, 0.05, 0, 0, 0, 0.03]
DOWN = np.array([0.0, 1.0, 0.0])


class SlowImage:
    """An image that a thread reads until it is let go."""

    def __init__(self, values):
        self.values, self.is_read, self.let_go = values, threading.Event(), threading.Event()

    def __array__(self, dtype=None, copy=None):
        self.is_read.set()
        assert self.let_go.wait(60)
        return np.asarray(self.values, dtype)


def started(localizer):
    localizer.initialize(START)
    return localizer.step


# Each gives the call that takes an image, of a localizer that is ready.
CALLS = {
    "MonteCarloLocalizer": lambda renderer: started(MonteCarloLocalizer(renderer, 20, SIGMA)),
    "AnnealedLocalizer": lambda renderer: started(AnnealedLocalizer(renderer, 20)),
    "GuardedLocalizer": lambda renderer: started(GuardedLocalizer(MonteCarloLocalizer(renderer, 20, SIGMA))),
    "RecoveringLocalizer": lambda renderer: started(RecoveringLocalizer(renderer, 20, max_places=50)),
    "GlobalSearch": lambda renderer: lambda z: GlobalSearch.step(search_of(renderer), z, DOWN),
    "GuardedRig": lambda _: lambda z: GuardedRig.localize(RIG, z, np.zeros((32, 64, 3), np.uint8)),
}
RIG = GuardedRig(SemanticLocalizer(StereoRig(BASELINE), mapped_scene()[2], KnowingDetector()))
SEARCH = []


def search_of(renderer):
    if not SEARCH:
        SEARCH.append(GlobalSearch(renderer, max_places=50))
    return SEARCH[0]


@pytest.mark.parametrize("name", CALLS)
def test_a_second_call_at_once_is_refused_by_name(renderer, name):
    step, slow = CALLS[name](renderer), SlowImage(renderer.render(START)[0])
    with ThreadPoolExecutor(1) as pool:
        first = pool.submit(step, slow)
        assert slow.is_read.wait(60)
        with pytest.raises(RuntimeError, match=rf"two threads called \w+ of one {name} .* one lock around"):
            step(slow.values)
        slow.let_go.set()
        error = first.exception()
    assert error is None or name == "GuardedRig"  # whose image is none


def test_the_first_call_gives_what_it_gives_alone_and_copies_are_free(renderer):
    localizer = MonteCarloLocalizer(renderer, 20, SIGMA)
    localizer.initialize(START)
    image = renderer.render(START)[0]
    copies = copy.deepcopy(localizer), pickle.loads(pickle.dumps(localizer))
    slow = SlowImage(image)
    with ThreadPoolExecutor(1) as pool:
        first = pool.submit(localizer.step, slow)
        assert slow.is_read.wait(60)
        others = [one.step(image) for one in copies]
        with pytest.raises(RuntimeError, match="initialize of one"):
            localizer.initialize(START)
        slow.let_go.set()
    assert all(np.array_equal(one.state, first.result().state) for one in others)
    localizer.step(image)  # free again


def test_a_method_may_call_another_of_its_object_and_an_error_sets_it_free():
    class Thing:
        @one_at_a_time
        def outer(self):
            return self.inner()

        @one_at_a_time
        def inner(self):
            raise KeyError("inner")

    thing = Thing()
    for _ in range(2):
        with pytest.raises(KeyError), ThreadPoolExecutor(1) as pool:
            pool.submit(thing.outer).result()
