"""The one rule of what runs: what an answer needs, and what changes it; magics are stripped line by line."""

import ast
import time

import pytest

from courseware.lessons.kit.statements import needed, read_statements, without_magics


def ran(function, *cells):
    """Return the source of the statements that a function needs, and the problems."""
    statements, problems = read_statements([(f"cell {k}", source) for k, source in enumerate(cells, 1)])
    return [ast.unparse(one.node) for one in needed(statements, function)], problems


@pytest.mark.parametrize(
    ("source", "python"),
    [
        ("%%time\nx = 1", "\nx = 1"),
        ("%%bash\nrm -rf /", ""),
        ("%matplotlib inline\nx = 1", "pass\nx = 1"),
        ("if x:\n    !ls\n    y = 2", "if x:\n    pass\n    y = 2"),
        ("x = 1\nx?", "x = 1\npass"),
        ('s = ("%d"\n     % 3)', 's = ("%d"\n     % 3)'),
        ("%%capture out\n%time y = 2\nx = 1", "\npass\nx = 1"),
    ],
)
def test_magics_are_stripped_line_by_line(source, python):
    assert without_magics(source) == python
    ast.parse(python)


def test_what_defines_or_changes_a_needed_name_runs_and_nothing_else():
    found, problems = ran(
        "answer",
        "import numpy as np\nimport os",
        "table = {}\nother = {}\nshow(table)",
        "table.update(one=1)\nother.update(two=2)\ntable['three'] = 3",
        "def fill(t):\n    t[4] = 4\nfill(table)\nfill(other)",
        "def answer(x):\n    return np.sum(x) + table['one'] + helper(x)",
        "def helper(x):\n    return SCALE * x\nSCALE = 2\nprint(answer(3))",
    )
    assert problems == []
    assert found == [
        "import numpy as np", "table = {}", "table.update(one=1)", "table['three'] = 3",
        "def fill(t):\n    t[4] = 4", "fill(table)",
        "def answer(x):\n    return np.sum(x) + table['one'] + helper(x)", "def helper(x):\n    return SCALE * x",
        "SCALE = 2",
    ]  # fmt: skip


def test_a_loop_that_fills_a_needed_list_runs():
    found, _ = ran("answer", "rows = []\nfor k in range(3):\n    rows.append(k)", "def answer():\n    return rows")
    assert len(found) == 3


def test_a_cell_that_is_no_python_is_named_and_the_others_count():
    found, problems = ran("answer", "x = = 1", "def answer():\n    return 1", "x = " + "(" * 500)
    assert len(found) == 1
    assert [one.split(" is ")[0] for one in problems] == ["cell 1, line 1", "cell 3, line 1"]


LONG = {
    "assignments": lambda n: "\n".join(f"x{k} = x{k - 1} + 1" for k in range(1, n)) + f"\nlast = x{n - 1}",
    "one name": lambda n: "\n".join(["last = 0", *["last = last + 1"] * n]),
    "an f-string": lambda n: "last = f'" + "{y}" * n + "'",
}


@pytest.mark.parametrize("source", LONG.values(), ids=LONG)
def test_reading_takes_time_in_proportion_to_the_length(source):
    """Nine thousand assignments took 467 s, and an f-string of 400 KB took 51 s. Ten times the length is ten times."""

    def seconds(n: int) -> float:
        start = time.process_time()
        ran("answer", source(n), "def answer():\n    return last")
        return time.process_time() - start

    # A quadratic rule takes a hundred times as long.
    # (A profiler would count steps, but CPython 3.11.7 can hang under one.)
    assert seconds(10_000) < 40 * min(seconds(1000) for _ in range(3))
