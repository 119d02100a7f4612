"""Look at the environment: one line a dependency, OpenGL, and a rendered depth image compared with its closed form.

Every line reads OK, or FAIL (LACK for OpenGL) with the cure. Imports and drivers can crash, so they run apart.
"""

import argparse
import importlib.metadata
import json
import platform
import re
import subprocess
import sys
from collections.abc import Iterator
from itertools import chain
from typing import NamedTuple

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

DISTRIBUTION = "course-lib"
EXTRAS = ("", "lessons")  # what a student needs
MAKE_ANEW = "delete the folder .venv and run: python3 course.py check. If it stays, ask whoever gave you the course"
INSTALL_OPENGL = (
    "as root: apt-get install -y --no-install-recommends libegl1 libgl1-mesa-dri libgl1. Without it both methods and "
    "the lessons run, but 3D scenes have no picture, and lesson 19, demo rooms, trouble and finale stop"
)
HANGS_S = 600  # only what hangs takes so long
MIN_FREE_MEMORY_GB = 1.0  # chosen: a kernel with the corridor's map and one batch of tiles, with room to spare
MAX_ERROR_MM = 0.5  # from the closed form; the z-buffer's own steps are below 0.3 mm up to 15 m

IMPORT_SCRIPT = """
import importlib, sys
for name in sys.argv[1:]:
    print("importing", name, flush=True)
    try:
        importlib.import_module(name)
    except BaseException as error:
        print("broken", name, type(error).__name__, str(error).split("\\n")[0], flush=True)
"""


class Finding(NamedTuple):
    """One line of the report: what was looked at, whether it is as it should be, and the cure where it is not."""

    ok: bool
    text: str
    cure: str = ""
    optional: bool = False

    def __str__(self) -> str:
        word = "LACK, which is optional:" if self.optional else "FAIL "
        return f"OK    {self.text}" if self.ok else f"{word} {self.text}. Cure: {self.cure}"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    pass


def run(arguments: argparse.Namespace) -> int:
    right = []
    for finding in chain(check_packages(), check_depth_images(), check_machine()):
        print(finding, flush=True)
        right += [finding.ok] if finding.ok or not finding.optional else []
    failed = right.count(False)
    print(f"\n{failed} of {len(right)} FAILED." if failed else f"\nAll {len(right)} OK.", flush=True)
    return 1 if failed else 0


def check_packages() -> Iterator[Finding]:
    """A finding for Python and for each dependency: is it there, in the wanted range, importable?"""
    yield Finding(True, f"Python {platform.python_version()} (wanted >=3.11)")  # course.py has refused an older one
    requirements = [Requirement(text) for text in importlib.metadata.requires(DISTRIBUTION) or []]
    here = [r for r in requirements if r.marker is None or any(r.marker.evaluate({"extra": e}) for e in EXTRAS)]
    modules = import_names()
    broken = find_broken_imports([name for r in here for name in modules.get(canonicalize_name(r.name), [])])
    for requirement in here:
        wanted = f"(wanted {requirement.specifier or 'any version'})"
        try:
            version = importlib.metadata.version(requirement.name)
        except importlib.metadata.PackageNotFoundError:
            yield Finding(False, f"{requirement.name} is not installed {wanted}", MAKE_ANEW)
            continue
        text = f"{requirement.name} {version} {wanted}"
        names = modules.get(canonicalize_name(requirement.name), [])
        errors = [f"{name}: {broken[name]}" for name in names if name in broken]
        if errors:
            text += f" cannot be imported ({errors[0]})"
        yield Finding(not errors and requirement.specifier.contains(version, prereleases=True), text, MAKE_ANEW)


def import_names() -> dict[str, list[str]]:
    """Return distribution -> modules that it brings; of several, the one named as the distribution stands for all."""
    found: dict[str, list[str]] = {}
    for module, distributions in importlib.metadata.packages_distributions().items():
        for name in map(canonicalize_name, distributions if module.isidentifier() else ()):
            found.setdefault(name, []).append(module)
    for name, modules in found.items():
        own = [module for module in modules if canonicalize_name(module) == name]
        found[name] = own or [module for module in modules if not module.startswith("_")]
    return found


