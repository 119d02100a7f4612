#!/usr/bin/env python3
"""Sets the course up and starts it: `python3 course.py lab`, `python3 course.py test`.

The standard library only. The first call makes `.venv` from environment.txt, installs course_lib into it and sees to
the system's OpenGL libraries; every call then hands over to `python -m course_lib` in `.venv`. What is said on the way
goes to standard error, so that `--json` output stays clean.

`.venv/course-made` says that the folder is ours: nothing is written to or deleted from a `.venv` without it.
`.venv/course-ready.json` is written last and says what was installed, from where: without it `.venv` is not trusted.
`.venv/course-incomplete` stands there while an installation runs: what was killed half-way is made anew.
This file must be readable by an old Python (3.6), which has to get as far as saying that it is too old.
"""

import os
import sys

if __name__ == "__main__":
    # Python's own modules, and no json.py beside this file, in the folder that one stands in, or in PYTHONPATH.
    try:
        HERE = os.getcwd()
    except OSError:  # it is gone
        HERE = ""
    OTHERS = {"", HERE, os.path.dirname(__file__), os.path.dirname(os.path.realpath(__file__))}
    OTHERS.update(
        os.path.normpath(os.path.join(HERE, folder)) for folder in os.getenv("PYTHONPATH", "").split(os.pathsep)
    )
    sys.path[:] = [
        folder for folder in sys.path if folder.startswith(os.path.dirname(os.__file__)) or folder not in OTHERS
    ]

import contextlib
import hashlib
import importlib.util
import json
import shutil
import subprocess
import time

ROOT = os.path.dirname(os.path.realpath(__file__))
VENV = os.path.join(ROOT, ".venv")
PYTHON = os.path.join(VENV, "Scripts", "python.exe") if os.name == "nt" else os.path.join(VENV, "bin", "python")
MADE = os.path.join(VENV, "course-made")
READY = os.path.join(VENV, "course-ready.json")
INCOMPLETE = os.path.join(VENV, "course-incomplete")
OPENGL_READY = os.path.join(VENV, "course-opengl-ready")
OPENGL_FAILED = os.path.join(VENV, "course-opengl-failed")
OPENGL_PACKAGES = ["libegl1", "libgl1-mesa-dri", "libgl1"]

# What Python's venv, pip and the lessons' JupyterLab put there, beside our own files, whose names begin with "course-".
IN_VENV = (
    "bin",
    "include",
    "lib",
    "lib64",
    "share",
    "etc",
    "man",
    "pyvenv.cfg",
    ".lock",
    ".DS_Store",
    "CACHEDIR.TAG",
    ".gitignore",
    "Include",
    "Lib",
    "Scripts",
)

KEPT = (  # the same as in course_lib/child.py
    "PYTHONDONTWRITEBYTECODE",
    "PYTHONFAULTHANDLER",
    "PYTHONHASHSEED",
    "PYTHONIOENCODING",
    "PYTHONPYCACHEPREFIX",
    "PYTHONUNBUFFERED",
    "PYTHONUTF8",
)

HINT = """
Options of one command: python3 course.py COMMAND --help
The first call sets up .venv: a download of about 450 MB, 1.9 GB on disk, one or a few minutes.
"""

# Asks for what VTK asks for: an EGL device, a display without a surface, or the default one. It runs in a process of
# its own, because a broken driver crashes the process that loads it.
OPENGL_PROBE = """
import ctypes, sys
ctypes.CDLL("libGL.so.1")
egl = ctypes.CDLL("libEGL.so.1")
pointer = ctypes.c_void_p
egl.eglGetProcAddress.restype = egl.eglGetDisplay.restype = pointer
egl.eglInitialize.argtypes = [pointer, pointer, pointer]
egl.eglGetDisplay.argtypes = [pointer]
find = lambda name, result, *kinds: (lambda a: a and ctypes.CFUNCTYPE(result, *kinds)(a))(egl.eglGetProcAddress(name))
platform_display = find(b"eglGetPlatformDisplayEXT", pointer, ctypes.c_int, pointer, pointer)
query_devices = find(b"eglQueryDevicesEXT", ctypes.c_int, ctypes.c_int, pointer, pointer)
displays = [egl.eglGetDisplay(None)]
if platform_display:
    displays.insert(0, platform_display(0x31DD, None, None))
    devices, count = (pointer * 16)(), ctypes.c_int(0)
    if query_devices and query_devices(16, devices, ctypes.byref(count)):
        displays[:0] = [platform_display(0x313F, device, None) for device in devices[: count.value]]
sys.exit(0 if any(display and egl.eglInitialize(display, None, None) for display in displays) else 1)
"""


