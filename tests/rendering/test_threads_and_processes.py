"""One renderer in several threads, after a fork, and pickled: right images or a named error, never a hang.

Whoever could hang is waited for with a limit and killed, so that a hang is a failure of one test. The limit is no
measure of speed: it only has to be longer than a slow, busy machine takes, for a forked child (which has all it needs
in memory) and for a new process.
"""

import copy
import gc
import multiprocessing
import os
import pickle
import select
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest

from course_lib.rendering.renderer import DepthRenderer, OpenGLError, RendererClosedError
from tests.rendering.shapes import SMALL, random_states, room, room_depth

PATIENCE_WITH_A_CHILD = 30.0
PATIENCE = 240.0
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


def run_together(works):
    """Runs each function in a thread of its own, all at once, and returns what they returned, or their errors."""
    results = [None] * len(works)
    start = threading.Barrier(len(works))

    def run(index):
        start.wait()
        try:
            results[index] = works[index]()
        except Exception as error:
            results[index] = error

    threads = [threading.Thread(target=run, args=(index,), daemon=True) for index in range(len(works))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(PATIENCE)
    assert not any(thread.is_alive() for thread in threads), "a thread hangs"
    return results


def in_a_fork(work):
    """What `work()` returns in a forked child, or its error's name and message, or HANGS (it is killed then)."""
    read_end, write_end = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            answer = str(work())
        except BaseException as error:
            answer = f"{type(error).__name__}: {error}"
        os.write(write_end, answer.encode())
        os._exit(0)
    os.close(write_end)
    try:
        answered = select.select([read_end], [], [], PATIENCE_WITH_A_CHILD)[0]
        return os.read(read_end, 10_000).decode() if answered else "HANGS"
    finally:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        os.close(read_end)


def test_threads_that_share_a_renderer_each_get_their_own_images(renderer):
    def work(seed):
        rng = np.random.default_rng(seed)
        rounds = [random_states(int(rng.integers(1, 9)), rng, spread=2.5) for _ in range(10)]
        return [is_right(renderer.render(states), states) for states in rounds]

    results = run_together([lambda seed=seed: work(seed) for seed in range(4)])
    assert results == [[True] * 10] * 4


def test_a_measurement_drawn_in_one_thread_and_views_in_another_do_not_meet(renderer):
    points = CAMERA.points(np.ones(CAMERA.shape))
    states = random_states(6, np.random.default_rng(1), spread=2.5)
    measured, views = run_together(
        [
            lambda: [bool(np.abs(renderer.render_points(points) - 1.0).max() < 1e-3) for _ in range(10)],
            lambda: [is_right(renderer.render(states), states) for _ in range(10)],
        ]
    )
    assert measured == views == [True] * 10


def test_threads_take_turns_with_two_windows():
    with DepthRenderer(room(), CAMERA) as first, DepthRenderer(room(), CAMERA) as second:

        def work(seed):
            rng = np.random.default_rng(seed)
            rounds = [random_states(3, rng, spread=2.5) for _ in range(8)]
            return [
                is_right(window.render(states), states)
                for index, states in enumerate(rounds)
                for window in ((first, second) if (seed + index) % 2 else (second, first))
            ]

        assert run_together([lambda seed=seed: work(seed) for seed in range(3)]) == [[True] * 16] * 3


def test_a_renderer_made_in_one_thread_works_in_another_and_is_closed_in_a_third(renderer, rng):
    states = random_states(3, rng, spread=2.5)
    (second,) = run_together([lambda: is_right(renderer.render(states), states)])
    assert second
    assert is_right(renderer.render(states[::-1]), states[::-1])
    assert run_together([renderer.close]) == [None]
    with pytest.raises(RendererClosedError):
        renderer.render(states)


def test_closing_while_another_thread_draws_is_named(renderer, rng):
    states = random_states(4, rng, spread=2.5)

    def draw_until_closed():
        while True:
            assert is_right(renderer.render(states), states)

    drawing, closing = run_together([draw_until_closed, renderer.close])
    assert isinstance(drawing, RendererClosedError)
    assert closing is None


@needs_fork
@pytest.mark.parametrize(
    "use",
    [
        lambda renderer: renderer.render(np.zeros(6)),
        lambda renderer: renderer.render_points(np.ones((1, 3))),
        lambda renderer: renderer.describe(),
        lambda renderer: DepthRenderer(room(), CAMERA, "vtk"),
    ],
    ids=["render", "render_points", "describe", "a new one"],
)
def test_in_a_forked_child_the_z_buffer_is_refused_by_name(z_buffer, use):
    answer = in_a_fork(lambda: use(z_buffer))
    assert answer.startswith("OpenGLError")
    assert "spawn" in answer
    assert 'backend="raster"' in answer
    assert is_right(z_buffer.render(np.zeros((1, 6))), np.zeros((1, 6)))


@needs_fork
def test_a_fork_while_another_thread_draws_finds_no_closed_door(z_buffer):
    """The lock is copied as it is: held, by a thread that the child does not have."""
    with z_buffer._open_backend._turn:
        assert in_a_fork(lambda: z_buffer.render(np.zeros(6))).startswith("OpenGLError")
        assert in_a_fork(z_buffer.close) == "None"


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


IN_A_FRESH_PROCESS = """
import os, sys
import numpy as np
from course_lib.depth_mcl import DepthCamera, DepthRenderer, SceneMap
scene = SceneMap(np.array([[2., -9, -9], [2, 9, -9], [2, 0, 9]]), np.array([[0, 1, 2]]))
def depth():
    renderer = DepthRenderer(scene, DepthCamera.from_fov(8, 6, 40, 30))
    return renderer, round(float(np.median(renderer.render(np.zeros(6)))), 3)
if sys.argv[1] == "exit": kept, two = depth()
if os.fork() == 0:
    if sys.argv[1] == "fork first": kept, two = depth(); print("child", two)
    sys.exit(0)
os.wait()
if sys.argv[1] == "fork first": kept, two = depth()
print("parent", two)
"""


@needs_fork
@pytest.mark.parametrize(("case", "said"), [("fork first", "child 2.0\nparent 2.0\n"), ("exit", "parent 2.0\n")])
def test_a_child_draws_if_forked_before_the_first_window_and_always_ends(case, said):
    """In a process of its own that has opened no window; its child ends as programs end, freeing what it holds."""
    command = [sys.executable, "-c", IN_A_FRESH_PROCESS, case]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, start_new_session=True) as process:
        try:
            assert process.communicate(timeout=PATIENCE)[0] == said
        except subprocess.TimeoutExpired:
            pytest.fail("a forked child hangs")
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
    assert process.returncode == 0


