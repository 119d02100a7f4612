"""Find the library's own solution in a submission. This is a rule that is checked, not a wall."""

import dis
import inspect
from collections.abc import Callable, Iterator
from types import CodeType, ModuleType


def forbidden_module(function: Callable, forbidden: tuple[str, ...]) -> str | None:
    """Return the first of the `forbidden` modules that a function, or a function that it names, imports or uses."""
    waiting, seen = [function], set()
    while waiting:
        value = waiting.pop()
        if id(value) in seen:
            continue
        seen.add(id(value))
        name = value.__name__ if isinstance(value, ModuleType) else getattr(value, "__module__", None) or ""
        for module in [name, *_imported(value)]:
            if found := next((one for one in forbidden if f"{module}.".startswith(f"{one}.")), None):
                return found
        if name == function.__module__:
            waiting += _used(value)
    return None


def _codes(code: CodeType) -> Iterator[CodeType]:
    """Yield a function's code and the code of the functions inside of it."""
    yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _codes(constant)


def _imported(value: object) -> Iterator[str]:
    """Yield the modules that a function imports. For `from a import b`, yield both a and a.b."""
    for code in _codes(value.__code__) if inspect.isfunction(value) else ():
        for one in dis.get_instructions(code):
            if one.opname == "IMPORT_NAME":
                yield (module := one.argval)
            elif one.opname == "IMPORT_FROM":
                yield f"{module}.{one.argval}"


def _used(value: object) -> list:
    """Return what a student's function or class names: globals, attributes of modules, closures, methods."""
    if inspect.isclass(value):
        return list(vars(value).values())
    if not inspect.isfunction(value):
        return []
    names = {name for code in _codes(value.__code__) for name in code.co_names}
    found = [value.__globals__[name] for name in names if name in value.__globals__]
    found += [cell.cell_contents for cell in value.__closure__ or ()]
    modules = [one for one in found if isinstance(one, ModuleType)]
    return found + [vars(module)[name] for module in modules for name in names if name in vars(module)]
