"""Tell and write the results of `localize`: numbers, a table, one line on the track, rows, trajectory, figure."""

from collections import Counter
from functools import partial
from itertools import pairwise
from pathlib import Path

import numpy as np

from course_lib.recordings import pose_error_summary
from courseware.commands.output import write_scene


def results(run, sequence, camera) -> dict:
    """Return the numbers of a run as its JSON has them."""
    return {
        "frames": len(run.frames),
        "frames_without_measurement": run.faults.count("no return"),
        "frames_at_fault": dict(Counter(fault for fault in run.faults if fault not in (None, "no return"))),
        **{f"frames_{status}": run.statuses.count(status) for status in ("tracked", "doubtful", "lost")},
        "believes": believed(run.frames, run.statuses),
        **doubted_intrinsics(run.calibration, camera),
        **(pose_error_summary(run, sequence) if sequence.has_poses else {}),
        "renders_per_frame": float(np.mean(run.renders)),
        "most_renders": int(run.renders.max()),
        "ms_per_frame": run.ms_per_frame,
    }


def believed(frames: list[int], statuses: list[str]) -> str:
    """Return one line on the track, such as "lost from frame 41 on (126 of 167 frames; tracked 40, doubtful 1)"."""
    total, lost, tracked = len(frames), statuses.count("lost"), statuses.count("tracked")
    doubtful, unseen = statuses.count("doubtful"), statuses.count("no measurement")
    predicted = f", predicted only {unseen}" if unseen else ""
    if tracked == total:
        return f"tracked in all {total} frames"
    if not lost:
        return f"tracked in {tracked} of {total} frames, doubtful in {doubtful}{predicted}"
    indices = [index for index, status in enumerate(statuses) if status == "lost"]
    first, last = indices[0], indices[-1]
    stretches = 1 + sum(b - a > 1 for a, b in pairwise(indices))
    if "tracked" not in statuses[first:]:
        where = f"from frame {frames[first]} on" if first else "from the first frame on"
    elif stretches == 1:
        where = f"from frame {frames[first]} to {frames[last]}"
    else:
        where = f"in {stretches} stretches between frames {frames[first]} and {frames[last]}"
    return f"lost {where} ({lost} of {total} frames; tracked {tracked}, doubtful {doubtful}{predicted})"


def doubted_intrinsics(calibration, camera) -> dict:
    """Return what the images tell of the camera's intrinsics: numbers, and a sentence if it doubts them (else None)."""
    if calibration is None:  # the paper's filter does not look
        return {}
    sentence, size = calibration.sentence(camera), np.array([100.0, camera.width, camera.height])
    names, sigma = ("focal_length_percent", "cx_px", "cy_px"), np.sqrt(np.diag(calibration.covariance))
    numbers = {name: float(value) for name, value in zip(names, calibration.correction * size, strict=True)}
    numbers |= {f"{name}_sigma": float(value) for name, value in zip(names, sigma * size, strict=True)}
    told = None if sentence is None else f"{sentence}: check intrinsics.txt"
    return {"intrinsics_doubted": told, "intrinsics_off_by": {**numbers, "images": calibration.images}}


def localize_table(s: dict) -> str:
    """Return the summary `s` in words."""
    estimated = "all six degrees of freedom" if s["dof"] == "6" else "x, y and yaw"
    by = f"{s['n_particles']} particles" if s["method"] == "paper" else "the annealed filter"
    lines = [f"{s['frames']} frames, {estimated} estimated with {by}", ""]
    if "median_position_m" in s:
        error = s["mean_normalized_error"]
        unknown = "unknown (too few particles to span the motion)"
        honest = unknown if error is None else f"{error:.2f} in the mean (1 is honest)"
        lines += [
            "                      median   90th percentile",
            f"position error [m]    {s['median_position_m']:6.3f}   {s['p90_position_m']:6.3f}",
            f"rotation error [deg]  {s['median_rotation_deg']:6.2f}   {s['p90_rotation_deg']:6.2f}",
            "",
            f"within 5 cm and 5 degrees: {s['within_5cm_5deg_percent']:.1f} %",
            f"squared error in units of its covariance: {honest}",
        ]
    else:
        lines += ["no poses.txt: errors are not known", ""]
    if s["frames_without_measurement"]:
        lines.append(f"{s['frames_without_measurement']} frames held no measurement between --near and --far")
    if s["frames_at_fault"]:
        told = ", ".join(f"{fault} {count}" for fault, count in sorted(s["frames_at_fault"].items()))
        lines.append(f"{sum(s['frames_at_fault'].values())} frames were at fault and not used: {told}")
    if s.get("intrinsics_doubted"):
        lines.append(s["intrinsics_doubted"])
    lines.append(f"{s['renders_per_frame']:.0f} renders and {s['ms_per_frame']:.0f} ms a frame")
    return "\n".join(lines)


def write_localized(folder: Path, summary: dict, result, sequence, scene_map) -> list[str]:
    """Write numbers (JSON), a row a frame (CSV), trajectory (TUM), figure and scene; return the names."""
    from course_lib.depth_mcl.evaluation import pose_errors
    from course_lib.depth_mcl.sequence_files import write_tum
    from courseware.experiments.results import write_results
    from courseware.plots.track_figure import track_figure
    from courseware.plots.track_scene import track_scene

    count, positions = len(result.frames), result.camera_to_world[:, :3, 3]
    rows = []
    for k in range(count):
        row = {"frame": result.frames[k], "status": result.statuses[k], "fault": result.faults[k] or ""}
        row["score"] = round(float(result.scores[k]), 5)
        row |= {f"{axis}_m": round(float(value), 5) for axis, value in zip("xyz", positions[k], strict=True)}
        rows.append(row | {name: round(value, 4) for name, value in result.agreements[k]._asdict().items()})
    true = sequence.camera_to_world[:count] if sequence.has_poses else None
    if true is not None:
        for row, metres, radians in zip(rows, *pose_errors(result.camera_to_world, true), strict=True):
            row |= {"position_error_m": round(metres, 5), "rotation_error_deg": round(float(np.rad2deg(radians)), 4)}
    write_results(folder / "localize.json", summary, rows)
    times = np.asarray(result.frames, float) if sequence.times is None else sequence.times[:count]
    write_tum(folder / "trajectory.txt", times, result.camera_to_world)
    up = None if summary["up"] == "unknown" else summary["up"]
    truth = None if true is None else true[:, :3, 3]
    figure = track_figure(scene_map, result.frames, positions, result.scores, result.statuses, up, truth)
    figure.savefig(folder / "track.png", dpi=130)
    title = f"Path of {sequence.folder.name} in {Path(summary['map']).name}"
    make = partial(track_scene, scene_map, result, sequence, up, summary["near_m"], summary["far_m"])
    scene = write_scene(folder / "track.html", title, make)
    return ["localize.json", "localize.csv", "trajectory.txt (TUM)", "track.png", scene]
