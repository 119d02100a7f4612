"""General mistakes: slips that people make in every exercise, so that no exercise lists them.

A slip changes the values that the solution returns (degrees for radians), the values that it is given (two arguments
exchanged), or one place of its code (`axis=0` for `axis=1`). A sentence belongs to each. Degrees and radians are
exchanged in angles only: in arguments and results that a name or the docstring of the solution calls an angle.
"""

import ast
import copy
import functools
import inspect
import re
import textwrap
from collections.abc import Callable, Iterator, Sequence
from itertools import accumulate

import numpy as np

from courseware.lessons.kit.attempt import TIME_LIMIT, attempt
from courseware.lessons.kit.exercise import Exercise
from courseware.lessons.kit.mistakes import compiled
from courseware.lessons.kit.values import agree, as_numbers, is_row_of, parts

SIGN = "Look at the signs: one of them is the other way round."
DEGREES = "Look at the units: are these degrees where radians are asked, or the reverse?"
SQUARED = "A square or a root is missing, or there is one too many: variance or deviation?"
TRANSPOSED = "Something is transposed: rows for columns, or a rotation for its inverse. From which frame to which?"
ABSOLUTE = "An absolute value is missing, or one too many: try a negative number."
AXIS = "Rows for columns: look along which axis you add, average or compare."
EXCHANGED = "Two arguments are exchanged, or two frames: which one comes from where?"
OFF_BY_ONE = (
    "Off by one: look where you begin to count, and whether a loop or a slice leaves out the first or the last."
)
DIVISOR = "n, or n - 1? Look at what you divide by, and at `ddof`."
MIDDLE = "A mean is not a median: which of them does the task ask for?"
EXTREME = "Least and greatest are exchanged."
EQUAL = "Try equal values: less than, or less than or equal?"
QUOTIENT = "Something is multiplied where it should be divided, or the reverse."
ARCTAN2 = "`np.arctan2` takes y first, then x."
HALF_CIRCLE = "An arctangent of a quotient knows half of the circle only: which function is told both signs?"
SINE = "Sine and cosine are exchanged."
WRAP = "An angle leaves the range from -pi to pi: bring it back."
LIMITS = "A limit at the ends of the range is missing."
NEARLY = "Nearly right, within 1 % everywhere: is something rounded, or simulated where it can be computed?"
CLOSE = "Within 5 % everywhere, but not equal: is something simulated, rounded, or a small term left out?"
FACTOR = "Yours differs from the right values by one constant factor."
OFFSET = "Yours differs from the right values by one constant summand."

LIMIT = 0.2  # [s] of one call of a slip, which may make a loop endless; the right function takes milliseconds

OF_ARGUMENTS = ((SIGN, np.negative), (DEGREES, np.rad2deg), (DEGREES, np.deg2rad), (TRANSPOSED, np.transpose))
OF_VALUES = (*OF_ARGUMENTS[:3], (SQUARED, np.square), (SQUARED, np.sqrt), OF_ARGUMENTS[3], (ABSOLUTE, np.abs))

ANGLE = re.compile(
    r"(?<![a-z])(angles?|theta|roll|pitch|yaw|headings?|azimuths?|elevations?|rad(ians)?|deg(rees)?)(?![a-z])"
)
BESIDE_THE_RESULT = re.compile(r", from |;| after | by | with(in)? |_from_")  # what follows describes something else


def general_mistake(exercise: Exercise, arguments: list[tuple], answers: list) -> str | None:
    """Return the sentence of the slip that gives exactly these answers, or None."""
    with np.errstate(all="ignore"):
        wanted = [exercise.solution(*copy.deepcopy(given)) for given in arguments]
        for sentence, slip in value_slips(exercise.solution, wanted):
            if all(agree(a, slip(w), exercise.tolerance) for a, w in zip(answers, wanted, strict=True)):
                return sentence
        for sentence, function in [*argument_slips(exercise.solution, arguments[-1]), *code_slips(exercise.solution)]:
            if all(gives(function, g, a, exercise.tolerance, LIMIT) for g, a in zip(arguments, answers, strict=True)):
                return sentence
        return constant_difference(answers, wanted, exercise.tolerance)


def gives(function: Callable, given: tuple, answer: object, tolerance: float, seconds: float = TIME_LIMIT) -> bool:
    """Return whether a mistaken function gives this answer. If it cannot run on these arguments, it does not."""
    call = attempt(function, copy.deepcopy(given), seconds)
    return call.failure is None and agree(answer, call.value, tolerance)


