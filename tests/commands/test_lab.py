"""`course.py lab`: a server for this computer only, with its token, without news, and without touching the home."""

import argparse
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from pathlib import Path

import nbformat
import pytest
from nbformat.sign import NotebookNotary

from course_lib.commands import lab
from course_lib.commands.saved_panels import WIDGET_VIEW
from course_lib.paths import REPOSITORY


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    """The lessons' server as `lab` starts it: its address, its token, its process, and the (empty) home it ran in."""
    home, state = tmp_path_factory.mktemp("home"), tmp_path_factory.mktemp("state")
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    command, environment = lab.lab_command(port, browser=False, state_folder=state)
    environment |= {"HOME": str(home), "JUPYTER_TOKEN": "a-token-for-the-tests"}
    with open(state / "log", "wb") as log:
        process = subprocess.Popen(command, env=environment, stdout=log, stderr=log, cwd=home)
    address = f"http://127.0.0.1:{port}"
    wait_until_it_answers(address, process)
    yield address, "a-token-for-the-tests", process, home
    process.send_signal(signal.SIGTERM)
    process.wait(timeout=600)


def wait_until_it_answers(address, process):
    for _ in range(6000):
        try:
            get(f"{address}/api")
            return
        except OSError:
            assert process.poll() is None, "the server ended by itself"
            time.sleep(0.1)
    raise AssertionError("the server did not answer within ten minutes")


def get(address):
    with urllib.request.urlopen(address, timeout=600) as answer:
        return answer.read().decode()


def test_the_token_is_needed(server):
    address, token, _, _ = server
    for path in ("/api/status", "/api/contents", "/api/kernels"):
        with pytest.raises(urllib.error.HTTPError) as refused:
            get(address + path)
        assert refused.value.code == 403
    assert json.loads(get(f"{address}/api/status?token={token}"))["kernels"] == 0


@pytest.mark.skipif(not Path("/proc/net/tcp").exists(), reason="reads Linux's list of sockets")
def test_it_listens_on_this_computer_only(server):
    port = int(server[0].rsplit(":", 1)[1])
    listening = set()
    for name in ("tcp", "tcp6"):
        for line in Path(f"/proc/net/{name}").read_text().splitlines()[1:]:
            local, state = line.split()[1], line.split()[3]
            if int(local.split(":")[1], 16) == port and state == "0A":  # LISTEN
                listening.add(local.split(":")[0])
    assert listening == {"0100007F"}  # 127.0.0.1, its bytes reversed


def test_news_updates_builds_and_needless_extensions_are_off(server):
    address, token, _, _ = server
    page = get(f"{address}/lab?token={token}")
    config = json.loads(page.split('id="jupyter-config-data"', 1)[1].split(">", 1)[1].split("</script>", 1)[0])
    assert config["news"] == {"disabled": True}
    assert config["buildAvailable"] is False
    assert config["buildCheck"] is False
    assert config["extensionManager"]["can_install"] is False
    for name in ("jupyter-server-proxy", "announcements", "lsp-extension", "nbgrader", "terminal-extension"):
        assert any(name in disabled for disabled in config["disabledExtensions"]), name
    for needless in ("lsp/status", "server-proxy/servers-info", "api/terminals", "formgrader", "tree"):
        with pytest.raises(urllib.error.HTTPError) as missing:
            get(f"{address}/{needless}?token={token}")
        assert missing.value.code == 404


@pytest.mark.parametrize("plugin", lab.SETTINGS)
def test_our_settings_are_the_defaults(server, plugin):
    address, token, _, _ = server
    properties = json.loads(get(f"{address}/lab/api/settings/{plugin}?token={token}"))["schema"]["properties"]
    for name, value in lab.SETTINGS[plugin].items():
        assert properties[name]["default"] == value


