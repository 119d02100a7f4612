"""Look at the environment: one line a dependency, OpenGL, and a rendered depth image compared with its closed form.

Every line reads OK, or FAIL with the cure. What can crash (a package's import, an OpenGL driver) runs in a process of
its own and becomes a FAIL like any other. Exit code 0 only if every line is OK.
"""

from __future__ import annotations

import argparse
import base64
import hashlib
import importlib.metadata
import platform
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass

from course_lib.child import course_module, python
from course_lib.child import run as run_child
from course_lib.commands.depth_image_probe import LARGEST_ERROR_MM, read_result
from course_lib.processors import processors

DISTRIBUTION = "course-lib"
EXTRAS = ("", "lessons", "test")  # what environment.txt pins
MAKE_ANEW = "delete the folder .venv and run: python3 course.py check"
NOT_BY_A_NEW_ENVIRONMENT = (
    "its files are as pip installed them, so a new .venv would be the same: mend what the message names (a library of "
    "the system?), or send this line to whoever gave you the course"
)
INSTALL_OPENGL = "as root: apt-get install -y --no-install-recommends libegl1 libgl1-mesa-dri libgl1"
IMPORT_TIMEOUT_S = 600  # only what hangs takes so long
RENDER_TIMEOUT_S = 600
LEAST_FREE_MEMORY_GB = 1.0  # chosen: a kernel with the corridor's map and one batch of tiles, with room to spare

IMPORT_SCRIPT = """
import importlib, sys
for name in sys.argv[1:]:
    print("importing", name, flush=True)
    try:
        importlib.import_module(name)
    except BaseException as error:
        print("broken", name, type(error).__name__, str(error).split("\\n")[0], flush=True)
"""


@dataclass(frozen=True)
class Finding:
    """One line of the report: what was looked at, whether it is as it should be, and the cure where it is not."""

    ok: bool
    text: str
    cure: str = ""

    def __str__(self) -> str:
        return f"OK    {self.text}" if self.ok else f"FAIL  {self.text}. Cure: {self.cure}"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    pass


def run(arguments: argparse.Namespace) -> int:
    findings = []
    for finding in look():
        print(finding, flush=True)
        findings.append(finding)
    failed = sum(not finding.ok for finding in findings)
    print(f"\n{failed} of {len(findings)} FAILED." if failed else f"\nAll {len(findings)} OK.", flush=True)
    return 1 if failed else 0


def look() -> Iterator[Finding]:
    """All findings, as they come."""
    yield check_python()
    yield from check_packages()
    yield from check_depth_images()
    yield check_machine()


def check_python() -> Finding:
    version = platform.python_version()
    return Finding(sys.version_info >= (3, 11), f"Python {version} (wanted >=3.11)", "install Python 3.11 or newer")


def check_packages() -> Iterator[Finding]:
    """A finding for each dependency in the package's metadata: is it there, in the wanted range, importable?"""
    try:
        from packaging.requirements import Requirement

        requirements = [Requirement(text) for text in importlib.metadata.requires(DISTRIBUTION) or []]
    except (ImportError, importlib.metadata.PackageNotFoundError) as error:
        yield Finding(False, f"the list of dependencies cannot be read ({type(error).__name__}: {error})", MAKE_ANEW)
        return
    here = [r for r in requirements if r.marker is None or any(r.marker.evaluate({"extra": e}) for e in EXTRAS)]
    modules = {requirement.name: import_names(requirement.name) for requirement in here}
    broken = find_broken_imports([name for names in modules.values() for name in names])
    for requirement in here:
        errors = [f"{name}: {broken[name]}" for name in modules[requirement.name] if name in broken]
        yield check_package(requirement, errors[0] if errors else None)


def check_package(requirement, import_error: str | None) -> Finding:
    """The finding for one `packaging` Requirement, given what its import said (None: it imports)."""
    wanted = f"(wanted {requirement.specifier or 'any version'})"
    try:
        version = importlib.metadata.version(requirement.name)
    except importlib.metadata.PackageNotFoundError:
        return Finding(False, f"{requirement.name} is not installed {wanted}", MAKE_ANEW)
    text = f"{requirement.name} {version} {wanted}"
    if version is None or not requirement.specifier.contains(version, prereleases=True):
        return Finding(False, text, MAKE_ANEW)
    if import_error is not None:
        cure = NOT_BY_A_NEW_ENVIRONMENT if is_as_installed(requirement.name) else MAKE_ANEW
        return Finding(False, f"{text} cannot be imported ({import_error})", cure)
    return Finding(True, text)


