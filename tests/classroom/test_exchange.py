"""Answers as text: what goes in comes out, and nothing else ever does."""

import base64
import json
import struct

import numpy as np
import pytest

from courseware.classroom.exchange import AnswerFormatError, Unreadable, decode, encode, load


def array(header: str) -> str:
    """A file of NumPy's with this header and no data."""
    return base64.b64encode(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode()).decode()


def there_and_back(value):
    return decode(json.loads(json.dumps(encode(value))))


@pytest.mark.parametrize("value", [
    None, True, 3, -(2**63), 0.1, float("inf"), float("-inf"), "text", ..., (1, (2.0, [3, "a"]), []), [[1, 2], [3]],
])  # fmt: skip
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
    assert found.dtype == np.dtype(kind)
    np.testing.assert_array_equal(found, value)


def test_numbers_of_numpy_stay_numbers_of_numpy_and_nan_stays_nan():
    assert type(there_and_back(np.float32(0.5))) is np.float32
    assert np.isnan(there_and_back(float("nan")))
    assert there_and_back(np.longdouble(2)) == 2


def test_what_holds_no_numbers_arrives_under_its_name():
    class Bomb:
        def __reduce__(self):
            raise AssertionError("nobody asks")

    values = [Bomb(), {}, {1}, 10**10000, np.array([None]), np.broadcast_to(1.0, (10**7,))]
    found = [there_and_back(value) for value in values]
    assert all(isinstance(one, Unreadable) for one in found)
    assert [type(one).__name__ for one in found] == ["Bomb", "dict", "set", "int", "ndarray", "ndarray"]


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
        {}, {"tuple": 3}, {"tuple": {}, "list": 1}, {"pickle": "gASVAA=="}, {"array": ""}, {"array": 3},
        {"array": "!", "scalar": False}, {"array": array("{'descr': '|O', 'fortran_order': False, 'shape': (1,)}")},
        {"array": array("{'descr': '<f8', 'fortran_order': False, 'shape': (1000000000000,)}")},
        {"array": array("{'descr': '<f8', 'fortran_order': False, 'shape': (-1,)}")},
        {"array": array("{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (0,)}")},
        {"array": array("{'descr': '<U9', 'fortran_order': False, 'shape': (0,)}")}, {"array": array("(" * 200)},
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
