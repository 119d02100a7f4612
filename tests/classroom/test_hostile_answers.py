"""Hostile answers: each says what happened, earns nothing and harms nothing; the right answer beside it counts."""

import textwrap
from pathlib import Path

import pytest

from course_lib.classroom.confinement import Limits
from course_lib.classroom.judging import Task, grade
from course_lib.classroom.model_answers import function_name
from course_lib.classroom.probe import missing_protections
from course_lib.classroom.sandbox import Sandbox
from course_lib.paths import REPOSITORY
from tests.classroom.handed_in import assignment_of, handed_in, solved
from tests.classroom.walls import require_walls

pytestmark = pytest.mark.slow

SHORT = Limits(call_seconds=0.5, seconds=2.0)
"""For what never ends, however fast the machine is; answers that end have the usual limits."""
REFERENCES = REPOSITORY / "course_lib" / "lessons" / "lesson_06" / "exercises.py"
SCORE = "(1 - hidden) * alpha / (alpha + 0.02) + hidden * alpha / (alpha + 2)"
RIGHT = f"    return {SCORE}\n"


@pytest.fixture(scope="module")
def sandbox(tmp_path_factory):
    require_walls(tmp_path_factory.mktemp("walls"))
    with Sandbox(tmp_path_factory.mktemp("sandbox")) as sandbox:
        yield sandbox


@pytest.fixture
def graded(sandbox, tmp_path):
    """What becomes of a body of `raw_score` (06.1); `{trap}` in it is a file, `{own}` the submission, `{before}`
    stands before the function."""
    trap = tmp_path / "trap.txt"
    trap.write_text("untouched", encoding="ascii")
    right = solved("06")

    def run(body: str, before: str = "", limits: Limits | None = None):
        path = tmp_path / "mallory" / "06.ipynb"
        body = textwrap.indent(textwrap.dedent(body).strip("\n"), "    ")
        source = f"{before}\ndef raw_score(hidden, alpha):\n{body}\n"
        for name, place in {"{trap}": trap, "{own}": path, "{references}": REFERENCES}.items():
            source = source.replace(name, str(place))
        handed_in(path, "06", {"06.1": source, "06.3": right["06.3"]})
        written = path.read_bytes()
        hostile = grade(Task("mallory", "06", path, "06.1", "raw_score"), sandbox, 1, limits or Limits())
        beside = grade(Task("mallory", "06", path, "06.3", "min_likelihood"), sandbox, 1)
        assert (beside.status, beside.points) == ("right", 4), beside
        assert trap.read_text("ascii") == "untouched"
        assert path.read_bytes() == written
        assert not children(sandbox)
        return hostile

    return run


def children(sandbox: Sandbox) -> list[int]:
    """Processes that answers left behind."""
    tasks = Path(f"/proc/{sandbox._process.pid}/task").iterdir()
    return [int(word) for task in tasks for word in (task / "children").read_text("ascii").split()]


def test_this_machines_walls_hold_and_the_trial_finds_so(sandbox, tmp_path):
    assert missing_protections(tmp_path / "trial", Limits()) == ()


def test_a_right_answer_beside_nothing_hostile_is_right_and_nothing_is_refused(graded):
    found = graded(RIGHT)
    assert (found.status, found.points, found.refused) == ("right", 2, ())


# What does not end, or takes too much

ENDLESS = {
    "a loop": "while True: pass",
    "a loop that catches everything": """
        while True:
            try:
                while True: pass
            except BaseException:
                pass
        """,
    "sleep": "import time\ntime.sleep(1e6)",
    "a lock": "import threading\nthreading.Semaphore(0).acquire()",
}


@pytest.mark.parametrize("body", ENDLESS.values(), ids=ENDLESS)
def test_what_never_ends_is_stopped(graded, body):
    found = graded(body, limits=SHORT)
    assert (found.status, found.points) == ("wrong", 0)
    assert "does not end within" in found.sentence


def test_a_cell_that_never_ends_is_stopped(graded):
    found = graded("return FOREVER", before="FOREVER = [0 for _ in iter(int, 1)]", limits=SHORT)
    assert found.points == 0
    assert "does not end within" in found.sentence + "".join(found.problems)