def find_broken_imports(modules: list[str]) -> dict[str, str]:
    """What each module that cannot be imported said. A crash is put to the module that was being imported."""
    broken: dict[str, str] = {}
    rest = list(modules)
    while rest:
        code, output = run_apart("-c", IMPORT_SCRIPT, *rest)
        broken |= dict(re.findall(r"^broken (\S+) (.*)$", output, re.M))
        if code == 0:
            break
        culprit = [line.split()[1] for line in output.splitlines() if line.startswith("importing ")][-1]
        broken[culprit] = describe_exit(code)
        rest = rest[rest.index(culprit) + 1 :]
    return broken


def check_depth_images() -> Iterator[Finding]:
    """One depth image of a tilted plane by each backend, beside its closed form."""
    for backend, name in (("raster", "z-buffer"), ("vtk", "OpenGL's z-buffer"), ("ray", "ray casting")):
        code, output = run_apart("-m", "courseware.commands.check", backend)
        lines = output.strip().splitlines() or [""]
        results = [line for line in lines if line.startswith('["')]  # libraries' own messages may stand around it
        cure = INSTALL_OPENGL if backend == "vtk" else MAKE_ANEW
        if code != 0 or not results:
            why = f"{describe_exit(code)}: {lines[-1].split('. ')[0][:300]}"
            yield Finding(False, f"no depth image by {name}: {why}", cure, optional=backend == "vtk")
            continue
        renderer, error_mm, n_pixels = json.loads(results[0])
        if backend == "vtk":
            yield Finding(True, f"OpenGL renderer: {renderer}")
        text = f"depth image by {name}: largest error {error_mm:.4f} mm in {n_pixels:,} pixels of a tilted plane "
        yield Finding(error_mm <= MAX_ERROR_MM, f"{text}(at most {MAX_ERROR_MM} mm)", cure)


def render_plane(backend: str) -> tuple[str, float, int]:
    """Render a tilted plane: the renderer's name, the largest error in millimetres, the number of pixels.

    The plane n . X = d, seen along the pixel ray r (forward component one), has depth d / (n . r).
    """
    import numpy as np

    from course_lib.geometry import optical_pose
    from course_lib.rendering.camera import DepthCamera
    from course_lib.rendering.renderer import DepthRenderer
    from course_lib.rendering.scene_map import SceneMap

    camera, state = DepthCamera.sr4000(), np.array([4.0, -2.0, 1.2, 0.1, -0.2, 2.5])  # no component is zero
    normal, point = np.array([0.35, 0.25, 1.0]), np.array([0.0, 0.0, 3.0])  # in the optical frame
    across = np.cross(normal, [0.0, 1.0, 0.0]) / np.linalg.norm(np.cross(normal, [0.0, 1.0, 0.0]))
    along = np.cross(normal, across) / np.linalg.norm(normal)
    corners = point + 12.0 * np.array([-across - along, across - along, across + along, -across + along])
    pose = optical_pose(state)
    scene_map = SceneMap(corners @ pose[:3, :3].T + pose[:3, 3], np.array([[0, 1, 2], [0, 2, 3]]))
    with DepthRenderer(scene_map, camera, backend=backend) as renderer:
        image = renderer.render(state[np.newaxis])[0]
        error = np.abs(image.astype(np.float64) - normal @ point / (camera.rays() @ normal)).max()
        return renderer.describe(), 1000 * float(error), image.size


def check_machine() -> Iterator[Finding]:
    """Processors that this process may use, and free memory: too little memory stops kernels without a word."""
    import psutil
    from joblib import cpu_count

    free = psutil.virtual_memory().available / 1e9
    text = f"{cpu_count()} cores, {free:.1f} GB of memory free (wanted at least {MIN_FREE_MEMORY_GB:g} GB)"
    yield Finding(free >= MIN_FREE_MEMORY_GB, text, "close other programs, or take a machine with more memory")


def run_apart(*words: str, timeout_s: float = HANGS_S) -> tuple[int | None, str]:
    """Return exit code and output of a Python of its own; the code is None when it ran out of time."""
    pipes = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
    try:
        ended = subprocess.run([sys.executable, "-P", *words], timeout=timeout_s, **pipes)
    except subprocess.TimeoutExpired as expired:
        ended = expired
    return getattr(ended, "returncode", None), (ended.stdout or b"").decode("utf-8", "replace")


def describe_exit(code: int | None) -> str:
    if code is None:
        return "no answer in time"
    return f"crashed with signal {-code}" if code < 0 else f"stopped with code {code}"


if __name__ == "__main__":
    try:
        print(json.dumps(render_plane(sys.argv[1])), flush=True)
    except Exception as error:
        sys.exit(f"{type(error).__name__}: {error}")
