"""Find the library's own solution in a submission. This is a rule that is checked, not a wall."""

import dis
import inspect
import types
from collections.abc import Callable, Iterator


def forbidden_module(function: Callable, forbidden: tuple[str, ...]) -> str | None:
    """Return the first of the `forbidden` modules that a function, or a function that it names, imports or uses."""
    waiting, seen = [function], set()
    while waiting:
        value = waiting.pop()
        if id(value) in seen:
            continue
        seen.add(id(value))
        name = value.__name__ if isinstance(value, types.ModuleType) else getattr(value, "__module__", None) or ""
        for module in [name, *_imported(value)]:
            if found := next((one for one in forbidden if f"{module}.".startswith(f"{one}.")), None):
                return found
        if name == function.__module__:
            waiting += _used(value)
    return None


def _codes(function: types.FunctionType) -> Iterator[types.CodeType]:
    """Yield the code of a function and of the functions inside of it."""
    waiting = [function.__code__]
    while waiting:
        code = waiting.pop()
        yield code
        waiting += [constant for constant in code.co_consts if isinstance(constant, types.CodeType)]


def _imported(value: object) -> list[str]:
    """Return the modules that a function imports: of `from a import b`, both a and a.b."""
    if not inspect.isfunction(value):
        return []
    instructions = [one for code in _codes(value) for one in dis.get_instructions(code)]
    named, module = [], ""
    for one in instructions:
        if one.opname == "IMPORT_NAME":
            module = one.argval
            named.append(module)
        elif one.opname == "IMPORT_FROM":
            named.append(f"{module}.{one.argval}")
    return named


def _used(value: object) -> list:
    """Return what a student's function or class names: globals, attributes of modules, closures, methods."""
    if inspect.isclass(value):
        return list(vars(value).values())
    if not inspect.isfunction(value):
        return []
    names = {name for code in _codes(value) for name in code.co_names}
    found = [value.__globals__[name] for name in names if name in value.__globals__]
    found += [cell.cell_contents for cell in value.__closure__ or ()]
    modules = [one for one in found if isinstance(one, types.ModuleType)]
    return found + [vars(module)[name] for module in modules for name in names if name in vars(module)]
