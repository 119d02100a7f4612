"""Make what the course ships under data/.

Old data are replaced at the end, all at once: a run that is stopped leaves them as they were. The rooms of the projects
are kept one by one: the same command given again goes on where it was stopped.
"""

import argparse
import json
import sys
from pathlib import Path

from course_lib.files import staging_dir
from courseware.commands.arguments import require_output_folder, require_processes, require_seed
from courseware.commands.output import progress_bar
from courseware.paths import REPOSITORY, data_path

DATA = Path(__file__).resolve().parents[1] / "data"
SHIPPED = {
    "corridor": (4, "the true world, the surveyed map, the recorded runs"),
    "room": (4, "stereo panoramas at the paper's places, exact boxes and poses, the semantic map"),
    "finale": (10_001, "the semantic map and the mesh map of the room in which both methods meet"),
}
"""Folder of data/ that is made from one seed -> the shipped data's, and what it holds."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what can be made, and the options of each."""
    kinds = parser.add_subparsers(dest="kind", metavar="DATA", required=True)

    def kind(name: str, what: str):
        return kinds.add_parser(name, help=what, description=f"Make {what}.", allow_abbrev=False).add_argument

    folder, number = {"type": Path, "metavar": "FOLDER"}, {"type": int, "metavar": "N"}
    for name, (seed, what) in SHIPPED.items():
        add = kind(name, what)
        add("--seed", **number, default=seed, help=f"default {seed}, the shipped data's")
        add("--out", **folder, help=f"where the data go; another seed needs it (default: data/{name})")
    add, work = kind("projects", "what two spherical cameras saw in the rooms of P2 and P3"), "results/project_rooms"
    what = "where two folders go: projects/, for practice, and answers/, for the score (default: data/, courseware/)"
    add("--out", **folder, help=what)
    what = f"where finished rooms are kept, and looked for (default: {work})"
    add("--work", **folder, default=Path(work), help=what)
    add("--processes", **number, help="rooms made at a time (default: one for each core)")


def run(arguments: argparse.Namespace) -> int:
    """Make the data and say what was made; return the exit code."""
    if arguments.kind in SHIPPED:
        return make_shipped(arguments)
    return make_projects(arguments)


def make_shipped(arguments: argparse.Namespace) -> int:
    """Make a folder of data/ from its seed. Raises `ValueError` where it would replace the shipped one by another."""
    name, seed, (shipped, _) = arguments.kind, arguments.seed, SHIPPED[arguments.kind]
    require_seed(seed)
    if arguments.out is None and seed != shipped:
        raise ValueError(
            f"--seed {seed} makes other data than the shipped ones (seed {shipped}): "
            f"give --out FOLDER, or data/{name} would be replaced"
        )
    out = arguments.out or DATA / name
    require_output_folder(out)
    if name == "corridor":
        from tools.corridor_data import make_corridor_data

        made = make_corridor_data(out, seed, progress=lambda items, text: progress_bar(text, "part")(items))
        told = json.dumps(made["measured"], indent=2)
    elif name == "room":
        from courseware.simulation.room.data import make_room_data

        made = make_room_data(out, seed, progress=progress_bar("photographs", "pair"))
        told = f"{made['pairs']} pairs of a room with {made['objects']} objects"
    else:
        from courseware.simulation.room.finale_data import make_finale_data

        made = make_finale_data(out, seed)
        told = f"the maps of a room with {made['objects']} objects, {made['triangles']} triangles"
    print(f"{told}\nwritten to {out}")
    return 0


def make_projects(arguments: argparse.Namespace) -> int:
    """Make the rooms of data/projects, and those of courseware/answers for the score."""
    practice = (arguments.out or DATA) / "projects"
    hidden = (arguments.out or REPOSITORY / "courseware") / "answers"
    require_processes("--processes", arguments.processes)
    for out in (practice, hidden):
        require_output_folder(out)
    require_output_folder(arguments.work, "--work")
    from courseware.answers.project_2_task import HIDDEN_SEEDS
    from courseware.lessons.project_2.rooms import PRACTICE_SEEDS
    from courseware.simulation.data_folder import checksums
    from tools.project_rooms import write_rooms

    how = data_path("detector"), arguments.work, arguments.processes, progress_bar("rooms", "room")
    with staging_dir(practice) as for_students, staging_dir(hidden) as for_the_score:
        for new, name, seeds in ((for_students, "practice", PRACTICE_SEEDS), (for_the_score, "hidden", HIDDEN_SEEDS)):
            count = write_rooms(new / f"rooms_{name}.json", seeds, *how)
            (new / "SHA256SUMS").write_text(checksums(new, [f"rooms_{name}.json"]))
            print(f"{count} views ({name})")
    print(f"written to {practice} and {hidden}")
    return 0


if __name__ == "__main__":
    from courseware.cli import tool

    sys.exit(tool("tools.make_data"))
