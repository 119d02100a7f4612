"""What `interrupt` stops: every command that writes, in its smallest form, and the writers that stand behind others."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import NamedTuple

from course_lib.commands.interrupt_given import (
    prepare_courses,
    prepare_finished_rooms,
    prepare_measurements,
    prepare_recording,
    prepare_records,
    prepare_submissions,
)
from course_lib.commands.stopped_runs import COMMAND

_WRITER = (
    "import sys\nfrom pathlib import Path\nfrom course_lib.commands.interrupt_writers import WRITERS\n"
    "WRITERS[sys.argv[1]](Path(sys.argv[2]), int(sys.argv[3]))"
)
_SMALL = f"import sys\nfrom course_lib.commands.interrupt_small import SMALL\nSMALL[sys.argv.pop(1)]()\n{COMMAND}"
# What `progress` runs in a process of its own, whose steps would not be seen.
_PROGRESS = "import runpy\nrunpy.run_module('course_lib.lessons.kit.show_progress', run_name='__main__')"


class Case(NamedTuple):
    """A run that is stopped. In its words {out}, {given}, {data} are folders; {which}: 1 for the old, 2 for the new."""

    name: str
    words: str
    program: str = COMMAND
    by_file: bool = False
    """Each file is put in place by itself, and the next run goes on: not all of a run's outputs at once."""
    prints: bool = True
    """It prints what it found, and must do so before it writes."""
    kept: bool = False
    """Its second run is done once before both, and what it keeps (rows, rooms) is there for them: no run takes long."""
    environment: str = ""
    """NAME=value that its run gets."""
    prepare: Callable[[Path, Path], None] = lambda given, out: None
    """Puts into the folder `given` what it reads; `out` is where it will write."""

    @property
    def is_command(self) -> bool:
        """Whether its program is the course's command line, and so ends as a command does."""
        return self.program.endswith(COMMAND)


def writer(name: str, **options: object) -> Case:
    """The case of one of `interrupt_writers.WRITERS`."""
    return Case(name.replace("_", " "), f"{name} {{out}} {{which}}", _WRITER, prints=False, **options)


def small(command: str, options: str, **more: object) -> Case:
    """The case of a command that `interrupt_small.SMALL` makes short, which no option of its own does."""
    return Case(command, f"{command.replace(' ', '_')} {command} {options} --out {{out}}", _SMALL, **more)


_PAIR = "--upper {data}/room/experiment_1/01_a_upper.jpg --lower {data}/room/experiment_1/01_a_lower.jpg --baseline 0.3"
_RUN = "--particles 20 --frames 3 --seed {which} --out {out}"

CASES: tuple[Case, ...] = (
    writer("made_data"),
    writer("recording"),
    writer("semantic_map"),
    writer("simplified_map"),
    writer("checkpoint"),
    writer("sweep_rows", by_file=True),
    writer("lab_settings", by_file=True),
    writer("working_copies", by_file=True, prepare=prepare_courses),
    writer("notebook"),
    Case("demo corridor", f"demo corridor --recording shipped {_RUN}"),
    Case("demo room", "demo room --poses {which} --out {out}"),
    Case("demo rooms", "demo rooms --seeds 1-{which} --poses 1 --out {out}", kept=True),
    Case("demo walk", "demo walk --seeds 1-{which} --every 4 --methods floor --out {out}", kept=True),
    Case(
        "demo lost",
        "demo lost --seeds 1-{which} --recording {given}/recording --out {out}",
        kept=True,
        prepare=partial(prepare_recording, frames=60),
    ),
    Case("demo trouble", "demo trouble --seeds 1-{which} --method depth --share 1 --frames 40 --out {out}", kept=True),
    Case("demo finale", "demo finale --seeds 1-{which} --places 1 --out {out}", kept=True),
    Case("sweep", "sweep corridor --seeds {which}-{which} --particles 20 --frames 3 --out {out}", by_file=True),
    small("bench", "--no-tools", environment="MEASURED={given}/measured_{which}", prepare=prepare_measurements),
    Case(
        "localize",
        "localize --map {data}/corridor/map.ply --sequence {data}/corridor/wagon --dof xyyaw --method paper " + _RUN,
    ),
    Case(
        "compare",
        "compare --map {data}/corridor/map.ply --sequence {given}/recording --methods floor --seeds {which} "
        "--out {out}",
        by_file=True,
        prepare=partial(prepare_recording, frames=3),
    ),
    Case("locate", f"locate {_PAIR} --map {{data}}/room/semantic_map.json --score-threshold 0.{{which}} --out {{out}}"),
    Case("stereo", f"stereo {_PAIR} --sigma-pixels {{which}} --out {{out}}"),
    Case(
        "ambiguity",
        "ambiguity --map {data}/finale/semantic_map.json --association greedy --step 3 --draws 2 --seed {which} "
        "--out {out}",
    ),
    small("make-data corridor", "--seed {which}", prints=False),
    small("make-data room", "--seed {which}", prints=False),
    small("make-data finale", "--seed {which}", prints=False),
    Case(
        "make-data projects",
        "make-data projects --work {given}/rooms_{which} --out {out}",
        prints=False,
        prepare=prepare_finished_rooms,
    ),
    Case(
        "make-data training-rooms",
        "make-data training-rooms --rooms 1 --images-per-room 1 --first-room {which} --out {out}",
        by_file=True,
        prints=False,
    ),
    Case("fuzz", "fuzz --files 6 --formats boxes --seed {which} --out {out}"),
    Case("handout", "handout 03 --seed {which} --out {out}", prints=False),
    Case(
        "grade",
        "grade {given}/class_{which} --seed 1 --jobs 1 --trusted --out {out}",
        prepare=prepare_submissions,
    ),
    Case(
        "progress",
        "--out {out}/page.html",
        _PROGRESS,
        environment="COURSE_RECORD={given}/record_{which}",
        prepare=prepare_records,
    ),
)
