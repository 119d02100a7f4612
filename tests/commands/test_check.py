"""`course.py check`: OK for what is right, FAIL with the cure for what is not, whatever breaks underneath."""

import argparse
import base64
import hashlib
import importlib.metadata
import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from course_lib.commands import check, depth_image_probe

LOCK = Path(__file__).resolve().parents[2] / "environment.txt"


def install_for_children(monkeypatch, folder):
    """Lets the import check's own process find the modules of a folder, as if they were installed."""
    script = f"import sys\nsys.path.insert(0, {str(folder)!r})\n" + check.IMPORT_SCRIPT
    monkeypatch.setattr(check, "IMPORT_SCRIPT", script)


@pytest.fixture
def broken_modules(tmp_path, monkeypatch):
    """Modules for the import check's own process: one that crashes, one that raises, one that is right."""
    (tmp_path / "crashes_at_import.py").write_text("import os; os.abort()")
    (tmp_path / "raises_at_import.py").write_text("raise OSError('libsomething.so: cannot open')")
    (tmp_path / "is_right.py").write_text("")
    install_for_children(monkeypatch, tmp_path)


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


def locked_and_installed():
    """The names in environment.txt that this platform needs and this environment has."""
    lines = [line.split(" #")[0].strip() for line in LOCK.read_text("utf-8").splitlines()]
    wanted = [Requirement(line) for line in lines if line and not line.startswith("#")]
    here = [requirement.name for requirement in wanted if requirement.marker is None or requirement.marker.evaluate()]
    installed = {canonicalize_name(found.metadata["Name"]) for found in importlib.metadata.distributions()}
    return [name for name in here if canonicalize_name(name) in installed]


def test_every_locked_package_has_import_names_that_lead_to_a_module():
    names = {distribution: check.import_names(distribution) for distribution in locked_and_installed()}
    assert len(names) > 100
    for distribution, modules in names.items():
        assert modules, f"{distribution} has no module"
        for module in modules:
            assert importlib.util.find_spec(module) is not None, f"{distribution}: {module}"


@pytest.mark.parametrize(
    ("distribution", "modules"),
    [
        ("scikit-image", ["skimage"]),
        ("pillow", ["PIL"]),
        ("opencv-python-headless", ["cv2"]),
        ("argon2-cffi-bindings", ["_argon2_cffi_bindings"]),
        ("Matplotlib", ["matplotlib"]),
        ("setuptools", ["setuptools"]),
        ("no-such-package", []),
    ],
)
def test_the_import_name_comes_from_the_metadata(distribution, modules):
    assert check.import_names(distribution) == modules


@pytest.fixture
def fake_distribution(tmp_path, monkeypatch):
    """Installs "course-fake" in a scratch folder of its own, with one module of another name; returns a function."""

    def install(source, top_level=True):
        (tmp_path / "of_another_name.py").write_text(source)
        checksum = base64.urlsafe_b64encode(hashlib.sha256(source.encode()).digest()).rstrip(b"=").decode()
        info = tmp_path / "course_fake-1.dist-info"
        info.mkdir()
        (info / "METADATA").write_text("Metadata-Version: 2.1\nName: course-fake\nVersion: 1\n")
        (info / "RECORD").write_text(f"of_another_name.py,sha256={checksum},{len(source)}\n{info.name}/RECORD,,\n")
        if top_level:
            (info / "top_level.txt").write_text("of_another_name\n")
        monkeypatch.syspath_prepend(tmp_path)
        install_for_children(monkeypatch, tmp_path)
        monkeypatch.setattr(importlib.metadata, "requires", lambda name: ["course-fake>=1"])
        return tmp_path / "of_another_name.py"

    return install


@pytest.mark.parametrize("top_level", [True, False], ids=["top_level.txt", "RECORD alone"])
def test_a_package_whose_module_has_another_name_is_ok(fake_distribution, top_level):
    fake_distribution("x = 1\n", top_level)
    (finding,) = check.check_packages()
    assert str(finding) == "OK    course-fake 1 (wanted >=1)"


def test_a_broken_package_fails_with_a_cure_that_does_not_go_round_in_a_circle(fake_distribution):
    module = fake_distribution("raise OSError('libfake.so: cannot open')\n")
    (finding,) = check.check_packages()
    assert not finding.ok
    assert "of_another_name: OSError libfake.so: cannot open" in finding.text
    # As pip installed it: a new .venv would fail in the same way.
    assert "delete" not in finding.cure
    module.write_text("raise OSError('half of the fi")
    (damaged,) = check.check_packages()
    assert damaged.cure == check.MAKE_ANEW
    module.unlink()
    assert [finding.cure for finding in check.check_packages()] == [check.MAKE_ANEW]


@pytest.mark.slow
def test_a_module_of_the_callers_folder_neither_breaks_the_checks_nor_runs(tmp_path, monkeypatch):
    for name in ("random", "json", "numpy"):
        (tmp_path / f"{name}.py").write_text(f"open({str(tmp_path / 'ran')!r}, 'w')\nraise SystemExit(3)\n")
    monkeypatch.chdir(tmp_path)
    assert check.find_broken_imports(["numpy", "random", "json"]) == {}
    assert all(finding.ok for finding in check.check_depth_images())
    assert not (tmp_path / "ran").exists()


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


@pytest.mark.parametrize("backend", ["raster", "vtk", "ray"])
def test_the_tilted_plane_reads_its_closed_form(backend):
    result = depth_image_probe.measure(backend)
    assert result["pixels"] == 176 * 144
    assert result["largest_error_mm"] <= depth_image_probe.LARGEST_ERROR_MM


def test_a_plane_in_the_wrong_place_is_noticed(monkeypatch):
    # Every depth 2 mm too great.
    from course_lib.rendering.renderer import DepthRenderer

    render = DepthRenderer.render
    monkeypatch.setattr(DepthRenderer, "render", lambda renderer, states: render(renderer, states) + np.float32(0.002))
    assert depth_image_probe.measure("ray")["largest_error_mm"] > 1.9


@pytest.mark.slow
def test_opengl_that_cannot_start_fails_with_its_cure(monkeypatch):
    # No driver can be found: libEGL loads, and has nothing to hand over to.
    monkeypatch.setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere/mesa.json")
    findings = list(check.check_depth_images())
    vtk = [finding for finding in findings if "image by OpenGL" in finding.text]
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
    assert [finding.ok for finding in findings] == [False, False, False]
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
