"""The filter along the corridor alone, on a table of agreement that was rendered once."""

import functools
from typing import NamedTuple

import numpy as np

from course_lib.depth_mcl.evaluation import PositionError, nearest_path_error, summarize
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
_TABLE_SIZE = (44, 36)  # pixels of the panel's images: a sixteenth, so that its table is made in seconds


class AgreementTable(NamedTuple):
    """l / m of a stretch of frames for cameras that stand at the true pose but for x."""

    true: np.ndarray
    """`(T, 6)` true states."""
    path: np.ndarray
    """`(P, 3)` the path on the floor."""
    agreement: np.ndarray
    """`(T, K)` l / m at true x plus each of `OFFSETS`."""

    def at(self, frame: int, x: np.ndarray) -> np.ndarray:
        """l / m `(N,)` of particles at `x` [m] in a frame of the stretch, read between the table's places."""
        return np.interp(x - self.true[frame, 0], OFFSETS, self.agreement[frame])


@functools.cache
def agreement_table() -> AgreementTable:
    """The panel's table, made once: every frame of the stretch against small images from places along the corridor."""
    sequence = wagon_run()
    camera = sequence.camera()
    small = camera.resized(*_TABLE_SIZE)
    true = state_from_optical_pose(sequence.camera_to_world[list(STRETCH)])
    rows = []
    with DepthRenderer(corridor_map(), small) as renderer:
        for frame, state in progress(list(zip(STRETCH, true, strict=True)), "making the panel's table"):
            measured = subsample_depth(sequence.depth(frame), camera, small)
            states = np.tile(state, (len(OFFSETS), 1))
            states[:, 0] += OFFSETS
            rows.append(likelihood(measured, renderer.render(states)) / valid_pixels(measured).sum())
    return AgreementTable(true, sequence.path_on_floor, np.array(rows))


class AlongRun(NamedTuple):
    """What the filter along the corridor made of the stretch."""

    x: np.ndarray
    """`(T,)` estimates [m]."""
    nearest: PositionError
    timed: PositionError
    scores: np.ndarray
    """`(T,)` l / m of the best particle."""
    best_weights: np.ndarray
    """`(T,)` its normalized weight."""


def localize_along(
    table: AgreementTable, n_particles: int, sigma_x: float, beta: float, start_error: float, seed: int
) -> AlongRun:
    """The filter of figure 1 with x alone unknown: y and yaw are held at the truth, l / m is read from the table."""
    rng = np.random.default_rng(seed)
    sigma = np.array([sigma_x, 0, 0, 0, 0, 0])
    particles = initial_particles(table.true[0] + [start_error, 0, 0, 0, 0, 0], n_particles)
    x, scores, best = np.empty((3, len(table.true)))
    for frame in range(len(table.true)):
        particles = propagate(particles, sigma, rng)
        agreement = table.at(frame, particles[:, 0])
        w = weights(normalize_likelihood(agreement), beta)
        x[frame] = weighted_mean_state(particles, w)[0]
        scores[frame], best[frame] = agreement.max(), w.max()
        particles = particles[resample(w, rng)]
    positions = np.column_stack([x, table.true[:, 1]])
    return AlongRun(x, nearest_path_error(positions, table.path), summarize(np.abs(x - table.true[:, 0])), scores, best)


def row(run: AlongRun) -> str:
    """One row as in table 1; the table of agreement is spaced by 0.05 m, so nothing finer is told."""

    def metres(value: float) -> str:
        return "< 0.05 m" if value < 0.05 else f"{value:.2f} m"

    n, t = run.nearest, run.timed
    return (
        f"nearest path: median {metres(n.median)}, rms (sigma) {metres(n.sigma)}, <= 0.30 m: {n.within_3sigma:.0%};  "
        f"timed: median {metres(t.median)}, largest {metres(t.errors.max())}"
    )
