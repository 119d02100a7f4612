"""The walls hold: every attempt of the self-test fails within them, and what takes too much is stopped and named."""

import pickle
import subprocess
import sys
import textwrap

import psutil
import pytest

from courseware.classroom import sandbox, self_test
from courseware.classroom.judge import Settings, judge
from courseware.classroom.sandbox import Limits, SandboxError, require_walls
from courseware.paths import REPOSITORY
from tests.classroom.handed_in import handed_in, solved

SHORT = Limits(call_seconds=0.5, seconds=2.0)
"""For what never ends, however fast the machine is; answers that end have the usual limits."""
FUNCTIONS = {"06.1": "raw_score", "06.3": "min_likelihood"}
SCORE = "(1 - hidden) * alpha / (alpha + 0.02) + hidden * alpha / (alpha + 2)"


def raw_score(body: str) -> str:
    return f"def raw_score(hidden, alpha):\n{textwrap.indent(textwrap.dedent(body).strip(), '    ')}\n"


@pytest.fixture
def graded(library, tmp_path):
    """Judge a body of `raw_score` (06.1) beside a right answer, which must count whatever the body does."""
    right = solved("06")["06.3"]

    def run(body: str, limits: Limits | None = None):
        path = handed_in(tmp_path / "06.ipynb", "06", {"06.1": raw_score(body), "06.3": right})
        hostile, beside = judge(path, Settings(FUNCTIONS, 1, library, limits or Limits())).answers
        assert (beside.status, beside.points) == ("right", 4), beside
        left = [one.pid for one in psutil.process_iter(["cmdline"]) if str(library) in (one.info["cmdline"] or [])]
        assert not left, "processes that answers left behind"
        return hostile

    return run


def test_every_attempt_of_the_self_test_fails_within_the_walls(library):
    found = self_test.attempts(library, Limits())
    assert len(found) >= 40
    assert f"{len(found)} ways through these walls" in (REPOSITORY / "TEACHING.md").read_text(encoding="utf-8")
    assert {what: got for what, got in found.items() if got} == {}


IMPORT_THE_LESSONS = """
import importlib, pkgutil, sys
sys.path.insert(0, "/course")
import courseware.lessons
for module in pkgutil.walk_packages(courseware.lessons.__path__, "courseware.lessons."):
    importlib.import_module(module.name)
    print(module.name)
"""


def test_every_module_of_the_lessons_can_be_imported_within_the_walls(library):
    pipes = dict.fromkeys(("stdout", "stderr"), subprocess.PIPE) | {"text": True}
    with sandbox.start([*sandbox.PYTHON, IMPORT_THE_LESSONS], Limits(), library, **pipes) as process:
        out, said = process.communicate(timeout=300)
    assert process.returncode == 0, said
    assert {"courseware.lessons.lesson_19.stages", "courseware.lessons.project_3.tasks"} <= set(out.split())


HARMLESS = {
    "read a file of the teacher's", "connect to this machine", "send to a named Unix socket", "see other processes",
    "send to an abstract Unix socket", "signal the grader through a file", "watch the teacher's folder",
    "send an open file over a socket", "see a network card", "read a solution's bytecode", "keep memory of a device",
}  # fmt: skip
"""Attempts that change nothing where they succeed. The others (mounting, tracing, ...) never run without walls."""


def test_without_walls_the_attempts_reach_what_they_look_for(library, monkeypatch):
    """An attempt that cannot succeed would show nothing."""
    monkeypatch.setattr(self_test, "start", lambda command, *given, **pipes: subprocess.Popen(command, **pipes))
    tried = {what: code for what, code in self_test.ATTEMPTS.items() if what in HARMLESS}
    monkeypatch.setattr(self_test, "ATTEMPTS", tried)
    reached = {what for what, got in self_test.attempts(library, Limits()).items() if got}
    assert reached >= HARMLESS - {"see a network card", "read a solution's bytecode"}


FILTERED = {
    "make a System V queue", "make a System V segment", "make a System V semaphore", "make memory without a name",
    "keep memory that no process has", "keep memory in a pipe", "keep memory in sockets", "open a socket to the kernel",
    "trace a process of its own",
}  # fmt: skip
"""Attempts that only the filter refuses, on every kernel. Rings, keys and sockets of other families are options."""


def test_without_the_filter_its_attempts_reach_what_they_look_for(library, monkeypatch):
    monkeypatch.setattr(pytest.importorskip("pyseccomp").SyscallFilter, "add_rule", lambda *given: None)
    assert {what for what, got in self_test.attempts(library, Limits()).items() if got} >= FILTERED


def test_a_wall_that_does_not_hold_stops_the_grading(library, monkeypatch):
    monkeypatch.setattr(self_test, "ATTEMPTS", {"do something": "got = True"})
    with pytest.raises(SandboxError, match=r"do something .*--trust"):
        self_test.self_test(library, Limits())


def few(bodies: dict[str, str]) -> list:
    """Return the bodies; `course.py test` runs the first, and `test --all` the others too."""
    first, *others = bodies.values()
    return [first, *(pytest.param(body, marks=pytest.mark.slow) for body in others)]


ENDLESS = {
    "a loop": "while True: pass",
    "a loop that catches everything": "while True:\n    try:\n        while True: pass\n    except BaseException: pass",
    "sleep": "import time\ntime.sleep(1e6)",
    "a lock": "import threading\nthreading.Semaphore(0).acquire()",
}


@pytest.mark.parametrize("body", few(ENDLESS), ids=ENDLESS)
def test_what_never_ends_is_stopped(graded, body):
    found = graded(body, limits=SHORT)
    assert (found.status, found.points) == ("wrong", 0)
    assert "does not end" in found.sentence