TOO_MUCH = {
    "two gigabytes": ("import numpy as np\nnp.ones(2 << 27)", "MemoryError"),
    "memory without end": ("rows = []\nwhile True: rows.append(bytearray(1 << 24))", "MemoryError"),
    "printing": ("for _ in range(10**6): print('x' * 100)", "prints more than 20,000 characters"),
    "printing by the descriptor": ("import os\nwhile True: os.write(1, b'x' * 10000)", "prints more than 256 kB"),
    "errors by the descriptor": ("import os\nwhile True: os.write(2, b'x' * 10000)", "prints more than 256 kB"),
    "a file of a gigabyte": (
        "with open('big', 'wb') as file:\n    for _ in range(1 << 10): file.write(bytes(1 << 20))",
        "File too large",
    ),
    "files without end": (
        "n = 0\nwhile True:\n    n += 1\n    open(f'{n}', 'wb').close()",
        "writes more than",
    ),
    "threads without end": (
        "import threading, time\nthreading.stack_size(65536)\n"
        "while True: threading.Thread(target=time.sleep, args=(60,), daemon=True).start()",
        "thread",
    ),
    "calls of itself": ("return raw_score(hidden, alpha)", "calls itself without end"),
}


@pytest.mark.parametrize(("body", "words"), TOO_MUCH.values(), ids=TOO_MUCH)
def test_what_takes_too_much_is_stopped_and_named(graded, body, words):
    found = graded(body)
    assert (found.status, found.points) == ("wrong", 0)
    assert words in found.sentence


# What ends the process

ENDINGS = {
    "SystemExit": ("raise SystemExit(0)", "calls exit() or quit()"),
    "os._exit": ("import os\nos._exit(0)", "ends its process"),
    "a crash": ("import ctypes\nctypes.string_at(1)", "crashes its process (SIGSEGV"),
    "its own kill": ("import os, signal\nos.kill(os.getpid(), signal.SIGKILL)", "crashes its process (SIGKILL"),
    "KeyboardInterrupt": ("raise KeyboardInterrupt", "ends its process"),
    "lines closed": ("import os\nos.closerange(3, 50)\nwhile True: pass", "SIGKILL"),
}


@pytest.mark.parametrize(("body", "words"), ENDINGS.values(), ids=ENDINGS)
def test_what_ends_its_process_is_named(graded, body, words):
    found = graded(body)
    assert (found.status, found.points) == ("wrong", 0)
    assert words in found.sentence


# What is refused: the answer after it counts, and what was tried is said

