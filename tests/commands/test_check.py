"""`course.py check`: OK for what is right, FAIL with the cure for what is not, whatever breaks underneath."""

import argparse
import importlib.metadata
import sys

import numpy as np
import pytest
from packaging.requirements import Requirement

from course_lib.commands import check, depth_image_probe


@pytest.fixture
def broken_modules(tmp_path, monkeypatch):
    """Modules for the import check's own process: one that crashes, one that raises, one that is right."""
    (tmp_path / "crashes_at_import.py").write_text("import os; os.abort()")
    (tmp_path / "raises_at_import.py").write_text("raise OSError('libsomething.so: cannot open')")
    (tmp_path / "is_right.py").write_text("")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))


def test_each_broken_import_is_named_and_the_others_are_still_tried(broken_modules):
    broken = check.find_broken_imports(["is_right", "crashes_at_import", "raises_at_import", "not_there", "json"])
    assert broken["crashes_at_import"].startswith("crashed with signal")
    assert broken["raises_at_import"] == "OSError libsomething.so: cannot open"
    assert broken["not_there"].startswith("ModuleNotFoundError")
    assert set(broken) == {"crashes_at_import", "raises_at_import", "not_there"}


def test_a_package_in_its_range_is_ok():
    finding = check.check_package(Requirement("numpy>=1.26,<3"), None)
    assert finding.ok
    assert str(finding).startswith(f"OK    numpy {np.__version__}")


@pytest.mark.parametrize(
    ("requirement", "import_error", "said"),
    [
        ("numpy<1", None, "wanted <1"),
        ("no-such-package>=2", None, "not installed"),
        ("numpy>=1.26", "ImportError libc", "cannot be imported (ImportError libc)"),
    ],
)
def test_a_package_that_is_not_right_fails_with_the_cure(requirement, import_error, said):
    finding = check.check_package(Requirement(requirement), import_error)
    assert not finding.ok
    assert said in str(finding)
    assert str(finding).startswith("FAIL")
    assert ".venv" in finding.cure


def test_every_dependency_of_the_package_gets_a_line(monkeypatch):
    monkeypatch.setattr(check, "find_broken_imports", lambda modules: {})
    names = {finding.text.split()[0] for finding in check.check_packages()}
    assert {"numpy", "vtk", "pyvista", "opencv-python-headless", "jupyterlab", "pytest", "nbval"} <= names


def test_a_package_without_metadata_fails_instead_of_stopping(monkeypatch):
    def missing(name):
        raise importlib.metadata.PackageNotFoundError(name)

    monkeypatch.setattr(importlib.metadata, "requires", missing)
    (finding,) = check.check_packages()
    assert not finding.ok
    assert "PackageNotFoundError" in finding.text


@pytest.mark.parametrize("backend", ["vtk", "ray"])
def test_the_tilted_plane_reads_its_closed_form(backend):
    result = depth_image_probe.measure(backend)
    assert result["pixels"] == 176 * 144
    assert result["largest_error_mm"] <= depth_image_probe.LARGEST_ERROR_MM


def test_a_plane_in_the_wrong_place_is_noticed(monkeypatch):
    # Every depth 2 mm too great.
    from course_lib.depth_mcl.rendering.renderer import DepthRenderer

    render = DepthRenderer.render
    monkeypatch.setattr(DepthRenderer, "render", lambda renderer, states: render(renderer, states) + np.float32(0.002))
    assert depth_image_probe.measure("ray")["largest_error_mm"] > 1.9


def test_opengl_that_cannot_start_fails_with_its_cure(monkeypatch):
    # No driver can be found: libEGL loads, and has nothing to hand over to.
    monkeypatch.setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere/mesa.json")
    findings = list(check.check_depth_images())
    vtk = [finding for finding in findings if "z-buffer" in finding.text]
    ray = [finding for finding in findings if "image by ray casting" in finding.text]
    assert [finding.ok for finding in vtk] == [False]
    assert "apt-get install" in vtk[0].cure
    assert [finding.ok for finding in ray] == [True]


@pytest.mark.parametrize(
    ("code", "said"), [(-11, "crashed with signal 11"), (None, "no answer in time"), (1, "code 1")]
)
def test_a_driver_that_crashes_or_hangs_is_a_finding(monkeypatch, code, said):
    monkeypatch.setattr(check, "run_apart", lambda command, timeout_s: (code, "last words\n"))
    findings = list(check.check_depth_images())
    assert [finding.ok for finding in findings] == [False, False]
    assert said in findings[0].text
    assert "last words" in findings[0].text


def test_a_program_that_hangs_is_ended():
    code, _ = check.run_apart([sys.executable, "-c", "import time; time.sleep(60)"], timeout_s=0.5)
    assert code is None


def test_too_little_memory_fails(monkeypatch):
    monkeypatch.setattr(check, "free_memory_gb", lambda: 0.2)
    assert not check.check_machine().ok
    monkeypatch.setattr(check, "free_memory_gb", lambda: 8.0)
    assert check.check_machine().ok


@pytest.mark.parametrize(
    ("oks", "code", "last"), [([True, True], 0, "All 2 OK."), ([True, False], 1, "1 of 2 FAILED.")]
)
def test_the_exit_code_is_zero_only_if_all_is_ok(monkeypatch, capsys, oks, code, last):
    monkeypatch.setattr(check, "look", lambda: iter(check.Finding(ok, "thing", "mend it") for ok in oks))
    assert check.run(argparse.Namespace()) == code
    assert capsys.readouterr().out.strip().splitlines()[-1] == last
