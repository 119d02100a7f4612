"""Record what small, seeded runs of every computing command give, and compare two such recordings.

    .venv/bin/python -m tools.recorded_outputs record FOLDER [NAME ...] [--tree OTHER_CHECKOUT]
    .venv/bin/python -m tools.recorded_outputs compare BEFORE AFTER

For whoever changes the code and not its results: numbers must be equal to the last digit; times, paths and versions may
differ. A checkout of an earlier commit takes this environment's Python, or its own by `--python`. Some 15 minutes.
"""

import argparse
import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from courseware.paths import REPOSITORY

REAL = REPOSITORY.parent / "shared" / "real"
KITCHEN = f"--map {REAL}/kinect_kitchen/map.ply --sequence {REAL}/kinect_kitchen"
ROOMS = f"--map {REAL}/hololens_rooms/map.ply --sequence {REAL}/hololens_rooms"
CORRIDOR = "--map data/corridor/map.ply --sequence data/corridor/wagon"
PAIR = "--upper data/room/experiment_2/03_a_upper.jpg --lower data/room/experiment_2/03_a_lower.jpg --baseline 0.3"
OWN_PAIR = f"--upper {REAL}/panorama_room/upper.png --lower {REAL}/panorama_room/lower.png --baseline 0.2"

RUNS = {
    "corridor_shipped": "demo corridor --seed 1 --recording shipped --frames 8",
    "corridor_seeds": "demo corridor --seeds 1-2 --frames 5",
    "corridor_dof6": "demo corridor --dof 6 --seeds 1-1 --frames 16 --methods annealed,floor",
    "room": "demo room --poses 3",
    "room_consistent": "demo room --poses 2 --association consistent --roll 100",
    "rooms": "demo rooms --seeds 1 --poses 2 --views 2 --ablation --tilts 0.3",
    "walk": "demo walk --seed 1 --every 4 --methods annealed,floor",
    "lost": "demo lost --seeds 1-1",
    "trouble": "demo trouble --seeds 41-41 --share 20 --frames 44",
    "finale": "demo finale --seed 1 --places 1",
    "localize_corridor_paper": f"localize {CORRIDOR} --dof xyyaw --frames 12",
    "localize_corridor_annealed": f"localize {CORRIDOR} --frames 12",
    "localize_corridor_vtk": f"localize {CORRIDOR} --dof xyyaw --frames 3 --backend vtk",
    "localize_corridor_ray": f"localize {CORRIDOR} --dof xyyaw --frames 2 --backend ray",
    "localize_kitchen_annealed": f"localize {KITCHEN} --frames 20",
    "localize_kitchen_paper": f"localize {KITCHEN} --frames 10 --method paper",
    "localize_kitchen_recover": f"localize {KITCHEN} --frames 8 --recover",
    "localize_kitchen_unknown": f"localize {KITCHEN} --frames 4 --start unknown --up -y",
    "localize_rooms": f"localize {ROOMS} --frames 16",
    "compare_kitchen": f"compare {KITCHEN} --every 8 --methods all",
    "locate": f"locate {PAIR} --map data/room/semantic_map.json",
    "locate_consistent": f"locate {PAIR} --map data/room/semantic_map.json --association consistent",
    "locate_paper": f"locate {PAIR} --map data/room/semantic_map.json --paper",
    "stereo": f"stereo {OWN_PAIR}",
    "ambiguity": "ambiguity --map data/room/semantic_map.json --step 1.5 --draws 2",
}
"""Name of a recording -> the command; each is given --json and --out."""

LOOSE = re.compile(
    r"second|_s$|ms$|per_frame|^time|version|machine|processor|python|folder|path|data$|speed|memory", re.I
)
"""Names of values that may differ."""


def record(tree: Path, out: Path, python: str, names: list[str]) -> None:
    """Run each command in `tree`, and keep what it prints as `NAME.json` and what it writes in the folder `NAME`."""
    out.mkdir(parents=True, exist_ok=True)
    for name in names or RUNS:
        words = [*RUNS[name].split(), "--json", "--out", str(out / name)]
        environment = os.environ | {"PYTHONPATH": str(tree)}
        done = subprocess.run(
            [python, "-m", "courseware", *words], cwd=tree, env=environment, capture_output=True, text=True, check=False
        )
        (out / f"{name}.json").write_text(done.stdout, encoding="utf-8")
        print(f"{name}: exit code {done.returncode} {done.stderr[-300:] if done.returncode else ''}", flush=True)


def differences(one: object, other: object, where: str = "") -> Iterator[str]:
    """Yield where two values read from JSON differ."""
    if isinstance(one, dict) and isinstance(other, dict):
        for key in sorted(set(one) | set(other)):
            if not LOOSE.search(key):
                yield from differences(one.get(key), other.get(key), f"{where}.{key}")
    elif isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        for index, pair in enumerate(zip(one, other, strict=True)):
            yield from differences(*pair, f"{where}[{index}]")
    elif one != other and not (one != one and other != other):  # NaN is NaN
        yield f"{where}: {str(one)[:60]} is {str(other)[:60]} now"


def compare(before: Path, after: Path) -> int:
    """Print what differs between two recordings and return 1 if anything does."""
    found = 0
    for path in sorted(after.glob("*.json")):
        told = list(differences(json.loads((before / path.name).read_text()), json.loads(path.read_text())))
        for written in sorted((after / path.stem).rglob("*.json")):
            earlier = before / written.relative_to(after)
            if earlier.is_file():
                told += differences(json.loads(earlier.read_text()), json.loads(written.read_text()), written.name)
        print(f"{path.stem}: {'equal' if not told else '; '.join(told[:8])}")
        found += bool(told)
    return 1 if found else 0


def main() -> int:
    """Record or compare, as the words say."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    one = commands.add_parser("record")
    one.add_argument("out", type=Path)
    one.add_argument("names", nargs="*", choices=[[], *RUNS], metavar="NAME")
    one.add_argument("--tree", type=Path, default=REPOSITORY)
    one.add_argument("--python", default=sys.executable)
    two = commands.add_parser("compare")
    two.add_argument("before", type=Path)
    two.add_argument("after", type=Path)
    given = parser.parse_args()
    if given.command == "compare":
        return compare(given.before, given.after)
    record(given.tree.resolve(), given.out.resolve(), given.python, given.names)
    return 0


if __name__ == "__main__":
    sys.exit(main())
