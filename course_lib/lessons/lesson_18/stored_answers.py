"""What `demo rooms` measured on generated rooms, seeds 1 to 20, read back (RESULTS.md, section 2.5)."""

import functools
import json

from course_lib.experiments.look_alikes import KINDS
from course_lib.paths import data_path


@functools.cache
def stored_answers() -> dict:
    """What `look_alikes.answers_summary` made: "one_view", "several_views", "thinned_views", "ablation" and more."""
    return json.loads(data_path("room/results/rooms_1-20.json").read_text(encoding="utf-8"))["answers"]


def shares_line(name: str, table: dict, width: int = 22) -> str:
    """One row of a printed table: correct, wrong and unanswered in percent, each with Wilson's 95 % interval."""
    cells = []
    for kind in KINDS:
        low, high = table[f"{kind}_wilson_percent"]
        cells.append(f"{kind} {table[f'{kind}_percent']:5.1f} ({low:4.1f} to {high:5.1f})")
    return f"{name:{width}} {', '.join(cells)} %"
