"""The course's command line: a table of commands, each a module of `courseware.commands`.

A command module has `add_arguments(parser)` and `run(arguments)`, which returns the exit code; its docstring's first
line is shown by `--help`. It may have `join_words(words)`, to mend what argparse would misread (`--up -y`), and
`PASSES_ARGUMENTS_ON = True`, to get the words that its parser does not know as `arguments.passed_on`.
"""

import argparse
import importlib
import importlib.util
import os
import re
import signal
import sys
import threading
import traceback
import warnings
from collections.abc import Callable, Iterable, Sequence
from difflib import get_close_matches
from types import ModuleType
from typing import NoReturn

from course_lib import __version__

# For whom -> name as typed -> (module of courseware.commands, one line for the list of commands).
GROUPS: dict[str, dict[str, tuple[str, str]]] = {
    "learn": {
        "lab": ("lab", "open the lessons in JupyterLab (on this computer only)"),
        "progress": ("progress_page", "show how far you have come: predictions typed, checks right"),
        "check": ("check", "look at the environment: packages, OpenGL, one rendered depth image"),
        "test": ("test", "run every test, the notebooks included; arguments go on to pytest"),
    },
    "use": {
        "localize": ("localize", "localize a recorded depth-camera sequence in a mesh map"),
        "locate": ("locate", "find where two panoramas were taken, on a semantic map"),
        "stereo": ("stereo", "match a pair of panoramas and list the distances of boxed objects"),
        "ambiguity": ("ambiguity", "show where in a semantic map the objects could be confused"),
        "compare": ("compare", "compare filters in six degrees of freedom on a recording with its truth"),
        "demo corridor": ("demo", "run paper 1's corridor experiment and print its table"),
        "demo room": ("demo", "run paper 2's room experiment and print its tables"),
        "demo rooms": ("demo", "run paper 2's experiment in randomly generated rooms, with intervals"),
        "demo walk": ("demo", "carry a depth camera through generated rooms: errors in six degrees of freedom"),
        "demo lost": ("demo", "kidnap the camera, start it anywhere, and count how often it finds itself"),
        "demo trouble": ("demo", "disturb the sensors: the outcome of each frame, recovery, wrong poses"),
        "demo finale": ("demo", "both papers in one world: panoramas find the robot, the depth camera refines"),
    },
    "teach": {
        "handout": ("handout", "make a class's folder: lessons without solutions, and the teacher's graded tests"),
        "grade": ("grade", "grade a folder of submissions within walls: points, feedback pages, CSV tables"),
        "score": ("score", "score a project that was handed in, on its hidden seeds"),
    },
}
COMMANDS = {name: command for group in GROUPS.values() for name, command in group.items()}

EXIT_BAD_INPUT = 2
EXIT_FAULT = 1
EXIT_INTERRUPTED = 130  # 128 + SIGINT, as shells report it

NOT_HERE = "handout and grade do not work in this copy of the course: it was made for students, without the grader"

# argparse's words -> ours. What is not among them (another Python's words) is told as it is.
_SAID = (
    (r"argument (\S+): invalid int value: (.*)", r"\1 must be a whole number; got \2"),
    (r"argument (\S+): invalid float value: (.*)", r"\1 must be a number; got \2"),
    (r"argument (\S+): invalid choice: (.*?) \(choose from (.*)\)", r"\1 must be one of \3; got \2"),
    (r"argument (\S+): expected one argument", r"\1 needs a value"),
    (r"argument (\S+): expected (.*)", r"\1 needs \2"),
    (r"the following arguments are required: (.*)", r"\1 must be given"),
)


def usage() -> str:
    """Return the list of commands, grouped by the people who use them."""
    lines = ["usage: python3 course.py COMMAND [options]"]
    for group, commands in GROUPS.items():
        lines += ["", f"{group}:", *(f"  {name:<13}  {line}" for name, (_, line) in commands.items())]
    if importlib.util.find_spec("courseware.classroom") is None:
        lines += ["", f"{NOT_HERE}."]
    lines += ["", "Options of one command: python3 course.py COMMAND --help"]
    lines += ["Version of the course: python3 course.py --version"]
    lines += ["The first call sets up .venv: a download of about 415 MB, 1.6 GB on disk, one or a few minutes."]
    return "\n".join(lines) + "\n"


def version() -> str:
    """Return the version of the course. Version 1.0.0 is told as 1.0."""
    return __version__.removesuffix(".0")


def find_command(words: list[str]) -> tuple[str, list[str]] | None:
    """Return the command that `words` begin with (the longest name wins) and the words after it, or None."""
    for length in (2, 1):
        name = " ".join(words[:length])
        if len(words) >= length and name in COMMANDS:
            return name, words[length:]
    return None


def main(words: list[str]) -> int:
    """Run the command that `words` name, and return its exit code."""
    if not words or words[0] in ("-h", "--help", "help"):
        print(usage(), end="")
        return 0 if words else EXIT_BAD_INPUT
    if words[0] == "--version":
        print(version())
        return 0
    found = find_command(words)
    if found is None:
        print(f"error: there is no command {' '.join(words[:2])!r}{what_instead(words)}", file=sys.stderr)
        return EXIT_BAD_INPUT
    name, rest = found
    return call(lambda: importlib.import_module(f"courseware.commands.{COMMANDS[name][0]}"), f"course.py {name}", rest)