def import_names(distribution: str) -> list[str]:
    """The modules that a distribution brings, by its own metadata: `skimage` of scikit-image; none where it is missing.

    Of several modules, the one named as the distribution stands for all of them, since what lies beside it are parts
    and helpers (`mpl_toolkits`); without such a one all that are not private count, and where all are, all.
    """
    try:
        found = importlib.metadata.distribution(distribution)
    except importlib.metadata.PackageNotFoundError:
        return []
    declared = (found.read_text("top_level.txt") or "").split()
    listed = declared or [file.parts[0].split(".")[0] for file in found.files or [] if is_python_module(file)]
    names = sorted({name for name in listed if name.isidentifier()})
    own = [name for name in names if name.lower() == distribution.lower().replace("-", "_").replace(".", "_")]
    return own or [name for name in names if not name.startswith("_")] or names


def is_python_module(file: importlib.metadata.PackagePath) -> bool:
    """Whether a file of a distribution is a module, or a part of a package, that can be imported from site-packages."""
    return file.suffix in (".py", ".so", ".pyd") and file.parts[0] != ".."


def is_as_installed(distribution: str) -> bool:
    """Whether every file of a distribution has the size and checksum that its RECORD states."""
    for file in importlib.metadata.files(distribution) or []:
        if file.hash is None:  # RECORD itself
            continue
        try:
            content = file.locate().read_bytes()
        except OSError:
            return False
        digest = hashlib.new(file.hash.mode, content).digest()
        if base64.urlsafe_b64encode(digest).rstrip(b"=").decode() != file.hash.value:
            return False
    return True


def find_broken_imports(modules: list[str]) -> dict[str, str]:
    """What each module that cannot be imported said. A crash is put to the module that was being imported."""
    broken: dict[str, str] = {}
    rest = list(modules)
    while rest:
        code, output = run_apart(python("-c", IMPORT_SCRIPT, *rest), IMPORT_TIMEOUT_S)
        begun = [line.split()[1] for line in output.splitlines() if line.startswith("importing ")]
        for line in output.splitlines():
            if line.startswith("broken "):
                _, name, message = line.split(" ", 2)
                broken[name] = message
        if code == 0:
            return broken
        culprit = begun[-1] if begun else rest[0]
        broken[culprit] = describe_exit(code)
        rest = rest[rest.index(culprit) + 1 :]
    return broken


def check_depth_images() -> Iterator[Finding]:
    """OpenGL's renderer, and one depth image of a tilted plane by each backend beside its closed form."""
    for backend, name in (("raster", "z-buffer"), ("vtk", "OpenGL's z-buffer"), ("ray", "ray casting")):
        command = course_module("course_lib.commands.depth_image_probe", backend)
        code, output = run_apart(command, RENDER_TIMEOUT_S)
        result = read_result(output) if code == 0 else None
        cure = INSTALL_OPENGL if backend == "vtk" else MAKE_ANEW
        if result is None:
            # The first sentence of its last line: the cure that errors name as well follows here anyway.
            last = (output.strip().splitlines() or [""])[-1].split(". ")[0]
            why = f"{describe_exit(code)}{': ' if last else ''}{last[:300]}"
            yield Finding(False, f"no depth image by {name}: {why}", cure)
            continue
        if backend == "vtk":
            yield Finding(True, f"OpenGL renderer: {result['renderer']}")
        yield Finding(
            result["largest_error_mm"] <= LARGEST_ERROR_MM,
            f"depth image by {name}: largest error {result['largest_error_mm']:.4f} mm in {result['pixels']:,} pixels "
            f"of a tilted plane (at most {LARGEST_ERROR_MM} mm)",
            f"the driver draws wrongly; install Mesa's, {cure}" if backend == "vtk" else cure,
        )


def check_machine() -> Finding:
    """Cores this process may use and memory that is free; too little memory stops kernels without a word."""
    cores = processors()
    free = free_memory_gb()
    if free is None:
        return Finding(True, f"{cores} cores; this system does not tell its free memory")
    text = f"{cores} cores, {free:.1f} GB of memory free (wanted at least {LEAST_FREE_MEMORY_GB:g} GB)"
    return Finding(free >= LEAST_FREE_MEMORY_GB, text, "close other programs, or take a machine with more memory")


def free_memory_gb() -> float | None:
    """Memory that programs can still get, in 10^9 bytes; None where the system does not tell (only Linux does)."""
    try:
        with open("/proc/meminfo", encoding="ascii") as file:
            kibibytes = next(int(line.split()[1]) for line in file if line.startswith("MemAvailable:"))
        return kibibytes * 1024 / 1e9
    except (OSError, StopIteration, ValueError):
        return None


def run_apart(command: list[str], timeout_s: float) -> tuple[int | None, str]:
    """Exit code and output of a command in a process of its own; the code is None when it ran out of time."""
    try:
        done = run_child(
            command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=timeout_s
        )
    except subprocess.TimeoutExpired as expired:
        return None, (expired.stdout or b"").decode("utf-8", "replace")
    return done.returncode, done.stdout.decode("utf-8", "replace")


def describe_exit(code: int | None) -> str:
    """How a process ended, in words."""
    if code is None:
        return "no answer in time"
    return f"crashed with signal {-code}" if code < 0 else f"stopped with code {code}"
