#!/usr/bin/env python3
"""Set the course up and start it: `python3 course.py lab`, `python3 course.py test`.

The standard library only. The first call makes `.venv` from environment.txt with course_lib and courseware. `test`
adds the rest of environment-test.txt. Every call then hands over to `python -m courseware` there. What it says goes to
stderr.
A `.venv` without `course-made` is not ours and never touched. `course-ready.json` is written last: without it, `.venv`
is made anew. Even Python 3.6 must be able to read this file, so that it can say that it is too old.
"""

import os
import sys

if __name__ == "__main__":  # a json.py beside this file must not be taken for Python's
    sys.path[:] = [path for path in sys.path if os.path.realpath(path) != os.path.dirname(os.path.realpath(__file__))]

import contextlib
import ctypes
import hashlib
import importlib.util
import json
import re
import shutil
import subprocess
import time

ROOT = os.path.dirname(os.path.realpath(__file__))
VENV = os.path.join(ROOT, ".venv")
PYTHON = os.path.join(VENV, "Scripts", "python.exe") if os.name == "nt" else os.path.join(VENV, "bin", "python")
MADE, READY = os.path.join(VENV, "course-made"), os.path.join(VENV, "course-ready.json")
APT = "apt-get install -y --no-install-recommends "
OPENGL = "libegl1 libgl1-mesa-dri libgl1"  # binder/apt.txt has the same
LESSONS, TESTS = "environment.txt", "environment-test.txt"
# Python's variables that say how it runs. The others (PYTHONPATH, PYTHONHOME ...) say which code, and are dropped.
KEPT = "DONTWRITEBYTECODE FAULTHANDLER HASHSEED IOENCODING PYCACHEPREFIX UNBUFFERED UTF8".split()
HELP = {"-h", "--help", "help", "--version"}


class SetupError(Exception):
    """What stopped the set-up, and what to do about it, in one or two sentences."""


def say(text):
    print(text, file=sys.stderr, flush=True)


def main(arguments):
    if sys.version_info < (3, 11):  # noqa: UP036
        say(
            f"The course needs Python 3.11 or newer; this is {sys.version_info[0]}.{sys.version_info[1]}. Install a "
            "newer one from your system's packages or python.org and call it by name: python3.11 course.py lab"
        )
        return 1
    try:
        if not arguments or arguments[0] in HELP:
            return command_line().main(arguments)
        lock = TESTS if arguments[0] == "test" else LESSONS
        if why_not_ready(lock):
            if HELP & set(arguments):
                return command_line().main(["--help"])
            set_up(lock)
        command = [PYTHON, "-P", "-m", "courseware", *arguments]
        if os.name == "nt":  # execve does not wait there
            return subprocess.call(command, env=clean_environment())
        os.execve(PYTHON, command, clean_environment())
    except SetupError as error:
        say(f"error: {error}")
    except KeyboardInterrupt:
        say("\nStopped. Call course.py again to go on.")
        return 130
    except OSError as error:
        say(f"error: {error}. Does this folder belong to you, and is there room on the disk?")
    return 1


def command_line():
    """courseware.cli. It imports only the standard library, so it works before .venv is there."""
    sys.path.append(ROOT)
    sys.dont_write_bytecode = True  # help leaves no file behind
    return importlib.import_module("courseware.cli")


def clean_environment():
    return {name: value for name, value in os.environ.items() if name[:6] != "PYTHON" or name[6:] in KEPT}


def put(path, text):
    with open(path + ".part", "w", encoding="utf-8") as file:
        file.write(text)
    os.replace(path + ".part", path)


def wanted(lock):
    """What `.venv` must have been made from: the lock, the package's metadata, this folder, and its Python."""
    digest = hashlib.sha256()
    for name in (lock, "pyproject.toml", os.path.join("courseware", "pyproject.toml")):
        with open(os.path.join(ROOT, name), "rb") as file:
            digest.update(file.read())
    return {"environment": digest.hexdigest(), "lock": lock, "folder": ROOT, "python": os.path.realpath(PYTHON)}


def why_not_ready(lock):
    """None when `.venv` has what `lock` pins; else (the sentence to say, whether it must be made anew, the lock)."""
    if not os.path.lexists(VENV):
        return "There is no .venv yet: setting it up.", True, lock
    # A link, which shows in its real path on Windows too, may lead to somebody's files.
    if os.path.realpath(VENV) != VENV or not os.path.isdir(VENV) or (os.listdir(VENV) and not os.path.isfile(MADE)):
        raise SetupError(f"{VENV} was not made by course.py. Move it away and call course.py again.")
    try:
        with open(READY, encoding="utf-8") as file:
            found = json.load(file)
        lock = TESTS if found.get("lock") == TESTS else lock  # what the tests need is never taken away
        changed = [name for name, value in wanted(lock).items() if found.get(name) != value]
    except (OSError, ValueError, AttributeError):
        return "The .venv here is half-made, because a set-up was interrupted: making a new one.", True, lock
    if "folder" in changed or "python" in changed or not os.path.exists(PYTHON):
        return "The .venv here was made in another folder or by another Python: making a new one.", True, lock
    if "lock" in changed and "lock" in found:
        return "The tests need more packages than the lessons: adding them, about 120 MB.", False, lock
    return (lock + " or pyproject.toml has changed: bringing .venv up to date.", False, lock) if changed else None