TRY = "try:\n    {}\nexcept BaseException:\n    pass\n" + textwrap.dedent(RIGHT)
REFUSED = {
    "os.remove": ("import os\n    os.remove('{trap}')", "remove {trap}"),
    "os.remove of the submission": ("import os\n    os.remove('{own}')", "remove {own}"),
    "os.remove of the library": ("import os\n    os.remove('{references}')", "remove {references}"),
    "shutil.rmtree": ("import shutil, os\n    shutil.rmtree(os.path.dirname('{trap}'))", "remove the folder"),
    "os.rename": ("import os\n    os.rename('{trap}', 'mine')", "rename {trap}"),
    "os.chmod": ("import os\n    os.chmod('{trap}', 0)", "change the rights of {trap}"),
    "open to write": ("open('{trap}', 'w')", "write to {trap}"),
    "open to append": ("open('{trap}', 'a').write('!')", "write to {trap}"),
    "a link": ("import os\n    os.symlink('{trap}', 'link')", "make a link to {trap}"),
    "TCP": ("import socket\n    socket.create_connection(('192.0.2.1', 80))", "192.0.2.1"),
    "TCP to localhost": ("import socket\n    socket.socket().connect(('127.0.0.1', 22))", "open a network connection"),
    "UDP": (
        "import socket\n    socket.socket(socket.AF_INET, socket.SOCK_DGRAM).sendto(b'x', ('192.0.2.1', 9))",
        "open a network connection",
    ),
    "DNS": ("import socket\n    socket.gethostbyname('example.org')", "look up the network address of example.org"),
    "a web page": ("import urllib.request\n    urllib.request.urlopen('http://example.org')", "example.org"),
    "another program": ("import subprocess\n    subprocess.run(['touch', '/tmp/x'])", "start another program touch"),
    "a shell": ("import os\n    os.system('touch /tmp/x')", "start another program touch /tmp/x"),
    "a fork": ("import os\n    os.fork()", "start another process"),
    "a fork bomb": ("import os\n    while True: os.fork()", "start another process"),
    "a signal to the parent": ("import os\n    os.kill(os.getppid(), 9)", "send a signal to another process"),
    "a signal to everybody": ("import os\n    os.kill(-1, 9)", "send a signal to another process"),
    "the references": ("print(open('{references}').read())", "read {references}"),
    "the references, imported": ("from course_lib.lessons.lesson_06 import exercises", "read {references}"),
    "keys": ("open('/root/.ssh/id_ed25519')", "read /root/.ssh/id_ed25519"),
    "the environment": ("open('/proc/self/environ').read()", "read /proc/self/environ"),
    "the parent's memory": ("import os\n    open(f'/proc/{os.getppid()}/mem', 'rb')", "read /proc/"),
    "a folder's names": ("import os\n    os.listdir(os.path.dirname('{own}'))", "list the folder"),
}


@pytest.mark.parametrize(("attempt", "words"), REFUSED.values(), ids=REFUSED)
def test_what_is_refused_is_said_and_a_right_answer_after_it_counts(graded, tmp_path, attempt, words):
    found = graded(TRY.format(attempt) if "{os" not in attempt else TRY.replace("{}", attempt))
    assert (found.status, found.points) == ("right", 2), found
    places = {"{trap}": tmp_path / "trap.txt", "{own}": tmp_path / "mallory" / "06.ipynb", "{references}": REFERENCES}
    for name, place in places.items():
        words = words.replace(name, str(place)[:150])
    assert any(words in what for what in found.refused), found.refused


def test_without_a_try_the_refusal_is_what_the_answer_stops_with(graded):
    found = graded("import os\nos.remove('{trap}')\n" + textwrap.dedent(RIGHT))
    assert (found.status, found.points) == ("wrong", 0)
    assert "PermissionError in its line 3" in found.sentence
    assert "refused while grading" in found.sentence


BY_THE_C_LIBRARY = {
    "unlink": "libc.unlink(b'{trap}')",
    "truncate": "libc.truncate(b'{trap}', 0)",
    "open and empty": "libc.open(b'{trap}', os.O_TRUNC)",
    "open to write": "libc.open(b'{trap}', os.O_WRONLY)",
    "read the references": "libc.open(b'{references}', os.O_RDONLY)",
    "chmod": "libc.chmod(b'{trap}', 0)",
    "chown": "libc.chown(b'{trap}', 1, 1)",
    "times": "libc.utimes(b'{trap}', None)",
    "rename": "libc.rename(b'{trap}', b'mine')",
    "link": "libc.link(b'{trap}', b'mine')",
    "make a folder": "libc.mkdir(b'{trap}.d', 0o777)",
    "socket": "libc.socket(2, 1, 0)",
    "socket over IPv6": "libc.socket(10, 2, 0)",
    "local socket": "libc.socket(1, 1, 0)",
    "fork": "libc.fork()",
    "vfork's number": "libc.syscall(58)",
    "exec": "libc.execv(b'/bin/true', (ctypes.c_char_p * 2)(b'true', None))",
    "signal": "libc.kill(os.getppid(), 0)",
    "signal to a group": "libc.kill(-os.getppid(), 0)",
    "trace": "libc.ptrace(0x4206, os.getppid(), 0, 0)",
    "the parent's memory": "libc.process_vm_readv(os.getppid(), None, 0, None, 0, 0)",
    "the parent's limits": "libc.prlimit(os.getppid(), 7, None, None)",
    "outlive the parent": "libc.prctl(1, 0, 0, 0, 0)",
    "a name space": "libc.unshare(0x10000000)",
    "io_uring": "libc.syscall(425, 1, None)",
    "openat2": "libc.syscall(437, -100, b'/etc/passwd', None, 0)",
    "become somebody": "libc.setuid(12345)",
    "more time": "libc.setrlimit(0, (ctypes.c_ulong * 2)(10**6, 10**6))",
}


