"""The sources of the web site: what Sphinx reads, made from the stored lessons and the Markdown files.

Every page keeps its path in the repository, and README.md becomes index. Solutions and last hints go. Where a page
names a figure or an equation, it gets a link.
"""

import ast
import inspect
import json
import posixpath
import re
import shutil
from importlib import import_module
from pathlib import Path, PurePosixPath

import nbformat

from courseware.classroom.assignment_cells import Assignment, read_assignments, tag_of
from courseware.classroom.student_copies import student_text, unsolved_notebook
from courseware.paths import REPOSITORY

SETTINGS = Path(__file__).with_name("site_source")
PAGES = "*.md notebooks/*.md notebooks/projects/*.md results-in-detail/*.md data/**/*.md tools/README.md"
LEFT_OUT = {"TEACHING.md"}  # for teachers: it tells answers

FIGURE = re.compile(r"(<img alt=.*?>)<p><em>Figure (F?\d+\.\d+)\. (.*?)</em></p>", re.S)
EQUATION = re.compile(r"^\$\$(?:(?!\$\$).)*?\\tag\{([^}]+)\}(?:(?!\$\$).)*\$\$", re.M | re.S)
CITED = re.compile(r"Source:\s+paper (\d),\s+eqs?\.?\s+([(\d), ]+)")
# Nothing in these may become a link: code, mathematics, links, tags, headings.
PROTECTED = re.compile(
    r"(```.*?```|`[^`\n]+`|\$\$.*?\$\$|\$[^$\n]+\$|!?\[(?:[^\[\]]|\[[^\]]*\])*\]\([^)]*\)|<[^>\n]+>|^(?:#+| {4}) .*?$)",
    re.S | re.M,
)
# "Figures 6.1 and 6.2", "lessons 03 and 04".
NUMBER = r"(?:F?\d+\.\d+|\d\d|F\d)\b"
NAMES = re.compile(rf"\b(?:[Ff]igure|[Ll]esson)s? {NUMBER}(?:(?:, (?=F?\d+\.)|,? and | to ){NUMBER})*")
# "Eqs (9) and (10)" names equations. In the lesson that shows them, "by (9)" does, too.
NAMED = re.compile(r"([Ee]quations?|[Ee]qs?\.?)(?: \([\dF.]+\),?| to| and| or)* $")
NAMED_AT_HOME = re.compile(r"(?:\b(?:by|in|of|to|with|from|like|and|or|than|through|into|for)|^) $", re.M)

NAVIGATION = re.compile(r"^.*\[all lessons\]\(.*$", re.M)  # the site has its own
LAST_STEP = re.compile(r"<details>\s*<summary>([^<]*)</summary>(?:(?!<details>).)*</details>\s*\Z", re.S)
TOLERANCE = re.compile(r"\n# numbers within .*")  # for the test of the stored outputs
STORED_RUN = """

<p class="needs-notebook">This page shows a stored run. To change and run it: <code>python3 course.py lab</code></p>"""
WORDS = {
    "<p>Run this cell to move the controls.</p>": '<p class="needs-notebook">The controls move in the notebook.</p>',
    "Your predictions (run this cell to type them in):": "Write your predictions down before you read on:",
    "<iframe ": '<iframe loading="lazy" ',
}


