"""Open the lessons in JupyterLab, on this computer only.

The student's own copies open, from `work/` (`courseware.working_copies`). The server listens on 127.0.0.1 with its
token on. Its settings live in `.venv/course-lab`, so that nothing in the user's home is read or changed.
"""

import argparse
import contextlib
import json
import os
import subprocess
import sys
from pathlib import Path

from course_lib.files import atomic_write
from courseware.commands.saved_panels import HOOK
from courseware.paths import REPOSITORY
from courseware.working_copies import NOTEBOOKS, WORK, copy_of, lessons, make_copies

EXTENSION = Path(__file__).with_name("lab_extension")
FIRST_LESSON = "work/00_start_here.ipynb"
NO_UPDATES = "jupyterlab.NeverCheckForUpdate"

# Parts of JupyterLab that a student does not need: what other packages bring along, and what would ask or load things.
DISABLED_SERVER_EXTENSIONS = """
jupyter_lsp jupyter_server_proxy jupyter_server_terminals notebook trame_jupyter_extension
nbgrader.server_extensions.assignment_list nbgrader.server_extensions.course_list
nbgrader.server_extensions.formgrader nbgrader.server_extensions.validate_assignment
""".split()
DISABLED_LAB_EXTENSIONS = """
@jupyter/nbgrader @jupyter-notebook/lab-extension @jupyterhub/jupyter-server-proxy trame_jupyter_extension
@jupyterlab/apputils-extension:announcements @jupyterlab/extensionmanager-extension @jupyterlab/hub-extension
@jupyterlab/fileeditor-extension:language-server @jupyterlab/notebook-extension:language-server
@jupyterlab/lsp-extension @jupyterlab/terminal-extension
""".split()
SETTINGS = {
    "@jupyterlab/apputils-extension:notification": {"fetchNews": "false", "checkForUpdates": False},
    # Lessons bring their kernel; cells outside the view are drawn too, so that links and searches find them.
    # Long lines of code go on in the next, as the text does: in a narrow or enlarged window nothing is out of sight.
    "@jupyterlab/notebook-extension:tracker": {
        "autoStartDefaultKernel": True,
        "windowingMode": "none",
        "codeCellConfig": {"lineNumbers": False, "lineWrap": True},
    },
    "@jupyterlab/docmanager-extension:plugin": {"defaultViewers": {"markdown": "Markdown Preview"}},
    "@jupyterlab/filebrowser-extension:browser": {"showLastModifiedColumn": False},  # its place is the names'
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("--port", type=int, help="port to listen on (default: 8888, or the next one that is free)")
    add("--no-browser", action="store_true", help="open no browser, only print the address")
    told = "the notebook to open: 06, F1, P1 or a path; of a lesson it is your copy in work/ (default: lesson 00)"
    add("--notebook", metavar="PATH", help=told)
    told = "start these lessons or projects again (06, P1); your earlier copies are renamed, not deleted"
    add("--fresh", nargs="+", default=[], metavar="NN", help=told)


def run(arguments: argparse.Namespace) -> int:
    if arguments.port is not None and not 1 <= arguments.port <= 65535:
        raise ValueError(f"--port must lie between 1 and 65535; got {arguments.port}")
    notebook = copy_of(arguments.notebook or "00", REPOSITORY)
    for sentence in make_copies(REPOSITORY, arguments.fresh):
        print(sentence, flush=True)
    if arguments.fresh and not arguments.notebook:
        notebook = copy_of(arguments.fresh[0], REPOSITORY)
    command, environment = lab_command(arguments.port, not arguments.no_browser, notebook, root=REPOSITORY)
    make_progress_page(REPOSITORY, environment)
    print("Starting JupyterLab. Keep this window open; Ctrl-C ends it. Its address:", flush=True)
    if os.name == "nt":  # execve does not wait there
        return subprocess.call(command, env=environment, cwd=REPOSITORY)
    os.execve(command[0], command, environment)


def make_progress_page(root: Path, environment: dict[str, str]) -> None:
    """Write work/progress.html if there is none yet. A lesson's checks and predictions bring it up to date."""
    page = root / WORK / "progress.html"
    if not page.exists():
        command = [sys.executable, "-P", "-m", "courseware.lessons.kit.show_progress", "--out", str(page)]
        subprocess.run(command, env=environment, capture_output=True, check=False)  # lessons run without it as well


def lab_command(
    port: int | None = None,
    browser: bool = False,
    notebook: str = FIRST_LESSON,
    state_folder: str | os.PathLike | None = None,
    root: Path = REPOSITORY,
) -> tuple[list[str], dict[str, str]]:
    """Write the settings of the lessons' JupyterLab, and return its command and environment variables.

    port: None takes 8888 or the next free one. notebook: path below `root`, the folder that JupyterLab shows.
    state_folder: for settings and workspaces (None: `.venv/course-lab`). Token: JUPYTER_TOKEN, else a random one.
    """
    state = Path(state_folder) if state_folder is not None else Path(sys.prefix) / "course-lab"
    write_settings(state)
    trust_lessons(state, root)
    command = [
        *(sys.executable, "-P", "-m", "jupyterlab"),
        "--ServerApp.ip=127.0.0.1",
        f"--ServerApp.port={port or 8888}",
        f"--ServerApp.port_retries={0 if port else 50}",
        f"--ServerApp.open_browser={browser}",
        f"--ServerApp.root_dir={root}",
        f"--LabApp.default_url=/lab/tree/{notebook}",
        "--Application.log_level=ERROR",  # the address is printed all the same
        "--ServerApp.answer_yes=True",  # Ctrl-C ends it without a question
    ]
    if hasattr(os, "geteuid") and os.geteuid() == 0:
        command.append("--ServerApp.allow_root=True")  # containers run as root; the server still listens here only
    others = ("JUPYTER_PATH", "JUPYTER_CONFIG_PATH")  # from which the server would take foreign settings
    environment = {name: value for name, value in os.environ.items() if name not in others}
    if not environment.get("JUPYTER_TOKEN"):
        environment.pop("JUPYTER_TOKEN", None)  # set but empty, it would switch the token off
    folders = {f"JUPYTER_{name.upper()}_DIR": name for name in ("config", "data", "runtime")}
    folders |= {"JUPYTERLAB_SETTINGS_DIR": "user-settings", "JUPYTERLAB_WORKSPACES_DIR": "workspaces"}
    folders["IPYTHONDIR"] = "ipython"
    environment |= {name: str(state / folder) for name, folder in folders.items()}
    return command, environment | {"COURSE_RECORD": str(root / WORK / "record")}


def write_settings(state: Path) -> None:
    """Write the settings of the server, of JupyterLab and of the kernel, and the course's extension, below `state`."""
    files = {
        "config/jupyter_server_config.json": {
            "ServerApp": {"jpserver_extensions": dict.fromkeys(DISABLED_SERVER_EXTENSIONS, False)},
            "FileContentsManager": {"pre_save_hook": HOOK},
            "LabApp": {"extension_manager": "readonly", "news_url": None, "check_for_updates_class": NO_UPDATES},
        },
        "config/labconfig/page_config.json": {
            **{"buildAvailable": False, "buildCheck": False},
            "disabledExtensions": dict.fromkeys(DISABLED_LAB_EXTENSIONS, True),
        },
        "config/labconfig/default_setting_overrides.json": SETTINGS,
        # Every kernel would warn that it talks to the server unencrypted; both are on this computer.
        "ipython/profile_default/ipython_kernel_config.json": {"IPKernelApp": {"log_level": "ERROR"}},
    }
    files = {name: json.dumps(content, indent=1) for name, content in files.items()}
    for path in (path for path in EXTENSION.rglob("*") if path.is_file()):
        files[f"data/labextensions/course-lab/{path.relative_to(EXTENSION).as_posix()}"] = path.read_bytes()
    for name, content in files.items():
        (state / name).parent.mkdir(parents=True, exist_ok=True)
        atomic_write(state / name, content)  # another lab may be reading it


def trust_lessons(state: Path, root: Path) -> None:
    """Sign the lessons' content, so that their stored 3D scenes, and those of unchanged copies, show at once."""
    from nbformat import read
    from nbformat.reader import NotJSONError
    from nbformat.sign import NotebookNotary

    notary = NotebookNotary(data_dir=str(state / "data"))
    for name in lessons(root).values():
        with contextlib.suppress(NotJSONError):  # a merge that stopped half-way
            notary.sign(read(root / NOTEBOOKS / name, as_version=4))
