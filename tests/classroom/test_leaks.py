"""What of the teacher's is found, however a file writes it."""

import json

import pytest

from courseware.classroom.leaks import find_leaks

BODY = "# one over the term\nreturn alpha / term - alpha  # metres"


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.md", f"see\n    {BODY}"),
        ("a.py", "def f(term, alpha):\n        # one over the term\n        return alpha/term  -  alpha # metres"),
        ("a.ipynb", json.dumps({"cells": [{"source": [line + "\n" for line in BODY.splitlines()]}]})),
        ("a.ipynb", json.dumps({"cells": [{"outputs": [{"data": {"text/plain": BODY}}]}]})),
        ("a.png", f"\x00{BODY}"),
        ("a.html", "<i># one over the term</i>\n<b>return</b> alpha <b>/</b> term <b>-</b> alpha <i># metres</i>"),
    ],
)
def test_a_body_is_found_whatever_its_spaces_and_colours(tmp_path, name, text):
    (tmp_path / "deep").mkdir()
    (tmp_path / "deep" / name).write_bytes(b"\xff" + text.encode())  # no UTF-8, but read all the same
    assert find_leaks(tmp_path, {"the answer": BODY}) == [f"deep/{name} holds the answer"]
    assert find_leaks(tmp_path, {"the answer": BODY.replace("alpha", "beta")}) == []
