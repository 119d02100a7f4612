"""Run the lessons and store what they show: every output, every picture, and no widget state.

Each notebook runs in a fresh kernel, without a network. It is written back only after its last cell ran without an
error, in one form, so that a difference in git is a difference in the lesson.
"""

import argparse
import ast
import inspect
import math
import os
import re
import sys
import textwrap
import time
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path

import nbformat
from jupyter_client.kernelspec import KernelSpecManager
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError, CellTimeoutError, DeadKernelError

from course_lib.files import atomic_write, temporary_folder
from courseware.commands.saved_panels import drop_widgets
from courseware.commands.test import OFFLINE_STARTUP
from courseware.lessons.kit.exercise import Exercise
from courseware.lessons.kit.exercises import find_exercise
from courseware.paths import REPOSITORY, STORE_SCENES, numbered_paths
from tools.pace import write_minutes
from tools.series_pictures import write_picture

MAX_BYTES = 700_000
HANGS_S = 1800.0  # only what hangs takes so long
METADATA = {
    "kernelspec": {"display_name": "Python 3 (ipykernel)", "language": "python", "name": "python3"},
    "language_info": {"file_extension": ".py", "mimetype": "text/x-python", "name": "python"},
}
KEPT_CELL_METADATA = ("exercise", "tags", "numbers_within", "because", "jupyter", "jp-MarkdownHeadingCollapsed")


NUMBER = r"(-?\d+(\.\d+)?(e-?\d+)?|nan|NaN|inf|True|False)\b"
VALUE = rf"(?P<value>\[({NUMBER}|[\s,\[\]])*\]|(?<![\w.\\]){NUMBER})"  # a list of numbers, of any depth, or one number


class RefreshError(RuntimeError):
    """A notebook did not run to its end or became too large; its file is unchanged."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `refresh`."""
    what = "lessons and projects, such as 03, F1 or P1 (default: all)"
    parser.add_argument("lessons", nargs="*", metavar="NN", help=what)
    parser.add_argument(
        "--solutions", action="store_true", help="write stubs, solutions and examples only; run nothing"
    )
    what = "seconds a cell may take (default: %(default)g)"
    parser.add_argument("--cell-timeout", type=float, default=HANGS_S, metavar="S", help=what)


def run(arguments: argparse.Namespace) -> int:
    """Refresh what was asked for; 1 where a notebook failed."""
    if not 0 < arguments.cell_timeout < math.inf:
        raise ValueError(f"--cell-timeout must be a positive number of seconds; got {arguments.cell_timeout:g}")
    failed = 0
    for path in select(arguments.lessons):
        if arguments.solutions:
            notebook = nbformat.read(path, as_version=4)
            write_solutions(notebook)
            atomic_write(path, nbformat.writes(notebook) + "\n")
            continue
        try:
            seconds, size = refresh(path, arguments.cell_timeout)
            write_picture(path)
            print(f"{path.name}: {seconds:.1f} s, {size / 1000:.0f} kB", flush=True)
        except RefreshError as error:
            failed += 1
            print(f"{path.name}: FAILED, left as it was. {error}", flush=True)
    return 1 if failed else 0


def select(lessons: list[str]) -> list[Path]:
    """Notebooks of these lessons ("03") and projects ("P1"), all of them for none."""
    paths = numbered_paths()
    wanted = [number.zfill(2) for number in lessons] or sorted(paths)
    unknown = sorted(set(wanted) - set(paths))
    if unknown or not wanted:
        raise ValueError(f"no lesson {', '.join(unknown)}; there are: {', '.join(sorted(paths)) or 'none'}")
    return [paths[number] for number in wanted]


def refresh(path: Path, cell_timeout: float = HANGS_S) -> tuple[float, int]:
    """Run one notebook and store its outputs; returns its seconds and bytes. Raises `RefreshError`, file unchanged."""
    notebook = nbformat.read(path, as_version=4)
    write_solutions(notebook)
    seconds = execute(notebook, path.parent, cell_timeout)
    normalize(notebook)
    write_minutes(notebook)
    text = nbformat.writes(notebook) + "\n"
    size = len(text.encode("utf-8"))
    if size > MAX_BYTES:
        raise RefreshError(f"{size / 1000:.0f} kB with its outputs, at most {MAX_BYTES / 1000:.0f}: smaller pictures?")
    atomic_write(path, text)
    return seconds, size


def write_solutions(notebook: nbformat.NotebookNode) -> None:
    """Write the stubs, the solutions and the numbers of the examples into a notebook, from its exercises."""
    for cell in notebook.cells:
        tags = cell.metadata.get("tags", [])
        if "exercise" in tags:
            cell.source = stub_cell(find_exercise(cell.metadata["exercise"]))
        elif "solution" in tags:
            cell.source = solution_cell(find_exercise(cell.metadata["exercise"]))
        elif "task" in tags:
            cell.source = with_example(cell.source, find_exercise(cell.metadata["exercise"]))


def with_example(task: str, exercise: Exercise) -> str:
    """Return the text of a task with the numbers of its exercise's example. All words stay as they are.

    The example begins at the first "For `name` = ". Each argument's value is written behind its name, and the numbers
    of the answer behind the last argument. Raises `RefreshError` if the text has no place for one of them.
    """
    if exercise.example is None:
        return task
    arguments, answer = exercise.example
    names = list(inspect.signature(exercise.solution).parameters)
    begin = re.search(rf"\bFor `?({'|'.join(names)})`? = ", task)
    if begin is None:
        raise RefreshError(f"{exercise.number}: the task needs an example that begins with 'For `{names[0]}` = '")
    before, text, last = task[: begin.start()], task[begin.start() :], 0
    for name, value in zip(names, arguments, strict=True):
        text, end = _with_number(text, rf"\b{name}`? = (np\.array\()?", value, 0, exercise.number)
        last = max(last, end)
    for value in answer if isinstance(answer, tuple) else (answer,):
        text, last = _with_number(text, "", value, last, exercise.number)
    return before + text


