"""`bench`: its tools are installed once, into their own folder. How fast anything is, is no test."""

import json
import subprocess
from pathlib import Path

import pytest

from tools import bench

STORED = Path(__file__).parents[2] / "data" / "corridor" / "results" / "bench.json"


@pytest.fixture
def fake(tmp_path, monkeypatch):
    """A place for tools, and measurements that print stored results; what was called."""
    monkeypatch.setattr(bench, "TOOLS", tmp_path / "tools")
    monkeypatch.setattr(bench, "LOCK", tmp_path / "lock.txt")
    (tmp_path / "lock.txt").write_text("a-tool==1\n")
    calls = []

    def run(command, **options):
        calls.append(command)
        if "pip" not in command:
            return subprocess.CompletedProcess(command, 0, f"noise\n{json.dumps(json.loads(STORED.read_text()))}\n")
        network = "a-tool==3" not in (tmp_path / "lock.txt").read_text()
        return subprocess.CompletedProcess(command, 1 - network, "", "noise\nERROR: no route to host")

    monkeypatch.setattr(subprocess, "run", run)
    return calls


def test_tools_are_installed_once_into_their_own_folder_and_anew_with_their_lock(fake, tmp_path, run_tool, capsys):
    words = ["bench", "--quick", "--out", tmp_path / "out"]
    assert run_tool(*words, "--json") == 0
    assert json.loads(capsys.readouterr().out) == json.loads(STORED.read_text())
    assert json.loads((tmp_path / "out" / "bench.json").read_text()) == json.loads(STORED.read_text())
    (pip,) = [call for call in fake if "pip" in call]
    assert pip[pip.index("--target") + 1] == str(tmp_path / "tools")
    assert run_tool(*words) == 0
    assert "step, default" in capsys.readouterr().out
    assert sum("pip" in call for call in fake) == 1
    (tmp_path / "lock.txt").write_text("a-tool==3\n")
    for _ in range(2):  # an installation that failed is tried again
        assert run_tool(*words) == 0
        assert "are left out: ERROR: no route to host" in capsys.readouterr().err


def test_a_folder_that_is_not_ours_is_left_and_a_recording_without_map_named(fake, tmp_path, run_tool, capsys):
    (tmp_path / "tools").mkdir()
    (tmp_path / "tools" / "thesis.txt").write_text("mine")
    assert run_tool("bench", "--quick", "--out", tmp_path / "out") == 0
    assert "was not made by this command" in capsys.readouterr().err
    assert (tmp_path / "tools" / "thesis.txt").read_text() == "mine"
    assert run_tool("bench", "--recording", tmp_path) == 2
    assert "holds no map.ply" in capsys.readouterr().err
