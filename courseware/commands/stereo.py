"""Match two real panoramas of a vertical rig, draw the vertical disparity, and list a distance for every boxed object.

Two distances an object: from the centres of its two boxes, and from the vertical disparities of the features in them.
"""

import argparse
import time
from functools import partial
from pathlib import Path

import numpy as np

from courseware.commands.arguments import add_results, check_options, require_positive
from courseware.commands.output import print_and_write

BOXES_FORMAT = """\
the boxes file, in pixels (left, top, right, bottom) of images of that size; "name" may be left out:
  {"version": 1, "width": 1024, "height": 512, "upper": [{"label": "chair", "box": [420, 285, 498, 404]}],
   "lower": [{"label": "chair", "box": [420, 270, 499, 391], "name": "the red one"}]}
"""


# The two ways of measuring an object's distance, and what each says.
WAYS, MEASURED = ("box_centre", "disparity"), ("outcome", "horizontal_range_m", "horizontal_sigma_m")


def add_pair_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of every command on two panoramas, and end its help with the format of boxes."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter  # keeps the lines of the example
    parser.epilog = BOXES_FORMAT
    add = parser.add_argument
    add("--upper", required=True, type=Path, metavar="IMG", help="panorama of the upper camera (2:1)")
    add("--lower", required=True, type=Path, metavar="IMG", help="panorama of the lower camera")
    add("--baseline", required=True, type=float, metavar="M", help="height between the cameras, metres")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_pair_arguments(parser)
    told = "boxes in both images, as a JSON file in the format below (default: features alone, no distances)"
    parser.add_argument("--boxes", type=Path, metavar="JSON", help=told)
    told = "standard deviation of a box centre (default: 1)"
    parser.add_argument("--sigma-pixels", type=float, default=1.0, metavar="PX", help=told)
    add_results(parser, "write figures and results here (default: nowhere)")


def run(arguments: argparse.Namespace) -> int:
    """Match, measure, and print."""
    from course_lib.spherical_stereo.drawn_boxes import read_stereo_boxes
    from course_lib.spherical_stereo.matching.alignment import match_features
    from course_lib.spherical_stereo.matching.epipolar import EPIPOLAR_TOLERANCE
    from course_lib.spherical_stereo.matching.features import find_features
    from course_lib.spherical_stereo.matching.object_matching import match_views
    from course_lib.spherical_stereo.panorama import StereoRig, open_pair, read_panorama
    from course_lib.spherical_stereo.ranging.object_positions import measure_objects

    require_positive("--baseline", arguments.baseline, "metres")
    require_positive("--sigma-pixels", arguments.sigma_pixels, "pixels")
    check_options(arguments)
    rig = StereoRig(arguments.baseline)
    boxes = read_stereo_boxes(arguments.boxes) if arguments.boxes else None
    views = read_panorama(arguments.upper), read_panorama(arguments.lower)
    upper, lower = boxes.on(*views) if boxes else open_pair(*views)
    started = time.perf_counter()
    upper, lower = find_features(upper), find_features(lower)
    features = match_features(upper.features, lower.features)
    matching = match_views(upper, lower, rig)
    seconds = time.perf_counter() - started
    objects = measure_objects(matching.matches, upper, lower, rig, arguments.sigma_pixels)
    summary = {
        **{"upper": str(arguments.upper), "lower": str(arguments.lower), "baseline_m": rig.baseline},
        "matches": len(features),
        "epipolar_percent": 100 * features.epipolar_share,
        "epipolar_tolerance_deg": float(np.degrees(EPIPOLAR_TOLERANCE)),
        "median_disparity_px": _median(features.vertical_disparity[features.epipolar]) * upper.height / np.pi,
        "median_azimuth_difference_px": _median(np.abs(features.azimuth_difference)) * upper.width / (2 * np.pi),
        "sigma_pixels": arguments.sigma_pixels,
        "seconds": seconds,
        "objects": [_row(measured, boxes) for measured in objects],
        "unmatched": [],
    }
    for item in matching.unmatched:
        box, told = getattr(boxes, item.side)[item.index], {"side": item.side, "index": item.index}
        summary["unmatched"].append({"name": box.name, "label": box.label, **told, "reason": item.reason})
    # NaN is no JSON: what has no value is null.
    valid, text = _nan_to_none(summary), _table(summary, boxes is not None)
    write = partial(_write, summary=summary, views=(upper, lower), features=features, objects=objects)
    print_and_write(arguments, "stereo", valid, text, write)
    return 0


