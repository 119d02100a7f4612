"""What `interrupt` stops: every command that writes, in its smallest form, and the writers that stand behind others."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from course_lib.commands.stopped_runs import COMMAND
from course_lib.paths import REPOSITORY

_WRITER = (
    "import sys\nfrom pathlib import Path\nfrom course_lib.commands.interrupt_writers import WRITERS\n"
    "WRITERS[sys.argv[1]](Path(sys.argv[2]), int(sys.argv[3]))"
)
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
    share: int = 1
    """How many of the moments are its own, beside the other cases: more where a run takes a fraction of a second."""
    environment: str = ""
    """NAME=value that its run gets."""
    prepare: Callable[[Path, Path], None] = lambda given, out: None
    """Puts into the folder `given` what it reads; `out` is where it will write."""


def writer(name: str, **options: object) -> Case:
    """The case of one of `interrupt_writers.WRITERS`."""
    return Case(name.replace("_", " "), f"{name} {{out}} {{which}}", _WRITER, prints=False, **options)


def prepare_records(given: Path, out: Path) -> None:
    """What two students had typed in lesson 06."""
    for which in (1, 2):
        folder = given / f"record_{which}"
        folder.mkdir(parents=True)
        record = {"lesson": "06", "predictions": {str(n): "so many" for n in range(1, which + 1)}, "checks": {}}
        (folder / "06.json").write_text(json.dumps(record))


def prepare_submissions(given: Path, out: Path) -> None:
    """Two classes of one student each, who handed the lesson in as it came."""
    for which, student in ((1, "alice"), (2, "bob")):
        folder = given / f"class_{which}"
        folder.mkdir(parents=True)
        lesson = next((REPOSITORY / "notebooks").glob("03_*.ipynb"))
        shutil.copy(lesson, folder / f"{student}_03.ipynb")


def prepare_courses(given: Path, out: Path) -> None:
    """Two versions of the course, with one work/ between them: the second has a lesson more and changed companions."""
    lessons = sorted((REPOSITORY / "notebooks").glob("0*.ipynb"))[:4]
    for which in (1, 2):
        notebooks = given / f"course_{which}" / "notebooks"
        (notebooks / "pictures").mkdir(parents=True)
        for path in lessons[: 1 + which]:
            shutil.copy(path, notebooks)
        for name in ("README.md", "GLOSSARY.md", "pictures/00.png"):
            (notebooks / name).write_text(f"{name} {which}\n" * 1000)
        (given / f"course_{which}" / "work").symlink_to(out, target_is_directory=True)


_PAIR = "--upper {data}/room/experiment_1/01_a_upper.jpg --lower {data}/room/experiment_1/01_a_lower.jpg --baseline 0.3"
_RUN = "--particles 20 --frames 3 --seed {which} --out {out}"

CASES: tuple[Case, ...] = (
    writer("made_data", share=6),
    writer("recording", share=6),
    writer("semantic_map", share=6),
    writer("simplified_map", share=6),
    writer("checkpoint", share=6),
    writer("sweep", by_file=True, share=6),
    writer("lab_settings", by_file=True, share=6),
    writer("working_copies", by_file=True, share=6, prepare=prepare_courses),
    writer("notebook"),
    Case("demo corridor", f"demo corridor --recording shipped {_RUN}"),
    Case("demo room", "demo room --poses {which} --out {out}"),
    Case(
        "localize",
        "localize --map {data}/corridor/map.ply --sequence {data}/corridor/wagon --dof xyyaw --method paper " + _RUN,
    ),
    Case("locate", f"locate {_PAIR} --map {{data}}/room/semantic_map.json --score-threshold 0.{{which}} --out {{out}}"),
    Case("stereo", f"stereo {_PAIR} --sigma-pixels {{which}} --out {{out}}", share=2),
    Case(
        "ambiguity",
        "ambiguity --map {data}/finale/semantic_map.json --association greedy --step 3 --draws 2 --seed {which} "
        "--out {out}",
        share=2,
    ),
    Case(
        "make-data training-rooms",
        "make-data training-rooms --rooms 1 --images-per-room 1 --first-room {which} --out {out}",
        by_file=True,
        prints=False,
    ),
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
        share=2,
        environment="COURSE_RECORD={given}/record_{which}",
        prepare=prepare_records,
    ),
)