def test_the_courses_extension_is_served(server):
    address, token, _, _ = server
    page = get(f"{address}/lab?token={token}")
    config = json.loads(page.split('id="jupyter-config-data"', 1)[1].split(">", 1)[1].split("</script>", 1)[0])
    entry = next(one for one in config["federated_extensions"] if one["name"] == "course-lab")
    folder = f"{address}{config['fullLabextensionsUrl']}/{entry['name']}"
    for name in (entry["load"], "static/style.css"):
        assert get(f"{folder}/{name}?token={token}") == (lab.EXTENSION / name).read_text(encoding="utf-8")


def test_a_saved_panel_keeps_its_picture_only(tmp_path):
    import asyncio

    from jupyter_server.services.contents.largefilemanager import AsyncLargeFileManager  # the server's default
    from nbformat.v4 import new_code_cell, new_notebook, new_output
    from traitlets.config.loader import JSONFileConfigLoader

    lab.write_settings(tmp_path)
    config = JSONFileConfigLoader("jupyter_server_config.json", str(tmp_path / "config")).load_config()
    manager = AsyncLargeFileManager(config=config, root_dir=str(tmp_path))
    forms = {"text/plain": "Panel", "text/html": "<img>", WIDGET_VIEW: {"model_id": "1"}}
    notebook = new_notebook(cells=[new_code_cell("x", outputs=[new_output("display_data", forms)])])
    asyncio.run(manager.save({"type": "notebook", "content": notebook}, "a.ipynb"))
    saved = json.loads((tmp_path / "a.ipynb").read_text(encoding="utf-8"))
    assert set(saved["cells"][0]["outputs"][0]["data"]) == {"text/plain", "text/html"}


def test_nothing_is_written_to_the_home(server):
    address, token, _, home = server
    get(f"{address}/lab?token={token}")
    assert list(home.iterdir()) == []


def test_the_first_lesson_is_what_opens(tmp_path):
    command, _ = lab.lab_command(state_folder=tmp_path)
    assert "--LabApp.default_url=/lab/tree/work/00_start_here.ipynb" in command
    assert "--ServerApp.ip=127.0.0.1" in command
    assert not any("token" in word or "password" in word for word in command)


def test_port_and_browser_pass_through(tmp_path):
    command, _ = lab.lab_command(8899, browser=True, state_folder=tmp_path)
    assert {"--ServerApp.port=8899", "--ServerApp.port_retries=0", "--ServerApp.open_browser=True"} <= set(command)
    command, _ = lab.lab_command(state_folder=tmp_path)
    assert {"--ServerApp.port=8888", "--ServerApp.port_retries=50", "--ServerApp.open_browser=False"} <= set(command)


def test_an_empty_token_in_the_environment_does_not_switch_the_token_off(tmp_path, monkeypatch):
    monkeypatch.setenv("JUPYTER_TOKEN", "")
    assert "JUPYTER_TOKEN" not in lab.lab_command(state_folder=tmp_path)[1]


@pytest.fixture
def course(tmp_path, monkeypatch):
    """Two lessons in a repository of their own, which `run` takes for ours; the command it would become is kept."""
    folder = tmp_path / "course"
    for name in ("00_start_here.ipynb", "06_likelihood_and_weights.ipynb"):
        (folder / "notebooks").mkdir(parents=True, exist_ok=True)
        shutil.copy(lab.ROOT / "notebooks" / name, folder / "notebooks")
    monkeypatch.setattr(lab, "ROOT", folder)
    monkeypatch.setattr(lab.sys, "prefix", str(tmp_path / "environment"))
    return folder


def started(monkeypatch, port=None, notebook=None, fresh=()):
    """The words that `lab` becomes, and its environment."""
    became = []
    monkeypatch.setattr(lab.os, "execve", lambda program, words, environment: became.append((words, environment)))
    monkeypatch.setattr(lab.subprocess, "call", lambda words, env, cwd: became.append((words, env)))  # on Windows
    lab.run(argparse.Namespace(port=port, no_browser=True, notebook=notebook, fresh=list(fresh)))
    return became[0]