class Site:
    """Where pages, figures, equations and the functions of equations stand.

    An equation's key is "1.8" for paper 1's (8), and "9.1" for the course's own. Its home is the first lesson after 00
    that shows it.
    """

    def __init__(self, repository: str) -> None:
        self.repository = repository
        self.lessons = {path_of(one.path): one for one in read_assignments()}
        self.markdown = sorted({path_of(path) for glob in PAGES.split() for path in REPOSITORY.glob(glob)} - LEFT_OUT)
        self.numbers = {lesson.name: page for page, lesson in self.lessons.items()}
        self.figures: dict[str, str] = {}
        self.shown: dict[str, dict[str, str]] = {page: {} for page in self.markdown}  # page -> number -> key
        self.homes: dict[str, str] = {}
        for page, lesson in self.lessons.items():
            source = "\n\n".join(cell.source for cell in lesson.stored.cells if cell.cell_type == "markdown")
            numbers = [one for tag in EQUATION.findall(source) for one in tag.split(", ")]
            self.shown[page] = {number: key(number, page) for number in numbers}
            self.homes |= {
                one: page for one in self.shown[page].values() if one not in self.homes and lesson.name != "00"
            }
            outputs = [output for cell in lesson.stored.cells for output in cell.get("outputs", []) if "data" in output]
            for output in outputs:
                self.figures |= {found[1]: page for found in FIGURE.findall(output.data.get("text/html", ""))}
        self.functions = functions_of_equations()

    def text(self, source: str, page: str) -> str:
        """Return Markdown with its links as the site has them, and with links where it names figures and equations."""
        parts = PROTECTED.split(student_text(source, lambda target: self.target(target, page)))
        for index in range(0, len(parts), 2):
            text = self.with_equations(parts[index], page, "".join(parts[max(0, index - 2) : index])[-80:])
            parts[index] = NAMES.sub(lambda found: self.named(found[0], page), text)
        return EQUATION.sub(lambda found: self.anchored(found, page), "".join(parts))

    def target(self, target: str, page: str) -> str | None:
        """Return where a link from `page` leads on the site or in the repository; None for plain words."""
        meant = posixpath.normpath(posixpath.join(posixpath.dirname(page), target))
        meant = f"{meant}/README.md" if f"{meant}/README.md" in self.markdown else meant
        if meant in self.shown:
            return relative(on_site(meant), page)
        if self.repository and (REPOSITORY / meant).exists():
            return f"{self.repository}/{'tree' if (REPOSITORY / meant).is_dir() else 'blob'}/HEAD/{meant}"
        return None

    def named(self, words: str, page: str) -> str:
        """Return "Figures 6.1 and 6.2" or "lessons 03 and 04" with links."""

        def link(found: re.Match) -> str:
            home = self.figures.get(found[1]) or self.numbers.get(found[1])
            part = f"#figure-{found[1]}" if found[1] in self.figures else ""
            return self.link(found[0], home, part, page) if home and home + part != page else found[0]

        return re.sub(rf"(?:\b[FfLl]\w+ )?({NUMBER})", link, words)

    def with_equations(self, text: str, page: str, before: str) -> str:
        """Return text with a link for each "(8)" that is an equation. before: what stands in front of the text."""

        def link(found: re.Match) -> str:
            number, left = found[1], (before + text[: found.start()])[-80:]
            shown, paper = number in self.shown[page], re.findall(r"paper (\d)", left)
            if not (NAMED.search(left) or (shown and NAMED_AT_HOME.search(left))):
                return found[0]
            one = key(number, page) if page in self.lessons else f"{paper[-1]}.{number}" if paper else f"1.{number}"
            if one == "1.1" and not paper and page in self.markdown:  # both papers have an eq. (1)
                return found[0]
            home = page if shown else self.homes.get(one)
            return self.link(found[0], home, f"#eq-{one}", page) if home else found[0]

        return re.sub(r"\((F?\d+(?:\.\d+)?)\)", link, text)

    def link(self, words: str, home: str, part: str, page: str) -> str:
        address = "" if home == page else relative(as_html(home), page)
        return f'<a class="to-number" href="{address}{part}">{words}</a>'

    def anchored(self, found: re.Match, page: str) -> str:
        """Return an equation with its anchor, and at its home with the functions that compute it."""
        keys = [self.shown[page][number] for number in found[1].split(", ")]
        here = [self.functions[one] for one in keys if one in self.functions and self.homes[one] == page]
        api = relative("api/", page)
        equation = found[0].replace(r"\\", r"\cr ")  # Sphinx puts lines that end in two strokes where no tag may stand
        code = " ".join(
            f'<a href="{api}/{module}.html#course_lib.{module}.{name}"><code>{name}</code></a>' for module, name in here
        )
        said = f'\n\n<p class="in-code">In code: {code}</p>\n' if here else ""
        return "".join(f'<div class="equation" id="eq-{one}"></div>' for one in keys) + f"\n\n{equation}{said}"