def _with_number(text: str, words: str, value: object, start: int, number: str) -> tuple[str, int]:
    """Return a text with the first value behind `words` (a pattern) after `start` replaced, and where it ends."""
    found = re.compile(words + VALUE).search(text, start)
    if found is None:
        raise RefreshError(f"{number}: the task's example has no place for {value}")
    first, last = found.span("value")
    return f"{text[:first]}{value}{text[last:]}", first + len(str(value))


def stub_cell(exercise: Exercise) -> str:
    """Return the text of an exercise's stub: the solution's first line and docstring, and `...`."""
    head, docstring, _ = _function_text(exercise)
    return f"{head}\n{docstring}\n    ..."


def solution_cell(exercise: Exercise) -> str:
    """Return the text of an exercise's solution. It has another name, so that it never overwrites a student's work."""
    head, _, body = _function_text(exercise)
    return f"# Solution {exercise.number}\n{head.replace('(', '_solution(', 1)}\n{body}"


def _function_text(exercise: Exercise) -> tuple[str, str, str]:
    """Return the first line, the docstring and the body of a solution as they are written."""
    source = textwrap.dedent(inspect.getsource(exercise.solution))
    docstring = ast.parse(source).body[0].body[0]
    lines = source.rstrip().splitlines()
    first, last = docstring.lineno - 1, docstring.end_lineno
    return "\n".join(lines[:first]), "\n".join(lines[first:last]), "\n".join(lines[last:])


def execute(
    notebook: nbformat.NotebookNode,
    folder: Path,
    cell_timeout: float,
    watch: Callable[[int], AbstractContextManager] = nullcontext,
) -> float:
    """Run all cells of `notebook` in place, in a fresh kernel; returns the seconds that the cells took.

    watch: from the process id of the kernel, what is entered before its first cell and left after its last.
    Raises `RefreshError` where a cell fails.
    """
    with temporary_folder() as home:
        startup = home / "profile_default" / "startup"
        startup.mkdir(parents=True)
        (startup / "00-offline.py").write_text(OFFLINE_STARTUP, encoding="utf-8")
        (startup / "01-path.py").write_text(f'__import__("sys").path.extend([{str(REPOSITORY)!r}, ""])')
        environment = os.environ | {"IPYTHONDIR": str(home), STORE_SCENES: "1", "PYTHONSAFEPATH": "1"}
        client = NotebookClient(
            notebook,
            timeout=math.ceil(cell_timeout),  # 0 would be no limit
            startup_timeout=int(HANGS_S),
            kernel_name="python3",
            resources={"metadata": {"path": str(folder)}},
            store_widget_state=False,
            extra_arguments=["--IPKernelApp.log_level=ERROR"],  # it listens on this computer only; no need to warn
            allow_errors=False,
        )
        client.km = client.create_kernel_manager()
        client.km.connection_file = str(home / "kernel.json")  # else one of its own, which a killed run would leave
        client.km.kernel_spec_manager = KernelSpecManager(kernel_dirs=[])  # this environment's, no other of its name
        try:
            with client.setup_kernel(env=environment), watch(client.km.provisioner.pid):
                started = time.perf_counter()
                try:
                    for index, cell in enumerate(notebook.cells):
                        client.execute_cell(cell, index)
                except KeyboardInterrupt:
                    client.shutdown_kernel = "immediate"  # else it complains of the cell that it could not end
                    raise
                return time.perf_counter() - started
        except CellTimeoutError as error:
            raise RefreshError(f"a cell took longer than {cell_timeout:g} s: {str(error).splitlines()[-1]}") from error
        except (CellExecutionError, DeadKernelError) as error:
            raise RefreshError(re.sub(r"\x1b\[[0-9;]*m", "", str(error))) from error  # without its colours


def normalize(notebook: nbformat.NotebookNode) -> None:
    """Bring a notebook to the one stored form: counts 1 to n, no widget views or state, no traces of a session."""
    notebook.metadata = nbformat.from_dict(METADATA)
    notebook.nbformat, notebook.nbformat_minor = 4, 5
    drop_widgets(notebook)
    count = 0
    for cell in notebook.cells:
        cell.metadata = {key: cell.metadata[key] for key in KEPT_CELL_METADATA if key in cell.metadata}
        if cell.cell_type != "code":
            continue
        count += 1
        cell.execution_count = count
        for output in cell.outputs:
            output.pop("transient", None)
            if "execution_count" in output:
                output["execution_count"] = count
        cell.outputs = merge_streams(cell.outputs)


def merge_streams(outputs: list) -> list:
    """Outputs with neighbouring pieces of one stream joined: how it was cut up is a matter of timing."""
    merged = []
    for output in outputs:
        last = merged[-1] if merged else None
        if output.output_type == "stream" and last is not None and last.get("name") == output.name:
            last["text"] += output.text
        else:
            merged.append(output)
    return merged


if __name__ == "__main__":
    from courseware.cli import tool

    sys.exit(tool("tools.refresh"))
