"""Whatever is written goes through writing.py or output_folder.py; who writes by hand stands here, with the reason."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]

# Calls that write, move or copy a file, by the last word of their name ...
WRITES = {
    *("write_text", "write_bytes", "savefig", "imwrite", "savetxt", "savez", "savez_compressed", "tofile", "to_csv"),
    *("copyfile", "copy", "copy2", "copytree", "move", "rename", "replace", "link", "symlink", "symlink_to"),
    *("save", "dump", "write", "export"),
}
# ... where these words mean something else, or need one of these before them to mean a file.
ONLY_OF = {
    "copy": {"shutil"},
    "move": {"shutil"},
    "rename": {"os"},
    "replace": {"os"},
    "link": {"os"},
    "symlink": {"os"},
    "save": {"np", "numpy", "torch"},
    "dump": {"json", "pickle", "joblib"},
    "write": {"nbformat"},
    "export": {"mesh", "trimesh"},
}

TEMPORARY = "into a `scratch_folder`, which nobody else reads"
NEW = "into the folder that `replaced_outputs` puts in place as a whole"
ALLOWED = {
    "course_lib/writing.py": "the one way: a file",
    "course_lib/output_folder.py": "the one way: a folder",
    "course_lib/unfinished.py": "the one way: what lies beside its place until it is whole",
    "course_lib/classroom/handout.py": NEW,
    "course_lib/classroom/nbgrader_course.py": "handout's: " + NEW,
    "course_lib/classroom/nbgrader_trial.py": TEMPORARY,
    "course_lib/classroom/probe.py": TEMPORARY,
    "course_lib/classroom/sandbox.py": "the log of one answer, " + TEMPORARY,
    "course_lib/classroom/sandbox_process.py": "the walled-in process's own streams, no file",
    "course_lib/classroom/student_copies.py": "handout's: " + NEW,
    "course_lib/commands/ambiguity.py": NEW,
    "course_lib/commands/bench.py": NEW + "; .bench bears a mark until pip has ended, and is made anew while it does",
    "course_lib/commands/compare.py": NEW,
    "course_lib/commands/demo_corridor.py": NEW,
    "course_lib/commands/demo_room.py": NEW,
    "course_lib/commands/demo_rooms.py": NEW,
    "course_lib/commands/demo_trouble.py": NEW,
    "course_lib/commands/demo_walk.py": NEW,
    "course_lib/commands/grade.py": NEW,
    "course_lib/commands/localize_report.py": NEW,
    "course_lib/commands/locate.py": NEW,
    "course_lib/commands/make_projects.py": NEW,
    "course_lib/commands/refresh.py": "a kernel's start-up file, " + TEMPORARY,
    "course_lib/commands/stereo.py": NEW,
    "course_lib/commands/test.py": "a kernel's start-up file, " + TEMPORARY,
    "course_lib/commands/working_copies.py": "from `staged` to its place, one by one: a student works there meanwhile",
    "course_lib/depth_mcl/sequence.py": NEW,
    "course_lib/detector_training/checkpoints.py": "into memory, then `write_at_once`",
    "course_lib/depth_mcl/poses.py": "into memory, then `write_at_once`",
    "course_lib/depth_mcl/simplification.py": "into memory, then `write_at_once`",
    "course_lib/experiments/sweeps.py": "a line at a time at its file's end; the next sweep mends a half-written one",
    "course_lib/simulation/corridor/data.py": "make-data's: " + NEW,
    "course_lib/simulation/corridor/mesh_files.py": "make-data's: " + NEW,
    "course_lib/simulation/room/data.py": "make-data's: " + NEW,
    "course_lib/simulation/room/finale_data.py": "make-data's: " + NEW,
    "course_lib/simulation/room/stereo_photographs.py": "make-data's: " + NEW,
    "course_lib/standard_output.py": "the process's own stream, no file",
    "course.py": "it has the standard library alone: marks whose being there is all they say, and a stamp put in place "
    "in one step",
}


def called(node):
    """The dotted words of what is called, such as ("os", "replace"); "" stands for what is no plain name."""
    words, function = [], node.func
    while isinstance(function, ast.Attribute):
        words.insert(0, function.attr)
        function = function.value
    return [function.id if isinstance(function, ast.Name) else "", *words]


def opened_for_writing(node):
    """Whether a call opens a file with a mode that writes."""
    if called(node)[-1] not in ("open", "fdopen", "NamedTemporaryFile"):
        return False
    place = 1 if isinstance(node.func, ast.Name) or called(node)[-1] == "fdopen" else 0  # Path.open: the first argument
    given = [*node.args[place : place + 1], *(word.value for word in node.keywords if word.arg == "mode")]
    modes = [one.value for one in given if isinstance(one, ast.Constant) and isinstance(one.value, str)]
    return any(len(mode) <= 3 and set(mode) <= set("wax+bt") and set(mode) & set("wax+") for mode in modes)


def raw_writes(text):
    """Lines of Python source that write a file by hand."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Call):
            *before, last = called(node)
            if opened_for_writing(node):
                yield node.lineno
            elif last in WRITES and (last not in ONLY_OF or (before and before[-1] in ONLY_OF[last])):
                yield node.lineno


