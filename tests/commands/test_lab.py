"""`course.py lab`: a server for this computer only, with its token, without news, and without touching the home."""

import asyncio
import json
import re
import shutil
import signal
import subprocess
import urllib.error
import urllib.request
from pathlib import Path

import pytest

from courseware.cli import main
from courseware.commands import lab
from courseware.commands.saved_panels import WIDGET_VIEW
from courseware.paths import REPOSITORY
from tests.notebooks.driven_lab import TOKEN, free_port, wait_for_server


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    """The lessons' server as `lab` starts it: its address, its token, and the (empty) home it ran in."""
    home, state = tmp_path_factory.mktemp("home"), tmp_path_factory.mktemp("state")
    port = free_port()
    command, environment = lab.lab_command(port, browser=False, state_folder=state)
    environment |= {"HOME": str(home), "JUPYTER_TOKEN": TOKEN}
    with open(state / "log", "wb") as log:
        process = subprocess.Popen(command, env=environment, stdout=log, stderr=log, cwd=home)
    wait_for_server(process, port, state / "log")
    yield f"http://127.0.0.1:{port}", TOKEN, home
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=600) == 0, "Ctrl-C ends it without a question"


def get(address):
    """The page, or the code with which the server refuses it."""
    try:
        with urllib.request.urlopen(address, timeout=600) as answer:
            return answer.read().decode()
    except urllib.error.HTTPError as error:
        return error.code


@pytest.mark.slow
def test_the_token_is_needed_and_it_listens_on_this_computer_only(server):
    address, token, _ = server
    assert [get(f"{address}/api/{path}") for path in ("status", "contents", "kernels")] == [403] * 3
    assert json.loads(get(f"{address}/api/status?token={token}"))["kernels"] == 0
    if Path("/proc/net/tcp").exists():
        port = int(address.rsplit(":", 1)[1])
        sockets = "".join(Path(f"/proc/net/{name}").read_text() for name in ("tcp", "tcp6"))
        listening = re.findall(rf": (\w+):{port:04X} \w+:\w+ 0A ", sockets)  # 0A: LISTEN
        assert listening == ["0100007F"]  # 127.0.0.1, its bytes reversed


@pytest.mark.slow
def test_news_updates_builds_and_needless_extensions_are_off_and_nothing_is_written_to_the_home(server):
    address, token, home = server
    page = get(f"{address}/lab?token={token}")
    config = json.loads(page.split('id="jupyter-config-data"', 1)[1].split(">", 1)[1].split("</script>", 1)[0])
    assert config["news"] == {"disabled": True}
    assert config["buildAvailable"] is config["buildCheck"] is config["extensionManager"]["can_install"] is False
    for name in ("jupyter-server-proxy", "announcements", "lsp-extension", "nbgrader", "terminal-extension"):
        assert any(name in disabled for disabled in config["disabledExtensions"]), name
    for needless in ("lsp/status", "server-proxy/servers-info", "api/terminals", "formgrader", "tree"):
        assert get(f"{address}/{needless}?token={token}") == 404, needless
    for plugin, settings in lab.SETTINGS.items():
        properties = json.loads(get(f"{address}/lab/api/settings/{plugin}?token={token}"))["schema"]["properties"]
        assert {name: properties[name]["default"] for name in settings} == settings
    entry = next(one for one in config["federated_extensions"] if one["name"] == "course-lab")
    folder = f"{address}{config['fullLabextensionsUrl']}/{entry['name']}"
    for name in (entry["load"], "static/style.css"):
        assert get(f"{folder}/{name}?token={token}") == (lab.EXTENSION / name).read_text(encoding="utf-8")
    assert list(home.iterdir()) == []


def test_a_saved_panel_keeps_its_picture_only(tmp_path):
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


def test_port_and_browser_pass_through_and_an_empty_token_does_not_switch_the_token_off(tmp_path, monkeypatch):
    monkeypatch.setenv("JUPYTER_TOKEN", "")
    command, environment = lab.lab_command(8899, browser=True, state_folder=tmp_path)
    assert {"--ServerApp.port=8899", "--ServerApp.port_retries=0", "--ServerApp.open_browser=True"} <= set(command)
    assert "JUPYTER_TOKEN" not in environment
    command, _ = lab.lab_command(state_folder=tmp_path)
    assert {"--ServerApp.port=8888", "--ServerApp.port_retries=50", "--ServerApp.open_browser=False"} <= set(command)
    assert not any("token" in word or "password" in word for word in command)


@pytest.fixture
def started(tmp_path, monkeypatch):
    """Call `lab` in a course of two lessons; what it returns is the course, the command it became, its environment."""
    course, became = tmp_path / "course", []
    (course / "notebooks").mkdir(parents=True)
    for name in ("00_start_here.ipynb", "06_likelihood_and_weights.ipynb"):
        shutil.copy(REPOSITORY / "notebooks" / name, course / "notebooks")
    monkeypatch.setattr(lab, "REPOSITORY", course)
    monkeypatch.setattr(lab.sys, "prefix", str(tmp_path / "environment"))
    monkeypatch.setattr(lab.os, "execve", lambda program, words, environment: became.append((words, environment)))
    monkeypatch.setattr(lab.subprocess, "call", lambda words, env, cwd: became.append((words, env)))  # on Windows

    def start(*words):
        code = main(["lab", "--no-browser", *words])
        return course, *(became.pop() if became else (code, None))

    return start


def test_the_copies_are_made_and_lesson_00_opens_or_what_cannot_be_opened_is_told(started, capsys):
    for wrong, said in ((["--notebook", "x.ipynb"], "no notebook x.ipynb"), (["--fresh", "44"], "no lesson 44")):
        course, code, _ = started(*wrong)
        assert code == 2
        assert said in capsys.readouterr().err
        assert not (course / "work").exists()
    course, words, environment = started()
    assert "--LabApp.default_url=/lab/tree/work/00_start_here.ipynb" in words
    assert f"--ServerApp.root_dir={course}" in words
    assert environment["COURSE_RECORD"] == str(course / "work" / "record")
    assert (course / "work" / "06_likelihood_and_weights.ipynb").exists()
    assert "Your copies of the lessons are in work/" in capsys.readouterr().out
    assert "Your progress" in (course / "work" / "progress.html").read_text(encoding="utf-8")


@pytest.mark.parametrize("words", [["--notebook", "notebooks/06_likelihood_and_weights.ipynb"], ["--fresh", "06"]])
def test_a_lesson_that_is_named_or_begun_anew_is_what_opens(started, monkeypatch, words):
    monkeypatch.setattr(lab, "make_progress_page", lambda root, environment: None)
    started()
    course, command, _ = started(*words)
    assert "--LabApp.default_url=/lab/tree/work/06_likelihood_and_weights.ipynb" in command
    assert len(list((course / "work").glob("06*.before-*.ipynb"))) == ("--fresh" in words)
