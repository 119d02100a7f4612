"""One renderer in several threads, after a fork, and pickled: right images or a named error, never a hang."""

import gc
import multiprocessing
import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from course_lib.rendering.errors import OpenGLError, RendererClosedError
from course_lib.rendering.renderer import DepthRenderer
from tests.rendering.shapes import SMALL, random_states, room, room_depth

PATIENCE_WITH_A_CHILD, PATIENCE = 30.0, 240.0  # seconds that a forked child or a new process takes on no machine
CAMERA = SMALL.resized(32, 24)

needs_fork = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system cannot fork")


@pytest.fixture(params=["raster", "vtk", "ray"])
def renderer(request):
    with DepthRenderer(room(), CAMERA, request.param) as opened:
        yield opened


@pytest.fixture
def z_buffer():
    with DepthRenderer(room(), CAMERA, "vtk") as opened:
        opened.render(np.zeros(6))
        yield opened


def is_right(images, states):
    """Whether these are the images of these states, by the closed form; images of other states differ by metres."""
    return bool(np.mean(np.abs(images - room_depth(CAMERA, states)) < 1e-3) > 0.98)


def in_a_fork(work):
    """What `work()` returns in a forked child, or its error's name and message, or HANGS (it is killed then)."""
    receiver, sender = multiprocessing.Pipe(duplex=False)

    def answer():
        try:
            sender.send(str(work()))
        except BaseException as error:
            sender.send(f"{type(error).__name__}: {error}")

    child = multiprocessing.get_context("fork").Process(target=answer)
    child.start()
    try:
        return receiver.recv() if receiver.poll(PATIENCE_WITH_A_CHILD) else "HANGS"
    finally:
        child.kill()
        child.join()


def test_threads_that_share_a_renderer_each_get_their_own_images_and_measurement(renderer):
    points = CAMERA.points(np.ones(CAMERA.shape))

    def work(seed):
        rng = np.random.default_rng(seed)
        rounds = [random_states(int(rng.integers(1, 9)), rng, spread=2.5) for _ in range(10)]
        return [
            is_right(renderer.render(states), states) and np.abs(renderer.render_points(points) - 1.0).max() < 1e-3
            for states in rounds
        ]

    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(work, range(4), timeout=PATIENCE)) == [[True] * 10] * 4
        pool.submit(renderer.close).result(PATIENCE)
    with pytest.raises(RendererClosedError):
        renderer.render(np.zeros(6))


@needs_fork
@pytest.mark.parametrize(
    "use",
    [
        lambda renderer: renderer.render(np.zeros(6)),
        lambda renderer: renderer.render_points(np.ones((1, 3))),
        lambda renderer: DepthRenderer(room(), CAMERA, "vtk"),
    ],
    ids=["render", "render_points", "a new one"],
)
def test_in_a_forked_child_opengl_is_refused_by_name(z_buffer, use):
    with z_buffer._open_backend._turn:  # another thread draws: the child's copy of the lock stays held
        answer = in_a_fork(lambda: use(z_buffer))
    assert answer.startswith("OpenGLError")
    assert "spawn" in answer
    assert 'backend="raster"' in answer
    assert is_right(z_buffer.render(np.zeros((1, 6))), np.zeros((1, 6)))


@needs_fork
def test_a_forked_child_may_close_and_drop_what_it_inherited(z_buffer):
    assert in_a_fork(z_buffer.close) == "None"
    others = [DepthRenderer(room(), CAMERA, "vtk")]

    def drop():
        others.clear()
        return gc.collect() >= 0

    assert in_a_fork(drop) == "True"
    assert is_right(others[0].render(np.zeros((1, 6))), np.zeros((1, 6)))


@needs_fork
@pytest.mark.parametrize("backend", ["raster", "ray"])
def test_without_opengl_a_forked_child_may_use_what_it_inherits(backend, rng):
    states = random_states(30, rng, spread=2.5)
    with DepthRenderer(room(), CAMERA, backend) as inherited:
        assert is_right(inherited.render(states), states)  # its threads have run
        assert in_a_fork(lambda: is_right(inherited.render(states), states)) == "True"
    assert in_a_fork(lambda: is_right(DepthRenderer(room(), CAMERA, backend).render(states), states)) == "True"


@pytest.mark.parametrize("method", ["spawn", pytest.param("fork", marks=needs_fork)])
def test_a_worker_opens_the_renderer_again_or_names_why_not(renderer, method, rng):
    """A pool whose worker fails to unpickle its task waits for ever, so the error must come when it draws."""
    states = random_states(3, rng, spread=2.5)
    with multiprocessing.get_context(method).Pool(1) as pool:
        answer = pool.apply_async(renderer.render, (states,))
        if (renderer.backend, method) == ("vtk", "fork"):
            with pytest.raises(OpenGLError, match="spawn"):
                answer.get(timeout=PATIENCE)
        else:
            assert is_right(answer.get(timeout=PATIENCE), states)
