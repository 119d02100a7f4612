"""`course.py check`: OK for what is right, FAIL with the cure for what is not, whatever breaks underneath."""

import argparse
import importlib.metadata

import numpy as np
import pytest

from courseware.commands import check


def test_each_broken_import_is_named_and_the_others_are_still_tried(tmp_path, monkeypatch):
    (tmp_path / "crashes_at_import.py").write_text("import os; os.abort()")
    (tmp_path / "raises_at_import.py").write_text("raise OSError('libsomething.so: cannot open')")
    (tmp_path / "is_right.py").write_text("")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    broken = check.find_broken_imports(["is_right", "crashes_at_import", "raises_at_import", "not_there", "json"])
    assert broken["crashes_at_import"].startswith("crashed with signal")
    assert broken["raises_at_import"] == "OSError libsomething.so: cannot open"
    assert broken["not_there"].startswith("ModuleNotFoundError")
    assert set(broken) == {"crashes_at_import", "raises_at_import", "not_there"}


@pytest.mark.parametrize(
    ("requirement", "imports", "said"),
    [
        ("numpy>=1.26,<9", {}, f"OK    numpy {np.__version__} (wanted <9,>=1.26)"),
        ("no-such-package>=2", {}, "FAIL  no-such-package is not installed (wanted >=2). Cure: delete"),
        ("numpy>=1.26", {"numpy": "ImportError libc"}, "cannot be imported (numpy: ImportError libc). Cure: delete"),
    ],
)
def test_a_package_is_ok_or_fails_with_the_cure(monkeypatch, requirement, imports, said):
    monkeypatch.setattr(importlib.metadata, "requires", lambda name: [requirement])
    monkeypatch.setattr(check, "find_broken_imports", lambda modules: imports)
    _, finding = check.check_packages()
    assert said in str(finding)
    assert finding.ok == str(finding).startswith("OK")


def test_the_tilted_plane_reads_its_closed_form():
    """By OpenGL; the others are asked below."""
    _, error_mm, n_pixels = check.render_plane("vtk")
    assert n_pixels == 176 * 144
    assert error_mm <= check.MAX_ERROR_MM


@pytest.mark.slow
def test_opengl_that_cannot_start_is_optional_with_its_cure_and_what_is_lost(monkeypatch, capsys):
    # No driver can be found: libEGL loads, and has nothing to hand over to.
    monkeypatch.setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere/mesa.json")
    raster, vtk, ray = check.check_depth_images()
    assert (raster.ok, vtk.ok, ray.ok) == (True, False, True)
    assert "image by OpenGL" in vtk.text
    assert "apt-get install" in vtk.cure
    monkeypatch.setattr(check, "check_packages", lambda: iter([]))
    monkeypatch.setattr(check, "check_depth_images", lambda: iter([raster, vtk]))
    assert check.run(argparse.Namespace()) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[1].startswith("LACK, which is optional: no depth image by OpenGL")
    assert "3D scenes have no picture" in lines[1]
    assert lines[-1] == "All 2 OK."  # raster and the memory


@pytest.mark.parametrize(("code", "said"), [(-11, "signal 11: last"), (None, "no answer in time"), (1, "code 1: last")])
def test_a_driver_that_crashes_or_hangs_is_a_finding_and_the_exit_code_tells(monkeypatch, capsys, code, said):
    for name in ("check_packages", "check_machine"):
        monkeypatch.setattr(check, name, lambda: iter([check.Finding(True, "thing")]))
    monkeypatch.setattr(check, "run_apart", lambda *words: (code, "last words\n"))
    assert check.run(argparse.Namespace()) == 1
    *lines, last = capsys.readouterr().out.strip().splitlines()
    assert [line.startswith("OK") for line in lines[:5]] == [True, False, False, False, True]
    assert said in lines[1]
    assert last == "2 of 4 FAILED."
    monkeypatch.setattr(check, "check_depth_images", lambda: iter([]))
    assert check.run(argparse.Namespace()) == 0
    assert capsys.readouterr().out.strip().splitlines()[-1] == "All 2 OK."
