"""The command line: which command is meant, what is imported for it, and one line for every error."""

import subprocess
import sys
import types
from unittest.mock import Mock

import pytest

from courseware import cli


@pytest.fixture
def command(monkeypatch):
    """Puts a command "try it" into the table; call it with the function that stands for its `run`."""

    def put(run, add_arguments=lambda parser: None, **attributes):
        module = types.SimpleNamespace(run=run, add_arguments=add_arguments, __doc__="Try it.", **attributes)
        monkeypatch.setitem(cli.COMMANDS, "try it", ("try_it", "a try"))
        monkeypatch.setitem(sys.modules, "courseware.commands.try_it", module)
        monkeypatch.delenv("COURSE_DEBUG", raising=False)

    return put


def test_help_lists_every_command_imports_none_and_each_declares_its_arguments(capsys):
    script = "import sys; from courseware import cli; cli.main(['--help']); print(sorted(sys.modules))"
    printed = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True).stdout
    assert not any(f"'{name}" in printed for name in ("numpy", "vtk", "courseware.commands"))
    for name, (_, text) in cli.COMMANDS.items():
        assert name in printed
        assert text in printed
        with pytest.raises(SystemExit) as ended:
            cli.main([*name.split(), "--help"])
        assert ended.value.code == 0, name
        assert f"course.py {name}" in capsys.readouterr().out


def test_unknown_arguments_are_refused_unless_the_command_passes_them_on(command, capsys):
    command(lambda arguments: 0)
    with pytest.raises(SystemExit) as ended:
        cli.main(["try", "it", "-k", "foo"])
    assert ended.value.code == 2
    assert "-k foo" in capsys.readouterr().err
    command(lambda arguments: print(arguments.passed_on) or 0, PASSES_ARGUMENTS_ON=True)
    assert cli.main(["try", "it", "-k", "foo", "tests/a.py"]) == 0
    assert capsys.readouterr().out == "['-k', 'foo', 'tests/a.py']\n"


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (ValueError("n_particles must be at least 1; got 0"), 2),
        (FileNotFoundError(2, "No such file or directory", "map.ply"), 2),
        (ImportError("No module named 'vtk'"), 1),
        (KeyboardInterrupt(), 130),
    ],
)
def test_an_error_is_one_line_and_a_code(command, capsys, error, code):
    command(Mock(side_effect=error))
    assert cli.main(["try", "it"]) == code
    errors = capsys.readouterr().err
    assert len(errors.strip().splitlines()) == 1
    assert str(error) in errors
    assert "Traceback" not in errors
    assert cli.main(["try", "it", "--debug"]) == code
    assert "Traceback" in capsys.readouterr().err


def test_a_reader_that_leaves_early_causes_no_complaint():
    script = "from courseware import cli; import sys; sys.exit(cli.main(['check']))"
    process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    process.stdout.close()
    with process:
        assert process.stderr.read() == b""


def with_options(parser):
    parser.add_argument("--particles", type=int)
    parser.add_argument("--far", type=float)
    parser.add_argument("--map", required=True, metavar="MESH")
    parser.add_argument("--dof", choices=["xyyaw", "6"])


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--map", "m", "--particle", "5"], "--particle 5: there is no option '--particle'; did you mean --particles?"),
        (["--map", "m", "walk"], "walk: there is no place for the word 'walk'."),
        (["--map", "m", "--particles", "ten"], "--particles must be a whole number; got 'ten'."),
        (["--map", "m", "--particles"], "--particles needs a value."),
        ([], "--map must be given."),
        (["--map", "m", "--dof", "7"], "--dof must be one of "),
    ],
)
def test_words_that_do_not_fit_are_told_in_one_sentence_that_says_where_the_options_are(command, capsys, words, told):
    command(lambda arguments: pytest.fail("work had begun"), with_options)
    with pytest.raises(SystemExit) as ended:
        cli.main(["try", "it", *words])
    assert ended.value.code == 2
    error = capsys.readouterr().err
    assert error.startswith(f"error: {told}")
    assert error.endswith(" All options: python3 course.py try it --help\n")
    assert len(error.splitlines()) == 1


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["loclize"], "there is no command 'loclize'; did you mean localize"),
        (["demo", "corrider"], "there is no command 'demo corrider'; did you mean demo corridor"),
        (["demo"], "there is no command 'demo'; did you mean: demo corridor, demo room, "),
        (
            ["zzzzzz"],
            "there is no command 'zzzzzz'; the commands are, to learn: lab, progress, check, test; to use: localize, ",
        ),
    ],
)
def test_a_misspelt_command_is_told_with_the_one_that_may_be_meant(words, told, capsys):
    assert cli.main(words) == 2
    error = capsys.readouterr().err
    assert error.startswith(f"error: {told}")
    assert len(error.splitlines()) == 1