def in_a_pool(method, function, *arguments):
    """`function(*arguments)` in a worker of a new pool; a worker that hangs is killed, and `TimeoutError` raised."""
    with multiprocessing.get_context(method).Pool(1) as pool:
        return pool.apply_async(function, arguments).get(timeout=PATIENCE)


def test_a_spawned_worker_opens_the_renderer_again(renderer, rng):
    states = random_states(3, rng, spread=2.5)
    assert is_right(in_a_pool("spawn", renderer.render, states), states)


@needs_fork
def test_a_forked_worker_answers_with_the_error_or_the_images(renderer):
    """A pool whose worker fails to unpickle its task waits for ever, so the error must come when it draws."""
    states = np.zeros((1, 6))
    if renderer.backend == "vtk":
        with pytest.raises(OpenGLError, match="spawn"):
            in_a_pool("fork", renderer.render, states)
    else:
        assert is_right(in_a_pool("fork", renderer.render, states), states)


@pytest.mark.parametrize("travel", [copy.copy, copy.deepcopy, lambda renderer: pickle.loads(pickle.dumps(renderer))])
def test_a_copy_has_a_window_of_its_own_and_what_it_is_made_of(renderer, travel):
    states = np.zeros((1, 6))
    with travel(renderer) as other:
        assert is_right(other.render(states), states)
        assert (other.backend, other.camera, other.batch_size) == (renderer.backend, CAMERA, renderer.batch_size)
    assert is_right(renderer.render(states), states)
    with pytest.raises(RendererClosedError):
        other.render(states)
    with pytest.raises(RendererClosedError):
        travel(other).render(states)