def value_slips(solution: Callable, wanted: list) -> Iterator[tuple[str, Callable]]:
    """Yield slips of the returned value: of all parts of a tuple, or of one part alone."""
    n, whole = len(parts(wanted[0])), np.asarray(parts(wanted[0])[0]).dtype.kind == "i"
    for sentence, change in OF_VALUES:
        if sentence is DEGREES and (whole or not returns_angle(solution)):
            continue
        for which in [range(n), *([k] for k in range(n) if n > 1)]:
            yield sentence, functools.partial(_changed, change, which)
    if whole:
        for step in (1, -1):
            yield OFF_BY_ONE, functools.partial(_changed, functools.partial(np.add, step), range(n))


def returns_angle(solution: Callable) -> bool:
    """Return whether a function's name, or the beginning of its docstring, calls the result an angle."""
    if not inspect.isfunction(solution):
        return False
    result = (BESIDE_THE_RESULT.split(text)[0] for text in (solution.__name__, solution.__doc__ or ""))
    return any(ANGLE.search(text.lower()) for text in result)


def takes_angle(solution: Callable, k: int) -> bool:
    """Return whether argument k is an angle by its name, or by the unit behind its name in the docstring."""
    if not inspect.isfunction(solution):
        return False
    name = [*inspect.signature(solution).parameters][k]
    return bool(ANGLE.search(name) or re.search(rf"\b{name}`?( \([^)]*\))? \[(rad|deg)", solution.__doc__ or ""))


def _changed(change: Callable, which: Sequence[int], value: object) -> object:
    arrays = (np.asarray(part) * 1 for part in parts(value))  # numbers in place of truth values
    changed = tuple(change(part) if k in which else part for k, part in enumerate(arrays))
    return changed if isinstance(value, tuple) else changed[0]


def argument_slips(solution: Callable, given: tuple) -> Iterator[tuple[str, Callable]]:
    """Yield slips of the given values: one argument changed, or two of the same shape exchanged."""
    numbers = [k for k, value in enumerate(given) if np.asarray(value).dtype.kind in "if"]
    for k in numbers:
        fits = {
            SIGN: True,
            DEGREES: np.asarray(given[k]).dtype.kind == "f" and takes_angle(solution, k),
            TRANSPOSED: np.ndim(given[k]) == 2,
        }
        for sentence, change in OF_ARGUMENTS:
            if fits[sentence]:
                yield sentence, lambda *g, k=k, change=change: solution(*g[:k], change(g[k]), *g[k + 1 :])
        for j in numbers[:k]:
            if np.shape(given[j]) == np.shape(given[k]):
                yield EXCHANGED, lambda *g, j=j, k=k: solution(*g[:j], g[k], *g[j + 1 : k], g[j], *g[k + 1 :])


def code_slips(solution: Callable) -> Iterator[tuple[str, Callable]]:
    """Yield functions with one place of the solution's code changed, then with all places of one kind of slip."""
    source = textwrap.dedent(inspect.getsource(solution)) if inspect.isfunction(solution) else ""
    if not source.startswith("def "):  # a lambda, or compiled code
        return
    code = source.encode()  # because `ast` counts bytes
    lines = list(accumulate((len(line) + 1 for line in code.split(b"\n")), initial=0))
    places: dict[str, list] = {}
    for node in _expressions(ast.parse(source).body[0]):
        start, end = lines[node.lineno - 1] + node.col_offset, lines[node.end_lineno - 1] + node.end_col_offset
        for sentence, new in _changes(node):
            places.setdefault(sentence, []).append((start, end, new))
    for sentence, found in places.items():
        apart: list = []  # all places that do not overlap an earlier one
        for place in sorted(found):
            if not apart or place[0] >= apart[-1][1]:
                apart.append(place)
        for chosen in [*([place] for place in found), apart]:
            text = code
            for start, end, new in reversed(chosen):
                text = text[:start] + f"({new})".encode() + text[end:]
            try:
                yield sentence, compiled(solution, text.decode())
            except ValueError:  # such as a slip inside of an f-string
                continue


