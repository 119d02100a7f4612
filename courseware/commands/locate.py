"""Find the pose of a spherical stereo camera on a semantic map, from two panoramas of your own.

The objects come from a detector, or from boxes drawn by hand.
"""

import argparse
from functools import partial
from pathlib import Path

import numpy as np

from courseware.commands import arguments as options
from courseware.commands.output import print_and_write, write_scene
from courseware.commands.stereo import add_pair_arguments


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_pair_arguments(parser)
    options.add_semantic_map(parser)
    told = "objects drawn by hand on both images, in the format below (default: a detector finds them)"
    parser.add_argument("--boxes", type=Path, metavar="JSON", help=told)
    options.add_detector_arguments(parser)
    options.add_text(parser, "--association", "NAME", "how objects are matched to the map (default: greedy)", "greedy")
    told = "the paper's method as it is: it also gives a pose that its own residuals contradict (default: not)"
    options.add_flag(parser, "--paper", told)
    told = "write locate.json, .csv and .png here, and locate.html: map, rays and pose, to be turned in a browser "
    options.add_results(parser, told + "(default: nowhere)", text="tables")


def run(arguments: argparse.Namespace) -> int:
    """Localize and print. Return 0 also if there is no pose, because that is an answer."""
    from course_lib.beyond.look_alikes.matchers import matcher
    from course_lib.spherical_stereo.drawn_boxes import read_stereo_boxes
    from course_lib.spherical_stereo.localizer import SemanticLocalizer
    from course_lib.spherical_stereo.panorama import StereoRig, read_panorama
    from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

    by_detector = [arguments.detector, arguments.input_size, arguments.score_threshold]
    if arguments.boxes and any(one is not None for one in by_detector):
        raise ValueError("--boxes says what is in the images, and so does a detector: give one of the two")
    options.check_options(arguments)
    association, rig = matcher(arguments.association), StereoRig(arguments.baseline)
    semantic_map = SemanticMap.load(arguments.map)
    views = read_panorama(arguments.upper), read_panorama(arguments.lower)
    boxes = read_stereo_boxes(arguments.boxes) if arguments.boxes else None
    detector = options.chosen_detector(arguments) if boxes is None else None
    how = {"association": association, "reject_implausible": not arguments.paper}
    found = SemanticLocalizer(rig, semantic_map, detector, **how).localize(*views, boxes)
    summary = {
        **{name: str(getattr(arguments, name)) for name in ("upper", "lower", "map")},
        "baseline_m": arguments.baseline,
        "objects_from": str(arguments.boxes or arguments.detector or "data/detector"),
        "classes_of_the_detector": None if detector is None else detector.labels,
        **localization_summary(found, semantic_map),
    }
    if detector is not None and arguments.detector is None and not arguments.json:
        told = (
            f"The course's detector looked for objects. It knows {len(detector.labels)} classes, from simulated rooms"
        )
        print(f"{told} only:\n{', '.join(detector.labels)}. Give yours with --detector, or draw --boxes.\n")
    write = partial(_write, summary=summary, views=views, found=found, semantic_map=semantic_map)
    print_and_write(arguments, "locate", summary, _text(summary), write)
    return 0


def localization_summary(found, semantic_map) -> dict:
    """Return a localization as plain values, for JSON: angles in degrees, and null where there is nothing to say."""
    x, y, heading = [None] * 3 if found.pose is None else found.pose
    sigma = [None] * 3 if found.covariance is None else np.sqrt(np.diag(found.covariance)).tolist()
    statistics, rejected = found.statistics, found.rejected_pose
    return {
        **{"status": found.status, "reason": found.reason, "explanation": found.explanation},
        **{"x_m": x, "y_m": y, "heading_deg": _degrees(heading)},
        **{"sigma_x_m": sigma[0], "sigma_y_m": sigma[1], "sigma_heading_deg": _degrees(sigma[2])},
        "covariance": None if found.covariance is None else found.covariance.tolist(),
        "rejected_pose": None if rejected is None else [rejected.x, rejected.y, _degrees(rejected.theta)],
        "confidence": found.confidence,
        "alternatives": [[one.pose.x, one.pose.y, _degrees(one.pose.theta), one.share] for one in found.alternatives],
        "rms_residual_m": found.rms_residual,
        "expected_rms_residual_m": None if statistics is None else statistics.expected_rms,
        "normalized_residual": None if statistics is None else statistics.normalized,
        "lower_camera_turned_deg": None if found.turn is None else np.degrees(found.turn).tolist(),
        "objects_upper": len(found.upper_detections),
        "objects_lower": len(found.lower_detections),
        "objects": _objects(found, semantic_map),
        "unmatched": [
            {"side": one.side, "label": getattr(found, f"{one.side}_detections")[one.index].label, "reason": one.reason}
            for one in found.unmatched
        ],
    }


