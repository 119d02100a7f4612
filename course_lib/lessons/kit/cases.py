"""Special cases of an exercise that are written down, not drawn."""

from collections.abc import Callable

import numpy as np


def case(name: str, *arguments: object) -> Callable[[np.random.Generator], tuple]:
    """Return a special case for `Exercise.cases`: these arguments, under a name that a hint can tell."""

    def make(rng: np.random.Generator) -> tuple:
        return arguments

    make.__name__ = name.replace(" ", "_")
    return make