def _expressions(node: ast.AST) -> Iterator[ast.expr]:
    """Yield the expressions in a function. We leave out `while`, where a slip may run forever."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.expr):
            yield child
        if not isinstance(child, ast.While | ast.arguments):
            yield from _expressions(child)


SWAPPED = {
    "mean": ("median", MIDDLE), "median": ("mean", MIDDLE), "nanmean": ("nanmedian", MIDDLE),
    "nanmedian": ("nanmean", MIDDLE), "argmin": ("argmax", EXTREME), "argmax": ("argmin", EXTREME),
    "min": ("max", EXTREME), "max": ("min", EXTREME), "sin": ("cos", SINE), "cos": ("sin", SINE),
}  # fmt: skip
DROPPED = {"abs": ABSOLUTE, "sqrt": SQUARED, "wrap_angle": WRAP, "clip": LIMITS, "deg2rad": DEGREES, "rad2deg": DEGREES}
STRICT = {ast.Lt: "<=", ast.LtE: "<", ast.Gt: ">=", ast.GtE: ">"}
OPERATORS = {
    ast.Add: [(SIGN, "({a}) - ({b})")],
    ast.Sub: [(SIGN, "({a}) + ({b})")],
    ast.Mult: [(QUOTIENT, "({a}) / ({b})")],
    ast.Div: [(QUOTIENT, "({a}) * ({b})")],
    ast.Pow: [(SQUARED, "{a}")],
    ast.MatMult: [(TRANSPOSED, "({a}).T @ ({b})"), (TRANSPOSED, "({a}) @ ({b}).T")],
}


def _changes(node: ast.AST) -> Iterator[tuple[str, str]]:
    """Yield (sentence, new code) for the slips that one expression allows."""
    match node:
        case ast.Call(func=ast.Name(id=name) | ast.Attribute(attr=name)):
            yield from _changes_of_call(node, name)
        case ast.BinOp(left=left, op=op, right=right):
            for sentence, new in OPERATORS.get(type(op), ()):
                yield sentence, new.format(a=ast.unparse(left), b=ast.unparse(right))
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            yield SIGN, ast.unparse(operand)
        case ast.Attribute(value=value, attr="T", ctx=ast.Load()):
            yield TRANSPOSED, ast.unparse(value)
        case ast.Compare(left=left, ops=[op], comparators=[right]) if type(op) in STRICT:
            yield EQUAL, f"({ast.unparse(left)}) {STRICT[type(op)]} ({ast.unparse(right)})"


def _changes_of_call(node: ast.Call, name: str) -> Iterator[tuple[str, str]]:
    listed, rest, called = [*map(ast.unparse, node.args)], [*map(ast.unparse, node.keywords)], ast.unparse(node.func)
    if name in SWAPPED:
        other, sentence = SWAPPED[name]
        if other == "median" and not called.startswith("np."):  # arrays have no method of this name
            swapped, values = "np.median", [called.removesuffix(f".{name}"), *listed]
        else:
            swapped, values = f"{called.removesuffix(name)}{other}", listed
        yield sentence, f"{swapped}({', '.join(values + rest)})"
    if name in DROPPED and listed:
        yield DROPPED[name], listed[0]
    if name == "arctan2":
        yield ARCTAN2, f"{called}({listed[1]}, {listed[0]})"
        yield HALF_CIRCLE, f"{called.removesuffix('2')}({listed[0]} / ({listed[1]}))"
    if name in ("std", "var"):
        others = [word for word in rest if not word.startswith("ddof")]
        yield DIVISOR, f"{called}({', '.join(listed + others + ([] if others != rest else ['ddof=1']))})"
    if name == "range":
        yield OFF_BY_ONE, f"range({', '.join(listed)})[1:]"
        yield OFF_BY_ONE, f"range({', '.join(listed)})[:-1]"
    if name == "len":
        yield DIVISOR, f"({ast.unparse(node)} - 1)"
    for index, axis in enumerate(rest):
        if axis in ("axis=0", "axis=1", "axis=-1"):
            other = "axis=1" if axis == "axis=0" else "axis=0"
            yield AXIS, f"{called}({', '.join([*listed, *rest[:index], other, *rest[index + 1 :]])})"


def constant_difference(answers: list, wanted: list, tolerance: float) -> str | None:
    """Return a sentence if all answers are nearly right, or differ by the same factor or summand; else None."""
    several = isinstance(wanted[0], tuple)
    if several and not all(is_row_of(len(wanted[0]), answer) for answer in answers):
        return None
    pairs = [
        (as_numbers(a), np.asarray(w, dtype=float))
        for answer, right in zip(answers, wanted, strict=True)
        for a, w in zip(answer if several else (answer,), parts(right), strict=True)
    ]
    if any(a is None or a.shape != w.shape for a, w in pairs):
        return None
    for share, sentence in ((0.01, NEARLY), (0.05, CLOSE)):
        if all(np.allclose(a, w, rtol=0, atol=share * _size(w), equal_nan=True) for a, w in pairs):
            return sentence
    a, w = (np.concatenate([np.ravel(pair[k]) for pair in pairs]) for k in (0, 1))
    telling = np.isfinite(a) & np.isfinite(w) & (w != 0)
    if several or np.count_nonzero(telling) < 3:
        return None
    factor, summand = np.median(a[telling] / w[telling]), np.median(a[telling] - w[telling])
    for sentence, right in ((FACTOR, w * factor), (OFFSET, w + summand)):
        if np.any(right) and np.allclose(a, right, rtol=tolerance, atol=tolerance, equal_nan=True):
            return sentence
    return None


def _size(values: np.ndarray) -> float:
    return np.abs(values[np.isfinite(values)]).max(initial=0.0)
