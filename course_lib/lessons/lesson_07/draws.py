"""Copies that four resamplers make, and how many different particles they leave."""

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
from matplotlib.figure import Figure

from course_lib.depth_mcl.particle_filter import resample
from course_lib.lessons.kit.display import described
from course_lib.plots import figures

SCHEMES = ("systematic", "stratified", "multinomial", "residual")


@contextmanager
def numpy_global_seed(seed: int) -> Iterator[None]:
    """Seed NumPy's global generator inside the block, and leave it as it was: for libraries that draw from it."""
    before = np.random.get_state()  # noqa: NPY002 - filterpy knows no other
    np.random.seed(seed)  # noqa: NPY002
    try:
        yield
    finally:
        np.random.set_state(before)  # noqa: NPY002


def copies(scheme: str, w: np.ndarray, repeats: int, seed: int) -> np.ndarray:
    """How many copies each particle got in each of many resamplings `(repeats, N)`."""
    rng = np.random.default_rng(seed)
    return np.array([np.bincount(resample(w, rng, scheme), minlength=len(w)) for _ in range(repeats)])


def different_over_rounds(scheme: str, n: int, rounds: int, seed: int) -> np.ndarray:
    """How many of n equally weighted particles are still different after each round of resampling `(rounds + 1,)`."""
    rng, alive = np.random.default_rng(seed), [np.arange(n)]
    for _ in range(rounds):
        alive.append(alive[-1][resample(np.full(n, 1 / n), rng, scheme)])
    return np.array([len(np.unique(particles)) for particles in alive])


def copies_figure(expected: np.ndarray, found: dict[str, np.ndarray]) -> Figure:
    """Mean number of copies of every particle: what it should be, and what resamplers give."""
    figure, axes = figures.new_figure(size=(7.4, 3.0))
    places = np.arange(len(expected))
    axes.bar(places, expected, width=0.75, color="0.85", edgecolor="0.5", label="N w: as it should be")
    for index, (name, values) in enumerate(found.items()):
        style = figures.line_style(index + 2) | {"linestyle": "none", "markersize": 8}
        axes.plot(places + 0.16 * (2 * index - 1), values, **style, label=name)
    axes.set(title="Copies of each particle, in the mean", xlabel="particle [-]", ylabel="copies [-]", xticks=places)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    alt = """Mean copies of ten particles: course_lib meets N w everywhere; filterpy gives the two heavy ones 4 to 6
        copies and the eight light ones none."""
    return described(figure, alt)