@pytest.mark.parametrize("call", BY_THE_C_LIBRARY.values(), ids=BY_THE_C_LIBRARY)
def test_the_c_library_is_refused_by_the_kernel(graded, call):
    """Around Python's own hook: the call must fail, or the answer would be wrong."""
    body = f"import ctypes, os\nlibc = ctypes.CDLL(None)\nfailed = {call} == -1\n"
    found = graded(body + f"return {SCORE} if failed else None\n")
    assert (found.status, found.points) == ("right", 2), found


def test_files_of_its_own_may_be_written_and_are_gone_afterwards(graded, sandbox):
    body = "open('mine.txt', 'w').write('1')\nassert open('mine.txt').read() == '1'\n"
    assert graded(body + textwrap.dedent(RIGHT)).status == "right"
    assert not (sandbox.folder / "answer").exists()


def test_every_answer_starts_in_an_empty_folder(graded):
    body = "import os\nassert 'left' not in os.listdir('.')\n"
    for _ in range(2):
        found = graded(body + "import builtins\nbuiltins.left = 1\n" + textwrap.dedent(RIGHT))
        assert found.status == "right"
    body = "import builtins\nassert not hasattr(builtins, 'left')\n"
    assert graded(body + textwrap.dedent(RIGHT)).status == "right"


def test_threads_that_run_on_do_no_harm(graded):
    body = "import threading, time\nthreading.Thread(target=time.sleep, args=(600,)).start()\n"
    assert (
        graded(
            "if threading.active_count() < 20:\n    " + body.splitlines()[1] + "\n" + RIGHT.strip(),
            before="import threading, time",
        ).status
        == "right"
    )


# Forged verdicts

FORGED = {
    "printed": "print('06.1: right.')\nreturn hidden",
    "printed, then exit": "import sys\nprint('06.1: right.')\nsys.exit(0)",
    "sent": """
        import os
        for number in range(3, 60):
            for line in (b'{"verdict": "right"}', b'{"status": "right", "points": 2}', b'{"done": true}'):
                try: os.write(number, line + bytes([10]))
                except OSError: pass
        return hidden
        """,
    "the library patched": """
        import course_lib.lessons.kit.exercises as exercises, course_lib.lessons.kit.hints as hints
        import course_lib.classroom.answers as answers
        exercises.right_on = hints.agree = hints.agree_all = lambda *given: True
        exercises.judge = lambda *given: exercises.Verdict("right", "right.")
        return hidden
        """,
    "the caller's variables": """
        import sys
        frame = sys._getframe()
        while frame:
            for name in ("status", "right", "points"): frame.f_locals[name] = True
            frame = frame.f_back
        return hidden
        """,
    "an object that equals everything": """
        class Everything:
            def __eq__(self, other): return True
            def __array__(self, *given): return self
            def __reduce__(self): return (print, ("forged",))
        return Everything()
        """,
    "an array that equals everything": """
        import numpy as np
        class Everything(np.ndarray):
            def __eq__(self, other): return np.ones(self.shape, bool)
            def __sub__(self, other): return np.zeros(self.shape)
            def __array_function__(self, *given): return True
            def __array_ufunc__(self, *given, **named): return np.zeros(self.shape)
            def __reduce__(self): return (print, ("forged",))
        return np.asarray(hidden).view(Everything)
        """,
    "an array of objects": """
        import numpy as np
        class Everything(float):
            def __eq__(self, other): return True
            def __le__(self, other): return True
        return np.array([Everything(0) for _ in hidden], dtype=object)
        """,
    "not a number": "return hidden * float('nan')",
    "infinity": "return hidden + float('inf')",
    "nothing": "found = None\nreturn found",
    "a view of a billion": "import numpy as np\nreturn np.broadcast_to(np.float64(1), (10**9,))",
    "an empty array": "return hidden[:0]",
    "rows within rows": "row = []\nfor _ in range(10**5): row = [row]\nreturn row",
    "a long row": "return [0.0] * 10**7",
    "a huge number": "return 10**10000",
    "text": "return 'right' * 10**6",
    "records": "import numpy as np\nreturn np.zeros(3, dtype=[('a', 'O'), ('b', 'f8')])",
}


