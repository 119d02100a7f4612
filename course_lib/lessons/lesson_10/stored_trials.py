"""The trials of `demo lost` that come with the course: data/corridor/results/lost_*.json."""

import json

from course_lib.experiments.intervals import wilson_percent
from course_lib.paths import data_path

_ROWS = (("kidnapped, recovered", "kidnapped_recovered"), ("started anywhere, right", "started_right"))


def stored_table(place: str) -> str:
    """What `demo lost` measured in a place, "kitchen" or "corridor": shares with Wilson's 95 % intervals."""
    found = json.loads(data_path(f"corridor/results/lost_{place}.json").read_text(encoding="utf-8"))
    n, lines = found["trials"], []
    for name, key in _ROWS:
        low, high = wilson_percent(found[key], n)
        lines.append(f"{name:26} {found[key]:3} of {n}  (95 % interval {low:.0f} to {high:.0f} %)")
    false, frames = found["false_alarms"], found["undisturbed_frames"]
    low, high = wilson_percent(false, frames)
    lines.append(f"{'false alarms in peace':26} {false:3} of {frames} frames  ({low:.2f} to {high:.2f} %)")
    lines.append(
        f"{'median':26} {found['frames_to_recover']:.0f} frames to recover; to start: {found['frames_to_start']:.0f} "
        f"frames, {found['particles_to_start']:.0f} particles"
    )
    return "\n".join([f"{place}, {n} trials", *lines])
