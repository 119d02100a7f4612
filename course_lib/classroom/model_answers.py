"""Model answers put into the student's stubs: the stub's signature and docstring, the solution's body.

A lesson's solution is a function of another name, in a cell of its own. A project's stands in a file of its own, in
which functions share constants and small helpers; each stub gets those that it needs, so that it stands alone.
"""

import ast
import importlib.util
import textwrap
from collections.abc import Callable

from course_lib.classroom.assignment_cells import Assignment, AssignmentError
from course_lib.paths import REPOSITORY

BEGIN, END = "### BEGIN SOLUTION", "### END SOLUTION"
INDENT = "    "


def model_solution_path(name: str):
    """Where the model solution of a project ("P1") lies."""
    return REPOSITORY / "notebooks" / "projects" / "solutions" / f"{name}_model_solution.py"


def model_functions(name: str) -> dict[str, Callable]:
    """The functions of a project's model solution, by name."""
    path = model_solution_path(name)
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return {key: value for key, value in vars(module).items() if callable(value)}


def function_name(stub: str) -> str:
    """Name of the function that a stub's cell defines."""
    return _only_function(stub).name


def model_bodies(assignment: Assignment) -> dict[str, str]:
    """The model answer's body for every stub, by its function's name, not indented."""
    if not assignment.is_project:
        return {
            function_name(one.stub): lesson_body(one.stub, one.solution, one.number) for one in assignment.exercises()
        }
    source = model_solution_path(assignment.name).read_text(encoding="utf-8")
    stubs = [one.stub for one in assignment.exercises()] + [assignment.submission()]
    names = [function_name(stub) for stub in stubs]
    return {name: project_body(source, name, set(names)) for name in names}


def lesson_body(stub: str, solution: str | None, number: str) -> str:
    """Body of a lesson's solution, comments included; arguments that it has beyond the stub's become assignments.

    Raises `AssignmentError` where the two do not take the same arguments.
    """
    if solution is None:
        raise AssignmentError(f"exercise {number} has no solution cell")
    asked, answered = _only_function(stub), _only_function(solution)
    wanted, given = ([argument.arg for argument in one.args.args] for one in (asked, answered))
    more, defaults = given[len(wanted) :], answered.args.defaults
    if given[: len(wanted)] != wanted or len(more) > len(defaults):
        raise AssignmentError(f"exercise {number}: the stub takes {wanted}, its solution {given}")
    values = defaults[len(defaults) - len(more) :]
    fixed = [f"{name} = {ast.unparse(value)}" for name, value in zip(more, values, strict=True)]
    return "\n".join([*fixed, _body_text(solution, answered)])


def project_body(source: str, name: str, stages: set[str]) -> str:
    """Body of one function of a project's model solution, with the imports, constants and helpers that it needs.

    stages: names that the notebook defines itself; numpy is imported there as np.
    """
    tree = ast.parse(source)
    defined = {bound: node for node in tree.body for bound in _bound_names(node)}
    if not isinstance(defined.get(name), ast.FunctionDef):
        raise AssignmentError(f"the model solution has no function {name}()")
    needed: list[ast.stmt] = []
    waiting = [defined[name]]
    while waiting:
        for used in sorted(_used_names(waiting.pop()) - stages - {"np"}):
            node = defined.get(used)
            if node is not None and node not in needed:
                needed.append(node)
                waiting.append(node)
    parts = [ast.get_source_segment(source, node) for node in sorted(needed, key=lambda node: node.lineno)]
    return "\n\n".join([*parts, _body_text(source, defined[name])])


def solved_stub(stub: str, body: str, marked: bool = False) -> str:
    """The stub with the body in place of its `...`; marked: between nbgrader's two comments.

    With the region between the comments replaced by `...` it is the stub again.
    """
    lines = stub.splitlines()
    node = _only_function(stub)
    last = node.body[-1]
    if not (isinstance(last, ast.Expr) and isinstance(last.value, ast.Constant) and last.value.value is ...):
        raise AssignmentError(f"the stub of {node.name}() does not end in `...`")
    inner = [BEGIN, *body.splitlines(), END] if marked else body.splitlines()
    filled = [INDENT + line if line else line for line in inner]
    return "\n".join([*lines[: last.lineno - 1], *filled, *lines[last.end_lineno :]])


def _only_function(source: str) -> ast.FunctionDef:
    functions = [node for node in ast.parse(source).body if isinstance(node, ast.FunctionDef)]
    if len(functions) != 1:
        raise AssignmentError(f"a stub or a solution defines one function; this cell defines {len(functions)}")
    return functions[0]


def _body_text(source: str, node: ast.FunctionDef) -> str:
    """Lines of a function's body, comments included, docstring not, not indented."""
    statements = node.body[1:] if ast.get_docstring(node) is not None else node.body
    if ast.get_docstring(node) is not None:
        first = node.body[0].end_lineno
    else:
        ends = [node.lineno, *(argument.end_lineno for argument in node.args.args)]
        first = max(ends)
    lines = source.splitlines()[first : statements[-1].end_lineno]
    return textwrap.dedent("\n".join(lines)).strip("\n")


def _bound_names(node: ast.stmt) -> list[str]:
    """Names that a statement of a module binds."""
    if isinstance(node, ast.Import | ast.ImportFrom):
        return [alias.asname or alias.name for alias in node.names]
    if isinstance(node, ast.FunctionDef):
        return [node.name]
    if isinstance(node, ast.Assign):
        return [one.id for target in node.targets for one in ast.walk(target) if isinstance(one, ast.Name)]
    return []


def _used_names(node: ast.stmt) -> set[str]:
    return {one.id for one in ast.walk(node) if isinstance(one, ast.Name)}