class SetupError(Exception):
    """What stopped the set-up, and what to do about it, in one or two sentences."""


def say(text):
    print(text, file=sys.stderr, flush=True)


def python_version():
    return ".".join(str(number) for number in sys.version_info[:2])


def main(arguments):
    if sys.version_info < (3, 11):  # noqa: UP036
        say(
            f"The course needs Python 3.11 or newer; this is Python {python_version()}. Install a newer one from your "
            "system's packages or python.org and call it by name, for example: python3.11 course.py lab"
        )
        return 1
    if not arguments or arguments[0] in ("-h", "--help", "help"):
        print(usage() + HINT, end="")
        return 0 if arguments else 2
    try:
        if why_not_ready() is not None:
            if {"-h", "--help"} & set(arguments):
                print(usage() + HINT, end="")
                return 0
            set_up()
        if not {"-h", "--help"} & set(arguments):
            see_to_opengl()
        return hand_over(arguments)
    except SetupError as error:
        say(f"error: {error}")
    except KeyboardInterrupt:
        say("\nStopped. Call course.py again to go on.")
        return 130
    except OSError as error:
        say(f"error: {explain_os_error(error)}")
    return 1


def usage():
    """The list of commands. course_lib.cli imports nothing but the standard library, so it is there before .venv is."""
    sys.path.append(ROOT)
    sys.dont_write_bytecode = True  # help leaves no file behind
    from course_lib import cli

    return cli.usage()


def hand_over(arguments):
    command = [PYTHON, "-P", "-m", "course_lib", *arguments]
    if os.name == "nt":  # execv does not wait there
        return subprocess.call(command, env=clean_environment())
    sys.stdout.flush()
    os.execve(PYTHON, command, clean_environment())


def clean_environment():
    """The environment without Python's variables that say what code it runs: PYTHONPATH, PYTHONHOME and their like."""
    return {name: value for name, value in os.environ.items() if name in KEPT or not name.startswith("PYTHON")}


def wanted():
    """What a trusted `.venv` was made from: the lock and the package's metadata, this folder, and its Python."""
    digest = hashlib.sha256()
    for name in ("environment.txt", "pyproject.toml"):
        with open(os.path.join(ROOT, name), "rb") as file:
            digest.update(file.read())
    return {"environment": digest.hexdigest(), "folder": ROOT, "python": os.path.realpath(PYTHON)}


def count_packages():
    """Number of installed packages in `.venv`: one that was deleted by hand shows here, at no cost."""
    library = os.path.join(VENV, "Lib", "site-packages") if os.name == "nt" else os.path.join(VENV, "lib")
    if os.name != "nt" and os.path.isdir(library):
        library = os.path.join(library, next(iter(sorted(os.listdir(library))), ""), "site-packages")
    return sum(name.endswith(".dist-info") for name in os.listdir(library)) if os.path.isdir(library) else 0


