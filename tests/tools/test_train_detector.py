"""`tools.train_detector` says what it needs before it does anything."""

import importlib.util

import pytest


def words(folder, *more):
    return ["train_detector", "--images", folder, "--validation", folder, "--out", folder / "out", *more]


@pytest.mark.skipif(importlib.util.find_spec("torch") is not None, reason="PyTorch is installed here")
def test_without_pytorch_it_says_what_to_install(tmp_path, run_tool, capsys):
    assert run_tool(*words(tmp_path)) == 2
    assert "pip install 'torch>=2.6'" in capsys.readouterr().err


@pytest.mark.parametrize("option", ["--minutes", "--learning-rate"])
def test_numbers_that_must_be_positive_are_named(option, tmp_path, run_tool, capsys):
    assert run_tool(*words(tmp_path, option, "0")) == 2
    assert f"{option} must be above 0; got 0" in capsys.readouterr().err