def unclaimed(text):
    """Lines of Python source that make something temporary by hand."""
    for node in ast.walk(ast.parse(text)):
        made = ("TemporaryDirectory", "mkdtemp", "mkstemp", "NamedTemporaryFile", "TemporaryFile", "mktemp")
        if isinstance(node, ast.Call) and called(node)[-1] in made:
            yield node.lineno


def sources():
    paths = [ROOT / "course.py", *sorted((ROOT / "course_lib").rglob("*.py"))]
    return {path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8") for path in paths}


@pytest.mark.parametrize(
    "text",
    [
        "Path('a').write_text('x')",
        "open('a', 'w')",
        "path.open('wb')",
        "path.open(mode='x')",
        "os.replace(a, b)",
        "np.savez(file, a=a)",
        "figure.savefig(out / 'a.png')",
        "cv2.imwrite('a.png', image)",
        "shutil.move(a, b)",
        "nbformat.write(notebook, path)",
        "json.dump(a, file)",
    ],
)
def test_a_raw_write_is_seen(text):
    assert list(raw_writes(text)) == [1]


@pytest.mark.parametrize("text", ["open('a')", "text.replace('a', 'b')", "write_at_once(path, text)", "array.copy()"])
def test_what_writes_nothing_by_hand_is_let_be(text):
    assert list(raw_writes(text)) == []


def test_who_writes_by_hand_stands_in_the_list_with_a_reason():
    found = {name: list(raw_writes(text)) for name, text in sources().items()}
    strangers = {name: lines for name, lines in found.items() if lines and name not in ALLOWED}
    assert not strangers, "use course_lib's writing.py or output_folder.py, or say in ALLOWED why not"


def test_the_list_names_only_who_writes_by_hand():
    found = sources()
    assert [name for name in ALLOWED if name not in found or not list(raw_writes(found[name]))] == []


@pytest.mark.parametrize("name", [name for name, why in ALLOWED.items() if why.startswith(NEW) and name != "course.py"])
def test_who_says_that_a_folder_is_put_in_place_calls_what_does_so(name):
    """Reports are written by a module of their own: then the command that calls it does."""
    folder = (ROOT / name).parent
    texts = [
        path.read_text(encoding="utf-8") for path in (ROOT / name, *folder.glob(f"{Path(name).stem.split('_')[0]}*.py"))
    ]
    assert any("with replaced_outputs(" in text for text in texts)


@pytest.mark.parametrize("text", ["TemporaryDirectory()", "tempfile.mkdtemp('a')", "tempfile.NamedTemporaryFile()"])
def test_a_temporary_folder_that_no_run_would_clear_is_seen(text):
    assert list(unclaimed(text)) == [1]


def test_what_is_temporary_is_a_scratch_folder_which_the_next_run_clears_after_a_kill():
    found = {name: list(unclaimed(text)) for name, text in sources().items()}
    strangers = {name for name, lines in found.items() if lines} - {"course_lib/unfinished.py"}
    assert not strangers, "use course_lib.scratch"