def _median(values: np.ndarray) -> float:
    return float(np.median(values)) if len(values) else float("nan")


def _distance(found) -> dict:
    """Return a distance as the table has it; distance_m is that along the upper camera's direction."""
    values = {name: getattr(found, name) for name in MEASURED}
    return {**values, "distance_m": float(np.linalg.norm(found.position))}


def _row(measured, boxes) -> dict:
    upper, lower = boxes.upper[measured.upper], boxes.lower[measured.lower]
    names = [name for name in (upper.name, lower.name) if name]
    return {
        "name": " / ".join(dict.fromkeys(names)) or None,
        "label": measured.label,
        "upper": measured.upper,
        "lower": measured.lower,
        "matches": measured.n_matches,
        "azimuth_deg": measured.azimuth_deg,
        **{way: _distance(getattr(measured, way)) for way in WAYS},
    }


def _nan_to_none(value):
    if isinstance(value, dict):
        return {key: _nan_to_none(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_nan_to_none(item) for item in value]
    return None if isinstance(value, float) and not np.isfinite(value) else value


def _table(s: dict, has_boxes: bool) -> str:
    lines = ["no features matched between the two images: are they sharp, and of one place?"]
    if s["matches"]:
        found = f"{s['matches']} features matched over the two images; {s['epipolar_percent']:.1f} % of them obey the "
        lines = [found + f"epipolar constraint within {s['epipolar_tolerance_deg']:.2f} degrees"]
    if s["matches"] and s["epipolar_percent"] > 0:
        lines.append(
            f"median vertical disparity {s['median_disparity_px']:.1f} px, median azimuth difference "
            f"{s['median_azimuth_difference_px']:.2f} px; features and matching took {s['seconds']:.2f} s"
        )
    if not has_boxes:
        return "\n".join([*lines, "", "No distances: give the objects' boxes with --boxes."])
    lines += [
        "",
        f"{len(s['objects'])} objects seen in both images; metres, ± one standard deviation",
        f"  from box centres: of the centre, whose u and v have {s['sigma_pixels']:g} px each",
        "  from disparities: of the visible surface (the median of its features), not of the object's middle behind it",
    ]
    lines += [f"{'':<28} {'':>8} {'from box centres':^25} {'from disparities':^25}"]
    lines += [f"{'object':<28} {'matches':>8} {'horizontal':>14} {'d':>10} {'horizontal':>14} {'d':>10}"]
    for row in s["objects"]:
        cells = " ".join(_cell(row[way]) for way in WAYS)
        lines.append(f"{(row['name'] or row['label'])[:28]:<28} {row['matches']:>8} {cells}")
    for row in s["unmatched"]:
        lines.append(f"{(row['name'] or row['label'])[:28]:<28} {'':>8} {row['side']} image only: {row['reason']}")
    return "\n".join(lines)


def _cell(measured: dict) -> str:
    if measured["outcome"] != "ok":
        return f"{measured['outcome']:>25}"
    horizontal = f"{measured['horizontal_range_m']:.2f} ± {measured['horizontal_sigma_m']:.2f}"
    return f"{horizontal:>14} {measured['distance_m']:>10.2f}"


def _write(folder: Path, summary: dict, views, features, objects) -> list[str]:
    """Write numbers, a row an object, and figures; return the names."""
    from courseware.experiments.results import write_results
    from courseware.plots.stereo_figures import disparity_figure, distances_figure, room_figure

    rows = []
    for row in summary["objects"]:
        rows.append({name: row[name] for name in ("name", "label", "matches")})
        rows[-1]["azimuth_deg"] = round(row["azimuth_deg"], 3)
        for way in WAYS:
            for name, value in row[way].items():
                rows[-1][f"{way}_{name}"] = value if isinstance(value, str) else round(value, 4)
    write_results(folder / "stereo.json", _nan_to_none(summary), rows)
    figures = {"disparity.png": disparity_figure(views[0].image, features)}
    if objects:
        names = [row["name"] or row["label"] for row in summary["objects"]]
        figures["distances.png"] = distances_figure(views, objects, names)
        figures["room.png"] = room_figure(objects, names)
    for name, figure in figures.items():
        figure.savefig(folder / name, dpi=130)
    return ["stereo.json", *figures]
