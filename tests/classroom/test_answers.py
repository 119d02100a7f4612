"""Answers as text: what goes in comes out, and nothing else ever does."""

import json

import numpy as np
import pytest

from course_lib.classroom.answers import AnswerFormatError, Unreadable, decode, encode, load


def there_and_back(value):
    return decode(json.loads(json.dumps(encode(value))))


@pytest.mark.parametrize(
    "value",
    [None, True, 3, -(2**63), 0.1, float("inf"), float("-inf"), "text", ..., (1, (2.0, [3, "a"]), []), [[1, 2], [3]]],
)
def test_plain_values_come_back_as_they_are(value):
    found = there_and_back(value)
    assert found == value
    assert type(found) is type(value)


@pytest.mark.parametrize("kind", ["?", "u1", "u2", "i4", "i8", "f2", "f4", "f8", ">f8", "c16"])
@pytest.mark.parametrize("shape", [(), (0,), (3,), (2, 0, 1), (2, 3)])
def test_arrays_come_back_with_shape_and_type(kind, shape):
    value = np.arange(np.prod(shape, dtype=int)).reshape(shape).astype(kind)
    found = there_and_back(value)
    assert type(found) is np.ndarray
    assert found.shape == shape
    assert found.dtype == np.dtype(kind).newbyteorder("=")
    np.testing.assert_array_equal(found, value)


def test_numbers_of_numpy_stay_numbers_of_numpy_and_nan_stays_nan():
    assert type(there_and_back(np.float32(0.5))) is np.float32
    assert np.isnan(there_and_back(float("nan")))
    assert type(there_and_back(np.longdouble(2))) is np.float64


def test_what_holds_no_numbers_arrives_under_its_name():
    class Bomb:
        def __reduce__(self):
            raise AssertionError("nobody asks")

    for value, name in [(Bomb(), "Bomb"), ({}, "dict"), (np.array([None]), "ndarray of object"), ({1}, "set")]:
        found = there_and_back(value)
        assert isinstance(found, Unreadable)
        assert type(found).__name__ == name


def test_a_view_of_more_than_may_be_sent_is_never_copied():
    found = there_and_back(np.broadcast_to(1.0, (10**7,)))
    assert "too large" in type(found).__name__


def test_a_class_of_ones_own_is_the_number_or_row_that_it_is_underneath():
    class Odd(np.ndarray):
        def tobytes(self):
            raise AssertionError("of the base class")

    class Row(list):
        def __iter__(self):
            return iter([9, 9])

    class Number(float):
        def __float__(self):
            return 9.0

    assert type(there_and_back(np.ones(2).view(Odd))) is np.ndarray
    assert there_and_back(Row([1, 2])) == [1, 2]
    assert there_and_back(Number(2.5)) == 2.5


@pytest.mark.parametrize(
    "written",
    [
        {}, {"tuple": 3}, {"tuple": [], "list": []}, {"float": "1e400"}, {"kind": 3}, 10**100, {"pickle": "gASVAA=="},
        {"array": "", "type": "|O", "shape": [0], "scalar": False},
        {"array": "", "type": "<f8", "shape": [-1], "scalar": False},
        {"array": "", "type": "<f8", "shape": [10**18], "scalar": False},
        {"array": "", "type": "<f8", "shape": [0] * 40, "scalar": False},
        {"array": "", "type": "<f8", "shape": [0, 10**30], "scalar": False},
        {"array": "AAAA", "type": "<f8", "shape": [1], "scalar": False},
        {"array": "!", "type": "<f8", "shape": [1], "scalar": False},
        {"array": 3, "type": "<f8", "shape": [1], "scalar": False},
        {"array": "", "type": ["<f8"], "shape": [0], "scalar": False},
    ],
)  # fmt: skip
def test_what_nobody_writes_honestly_is_refused(written):
    with pytest.raises(AnswerFormatError):
        decode(written)


@pytest.mark.parametrize("line", [b"", b"x", b"[]", b"3", b"[" * 10**5, b'{"a": ' * 10**5, b"\xff", b"1" * 10**5])
def test_a_line_that_is_no_message_is_refused(line):
    with pytest.raises(AnswerFormatError):
        load(line)


def test_a_name_is_shown_without_control_characters():
    assert type(decode({"kind": "a\x1b[31m\nb" + "x" * 100})).__name__ == ("a [31m b" + "x" * 100)[:60]
