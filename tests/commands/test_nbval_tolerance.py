"""The comparison with a declared tolerance: numbers within it are taken, everything else is compared exactly."""

import pytest

from courseware.commands.nbval_tolerance import Tolerance, adopted, declared_tolerance, within_tolerance

TEN_PERCENT = Tolerance(0.1, 0.0)


@pytest.mark.parametrize(
    ("declared", "tolerance"), [("5 %", (0.05, 0.0)), ("0.002", (0.0, 0.002)), ("5 % or 0.002", (0.05, 0.002))]
)
def test_what_a_cell_declares(declared, tolerance):
    assert declared_tolerance({"metadata": {"numbers_within": declared}}) == tolerance
    assert declared_tolerance({"metadata": {}}) is None
    for wrong in ("", "5 % or", "five", "0.1 %%"):
        with pytest.raises(ValueError, match="numbers_within must be such as"):
            declared_tolerance({"metadata": {"numbers_within": wrong}})


@pytest.mark.parametrize(
    ("new", "stored", "taken"),
    [
        ("error 1.05 m", "error 1.00 m", True),
        ("error 1.12 m", "error 1.00 m", False),
        ("error 1.05 cm", "error 1.00 m", False),
        ("1.0, 2.0", "1.0, 2.0, 3.0", False),
        ("nan m", "1.0 m", False),
        ("1.05e-06", "1.00e-07", False),
    ],
)
def test_numbers_within_the_tolerance_are_taken_and_nothing_else(new, stored, taken):
    assert within_tolerance(new, stored, TEN_PERCENT) == (stored if taken else new)


def test_outputs_are_compared_one_by_one_in_every_form():
    stored = [{"text": "a 1.0\n"}, {"data": {"text/html": "b 2"}}]
    new = [{"text": "a 1.05\n"}, {"data": {"text/html": "b 2.1"}}]
    assert adopted(new, stored, TEN_PERCENT, str) == stored
    assert new[0]["text"] == "a 1.05\n", "what was run is left as it is"
    assert adopted(new, stored[:1], TEN_PERCENT, str)[1:] == new[1:], "an output too many is still one"
