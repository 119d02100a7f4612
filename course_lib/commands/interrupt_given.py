"""What the cases of `interrupt` read: small folders, made before their runs, twice where the runs differ by them."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

from course_lib.paths import REPOSITORY, data_path


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


def prepare_recording(given: Path, out: Path, frames: int) -> None:
    """The first frames of the run that was carried by hand through the corridor, with their truth and their map."""
    from course_lib.depth_mcl.sequence import read_sequence, write_sequence

    whole, folder = read_sequence(data_path("corridor") / "hand"), given / "recording"
    depths = [whole.depth(index) for index in range(frames)]
    write_sequence(folder, whole.intrinsics, whole.frames[:frames], depths, whole.camera_to_world[:frames], up=whole.up)
    (folder / "map.ply").symlink_to(data_path("corridor") / "map.ply")


def prepare_finished_rooms(given: Path, out: Path) -> None:
    """The finished rooms from which the shipped projects were put together, and before them such with a view less."""
    from course_lib.experiments.project_rooms import POSES, SEEDS
    from course_lib.experiments.rooms import RoomsOptions

    options = RoomsOptions(POSES).as_dict()
    for name in SEEDS:
        shipped = json.loads((data_path("projects") / f"rooms_{name}.json").read_text(encoding="utf-8"))
        for which, end in ((1, -1), (2, None)):
            folder = given / f"rooms_{which}"
            folder.mkdir(exist_ok=True)
            for room in shipped["rooms"]:
                room = room | {"options": options, "views": room["views"][:end]}
                (folder / f"room_{room['seed']:05d}.json").write_text(json.dumps(room))


def prepare_measurements(given: Path, out: Path) -> None:
    """In place of a measurement, which takes minutes: a program that tells stored numbers, the second time others.

    So does its figure, which here is any picture.
    """
    stored = data_path("corridor") / "results"
    result = json.loads((stored / "bench.json").read_text(encoding="utf-8"))
    for which, picture in ((1, stored / "overview.png"), (2, stored / "bench.png")):
        folder = given / f"measured_{which}" / "benchmarks"
        folder.mkdir(parents=True)
        result["maps"]["growth"] = float(which)
        told = json.dumps(result)
        program = f"import shutil, sys\nshutil.copy({str(picture)!r}, sys.argv[2])\nprint({told!r})\n"
        (folder / "measure.py").write_text(program)
