"""What an exercise is: a solution, a generator of inputs, and common mistakes with their hints."""

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from courseware.lessons.kit.mistakes import Mistake, read_mistakes

# Random inputs per check. A case that one input in five has is missed in one of 200 checks only: 0.8^24 = 0.005.
N_INPUTS = 24


@dataclass(frozen=True)
class Exercise:
    """One exercise.

    number: such as "03.1". solution: the right function; the notebook's stub and solution are written from its text.
    inputs: makes one tuple of arguments from a `numpy.random.Generator`. level: how hard it is. cases: like `inputs`,
    but each runs once in every check. They are special cases (a seam, a mirror image, empty input, equal values) with a
    name in words, which a hint may tell: `{"one point": lambda rng: (np.zeros((1, 2)),)}`. tolerance: absolute and
    relative, as in `numpy.allclose`. example: the numbers that the task shows, as `(arguments, answer)` with lists for
    arrays; `tools.refresh` writes them into the task. mistakes: about nine edits of the solution with their hints
    (`kit.mistakes`), from the file of hints. functions: function -> hint, for a mistake that is no edit.

    An answer is judged in this order:

    1. `verify`, for tasks with many right answers: `verify(arguments, answer)` returns a sentence that says what is
       wrong, or None. Then nothing is compared, and `others` is not used.
    2. `solution`, then `others`: other functions that the task allows, for example another estimator. The answer is
       right if all its values agree with those of one of them.
    3. A wrong answer gets the hint of the first mistake that gives the same values: the edits in the order of the file,
       then `functions`. Only after them come the general mistakes, and the sentence of `verify`.
    """

    number: str
    solution: Callable
    inputs: Callable[[np.random.Generator], tuple]
    level: Literal["warm-up", "core", "challenge"] = "core"
    cases: dict[str, Callable[[np.random.Generator], tuple]] = field(default_factory=dict)
    mistakes: str = ""
    functions: dict[Callable, str] = field(default_factory=dict)
    tolerance: float = 1e-6
    others: Sequence[Callable] = ()
    verify: Callable[[tuple, object], str | None] | None = None
    example: tuple[tuple, object] | None = None

    def draw(self, rng: np.random.Generator) -> list[tuple]:
        """Return the arguments of every call of one check: the cases, then `N_INPUTS` random inputs."""
        return [make(rng) for make in (*self.cases.values(), *[self.inputs] * N_INPUTS)]

    @functools.cached_property
    def known(self) -> tuple[Mistake, ...]:
        """Return the exercise's own mistakes: its edits, then its functions."""
        others = (Mistake((function,), hint) for function, hint in self.functions.items())
        return (*read_mistakes(self.solution, self.mistakes), *others)
