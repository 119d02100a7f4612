"""`tools.train_detector` says what it needs before it does anything."""

import importlib.util

import pytest

from course_lib.cli import main


def words(tmp_path, *more):
    here = str(tmp_path)
    return ["train-detector", "--images", here, "--validation", here, "--out", f"{here}/out", *more]


@pytest.mark.skipif(importlib.util.find_spec("torch") is not None, reason="PyTorch is installed here")
def test_without_pytorch_it_says_what_to_install(tmp_path, capsys):
    assert main(words(tmp_path)) == 2
    error = capsys.readouterr().err
    assert "needs PyTorch" in error
    assert "pip install 'torch>=2.6'" in error


@pytest.mark.parametrize("option", ["--minutes", "--epochs", "--batch", "--learning-rate", "--threads", "--processes"])
def test_numbers_that_must_be_positive_are_named(option, tmp_path, capsys):
    assert main(words(tmp_path, option, "0")) == 2
    assert f"{option} must be above 0; got 0" in capsys.readouterr().err


def test_a_negative_seed_is_refused(tmp_path, capsys):
    assert main(words(tmp_path, "--seed", "-1")) == 2
    assert "--seed must be 0 or more" in capsys.readouterr().err
