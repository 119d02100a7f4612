"""The data and the lessons are found, whatever folder a command runs in."""

import pytest

from courseware.paths import data_path, notebook_paths


def test_data_and_lessons_are_found_from_anywhere_and_what_is_missing_is_named(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert data_path("corridor/map.ply").is_file()
    assert [path.name[:2] for path in notebook_paths()][:2] == ["00", "01"]
    with pytest.raises(FileNotFoundError, match=r"no 'corridor/nothing' in .*make the data again"):
        data_path("corridor/nothing")
