"""The filter along the corridor alone, on a table of agreement that was rendered once."""

import functools
from collections import namedtuple

import numpy as np

from course_lib.depth_mcl.evaluation import nearest_path_error, summarize
from course_lib.depth_mcl.likelihood import likelihood, normalize_likelihood, valid_pixels, weights
from course_lib.depth_mcl.motion import propagate
from course_lib.depth_mcl.particle_filter import initial_particles, resample, weighted_mean_state
from course_lib.geometry import state_from_optical_pose
from course_lib.lessons.kit.corridor_views import corridor_map, wagon_run
from course_lib.lessons.kit.progress_bar import progress
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.sensor import subsample_depth

STRETCH = range(60, 84)  # frames that are localized live: a good two metres of the run (chosen)
# Where the panel's table is read off, metres from the true x: finely near it, where the hill is steep, and far back,
# where a filter that is lost falls behind.
OFFSETS = np.unique(np.round(np.r_[-5.4:-2.5:0.4, -2.6:2.7:0.3, -0.4:0.41:0.05], 2))
TABLE_SIZE = (44, 36)  # pixels of the panel's images: a sixteenth, so that its table is made in seconds
AgreementTable = namedtuple("AgreementTable", "true path agreement")
AlongRun = namedtuple("AlongRun", "x nearest timed scores best_weights")


@functools.cache
def agreement_table() -> AgreementTable:
    """True states `(T, 6)`, the path `(P, 3)` on the floor, and l / m `(T, K)` of cameras at true x plus `OFFSETS`."""
    sequence, rows = wagon_run(), []
    camera = sequence.camera()
    small = camera.resized(*TABLE_SIZE)
    true = state_from_optical_pose(sequence.camera_to_world[list(STRETCH)])
    with DepthRenderer(corridor_map(), small) as renderer:
        for frame, state in progress(list(zip(STRETCH, true, strict=True)), "making the panel's table"):
            measured = subsample_depth(sequence.depth(frame), camera, small)
            states = np.tile(state, (len(OFFSETS), 1))
            states[:, 0] += OFFSETS
            rows.append(likelihood(measured, renderer.render(states)) / valid_pixels(measured).sum())
    return AgreementTable(true, sequence.path_on_floor, np.array(rows))


def localize_along(
    table: AgreementTable, n_particles: int, sigma_x: float, beta: float, start_error: float, seed: int
) -> AlongRun:
    """The filter of figure 1 with x alone unknown: y and yaw are held at the truth, l / m is read from the table.

    Returns estimates `(T,)` [m], both errors, l / m `(T,)` of the best particle and its normalized weight `(T,)`.
    """
    rng, rows = np.random.default_rng(seed), []
    particles = initial_particles(table.true[0] + [start_error, 0, 0, 0, 0, 0], n_particles)
    for true, hill in zip(table.true, table.agreement, strict=True):
        particles = propagate(particles, np.array([sigma_x, 0, 0, 0, 0, 0]), rng)
        agreement = np.interp(particles[:, 0] - true[0], OFFSETS, hill)
        w = weights(normalize_likelihood(agreement), beta)
        rows.append([weighted_mean_state(particles, w)[0], agreement.max(), w.max()])
        particles = particles[resample(w, rng)]
    x, scores, best = np.transpose(rows)
    nearest = nearest_path_error(np.column_stack([x, table.true[:, 1]]), table.path)
    return AlongRun(x, nearest, summarize(np.abs(x - table.true[:, 0])), scores, best)


def row(run: AlongRun) -> str:
    """One row as in table 1; the table of agreement is spaced by 0.05 m, so nothing finer is told."""
    values = (run.nearest.median, run.nearest.sigma, run.timed.median, run.timed.errors.max())
    median, sigma, timed, largest = ("< 0.05 m" if value < 0.05 else f"{value:.2f} m" for value in values)
    within = f"<= 0.30 m: {run.nearest.within_3sigma:.0%}"
    return f"nearest path: median {median}, rms (sigma) {sigma}, {within};  timed: median {timed}, largest {largest}"
