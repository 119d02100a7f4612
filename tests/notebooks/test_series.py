"""Every lesson has all its places, among them its time and its picture in notebooks/README.md; and the glossary."""

import re
from fnmatch import fnmatch

import numpy as np
import pytest
from PIL import Image

from courseware.paths import REPOSITORY, foundation_paths, notebook_paths, numbered_paths
from tests.notebooks.conftest import read
from tools.series_pictures import MAX_BYTES, MAX_SIZE, write_picture

FOLDER = REPOSITORY / "notebooks"
README, GLOSSARY = ((FOLDER / name).read_text(encoding="utf-8") for name in ("README.md", "GLOSSARY.md"))
ENTRIES = dict(re.findall(r"^### (.+)\n((?:.+\n?)+)", GLOSSARY, re.M))


def row_of(path) -> str:
    return next(
        (line for line in README.splitlines() if " · " in line and f"]({path.relative_to(FOLDER).as_posix()})" in line),
        "",
    )


@pytest.mark.parametrize("path", [*notebook_paths(), *foundation_paths()], ids=lambda path: path.name[:2])
def test_every_lesson_has_a_row_with_its_time_and_its_picture(path):
    number, row = path.name[:2], row_of(path)
    assert row.startswith(f"| [{number} · "), "notebooks/README.md lacks its row"
    assert f"({read(path).minutes} min)" in row, "run `python -m tools.pace --write`"
    source, alt = re.search(r'<img src="([^"]+)" width="250" alt="([^"]+)">', row).groups()
    assert len(alt.split()) >= 4
    assert re.fullmatch(rf"pictures/{number}\.(png|webp|svg)", source)


@pytest.mark.parametrize("path", numbered_paths().values(), ids=lambda path: path.name[:2])
def test_a_lesson_begins_with_its_picture_which_is_of_its_stored_outputs(path, tmp_path):
    title = read(path).cells[0].source
    [source] = re.findall(r'<img src="([^"]+)" width="500" alt="[^"]+">\n\n\*\*', title)
    stored, made = path.parent / source, write_picture(path, tmp_path)
    assert stored.resolve() == FOLDER / "pictures" / made.name, "before the time that the lesson takes"
    assert stored.is_file(), "run tools.refresh"
    assert stored.read_bytes() == made.read_bytes(), "run tools.refresh"
    assert made.stat().st_size <= MAX_BYTES
    if made.suffix != ".svg":
        assert np.less_equal(Image.open(made).size, MAX_SIZE).all()


def test_the_times_of_the_paths_add_up():
    rows = re.findall(r"^\| ([a-z0-9 ]+) \| ((?:\d\d(?:, )?)+) \| (\d+) h (\d+) min \|$", README, re.M)
    assert [name for name, *_ in rows] == ["paper 1", "paper 2", "both"]
    for _, lessons, hours, minutes in rows:
        added = sum(read(numbered_paths()[number]).minutes for number in lessons.split(", "))
        assert added == 60 * int(hours) + int(minutes), "run `python -m tools.pace --write`"
    assert set(rows[0][1].split(", ") + rows[1][1].split(", ")) < set(rows[2][1].split(", "))


def numbers_in(text: str) -> set[str]:
    """The lessons that a text names: "01, 03 to 05" names four."""
    found = re.findall(r"\b(\d\d)\b(?:\]\([^)]*\))?(?: to \[?(\d\d)\b)?", text)
    return {f"{n:02}" for first, last in found for n in range(int(first), int(last or first) + 1)}


@pytest.mark.parametrize("path", notebook_paths(), ids=lambda path: path.name[:2])
def test_a_lesson_has_all_the_places_that_contributing_lists(path):
    number, root = path.name[:2], REPOSITORY
    readme, changes, teaching = (
        (root / name).read_text(encoding="utf-8") for name in ("README.md", "CHANGELOG.md", "TEACHING.md")
    )
    globs = re.findall(r"^notebooks/\S+$", (root / "tools/site_source/contents.txt").read_text(encoding="utf-8"), re.M)
    parts = re.findall(r"^\| (?:Start|Paper [12]|Both) \|([^|]*)\|", readme, re.M)
    paths = re.findall(r"^\| [a-z0-9 ]+ \|([\d, ]+)\| \d+ h", README, re.M)
    plan = teaching.partition("### Fifteen meetings")[2].partition("###")[0]
    places = {
        f"courseware/lessons/lesson_{number}/__init__.py": None,
        f"courseware/answers/lesson_{number}.py": None,
        f"tests/lessons/test_lesson_{number}.py": None,
        f"tests/lessons/right_answers/lesson_{number}.py": None,
        "README.md: the row of its part": number in numbers_in(" ".join(parts)),
        "CHANGELOG.md: a line": number in numbers_in(" ".join(re.findall(r"\([^()]*\)|[Ll]essons? [^.]*", changes))),
        "tools/site_source/contents.txt: the part of the web site": any(
            fnmatch(f"notebooks/{path.stem}", glob) for glob in globs
        ),
        "notebooks/README.md: a row": bool(row_of(path)),
        "notebooks/README.md: a path": number in numbers_in(" ".join(paths)),
        f"notebooks/pictures/{number}.*": any((FOLDER / "pictures").glob(f"{number}.*")),
        "TEACHING.md, section 1: the table of costs": f"\n| {number} | " in teaching.partition("## 2. Plans")[0],
        "TEACHING.md, section 2: fifteen meetings": number in numbers_in(plan),
        "TEACHING.md, section 3: an entry": f"\n### {number} · " in teaching,
    }
    before = [one for one in notebook_paths() if one.name < path.name][-1:]
    for lesson in map(read, before):
        next_text = lesson.markdown.rpartition("**Next:**")[2]
        places[f"{lesson.path.name}: its first cell links to the lesson"] = path.name in lesson.cells[0].source
        places[f"{lesson.path.name}: its last cell links to the lesson"] = path.name in lesson.cells[-1].source
        places[f"{lesson.path.name}: its **Next:** names the lesson"] = number in numbers_in(next_text)
    missing = [name for name, there in places.items() if not ((root / name).exists() if there is None else there)]
    assert not missing, "missing; CONTRIBUTING.md, 'A new lesson', says what belongs there:\n" + "\n".join(missing)


@pytest.mark.parametrize("term", ENTRIES)
def test_an_entry_is_named_as_its_anchor_and_names_a_lesson_that_exists(term):
    assert len(ENTRIES) >= 50
    assert re.fullmatch(r"[a-z0-9 -]+", term)
    named = {number for group in re.findall(r"Lessons? ([\dF and to,]+)\.", ENTRIES[term]) for number in group.split()}
    numbers = {word for word in named if re.fullmatch(r"[\dF]\d", word)}
    assert numbers
    assert numbers <= set(numbered_paths())


def test_every_link_to_the_glossary_finds_its_term(lesson):
    """GitHub and JupyterLab both make a heading's anchor of it: lower case already, spaces become dashes."""
    links = set(re.findall(r"GLOSSARY\.md#([^)\s]+)\)", lesson.markdown))
    assert links <= {term.replace(" ", "-") for term in ENTRIES}
