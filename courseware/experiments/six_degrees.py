"""Compare filters in six degrees of freedom: the annealed one, the paper's, and how well the truth itself fits.

A run gives plain lists, one entry a frame, so that runs of several seeds, recordings and offsets can be pooled.
"""

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

import numpy as np

from course_lib.beyond.being_lost import judge_refined
from course_lib.beyond.six_dof.prediction import MotionPrediction, Rival
from course_lib.beyond.six_dof.refinement import refine
from course_lib.beyond.six_dof.schedule import LAYERS, STEPS, pyramid
from course_lib.depth_mcl.evaluation import pose_errors
from course_lib.depth_mcl.sequence import DepthSequence, read_sequence
from course_lib.depth_mcl.status import agreement
from course_lib.files import temporary_folder
from course_lib.recordings import SIGMA, run_sequence, system_noise
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from courseware.experiments.runner import Outcome, Runner
from courseware.simulation.corridor.seeded_recording import HARDSHIPS, building_of_data, record_seed

METHODS = ("annealed", "paper", "floor")
NAMES = {"annealed": "annealed and refined", "paper": "the paper's filter", "floor": "floor: refined from the truth"}
NAMES["recovering"] = "the same, searching when lost"
"""How the table calls them; other methods are called as they are."""


class StandingStill(MotionPrediction):
    """A prediction that knows no motion: the cloud lies about the last pose, as wide as for a start."""

    def found(self, pose: np.ndarray, seen: bool = True, rivals: Sequence[Rival] = ()) -> None:
        """Take the camera to be at `pose`, and forget how it came there."""
        super().found(pose, seen, rivals)
        self.motion, self._lengths = np.zeros(6), []