def write_source(folder: Path, repository: str = "") -> None:
    """Write all that Sphinx reads into an empty folder. repository: address for links to files that are no page."""
    site, notebooks = Site(repository), REPOSITORY / "notebooks"
    shutil.copytree(SETTINGS, folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))
    scenes = folder / "extra" / "notebooks" / "scenes"
    shutil.copytree(notebooks / "scenes", scenes, ignore=shutil.ignore_patterns("yours"))
    for pictures in (folder / "notebooks" / "pictures", scenes.with_name("pictures")):  # for Markdown, for HTML
        shutil.copytree(notebooks / "pictures", pictures)
    for page, lesson in site.lessons.items():
        write(folder / page, nbformat.writes(lesson_page(site, page, lesson)) + "\n")
    for page in site.markdown:
        source = (REPOSITORY / page).read_text(encoding="utf-8")
        for picture in re.findall(r"!\[[^\]]*\]\(([^)\s]+)\)", source):
            place = posixpath.normpath(posixpath.join(posixpath.dirname(page), picture))
            (folder / place).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(REPOSITORY / place, folder / place)
        write(folder / on_site(page), site.text(source, page))
    contents = (SETTINGS / "contents.txt").read_text(encoding="utf-8")
    if not any(page.startswith("results-in-detail/") for page in site.markdown):
        contents = contents.replace("results-in-detail/*\n", "")
    with (folder / "index.md").open("a", encoding="utf-8") as front_page:
        front_page.write(contents)
    equations = {one: [as_html(home), f"eq-{one}"] for one, home in site.homes.items()}
    write(folder / "site.json", json.dumps({"equations": equations, "repository": repository}))


def lesson_page(site: Site, page: str, lesson: Assignment) -> nbformat.NotebookNode:
    """Return a lesson as the site shows it: without solutions and last hints, its plumbing folded."""
    notebook = unsolved_notebook(lesson)
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            text = NAVIGATION.sub("", cell.source).strip()
            if tag_of(cell) == "hint":
                text = LAST_STEP.sub(r"<p>\1: in the notebook.</p>", text)
            cell.source = site.text(text, page)
            continue
        cell.source = TOLERANCE.sub("", cell.source)
        imports = all(isinstance(node, ast.Import | ast.ImportFrom) for node in ast.parse(cell.source).body)
        hidden = "remove-input" if re.search(r"^predict\(", cell.source, re.M) else ""
        hidden = "hide-input" if imports or re.search(r"^recall\(", cell.source, re.M) else hidden
        cell.metadata["tags"] = [*cell.metadata.get("tags", []), *hidden.split()]
        cell.outputs = [] if tag_of(cell) == "check" else cell.outputs  # "not attempted yet"
        for output in cell.outputs:
            if "text/html" in output.get("data", {}):
                output.data["text/html"] = shown_html(output.data["text/html"])
    notebook.cells[0].source += STORED_RUN
    notebook.cells = [cell for cell in notebook.cells if cell.source]
    return notebook


def shown_html(text: str) -> str:
    """Return an output whose pictures scroll in a frame, whose figures have names, and whose words fit a page."""
    frame = r'<div class="picture" tabindex="0" role="group" aria-label="Picture">\g<0></div>'
    caption = r'<figure id="figure-\2">\1<figcaption><a href="#figure-\2">Figure \2.</a> \3</figcaption></figure>'
    text = re.sub(r"<img alt=[^>]*>", frame, FIGURE.sub(caption, text))
    for stored, shown in WORDS.items():
        text = text.replace(stored, shown)
    return text


def functions_of_equations() -> dict[str, tuple[str, str]]:
    """Return equation ("1.8") -> module and name of the public function whose docstring cites it as its source."""
    found: dict[str, tuple[str, str]] = {}
    for module in (path.stem for path in sorted((SETTINGS / "api").glob("[!i]*.rst"))):
        for name, thing in vars(import_module(f"course_lib.{module}")).items():
            parts = inspect.getmembers(thing, inspect.isfunction) if inspect.isclass(thing) else []
            for part, function in [("", thing), *parts]:
                for paper, numbers in CITED.findall(getattr(function, "__doc__", None) or ""):
                    for number in re.findall(r"\d+", numbers):
                        found.setdefault(f"{paper}.{number}", (module, f"{name}.{part}".rstrip(".")))
    return found


def key(number: str, page: str) -> str:
    """Return an equation's key. In the lessons of paper 2, (1) is paper 2's."""
    paper = 2 if re.match(r"notebooks/(1[1-8]_|projects/P[23])", page) else 1
    return number if "." in number else f"{paper}.{number}"


def path_of(path: Path) -> str:
    return path.relative_to(REPOSITORY).as_posix()


def on_site(page: str) -> str:
    return re.sub(r"README\.md$", "index.md", page)


def as_html(page: str) -> str:
    return PurePosixPath(on_site(page)).with_suffix(".html").as_posix()


def relative(path: str, page: str) -> str:
    return posixpath.relpath(path, posixpath.dirname(page) or ".")


def write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