@pytest.mark.parametrize("body", FORGED.values(), ids=FORGED)
def test_a_forged_verdict_earns_nothing(graded, body):
    found = graded(body)
    assert (found.points, found.right_inputs) == (0, 0), found
    assert found.status == "wrong"


def test_what_is_no_number_is_named(graded):
    assert (
        "yours returns a Bomb"
        in graded("class Bomb:\n    def __reduce__(self): return (print, ('forged',))\nreturn Bomb()").sentence
    )
    assert "ndarray of object" in graded("import numpy as np\nreturn hidden.astype(object)").sentence
    assert "1000000000 array, which is too large" in graded(FORGED["a view of a billion"]).sentence


def test_nonsense_on_the_graders_line_is_named_and_ends_the_answer(graded):
    found = graded("import os\nos.write(4, b'nonsense' + bytes([10]))\n" + textwrap.dedent(RIGHT))
    assert (found.status, found.points) == ("wrong", 0)
    assert "sends the grader" in found.sentence


def test_an_answer_knows_nothing_of_references_seeds_or_other_students(graded):
    """Neither modules with references nor the grader's own are there, nor anything of the last student's."""
    body = """
        import sys, os, gc
        names = [name.split(".") for name in sys.modules if name.startswith("course_lib.")]
        loaded = [name for name in names if name[-1] in ("project", "rivals", "judging", "points", "model_answers")]
        loaded += [name for name in names if name[-1] == "exercises" and "kit" not in name]
        known = [key for key in os.environ if key.startswith(("COURSE", "PYTEST", "SSH", "AWS")) or "TOKEN" in key]
        texts = [one for one in gc.get_objects() if isinstance(one, dict) and "min_likelihood" in one]
        score = (1 - hidden) * alpha / (alpha + 0.02) + hidden * alpha / (alpha + 2)
        return None if loaded or known or texts else score
        """
    for _ in range(2):
        found = graded(body)
        assert found.status == "right", found


def test_a_function_that_changes_what_it_was_given_earns_nothing(graded):
    found = graded(f"found = {SCORE}\nhidden *= 2\nreturn found")
    assert (found.status, found.points) == ("wrong", 0)
    assert "changes the array it was given" in found.sentence


def test_a_function_of_the_graders_is_called_over_the_line(sandbox, tmp_path):
    path = handed_in(tmp_path / "00.ipynb", "00", solved("00"))
    for one in assignment_of("00").exercises():
        found = grade(Task("alice", "00", path, one.number, function_name(one.stub)), sandbox, 1)
        assert (found.status, found.refused) == ("right", ()), found


def test_a_projects_last_function_runs_in_the_sandbox(sandbox, tmp_path):
    untouched = grade(Task("bob", "P3", assignment_of("P3").path, "P3", "match"), sandbox, 1)
    assert (untouched.status, untouched.points, untouched.most) == ("not attempted", 0, 12)
    path = tmp_path / "P3.py"
    path.write_text("def match(seen, semantic_map):\n    import os\n    os.remove(__file__)\n", encoding="utf-8")
    hostile = grade(Task("mallory", "P3", path, "P3", "match"), sandbox, 1)
    assert (hostile.status, hostile.points) == ("wrong", 0)
    path.write_text("def match(seen, semantic_map):\n    return []\n", encoding="utf-8")
    withheld = grade(Task("carol", "P3", path, "P3", "match"), sandbox, 1)
    assert (withheld.right_inputs, withheld.inputs) == (12, 12), withheld
    assert withheld.points > 0