def image_alone(prior: np.ndarray, information: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return, in place of `fused`, Kalman's covariance (P^-1 + I)^-1, and the image's pose in every direction."""
    return np.linalg.solve(np.eye(6) + prior @ information, prior), np.eye(6)


# The annealed filter with one idea switched off.
ABLATIONS: dict[str, dict] = {
    "without refinement": {"steps": ()},
    "without annealing": {"layers": (LAYERS[0]._replace(particles=LAYERS[0].particles + LAYERS[1].particles),)},
    "without a second look": {"second_look": ()},
    "without prediction": {"prediction": StandingStill},
    "without hypotheses": {"steps": tuple(step._replace(hypotheses=1) for step in STEPS), "rivals": 0},
    "without rivals": {"rivals": 0},
    "without fusion": {"fuse": image_alone},
    "without image motion": {"image_motion": False},
}
FLOOR_SCALES = (0.1, 0.05, 0.05, 0.03, 0.03)  # metres, of the steps from the truth
WRONG_POSITION, WRONG_ROTATION_DEG = 0.20, 20.0  # beyond either a pose is wrong, and should be said to be lost
# Recordings by hand: what is wrong with the camera, and how the table calls them. No wagon is pushed.
HAND_PARTS = {
    "methods": ((), ""),
    "methods_with_errors": (tuple(h for h in HARDSHIPS if h != "pushed by hand"), ", with errors"),
}


def require_methods(text: str, known: Sequence[str] = (*METHODS, "recovering", *ABLATIONS)) -> list[str]:
    """Return the methods that "annealed,paper" names; "all": every one. Raises `ValueError` for an unknown one."""
    methods = list(known) if text == "all" else text.split(",")
    if not set(methods) <= set(known):
        raise ValueError(f"--methods must name {', '.join(known)}, with commas, or be all; got {text!r}")
    return methods


def run_frames(
    method: str, scene_map: SceneMap, sequence: DepthSequence, seed: int, progress: Callable = iter
) -> dict[str, list]:
    """Return errors, statuses and renders of every frame by one of `METHODS` or `ABLATIONS`; "floor" has no seed."""
    if method == "floor":
        return floor_frames(scene_map, sequence, progress)
    parts = ABLATIONS.get(method, {}) if method != "paper" else system_noise("6", *SIGMA["6"])
    name = "annealed" if method in ABLATIONS else method
    run = run_sequence(scene_map, sequence, name, seed=seed, progress=progress, **parts)
    position, rotation = pose_errors(run.camera_to_world, sequence.camera_to_world[: len(run.frames)])
    return {
        "position_m": position.tolist(),
        "rotation_deg": np.rad2deg(rotation).tolist(),
        "status": list(run.statuses),
        "renders": run.renders.tolist(),
        "score": run.scores.tolist(),
        "normalized_error": run.normalized_errors.tolist(),
        "within_3_sigma": (np.abs(run.deviations) <= 3 * run.error_sigmas).mean(axis=1).tolist(),
    }


def floor_frames(scene_map: SceneMap, sequence: DepthSequence, progress: Callable = iter) -> dict[str, list]:
    """Return the errors of the refined *true* pose: no estimate agrees better. score: before refinement."""
    rows = []
    with DepthRenderer(scene_map, sequence.camera()) as renderer:
        fine = pyramid(renderer)[-1]
        for index in progress(range(len(sequence))):
            true = sequence.camera_to_world[index][None]
            fine.measure(sequence.depth(index))
            score = float(fine.score(fine.renderer.render_poses(true))[0])
            refined = refine(fine.renderer, fine.measured, true, FLOOR_SCALES)
            position, rotation = pose_errors(refined[0], true[0])
            status = judge_refined(agreement(fine.measured, fine.renderer.render_poses(refined)[0]))
            rows.append((float(position), float(np.rad2deg(rotation)), status, len(FLOOR_SCALES), score))
    names = ("position_m", "rotation_deg", "status", "renders", "score")
    return {name: list(column) for name, column in zip(names, zip(*rows, strict=True), strict=True)}


def pooled(runs: Sequence[dict[str, list]]) -> dict[str, float]:
    """Return the numbers of a row of the table, of all frames of some runs together."""
    frames = {key: np.concatenate([run[key] for run in runs]) for key in runs[0]}
    position, rotation, lost = frames["position_m"], frames["rotation_deg"], frames["status"] == "lost"
    wrong = (position > WRONG_POSITION) | (rotation > WRONG_ROTATION_DEG)
    close = (position <= 0.05) & (rotation <= 5.0)
    row = {
        "frames": len(position),
        "median_position_m": float(np.median(position)),
        "median_rotation_deg": float(np.median(rotation)),
        "within_5cm_5deg_percent": float(100 * close.mean()),
        "within_10cm_percent": float(100 * (position <= 0.10).mean()),
        "wrong": int(wrong.sum()),
        "wrong_called_lost": int((wrong & lost).sum()),
        "good": int(close.sum()),
        "good_called_lost": int((close & lost).sum()),
        "median_score": None if np.isnan(frames["score"]).all() else float(np.nanmedian(frames["score"])),
        "mean_renders": float(np.mean(frames["renders"])),
        "most_renders": int(frames["renders"].max()),
    }
    if "normalized_error" in frames:
        row["mean_normalized_error"] = float(np.mean(frames["normalized_error"]))
        row["within_3_sigma_percent"] = float(100 * np.mean(frames["within_3_sigma"]))
    return row


def six_degrees_table(rows: dict[str, dict]) -> str:
    """Return a line a row of `pooled`; the keys of `rows` are what stands at the beginning."""
    lines = [
        f"{'':44} {'frames':>7} {'median':>9} {'median':>8} {'within 5 cm':>12} {'within':>8} {'wrong':>7} "
        f"{'called lost':>16} {'renders':>9}",
        f"{'':44} {'':>7} {'[m]':>9} {'[deg]':>8} {'and 5 deg [%]':>12} {'10 cm':>7} {'':>7} "
        f"{'wrong':>8} {'good':>7} {'most':>9}",
    ]
    line = (
        "{name:44} {frames:>7} {median_position_m:>9.4f} {median_rotation_deg:>8.2f} {within_5cm_5deg_percent:>12.1f} "
        "{within_10cm_percent:>8.1f} {wrong:>7} {wrong_called_lost:>8} {good_called_lost:>7} {most_renders:>9}"
    )
    covered = (
        "{name}: squared error in units of its covariance {mean_normalized_error:.2f} in the mean; "
        "{within_3_sigma_percent:.1f} % of errors within three sigma"
    )
    lines += [line.format(name=name, **row) for name, row in rows.items()]
    lines += ["", "wrong: by more than 0.20 m or 20 degrees; good: within 5 cm and 5 degrees."]
    lines += [covered.format(name=name, **row) for name, row in rows.items() if "mean_normalized_error" in row]
    return "\n".join(lines)


def thinnings(methods: Iterable[str], everies: Sequence[int]) -> list[tuple[str, int, int]]:
    """Return (method, every, offset) of every offset of each thinning; the floor has none."""
    runs = [(method, every) for method in methods for every in ((1,) if method == "floor" else everies)]
    return [(method, every, offset) for method, every in runs for offset in range(every)]


def thinned_run(map_file: str, sequence: str, method: str, every: int, offset: int, seed: int) -> dict[str, list]:
    """Run one method on every so many frames of a recording from an offset on."""
    recording = read_sequence(sequence).thinned(every, offset)
    return run_frames(method, SceneMap.load(map_file), recording, seed)


def corridor_hand(data: str, seed: int, frames: int | None, methods: list[str]) -> dict[str, dict[str, dict]]:
    """Run each method on a seed's recording by hand through the corridor, and on one with calibration errors."""
    scene_map, building = SceneMap.load(Path(data) / "map.ply"), building_of_data(data)
    result = {}
    with temporary_folder() as temporary:
        for part, (hardships, _) in HAND_PARTS.items():
            record_seed(temporary / part, building, seed, hardships, frames=frames, carried="hand")
            recording = read_sequence(temporary / part)
            result[part] = {method: run_frames(method, scene_map, recording, seed) for method in methods}
    return result


def run_corridor(runner: Runner, seeds: list[int], data: Path, frames: int | None, methods: str | None) -> Outcome:
    """Run `demo corridor --dof 6`: recordings carried by hand, made anew from each seed."""
    names = require_methods(methods or "all", METHODS)
    points = [{"data": str(data), "frames": frames, "methods": names, "seed": seed} for seed in seeds]
    found = runner.rows(corridor_hand, points, "hand")
    parts = [(part, method, told) for part, (_, told) in HAND_PARTS.items() for method in names]
    runs = {NAMES[method] + told: [one[part][method] for one in found] for part, method, told in parts}
    result = {"seeds": seeds, "rows": {name: pooled(own) for name, own in runs.items()}}
    each = {name: [pooled([run]) for run in own] for name, own in runs.items()}
    files = {"hand.json": (result | {"recordings": each}, None)}
    return Outcome(result, six_degrees_table(result["rows"]), files, "covariance", runs)