def _degrees(radians: float | None) -> float | None:
    return None if radians is None else float(np.degrees(radians))


def _objects(found, semantic_map) -> list[dict]:
    """Return a row for every object seen in both images: where it is, and which landmark it was taken for."""
    landmark_of = dict(found.used_pairs)
    residuals = [] if found.residuals is None else [float(np.linalg.norm(residual)) for residual in found.residuals]
    residual_of = dict(zip(landmark_of, residuals, strict=False))  # none where there is no fit
    rows = []
    for one, match in zip(found.objects, found.matches, strict=True):
        landmark, (x, y) = landmark_of.get(one.observation), one.position[:2]
        row = {"label": one.label, "outcome": one.outcome, "matched_features": match.n_matches}
        placed, paired = bool(np.isfinite(one.position).all()), landmark is not None
        row["azimuth_deg"] = float(np.degrees(np.arctan2(y, x))) if placed else None
        row["range_m"] = float(np.hypot(x, y)) if placed else None
        row["landmark"] = landmark
        at = semantic_map.positions[landmark].tolist() if paired else (None, None)
        row["landmark_x_m"], row["landmark_y_m"] = at
        row["residual_m"] = residual_of.get(one.observation)
        rows.append(row)
    return rows


def _text(s: dict) -> str:
    if s["status"] == "ok":
        x, y, heading = (
            f"{s[name]:.{digits}f}" + ("" if s[f"sigma_{name}"] is None else f" ± {s[f'sigma_{name}']:.{digits}f}")
            for name, digits in (("x_m", 2), ("y_m", 2), ("heading_deg", 1))
        )
        lines = [f"pose: x {x} m, y {y} m, heading {heading} degrees (± one standard deviation)"]
    else:
        lines = [f"no pose, {s['reason']}: {s['explanation']}"]
    if s["confidence"] is not None:
        lines.append(f"confidence {s['confidence']:.2f}")
    if s["rms_residual_m"] is not None:
        lines.append(
            f"residuals: {s['rms_residual_m']:.2f} m (root mean square), {s['expected_rms_residual_m']:.2f} m may be "
            f"expected; normalized {s['normalized_residual']:.1f}, which is about 1 when all is right"
        )
    if s["lower_camera_turned_deg"] is not None:
        turn = float(np.linalg.norm(s["lower_camera_turned_deg"]))
        lines.append(f"the lower camera is turned against the upper one by {turn:.1f} degrees")
    lines += ["", f"{s['objects_upper']} objects above, {s['objects_lower']} below, {len(s['objects'])} seen in both"]
    head = f" n {'object':14} {'features':>8} {'azimuth':>8} {'range [m]':>10}   {'landmark at':16} {'off by [m]':>10}"
    lines += [head] if s["objects"] else []
    lines += [f"{n:2d} {line}" for n, line in enumerate(map(_row, s["objects"]), start=1)]
    lines += [f" - {one['label']:14} {one['side']} image only: {one['reason']}" for one in s["unmatched"]]
    return "\n".join(lines)


def _row(row: dict) -> str:
    start = f"{row['label']:14} {row['matched_features']:8d} "
    if row["range_m"] is None or row["outcome"] != "ok":
        return start + row["outcome"]
    start += f"{row['azimuth_deg']:7.0f}° {row['range_m']:10.2f}   "
    if row["landmark"] is None:
        return start + "no landmark of its class is left"
    at = f"({row['landmark_x_m']:.2f}, {row['landmark_y_m']:.2f})"
    return start + f"{at:16} " + (f"{row['residual_m']:10.2f}" if row["residual_m"] is not None else "")


def _write(folder: Path, summary: dict, views, found, semantic_map) -> list[str]:
    """Write numbers, figure and scene, and return their names."""
    from courseware.experiments.results import write_results
    from courseware.plots.location_scene import location_scene
    from courseware.plots.room_figures import location_figure

    write_results(folder / "locate.json", summary, summary["objects"])
    lines = [f"{n:2d} {_row(row)}" for n, row in enumerate(summary["objects"], start=1)]
    title = "On the map" if found.pose else f"No pose: {found.reason}"
    images = [view.image for view in views]
    location_figure(images, semantic_map, found, lines, title).savefig(folder / "locate.png", dpi=110)
    scene = write_scene(folder / "locate.html", title, lambda: location_scene(semantic_map, found))
    return ["locate.json", "locate.csv", "locate.png", scene]