def what_instead(words: list[str]) -> str:
    """Return how to go on where the words name no command: a similar name, or all names."""
    longer = [name for name in COMMANDS if name.split()[0] == words[0]]
    # A higher bar for two words: the first alone makes demo corridor and demo room alike.
    like = meant(" ".join(words[:2]), COMMANDS, 0.8) if len(words) > 1 else ""
    like = like or (f"; did you mean: {', '.join(longer)}?" if longer else meant(words[0], COMMANDS))
    groups = (f"to {group}: {', '.join(commands)}" for group, commands in GROUPS.items())
    return like or f"; the commands are, {'; '.join(groups)}"


def meant(word: str, names: Iterable[str], cutoff: float = 0.6) -> str:
    """Return "; did you mean ...?" with the names that are most like a word, or nothing."""
    lower = {name.lower(): name for name in names}
    found = [lower[name] for name in get_close_matches(word.lower(), lower, cutoff=cutoff)]
    return f"; did you mean {' or '.join(found)}?" if found else ""


class CommandParser(argparse.ArgumentParser):
    """Ends with code 2 and one sentence, with the nearest name, where the words do not fit."""

    def parse_args(self, args: Sequence[str], namespace: None = None) -> argparse.Namespace:
        if any(word == "" or re.fullmatch(r"--[\w-]+=", word) for word in args):
            self.error("an empty word stands where a value is expected (a variable that is not set?): give one")
        found, others = self.parse_known_args(args, namespace)
        if others:
            name = others[0].partition("=")[0]
            options = [option for action in self._actions for option in action.option_strings]
            like = f"option {name!r}{meant(name, options)}" if name.startswith("-") else f"place for the word {name!r}"
            self.error(f"{' '.join(others)}: there is no {like}")
        return found

    def error(self, message: str) -> NoReturn:
        """Print one sentence on standard error, and end with code 2."""
        for said, ours in _SAID:
            message = re.sub(f"^{said}$", ours, message)
        stop = "" if message.endswith("?") else "."
        self.exit(2, f"error: {message}{stop} All options: python3 {self.prog} --help\n")


def tool(module_name: str) -> int:
    """Run a maintainers' tool, a module of `tools` that was started by name, with the words of the command line."""
    module = sys.modules["__main__"]
    return call(lambda: module, f"python -m {module_name}", sys.argv[1:])


def call(load: Callable[[], ModuleType], program: str, words: list[str]) -> int:
    """Run a command's module with `words` and return its exit code; an error is one line instead of a traceback."""
    debug = os.environ.get("COURSE_DEBUG", "") not in ("", "0")
    # One line, without the place in the library where it was noticed.
    warnings.formatwarning = lambda message, *place, **told: f"warning: {message}\n"
    try:
        module = load()
        arguments = parse(program, module, words)
        debug = debug or arguments.debug
        raise_on_sigterm()
        code = module.run(arguments)
        sys.stdout.flush()
        return code
    except KeyboardInterrupt as stop:
        if debug:
            traceback.print_exc()
        print("\nStopped.", file=sys.stderr)
        return stop.args[0] if stop.args else EXIT_INTERRUPTED
    except BrokenPipeError:
        # Whoever read our output (head, less) has gone; Python would complain once more when it closes stdout.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return EXIT_FAULT
    except Exception as error:
        if debug:
            traceback.print_exc()
        return report(error)


def raise_on_sigterm() -> None:
    """Let SIGTERM and SIGHUP end a command as Ctrl-C does, so that temporary files are removed. Exit codes 143, 129."""

    def end(number: int, _: object) -> None:
        raise KeyboardInterrupt(128 + number)

    if threading.current_thread() is not threading.main_thread():
        return
    for name in ("SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)
        if number and signal.getsignal(number) is signal.SIG_DFL:  # nohup stays as it is
            signal.signal(number, end)


def parse(program: str, module: ModuleType, words: list[str]) -> argparse.Namespace:
    """Parse the arguments of one command; the parser ends the process where they do not fit."""
    description = (module.__doc__ or "").strip().split("\n")[0]
    parser = CommandParser(prog=program, description=description, allow_abbrev=False)
    module.add_arguments(parser)
    words = module.join_words(words) if hasattr(module, "join_words") else words
    parser.add_argument("--debug", action="store_true", help="show the traceback of an error")
    if not getattr(module, "PASSES_ARGUMENTS_ON", False):
        return parser.parse_args(words)
    arguments, arguments.passed_on = parser.parse_known_args(words)
    return arguments


def report(error: Exception) -> int:
    """Print one line about `error`, and return the exit code: 2 for what the user can mend, 1 for a fault of ours."""
    code, told = EXIT_FAULT, f"{type(error).__name__}: {error} (--debug shows where)"
    if isinstance(error, ImportError) and (error.name or "").startswith("courseware.classroom"):
        code, told = EXIT_BAD_INPUT, f"{NOT_HERE}. Use the teacher's copy"
    elif isinstance(error, ImportError):
        told = f"{error}. See what is missing: python3 course.py check"
    elif isinstance(error, MemoryError):
        code, told = EXIT_BAD_INPUT, f"there is not enough memory ({error}): ask for less, such as fewer particles"
    elif isinstance(error, (ValueError, OSError, RuntimeError)):
        code, told = EXIT_BAD_INPUT, str(error)
    print(f"error: {told}", file=sys.stderr)
    return code
