"""Explain a wrong answer in a sentence: a known mistake, a wrong order, type or shape, a NaN or an infinity."""

import copy
import itertools

import numpy as np

from courseware.lessons.kit.exercise import Exercise
from courseware.lessons.kit.general_mistakes import general_mistake, gives
from courseware.lessons.kit.values import agree, agree_all, as_numbers, is_row_of, parts, shaped

MISSING_RETURN = "Your function returns None: does every way through it end in `return`?"


def hint(exercise: Exercise, arguments: list[tuple], answers: list, details: bool = True) -> str:
    """Return the hint for wrong answers to a list of inputs. It shows neither the inputs nor the right values.

    details: describe the answers, too: their type, their shape, how many are right. A grader leaves these out, because
    a function could carry one of its secret inputs out in them.
    """
    if any(answer is None for answer in answers):
        return MISSING_RETURN
    if (sentence := known_mistake(exercise, arguments, answers)) is not None:
        return sentence
    wanted = [exercise.solution(*copy.deepcopy(given)) for given in arguments]
    if isinstance(wanted[0], tuple):
        for order in itertools.permutations(range(len(wanted[0]))):
            if agree_all(answers, [tuple(right[k] for k in order) for right in wanted], exercise.tolerance):
                return "The values are right, but in another order than the task names them."
    if (sentence := general_mistake(exercise, arguments, answers)) is not None:
        return sentence
    inf_is_an_answer = any(np.isinf(np.asarray(w, dtype=np.float64)).any() for right in wanted for w in parts(right))
    for answer, right in zip(answers, wanted, strict=True):
        if (sentence := _difference(answer, right, inf_is_an_answer, details)) is not None:
            return sentence
    right = [agree(a, w, exercise.tolerance) for a, w in zip(answers, wanted, strict=True)]
    names = list(exercise.cases)  # of the first inputs
    if not any(right):
        return "Shape and type fit, but the values differ on every input. Work one small case by hand and compare."
    if all(right[len(names) :]):
        missed = [name for name, is_right in zip(names, right, strict=False) if not is_right]
        return f"Right on all ordinary inputs, wrong on a special case: {', '.join(missed)}."
    some, others = (f"{sum(right)} of {len(right)}", len(right) - sum(right)) if details else ("some", "others")
    return (
        f"Right on {some} inputs, wrong on {others}: which case is left out? "
        "Try small inputs of your own: equal values, zeros, both signs, the ends of the range."
    )


def known_mistake(exercise: Exercise, arguments: list[tuple], answers: list) -> str | None:
    """Return the hint of the exercise's own mistake that gives exactly these answers, or None."""
    pairs = list(zip(arguments, answers, strict=True))
    for mistake in exercise.known:
        for function in mistake.functions:
            if all(gives(function, given, answer, exercise.tolerance) for given, answer in pairs):
                return mistake.hint
    return None


def _difference(answer: object, right: object, inf_is_an_answer: bool, details: bool) -> str | None:
    """Return a sentence about a wrong type or shape, or an unexpected NaN or infinity. Return None if all are right."""
    if isinstance(right, tuple) and not is_row_of(len(right), answer):
        size = f" of {len(answer)}" if isinstance(answer, tuple | list) or getattr(answer, "ndim", 0) else ""
        yours = f"; yours returns a {kind_of(answer)}{size}" if details else ""
        return f"Return {len(right)} values, separated by commas{yours}."
    for a, r in zip(answer if isinstance(right, tuple) else (answer,), parts(right), strict=True):
        values = shaped(as_numbers(a), r)
        if values is None:
            return f"Return numbers; yours returns a {kind_of(a)}." if details else "Return numbers."
        if values.shape != np.shape(r):
            shapes = f"must have shape {np.shape(r)}; yours has {values.shape}"
            return f"The result {shapes if details else 'has another shape than the task asks for'}."
        nan, inf, wanted_inf = np.isnan(values), np.isinf(values), np.isinf(r)
        if (wanted_inf & nan).any() and (np.isnan(r).any() or not (np.isfinite(r) & nan).any()):
            return "Yours is nan where inf is expected."
        if nan.any() and not np.isnan(r).any():
            return "There is a NaN in your result: look for 0/0, inf - inf or the logarithm of a negative number."
        if inf.any() and not inf_is_an_answer:
            return "There is an infinity in your result: look for a division by zero."
        if (inf & ~wanted_inf).any():
            return "Yours is inf where a finite number is expected."
        if (wanted_inf & ~inf).any():
            return "Yours is a finite number where inf is expected."
    return None


def kind_of(value: object) -> str:
    """Return the name of a value's type, such as "float"."""
    return type(value).__name__