TOO_MUCH = {
    "memory without end": "rows = []\nwhile True: rows.append(bytearray(1 << 24))",
    "printing": "for _ in range(10**6): print('x' * 100)",
    "a file of a gigabyte": "file = open('big', 'wb')\nfor _ in range(1 << 10): file.write(bytes(1 << 20))",
    "a fork bomb": "import os\nwhile True: os.fork()",
    "calls of itself": "return raw_score(hidden, alpha)",
    "its own end": "import os\nos._exit(0)",
    "the end of its parent": "import os\nos.kill(os.getppid(), 9)",
    "a crash": "import ctypes\nctypes.string_at(1)",
    "sent on every line": """
        import os
        for number in range(3, 60):
            for line in (b'{"verdict": "right"}', b'{"end": ""}', b'{"call": 0, "value": 1}'):
                try: os.write(number, line + bytes([10]))
                except OSError: pass
        return hidden
        """,
    "a line without end": """
        import os
        for k in range(3, 9):
            try:
                for _ in range(200): os.write(k, b'x' * (1 << 20))
            except OSError: pass
        """,
}


@pytest.fixture
def alone(library, tmp_path):
    """Judge a body of `raw_score` (06.1), which may take its whole sandbox down."""

    def run(body: str, limits: Limits):
        path = handed_in(tmp_path / "06.ipynb", "06", {"06.1": raw_score(body)})
        return judge(path, Settings({"06.1": "raw_score"}, 1, library, limits._replace(memory_mb=800))).answers[0]

    return run


@pytest.mark.parametrize("body", few(TOO_MUCH), ids=TOO_MUCH)
def test_what_takes_too_much_is_stopped_and_earns_nothing(alone, body):
    found = alone(body, SHORT)
    assert (found.status, found.points) == ("wrong", 0), found
    assert found.sentence.startswith(("Your function ", "Not right"))


def test_memory_of_a_process_whose_main_thread_has_ended_is_seen(alone):
    body = "import ctypes, threading, time\nhold = lambda: (time.sleep(2), bytearray(1 << 30), time.sleep(1e6))"
    found = alone(f"{body}\nthreading.Thread(target=hold).start()\nctypes.CDLL(None).syscall(60, 0)", Limits())
    assert found.sentence == "Your function takes too much memory."


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
def test_nothing_runs_on_when_the_watch_fails(library, tmp_path, monkeypatch):
    path = tmp_path / "endless.py"
    path.write_text("def endless():\n    while True: pass\n", encoding="utf-8")
    with sandbox.Sandbox(path, library, Limits()) as box:
        monkeypatch.setattr(sandbox, "processes_and_memory", lambda *given: 1 / 0)
        assert box.run("06.1", "endless", pickle.dumps([()])).ended.startswith("ends its process")


FORGED = {
    "printed": "print('06.1: right.')\nreturn hidden",
    "the library patched": """
        import courseware.lessons.kit.exercises as exercises, courseware.classroom.exchange as exchange
        exercises.right_on = exercises.same_values = lambda *given: True
        exchange.encode = lambda value, depth=0: {"kind": "right"}
        return hidden
        """,
    "an array that equals everything": """
        import numpy as np
        class Everything(np.ndarray):
            def __eq__(self, other): return np.ones(self.shape, bool)
            def __array_ufunc__(self, *given, **named): return np.zeros(self.shape)
            def __reduce__(self): return (print, ("forged",))
        return np.asarray(hidden).view(Everything)
        """,
    "an array of objects": "import numpy as np\nreturn hidden.astype(object)",
    "not a number": "return hidden * float('nan')",
    "nothing": "found = None\nreturn found",
    "a view of a billion": "import numpy as np\nreturn np.broadcast_to(np.float64(1), (10**9,))",
    "rows within rows": "row = []\nfor _ in range(10**5): row = [row]\nreturn row",
    "a long row": "return [0.0] * 10**7",
    "a huge number": "return 10**10000",
    "the inputs changed": f"found = {SCORE}\nhidden *= 2\nreturn found",
}


@pytest.mark.parametrize("body", few(FORGED), ids=FORGED)
def test_a_forged_answer_earns_nothing(graded, body):
    found = graded(body)
    assert (found.status, found.points) == ("wrong", 0), found


def test_the_students_sentence_carries_no_input_out(graded):
    found = graded("raise ValueError(f'{hidden} {alpha}')")
    assert found.sentence == "Your function stops with ValueError."
    assert "[" in found.remarks[0], "the teacher reads it"
    named = graded("raise type(f'Of{int(1e6 * alpha)}', (Exception,), {})()")
    assert named.sentence == "Your function stops with an error."


def test_an_answer_finds_no_reference_seed_or_other_student(graded):
    found = graded(f"""
        import gc, sys
        names = [n for n in sys.modules if n.startswith(("courseware.answers", "courseware.classroom.judge"))]
        texts = [one for one in gc.get_objects() if isinstance(one, dict) and "images_with_holes" in one]
        return None if names or texts else {SCORE}
        """)
    assert found.status == "right", found


@pytest.mark.parametrize("missing", ["bwrap", "pyseccomp"])
def test_a_machine_without_walls_is_told_what_to_do(monkeypatch, tmp_path, missing):
    where = {"bwrap": (sandbox.ENVIRONMENT, "PATH", str(tmp_path)), "pyseccomp": (sys.modules, "pyseccomp", None)}
    monkeypatch.setitem(*where[missing])
    with pytest.raises(SandboxError, match=rf"{missing}.*apt install bubblewrap libseccomp2.*Containerfile.*--trust"):
        require_walls()
