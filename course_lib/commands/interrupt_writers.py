"""Writers that `interrupt` calls beside the commands: what lessons, `lab` and the making of data write, in small.

Each takes the folder to write into and which of two runs it is, 1 or 2: their outputs differ.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

CHECKPOINT_BYTES = 20_000_000  # a network's weights, their average and the optimiser's moments have as many
RECORDING_FRAMES = 12


def recording(out: Path, which: int) -> None:
    """A depth recording, where none was."""
    from course_lib.depth_mcl.sequence import write_sequence

    if which == 2:
        depths = [np.full((144, 176), 1.0 + number / 10) for number in range(RECORDING_FRAMES)]
        poses = np.tile(np.eye(4), (RECORDING_FRAMES, 1, 1))
        times = np.arange(float(RECORDING_FRAMES))
        write_sequence(
            out / "walk", np.eye(3), list(range(RECORDING_FRAMES)), depths, poses, times, "z", poses[:, 3, :3]
        )


def semantic_map(out: Path, which: int) -> None:
    """A map of 2,000 objects."""
    from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap

    landmarks = [Landmark("chair", float(n % 50), float(n // 50), 100.0 + which, 50.0) for n in range(2000)]
    SemanticMap(landmarks).save(out / "map.json")


def simplified_map(out: Path, which: int) -> None:
    """What is kept of a large map's simplification, in the cache."""
    import trimesh

    from course_lib.depth_mcl.scene_map import SceneMap
    from course_lib.depth_mcl.simplification import simplified

    if which == 2:
        os.environ["XDG_CACHE_HOME"] = str(out)
        ball = trimesh.creation.icosphere(subdivisions=5)
        simplified(SceneMap(ball.vertices, ball.faces))


def checkpoint(out: Path, which: int) -> None:
    """A checkpoint of a training, as `detector_training.checkpoints` writes it; here without PyTorch."""
    from course_lib.writing import write_at_once

    write_at_once(out / "checkpoint.pt", np.random.default_rng(which).bytes(CHECKPOINT_BYTES))


def made_data(out: Path, which: int) -> None:
    """Products of `make-data` in the place of earlier ones: made beside them, in minutes, and put there at once."""
    from course_lib.output_folder import replaced_outputs
    from course_lib.simulation.data_folder import checksums

    random, products = np.random.default_rng(which), ("map.ply", "wagon", "SHA256SUMS")
    with replaced_outputs(out, "make-data", products) as folder:
        (folder / "wagon").mkdir()
        (folder / "map.ply").write_bytes(random.bytes(3_000_000))
        for number in range(10 + which):
            (folder / "wagon" / f"{number}.png").write_bytes(random.bytes(20_000))
        (folder / "SHA256SUMS").write_text(checksums(folder, products))


def sweep_rows(out: Path, which: int) -> None:
    """Rows one by one, then what they say: as `sweep`, `compare`, `demo lost`, `walk`, `finale` do; a run adds rows."""
    from course_lib.experiments.results import write_results
    from course_lib.experiments.sweeps import sweep as run

    points = [{"seed": seed, "text": "x" * 2000} for seed in range(10 * which)]
    with ThreadPoolExecutor(1) as pool:
        rows = run(dict, points, pool, results=out / "rows.jsonl")
    write_results(out / "sweep.json", {"rows": len(rows)})


def lab_settings(out: Path, which: int) -> None:
    """What `lab` sets up before JupyterLab starts."""
    from course_lib.commands import lab

    if which == 2:
        lab.write_settings(out)
        lab.install_extension(out)


def working_copies(out: Path, which: int) -> None:
    """A student's copies: made of the one course, then brought up to date with another one."""
    from course_lib.commands.working_copies import make_copies

    make_copies(out.parent.parent / "given" / f"course_{which}")


def notebook(out: Path, which: int) -> None:
    """A small notebook, run again and stored as `refresh` does."""
    import nbformat

    from course_lib.commands.refresh import refresh

    path = out / "small.ipynb"
    if not path.exists():
        cell = nbformat.v4.new_code_cell("import os\nprint(os.environ['WHICH_RUN'] * 1000)", id="small")
        path.write_text(nbformat.writes(nbformat.v4.new_notebook(cells=[cell])), encoding="utf-8")
    os.environ["WHICH_RUN"] = str(which)
    refresh(path)


WRITERS: dict[str, Callable[[Path, int], None]] = {
    writer.__name__: writer
    for writer in (
        recording,
        semantic_map,
        simplified_map,
        checkpoint,
        made_data,
        sweep_rows,
        lab_settings,
        working_copies,
        notebook,
    )
}
