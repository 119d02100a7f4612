"""A foreign reader that crashes, hangs or takes all memory ends there, by name, and not here."""

import os
import sys

import pytest

from course_lib.child import ChildError, run_apart

MEMORY = 300_000_000


def test_what_it_writes_comes_back(tmp_path):
    (tmp_path / "a").write_bytes(b"one")
    code = "import sys; open(sys.argv[2], 'wb').write(open(sys.argv[1], 'rb').read() * 2)"
    assert run_apart(code, str(tmp_path / "a"), MEMORY) == b"oneone"
    assert run_apart("pass", "", MEMORY) == b""


@pytest.mark.parametrize(
    ("code", "said"),
    [
        ("raise ValueError('no such chunk')", "stops with ValueError: no such chunk"),
        ("import sys; sys.exit(3)", "stops with SystemExit: 3"),
        pytest.param(
            "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)",
            "crashes .SIGSEGV",
            marks=pytest.mark.skipif(os.name == "nt", reason="signals of POSIX"),
        ),
        pytest.param(
            "import numpy; numpy.ones(10**9)",
            "takes more than 300 MB of memory",
            marks=pytest.mark.skipif(not sys.platform.startswith("linux"), reason="a limit of Linux"),
        ),
    ],
)
def test_however_it_ends_is_told(code, said):
    with pytest.raises(ChildError, match=said):
        run_apart(code, "", MEMORY)


def test_one_that_hangs_is_stopped():
    with pytest.raises(ChildError, match=r"takes longer than 0\.5 s"):
        run_apart("while True: pass", "", MEMORY, seconds=0.5)


def test_nothing_of_the_callers_folder_or_path_is_imported(tmp_path, monkeypatch):
    (tmp_path / "random.py").write_text("raise SystemExit('the wrong one')")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    assert run_apart("import random", "", MEMORY) == b""
