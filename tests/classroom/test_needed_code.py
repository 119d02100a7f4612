"""Of a notebook's cells, the statements that one function needs."""

import ast

from course_lib.classroom.needed_code import needed_code


def chosen(cells, function="f"):
    """The statements that would run, each as one text."""
    code = needed_code([(f"cell {number}", source) for number, source in enumerate(cells, 1)], function)
    return [ast.unparse(ast.parse(source).body[index]) for _, source, which in code.cells for index in which]


def test_the_function_its_helpers_their_constants_and_imports_run_and_nothing_else():
    cells = [
        "import numpy as np\nimport os\nheavy = os.walk('/')",
        "SIZE = 3\nother = heavy",
        "def helper(x):\n    return np.ones(SIZE) * x",
        "print(heavy)\ncheck('06.1', f)",
        "def f(x):\n    heavy = helper(x)\n    return heavy",
    ]
    assert [text.splitlines()[0] for text in chosen(cells)] == [
        "import numpy as np", "SIZE = 3", "def helper(x):", "def f(x):",
    ]  # fmt: skip


def test_a_local_name_brings_no_cell_in_and_a_global_one_does():
    cells = ["w = slow()", "def f(x):\n    w = x\n    return w"]
    assert len(chosen(cells)) == 1
    assert chosen(["w = 1", "def f(x):\n    return lambda: w"])[0] == "w = 1"
    assert chosen(["w = 1", "def f(x, y=w):\n    return y"])[0] == "w = 1"
    assert chosen(["def w(g):\n    return g", "@w\ndef f(x):\n    return x"])[0].startswith("def w")


def test_what_changes_a_needed_name_runs_too():
    cells = [
        "table = {}\ntable['a'] = 1\ncount = 0\ncount += 1",
        "for k in range(3):\n    table[k] = k",
        "f = table.get",
    ]
    assert len(chosen(cells)) == 4  # not count


def test_the_last_definition_counts_and_what_is_assigned_after_it():
    cells = [
        "for f in slow(): pass",
        "def f(x):\n    return 0",
        "def f(x):\n    return g(x)\nf = wrap(f)",
        "def g(x): pass",
    ]
    texts = chosen([*cells, "for f in slow():\n    pass"])
    assert [text.splitlines()[0] for text in texts] == ["def f(x):", "f = wrap(f)", "def g(x):"]
    assert "g(x)" in texts[0]


def test_lines_for_ipython_and_cells_for_other_programs_are_left_out():
    cells = ["%matplotlib inline\n!rm -rf /\n?print\nSIZE = 1", "%%bash\nrm -rf /", "def f():\n    return SIZE"]
    assert chosen(cells) == ["SIZE = 1", "def f():\n    return SIZE"]


def test_a_cell_that_cannot_be_read_is_named_and_the_others_run():
    code = needed_code([("cell 1", "def f(:"), ("cell 2", "x = '\0'"), ("cell 3", "def f():\n    return 1")], "f")
    assert [name for name, *_ in code.cells] == ["cell 3"]
    assert code.problems[0].startswith("cell 1, line 1 is no Python that can be read: SyntaxError")
    assert code.problems[1].startswith("cell 2")


def test_code_nested_without_end_is_named():
    code = needed_code([("cell 1", "x = " + "(" * 5000 + ")" * 5000), ("cell 2", "x = " + "-" * 200_000 + "1")], "x")
    assert len(code.problems) == 2


def test_star_imports_and_the_future_always_run():
    cells = ["from __future__ import annotations", "from numpy import *", "def f():\n    return ones(3)"]
    assert len(chosen(cells)) == 3
