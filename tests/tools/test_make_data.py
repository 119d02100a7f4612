"""`make_data` refuses, before any work, what would lose the shipped data or cannot be made."""

import importlib

import pytest

from tools import make_data

# What is made -> where, by what, and what that returns.
MADE = {
    "corridor": ("tools.corridor_data", "make_corridor_data", {"measured": {}}),
    "room": ("courseware.simulation.room.data", "make_room_data", {"pairs": 40, "objects": 14}),
    "finale": ("courseware.simulation.room.finale_data", "make_finale_data", {"objects": 13, "triangles": 60_000}),
}


@pytest.fixture
def calls(monkeypatch):
    """The arguments of every call that would have worked for minutes; nothing is made."""
    noted = []
    for module, function, summary in MADE.values():

        def note(out, seed, summary=summary, **_):
            noted.append((out, seed))
            return summary

        monkeypatch.setattr(importlib.import_module(module), function, note)
    return noted


@pytest.mark.parametrize("name", MADE)
def test_another_seed_goes_where_out_says_and_never_in_the_place_of_the_shipped_data(
    name, calls, tmp_path, monkeypatch, run_tool, capsys
):
    shipped = make_data.SHIPPED[name][0]
    assert run_tool("make_data", name, "--seed", "7") == 2
    assert f"(seed {shipped}): give --out FOLDER, or data/{name} would be replaced" in capsys.readouterr().err
    assert run_tool("make_data", name, "--seed", "-1", "--out", tmp_path / "out") == 2
    assert calls == []
    assert run_tool("make_data", name, "--seed", "7", "--out", tmp_path / "out") == 0
    monkeypatch.setattr(make_data, "DATA", tmp_path)
    assert run_tool("make_data", name) == 0
    assert calls == [(tmp_path / "out", 7), (tmp_path / name, shipped)]


@pytest.mark.parametrize(("name", "option"), [*((name, "--out") for name in MADE), ("projects", "--work")])
def test_a_file_in_place_of_the_folder_is_named_with_its_option(name, option, calls, tmp_path, run_tool, capsys):
    (tmp_path / "file").write_text("")
    assert run_tool("make_data", name, option, tmp_path / "file") == 2
    assert f"error: {option} {tmp_path / 'file'} is a file" in capsys.readouterr().err
    assert calls == []