def why_not_ready():
    """None when `.venv` can be used; else (the sentence to say, whether it must be made anew)."""
    if not os.path.lexists(VENV):
        return "There is no .venv yet: setting it up.", True
    refuse_what_is_not_ours()
    if os.path.exists(INCOMPLETE):
        return "An earlier set-up was interrupted and left .venv half-made: making it anew.", True
    if not os.path.exists(PYTHON):
        return "The .venv here has no working Python (half-made, or its Python was removed): making it anew.", True
    try:
        with open(READY, encoding="utf-8") as file:
            found = json.load(file)
        count = found.pop("packages")
    except (OSError, ValueError, KeyError, AttributeError):
        return "The .venv here is half-made: completing it.", False
    now = wanted()
    if found.get("folder") != now["folder"] or found.get("python") != now["python"]:
        return "The .venv here was made in another folder or by another Python: making it anew.", True
    if found != now:
        return "environment.txt or pyproject.toml has changed: bringing .venv up to date.", False
    if not isinstance(count, int) or count_packages() < count:
        return "Packages are missing from .venv: completing it.", False
    return None


def refuse_what_is_not_ours():
    """Raises SetupError where `.venv` is a file, a link, or a folder that course.py did not make.

    Earlier versions of course.py set no mark of their own; an installation of theirs, finished or interrupted, shows by
    the two files that it left.
    """
    if os.path.realpath(VENV) != os.path.join(os.path.realpath(ROOT), ".venv"):  # a junction of Windows shows here too
        raise SetupError(
            f"{VENV} is a link to {os.path.realpath(VENV)}, and course.py touches nothing that is elsewhere. "
            "Remove the link (not what it leads to) and call course.py again."
        )
    if not os.path.isdir(VENV):
        raise SetupError(f"{VENV} is not a folder. Move it away and call course.py again.")
    marks = [mark for mark in (MADE, READY, INCOMPLETE) if os.path.isfile(mark) and not os.path.islink(mark)]
    if os.listdir(VENV) and not marks:
        raise SetupError(f"{VENV} was not made by course.py. Move it away and call course.py again.")


def refuse_to_delete_what_is_not_ours():
    """Raises SetupError where `.venv` has to be made anew and holds what no set-up puts there."""
    others = sorted(name for name in os.listdir(VENV) if name not in IN_VENV and not name.startswith("course-"))
    if others:
        raise SetupError(
            f"{VENV} must be made anew and holds what course.py did not put there: {', '.join(others[:5])}. Move that "
            "away and call course.py again."
        )


def put(path, text=""):
    """Writes a file of ours in `.venv` in one step; a link in its place is replaced, not followed."""
    part = path + ".part"
    if os.path.lexists(part):
        os.remove(part)
    with open(part, "x", encoding="utf-8") as file:
        file.write(text)
    os.replace(part, path)


def set_up():
    """Makes or repairs `.venv`; only one course.py does it at a time."""
    if not os.path.exists(os.path.join(ROOT, "environment.txt")):
        raise SetupError("environment.txt is missing beside course.py. Download the course again, whole.")
    see_to_venv_module()
    with only_one_at_a_time() as lock:
        state = why_not_ready()  # another course.py may have done it meanwhile
        if state is None:
            return
        sentence, anew = state
        os.makedirs(VENV, exist_ok=True)
        if anew:
            refuse_to_delete_what_is_not_ours()
        say(sentence)
        put(MADE, "course.py made this folder, and deletes what is in it where it has to be made anew.\n")
        if not anew and run([PYTHON, "-P", "-c", "import pip, sys; sys.exit(sys.version_info < (3, 11))"], lock)[0]:
            say("Its Python is too old or has no pip: making .venv anew.")
            refuse_to_delete_what_is_not_ours()
            anew = True
        put(INCOMPLETE)
        if anew:
            make_venv(lock)
        install(lock)
        stamp = wanted()
        stamp["packages"] = count_packages()
        put(READY, json.dumps(stamp, indent=1))
        os.remove(INCOMPLETE)


def make_venv(lock):
    """An empty environment; the mark of an unfinished one is never away while files are."""
    for name in os.listdir(VENV):
        path = os.path.join(VENV, name)
        if path not in (MADE, INCOMPLETE):
            shutil.rmtree(path) if os.path.isdir(path) and not os.path.islink(path) else os.remove(path)
    code, lines = run([getattr(sys, "_base_executable", sys.executable), "-P", "-m", "venv", VENV], lock)
    if code:
        raise SetupError(
            f"could not make .venv. If Python's module venv is incomplete, on Debian or Ubuntu: "
            f"{apt_install_line([venv_package()])}; then call course.py again. Python said: {last_lines(lines)}"
        )