def set_up(lock):
    """Make or repair `.venv`. Only one course.py does it at a time."""
    with only_one_at_a_time():
        sentence, anew, lock = why_not_ready(lock) or ("", False, lock)
        if not sentence:
            return  # another course.py has done it meanwhile
        say(sentence)
        see_to_the_system(anew)
        if anew:
            make_venv()
        install(lock)
        run([PYTHON, "-P", "-m", "courseware.commands.warm_up"])  # what fails here is told by `check`
        put(READY, json.dumps(wanted(lock), indent=1))


def see_to_the_system(anew):
    """Install what the system lacks, or name all of it at once, before anything is downloaded. OpenGL is optional."""
    without_venv = anew and importlib.util.find_spec("ensurepip") is None  # Debian keeps it apart
    missing = [f"python{sys.version_info[0]}.{sys.version_info[1]}-venv"] * without_venv
    try:
        if sys.platform.startswith("linux"):
            ctypes.CDLL("libEGL.so.1"), ctypes.CDLL("libGL.so.1")
    except OSError:
        missing.append(OPENGL)
    if missing and apt_install(" ".join(missing)):
        line = f"On Debian or Ubuntu, as an administrator: {APT}{' '.join(missing)}"
        if without_venv:
            raise SetupError(f"this Python has no ensurepip, which makes .venv. {line}; then call course.py again.")
        say(f"OpenGL is missing. It is optional, and `course.py check` says what is lost without it. {line}")


def make_venv():
    """Make an empty environment. The mark that says that it is ours is never away while files are there."""
    os.makedirs(VENV, exist_ok=True)
    put(MADE, "course.py made this folder, and deletes what is in it before it makes a new one.\n")
    for name in os.listdir(VENV):
        path = os.path.join(VENV, name)
        if path != MADE:
            shutil.rmtree(path) if os.path.isdir(path) and not os.path.islink(path) else os.remove(path)
    code, output = run([getattr(sys, "_base_executable", sys.executable), "-P", "-m", "venv", VENV])
    if code:
        raise SetupError(f"could not make .venv. Python said: {last_lines(output)}")


def install(lock):
    """Install the pinned packages, then course_lib and courseware in place. Meanwhile the stamp is away."""
    say("Installing the environment into .venv, a minute or a few ...")
    if os.path.exists(READY):
        os.replace(READY, READY + ".earlier")
    # uv is faster, but does not read pip's settings, which may say where packages come from.
    installers = [["uv", "pip", "install", "--python", PYTHON]] if shutil.which("uv") else []
    for pip in [*installers, [PYTHON, "-P", "-m", "pip", "install"]]:
        code, output = run([*pip, "--no-deps", "-r", os.path.join(ROOT, lock)], counted=True)
        if not code:
            ours = ["-e", ROOT, "-e", os.path.join(ROOT, "courseware")]
            code, output = run([*pip, "--no-deps", "--no-build-isolation", *ours])
            break
    if code:
        if os.path.exists(READY + ".earlier"):  # those packages are still there, and the next call tries again
            os.replace(READY + ".earlier", READY)
        raise SetupError(why_not_installed(output))


def why_not_installed(output):
    """What stopped pip or uv, in a sentence, with the last lines that it printed."""
    why = "pip could not install the environment."
    if "No space left" in output:
        why = "the disk is full: the environment needs about 3 GB. Make room and call course.py again."
    elif "Permission denied" in output:
        why = "pip may not write here. Put the course into a folder of your own."
    elif re.search(r"NewConn|Timeout|timed out|Proxy|resolve|refused|SSL|versions: none|sending req|dns|fetch", output):
        why = "no package could be downloaded. Is there a network connection, and does pip need a proxy?"
    return why + " pip said: " + last_lines(output)


def run(command, counted=False):
    """Exit code and output of a command. counted: show on a terminal which package pip has come to."""
    lines, pipes = [], {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
    with subprocess.Popen(command, env=clean_environment(), **pipes) as process:
        for raw in process.stdout:
            lines.append(raw.decode("utf-8", "replace").rstrip())
            if counted and sys.stderr.isatty() and lines[-1].startswith("Collecting "):
                print("\r\033[K  " + lines[-1][:70], end="\r", file=sys.stderr, flush=True)
    return process.returncode, "\n".join(lines)


def last_lines(output):
    lines = [line.strip() for line in output.splitlines() if line.strip()]
    return " / ".join(([line for line in lines if line.startswith(("ERROR", "E: "))] or lines)[-3:])[-400:] or "nothing"


@contextlib.contextmanager
def only_one_at_a_time():
    """Hold a lock on this file. The system releases it when the process ends, and no other file is left."""
    with open(os.path.abspath(__file__), "r+b") as file:
        if not locked(file):
            say("Another course.py is setting up .venv: waiting for it to finish (Ctrl-C stops waiting).")
            while not locked(file):
                time.sleep(0.5)
        yield


def locked(file):  # whether it could be locked
    try:
        if os.name == "nt":
            import msvcrt

            file.seek(1 << 30)  # beyond the file's end, so that nobody is kept from reading it
            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        return True
    except (BlockingIOError, PermissionError):
        return False


def apt_install(packages):
    """Install packages of Debian. Not 0: they are not there, because this is no root, no Debian, or no network."""
    if not shutil.which("apt-get") or os.geteuid() != 0:
        return 1
    say("Installing " + packages)
    os.environ.setdefault("DEBIAN_FRONTEND", "noninteractive")
    run(["apt-get", "update"])
    return run((APT + packages).split())[0]


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