@pytest.mark.parametrize(
    ("port", "notebook", "fresh", "said"),
    [
        (70000, None, (), "between 1 and 65535"),
        (None, "notebooks/x.ipynb", (), "no notebook"),
        (None, "/etc/hosts", (), "lies outside"),
        (None, None, ("44",), "no lesson 44"),
    ],
)
def test_what_cannot_be_opened_is_told(course, monkeypatch, port, notebook, fresh, said):
    with pytest.raises(ValueError, match=said):
        started(monkeypatch, port, notebook, fresh)
    assert not (course / "work").exists()


def test_the_copies_are_made_and_lesson_00_opens(course, monkeypatch, capsys):
    words, environment = started(monkeypatch)
    assert "--LabApp.default_url=/lab/tree/work/00_start_here.ipynb" in words
    assert f"--ServerApp.root_dir={course}" in words
    assert environment["COURSE_RECORD"] == str(course / "work" / "record")
    assert sorted(path.name for path in (course / "work").glob("*.ipynb")) == [
        "00_start_here.ipynb",
        "06_likelihood_and_weights.ipynb",
    ]
    assert "Your copies of the lessons are in work/" in capsys.readouterr().out
    assert "Your progress" in (course / "work" / "progress.html").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("notebook", "fresh", "opened"),
    [
        ("notebooks/06_likelihood_and_weights.ipynb", (), "work/06_likelihood_and_weights.ipynb"),
        (None, ("06",), "work/06_likelihood_and_weights.ipynb"),
        ("00", ("06",), "work/00_start_here.ipynb"),
    ],
)
def test_a_lesson_that_is_named_or_begun_anew_is_what_opens(course, monkeypatch, notebook, fresh, opened):
    monkeypatch.setattr(lab, "make_progress_page", lambda root: None)
    started(monkeypatch)
    words, _ = started(monkeypatch, None, notebook, fresh)
    assert f"--LabApp.default_url=/lab/tree/{opened}" in words
    assert len(list((course / "work").glob("06*.before-*.ipynb"))) == len(fresh)


def test_copies_are_trusted_as_long_as_they_are_the_lessons(course, monkeypatch, tmp_path):
    monkeypatch.setattr(lab, "make_progress_page", lambda root: None)
    started(monkeypatch)
    notary = NotebookNotary(data_dir=str(tmp_path / "environment" / "course-lab" / "data"))
    path = course / "work" / "06_likelihood_and_weights.ipynb"
    notebook = nbformat.read(path, as_version=4)
    assert notary.check_signature(notebook)
    notebook.cells[0].source += " by a stranger"
    nbformat.write(notebook, path)
    started(monkeypatch)
    assert not notary.check_signature(nbformat.read(path, as_version=4))


@pytest.mark.skipif(os.name == "nt", reason="needs a POSIX terminal")
def test_it_starts_beside_a_module_of_a_known_name_and_control_c_ends_it_without_a_question(tmp_path):
    import pty

    for name in ("random", "secrets", "tornado"):  # what the server imports
        (tmp_path / f"{name}.py").write_text("open('ran', 'w')\nraise SystemExit(3)\n")

    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    command, environment = lab.lab_command(port, state_folder=tmp_path)
    master, terminal = pty.openpty()
    process = subprocess.Popen(command, env=environment, stdin=terminal, stdout=terminal, stderr=terminal, cwd=tmp_path)
    wait_until_it_answers(f"http://127.0.0.1:{port}", process)
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=600) == 0
    assert not (tmp_path / "ran").exists()
    os.close(terminal)
    os.close(master)


def test_the_command_runs_in_this_environment_and_imports_nothing_of_the_callers_folder(tmp_path):
    command = lab.lab_command(state_folder=tmp_path)[0]
    assert command[:2] == [sys.executable, "-P"]
    assert command[4:6] == [str(REPOSITORY), "jupyterlab"]