def install(lock):
    with open(os.path.join(ROOT, "environment.txt"), encoding="utf-8") as file:
        total = sum(line[0] not in "# \n" for line in file)
    say("Installing the environment into .venv, a minute or a few:")
    pip = [PYTHON, "-P", "-m", "pip", "install", "--no-deps", "--no-user", "--disable-pip-version-check", "--no-input"]
    started = {"count": 0}

    def progress(line):
        # pip names each package once before it installs them together.
        if line.startswith(("Collecting ", "Requirement already satisfied: ")):
            started["count"] += 1
            name = line.split(": ")[-1].replace("Collecting ", "").split("==")[0].split(" ")[0]
            show(f"  {started['count']} of up to {total} packages: {name}", started["count"] % 50 == 0)
        elif line.startswith("Installing collected packages"):
            show("  writing the packages into .venv ...", True)

    code, lines = run([*pip, "-r", os.path.join(ROOT, "environment.txt")], lock, progress)
    if not code:
        code, lines = run([*pip, "--no-build-isolation", "-e", ROOT], lock)
    if sys.stderr.isatty():
        say("" if code else "\r\033[K  done.")
    if code:
        if code > 0:
            os.remove(INCOMPLETE)  # pip ended by itself, with nothing half-written: the next call goes on from here
        raise SetupError(explain_pip(lines))
    # What fails here would compile when it is first used, and `check` says why.
    run([PYTHON, "-P", "-m", "course_lib.commands.warm_up"], lock)


def show(text, milestone):
    """One line that rewrites itself on a terminal; elsewhere only the milestones."""
    if sys.stderr.isatty():
        print("\r\033[K" + text[: shutil.get_terminal_size().columns - 1], end="", file=sys.stderr, flush=True)
    elif milestone:
        say(text)


def run(command, lock, each_line=None):
    """Exit code and output lines of a command. It inherits the lock: an orphan of a killed course.py keeps it."""
    inherited = {} if os.name == "nt" or lock is None else {"pass_fds": [lock.fileno()]}
    process = subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        env=clean_environment(),
        **inherited,
    )
    lines = []
    try:
        for raw in process.stdout:
            lines.append(raw.decode("utf-8", "replace").rstrip())
            if each_line:
                each_line(lines[-1].strip())
        return process.wait(), lines
    except BaseException:
        process.terminate()
        process.wait()
        raise


@contextlib.contextmanager
def only_one_at_a_time():
    """Holds a lock on course.py itself: the system lets go of it however the process ends, and no file is left."""
    path = os.path.abspath(__file__)
    try:
        lock = open(path, "r+b")  # some network file systems lock only files open for writing
    except OSError:
        lock = open(path, "rb")
    with lock:
        if os.name == "nt":
            import msvcrt

            lock.seek(1 << 30)  # beyond the file's end, so that nobody is kept from reading it

            def take(wait):
                msvcrt.locking(lock.fileno(), msvcrt.LK_LOCK if wait else msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            def take(wait):
                fcntl.flock(lock, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))

        try:
            take(wait=False)
        except (BlockingIOError, PermissionError):
            say("Another course.py is setting up .venv: waiting for it to finish (Ctrl-C stops waiting).")
            take(wait=True)
        yield lock


def see_to_venv_module():
    """Installs Python's module that makes environments, which Debian keeps apart; SetupError where it cannot."""
    missing = missing_venv_modules()
    if not missing:
        return
    said = ""
    # Only the system's own Python can be completed by the system's packages.
    if shutil.which("apt-get") and sys.base_prefix == "/usr" and os.geteuid() == 0:
        say(f"Python's module {missing[0]!r}, which makes .venv, is missing: installing {venv_package()}")
        said = f" It could not be installed: {last_lines(apt_install([venv_package()])[1]).rstrip('.')}."
        importlib.invalidate_caches()
        if not missing_venv_modules():
            return
    raise SetupError(
        f"this Python {python_version()} comes without its module {missing[0]!r}, which makes .venv.{said} On Debian "
        f"or Ubuntu, as an administrator: {apt_install_line([venv_package()])}; then call course.py again."
    )


