"""`course.py test --mutations`: it tells what the tests notice from what they do not, and is not deceived."""

import argparse
from pathlib import Path

import pytest

from course_lib.commands import mutations
from course_lib.commands import test as test_command
from course_lib.commands.mutations import Mutation, MutationError

ROOT = Path(__file__).resolve().parents[2]
CODE = "def double(x):\n    return 2 * x\n\n\ndef name():\n    return 'double'\n"
TESTS = "from course_lib.code import double\n\n\ndef test_double():\n    assert double(3) == 6\n"


def entry(name, old="2 * x", new="3 * x", file="course_lib/code.py", tests="['tests/test_code.py']"):
    return f"[[mutation]]\nname = '{name}'\nfile = '{file}'\nold = \"{old}\"\nnew = \"{new}\"\ntests = {tests}\n"


@pytest.fixture
def repository(tmp_path, monkeypatch):
    """A repository of one function, its test, a place for mutations; pytest without plugins, which cost seconds."""
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    root = tmp_path / "course"
    for folder in ("course_lib", "tests"):
        (root / folder).mkdir(parents=True)
    (root / "course_lib" / "__init__.py").touch()
    (root / "course_lib" / "code.py").write_text(CODE)
    (root / "tests" / "test_code.py").write_text(TESTS)
    return root


def put(root, *entries):
    (root / "tests" / "mutations.toml").write_text("\n".join(entries))


def test_every_mutation_of_this_repository_fits_its_code():
    listed = mutations.read_mutations(ROOT)
    assert {m.name: why for m in listed if (why := mutations.misfit(m, ROOT))} == {}


@pytest.mark.slow
def test_what_is_noticed_is_killed_and_what_is_not_survives(repository, capsys):
    put(
        repository,
        entry("trebled"),
        # As long as the original and written within the same second: stale bytecode would hide it.
        entry("added", new="2 + x"),
        entry("renamed", old="'double'", new="'single'"),
        entry("no name any more", old="def double(x)", new="def other(x)"),
        entry("pytest dies", new="__import__('os').abort()"),
        entry("somebody kills pytest", new="__import__('os').kill(__import__('os').getpid(), 9)"),
    )
    assert mutations.run(repository, []) == 1
    printed = capsys.readouterr().out.splitlines()
    assert {line.split(maxsplit=1)[1]: line.split()[0] for line in printed[:6]} == {
        "trebled": "killed",
        "added": "killed",
        "renamed": "SURVIVED",
        "no name any more": "killed",
        "pytest dies": "killed",
        "CODE -9    somebody kills pytest": "EXIT",
    }
    assert printed[-1] == "6 mutations, 4 killed, 1 survived, 1 could not be tried"
    assert (repository / "course_lib" / "code.py").read_text() == CODE
    assert mutations.run(repository, ["Trebled"]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == "1 mutations, 1 killed, 0 survived"


def test_a_test_that_fails_anyway_notices_nothing(repository, monkeypatch, capsys):
    monkeypatch.setattr(test_command, "processors", lambda: 1)
    put(repository, entry("trebled"))
    (repository / "tests" / "test_code.py").write_text(TESTS + "\n\ndef test_broken():\n    assert False\n")
    assert mutations.run(repository, []) == 1
    printed = capsys.readouterr().out
    assert "fail on the unbroken code" in printed
    assert "test_broken" in printed
    assert "killed" not in printed


def test_what_does_not_apply_is_told_and_fails(repository, capsys):
    put(repository, entry("gone", old="4 * x"), entry("trebled"))
    assert mutations.run(repository, []) == 1
    printed = capsys.readouterr().out
    assert "DOES NOT APPLY  gone: its old text stands 0 times in course_lib/code.py, not once" in printed
    assert printed.splitlines()[-1] == "2 mutations, 1 killed, 0 survived, 1 could not be tried"


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"file": "course_lib/none.py"}, "there is no file course_lib/none.py"),
        ({"file": "tests/test_code.py", "old": "(3)"}, "is a test"),
        ({"old": "double"}, "stands 2 times"),
        ({"new": "2 * x"}, "its new text is its old text"),
        ({"new": "2 * * x"}, "no Python any more"),
        ({"tests": ("tests/test_none.py",)}, "there is no test tests/test_none.py"),
        ({"tests": ("tests/test_code.py::test_half",)}, "tests/test_code.py has no test_half"),
        ({"tests": ("tests/test_code.py::test_double[1]",)}, None),
        ({}, None),
    ],
)
def test_a_misfit_is_named(repository, changes, said):
    fitting = {"name": "a", "file": "course_lib/code.py", "old": "2 * x", "new": "3 * x"}
    why = mutations.misfit(Mutation(**({"tests": ("tests/test_code.py",)} | fitting | changes)), repository)
    assert (why is None) if said is None else (said in why)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[[mutation]]\nname = 'a'\n", "mutation 1: wanted the keys"),
        (entry("a", tests="[]"), "not empty"),
        (entry("a", tests="'tests/test_code.py'"), "a list of texts"),
        ("[[mutation]\n", "no list of"),
        ("x = 1\n", "no list of"),
        (entry("a") + entry("a"), "two mutations have the same name: a"),
    ],
)
def test_a_bad_entry_is_named(repository, text, said):
    put(repository, text)
    with pytest.raises(MutationError, match=said):
        mutations.read_mutations(repository)


def test_a_name_that_fits_none_and_an_empty_list_are_told(repository):
    with pytest.raises(ValueError, match="there are no mutations"):
        mutations.run(repository, [])
    put(repository, entry("one"))
    with pytest.raises(ValueError, match="no mutation has 'two' in its name"):
        mutations.run(repository, ["two"])


def test_a_copy_that_python_does_not_import_is_refused(repository, monkeypatch):
    put(repository, entry("one"))
    monkeypatch.setattr(mutations, "copy_environment", lambda copy: {"PYTHONPATH": str(ROOT), "PYTHONSAFEPATH": "1"})
    with pytest.raises(MutationError, match="instead of the copy"):
        mutations.run(repository, [])


def test_the_command_takes_names_and_no_arguments_of_pytest(monkeypatch):
    called = []
    monkeypatch.setattr(mutations, "run", lambda root, names: called.append((root, names)) or 0)
    arguments = argparse.Namespace(mutations=["colour"], passed_on=[])
    assert test_command.run(arguments) == 0
    assert called == [(ROOT, ["colour"])]
    arguments.passed_on = ["-x"]
    with pytest.raises(ValueError, match="takes names"):
        test_command.run(arguments)


def test_the_scratch_copies_leave_nothing_behind(repository):
    put(repository, entry("one"))
    for name in ("results/mine.csv", "data/room/results/seed_1.csv", ".venv/bin/python"):
        (repository / name).parent.mkdir(parents=True)
        (repository / name).touch()
    with mutations.scratch_copies(repository, 1) as (copy,):
        assert not (copy / "results").exists()
        assert not (copy / ".venv").exists()
        assert (copy / "data" / "room" / "results" / "seed_1.csv").exists()
        assert (copy / "course_lib" / "code.py").read_text() == CODE
    assert not copy.exists()