def missing_venv_modules():
    return [module for module in ("venv", "ensurepip") if importlib.util.find_spec(module) is None]


def venv_package():
    """Debian's package of the modules venv and ensurepip."""
    return f"python{python_version()}-venv"


def apt_install_line(packages):
    return "apt-get install -y --no-install-recommends " + " ".join(packages)


def apt_install(packages):
    """Exit code and output of installing Debian's packages, as root; where apt-get complains, what it complains of.

    Without a network, `apt-get update` says so and ends with code 0; the installation then says only "no candidate".
    """
    os.environ.setdefault("DEBIAN_FRONTEND", "noninteractive")
    updated = run(["apt-get", "update"], None)[1]
    code, lines = run([*apt_install_line(packages).split(), "-o", "DPkg::Lock::Timeout=120"], None)
    complaints = [line for line in updated if line.startswith(("W: Failed to fetch", "E: "))][:1]
    complaints += [line for line in lines if line.startswith("E: ")]
    return code, complaints or lines


def see_to_opengl():
    """Installs the system's OpenGL libraries, or prints the line that does; remembers a success."""
    if not sys.platform.startswith("linux") or os.path.exists(OPENGL_READY):
        return
    if not opengl_works():
        install_line = apt_install_line(OPENGL_PACKAGES)
        if not shutil.which("apt-get"):
            say("OpenGL is missing: install Mesa's EGL and OpenGL drivers with your system's package manager.")
            return
        if os.geteuid() != 0:
            say("OpenGL is missing, and installing it needs an administrator: sudo " + install_line)
            return
        if tried_today(OPENGL_FAILED):
            say("OpenGL is missing, and installing it failed earlier today. Run: " + install_line)
            return
        say("OpenGL is missing: installing " + " ".join(OPENGL_PACKAGES))
        code, lines = apt_install(OPENGL_PACKAGES)
        if code or not opengl_works():
            say(f"OpenGL could not be installed ({last_lines(lines)}). Run: {install_line}")
            remember(OPENGL_FAILED)
            return
    remember(OPENGL_READY)


def remember(path):
    with contextlib.suppress(OSError):
        put(path)


def tried_today(path):
    # apt-get without a network takes its time to fail: not with every call.
    return os.path.exists(path) and time.time() - os.path.getmtime(path) < 24 * 3600


def opengl_works():
    return run([sys.executable, "-P", "-c", OPENGL_PROBE], None)[0] == 0


def last_lines(lines, count=3):
    return " / ".join([line.strip() for line in lines if line.strip()][-count:])[-400:] or "nothing"


def explain_pip(lines):
    """What stopped pip, in a sentence, with its last lines."""
    text = "\n".join(lines)
    network = ("NewConnectionError", "Timeout", "ProxyError", "resolve", "Connection refused", "timed out", "SSLError")
    if "No space left" in text:
        return "the disk is full: the environment needs about 3 GB. Make room and call course.py again."
    if "Permission denied" in text:
        return "pip may not write here. Put the course into a folder of your own. " + last_lines(lines)
    errors = [line for line in lines if line.startswith("ERROR")] or lines
    if any(word in text for word in network) or "(from versions: none)" in text:
        return (
            "no package could be downloaded: is there a network connection, and does pip need a proxy? "
            "Connect and call course.py again; it goes on where it stopped. pip said: " + last_lines(errors, 1)
        )
    return "pip could not install the environment. Call course.py again, or see what pip said: " + last_lines(errors)


def explain_os_error(error):
    if isinstance(error, PermissionError):
        place = error.filename or ROOT
        return f"no permission to write {place}. Put the course into a folder of your own and call course.py there."
    return f"{error}. Repair that and call course.py again."


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
