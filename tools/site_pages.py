"""The sources of the web site: what Sphinx reads, made from the stored lessons and the Markdown files.

Every page keeps its path in the repository, and README.md becomes index. Solutions, last hints and measured plumbing go.
Links, figures and numbered equations become links between pages.
"""

import ast
import html
import inspect
import json
import posixpath
import re
import shutil
from importlib import import_module
from pathlib import Path, PurePosixPath

import nbformat

from course_lib.classroom.assignment_cells import Assignment, read_assignments, tag_of
from course_lib.classroom.student_copies import student_text, unsolved_notebook
from course_lib.paths import REPOSITORY

SETTINGS = Path(__file__).with_name("site_source")
PUBLIC = {
    "geometry": "Poses and angles",
    "depth_mcl": "Paper 1: depth Monte Carlo localization",
    "spherical_stereo": "Paper 2: spherical stereo",
    "beyond": "Beyond the papers",
}
"""Module of course_lib with public names -> title of its page."""

PAGES = "README.md *.md notebooks/*.md notebooks/projects/*.md results-in-detail/*.md data/**/*.md tools/README.md"
LEFT_OUT = {"TEACHING.md"}  # for teachers: it tells answers
# Name in the sidebar -> files. A page whose name begins another's path has that one below it.
CONTENTS = {
    "Start": "notebooks/README.md notebooks/00_*",
    "Paper 1: a depth camera": "notebooks/0[1-9]_* notebooks/10_*",
    "Paper 2: spherical stereo": "notebooks/1[1-8]_*",
    "Both papers": "notebooks/19_* notebooks/20_*",
    "Foundations": "notebooks/foundations/*.ipynb",
    "Projects": "notebooks/projects/README.md notebooks/projects/*.ipynb",
    "Reference": "notebooks/GLOSSARY.md RESULTS.md ARCHITECTURE.md",
    "The course": "data/README.md tools/README.md CONTRIBUTING.md CHANGELOG.md CODE_OF_CONDUCT.md",
}
BELOW = {"RESULTS.md": "results-in-detail/*.md", "data/README.md": "data/*/*.md"}

LAST_STEP = re.compile(r"<details>(?:(?!<details>).)*</details>\s*\Z", re.S)
NAVIGATION = re.compile(r"^.*\[all lessons\]\(.*$", re.M)
FIGURE = re.compile(r'(<img alt=.*?>)<p><em>Figure (F?\d+\.\d+)\. (.*?)</em></p>', re.S)
PICTURE = re.compile(r"!\[[^\]]*\]\(([^)\s]+)\)")
EQUATION = re.compile(r"^\$\$(?:(?!\$\$).)*?\\tag\{([^}]+)\}(?:(?!\$\$).)*\$\$", re.M | re.S)
# Words in which nothing may become a link: code, mathematics, links, tags, headings.
PROTECTED = re.compile(
    r"(```.*?```|`[^`\n]+`|\$\$.*?\$\$|\$[^$\n]+\$|!?\[(?:[^\[\]]|\[[^\]]*\])*\]\([^)]*\)|<[^>\n]+>|^#+ .*?$|^    .*?$)",
    re.S | re.M,
)
A_FIGURE = re.compile(r"\b([Ff]igures? )?\b(F?\d+\.\d+)\b")
AN_EQUATION = re.compile(r"\((F?\d+(?:\.\d+)?)\)")
NAMED = re.compile(r"([Ee]quations?|[Ee]qs?\.?)(?: \([\dF.]+\),?| to| and| or)* $")
JOINED = re.compile(r"(?:\b(?:by|in|of|to|with|from|like|and|or|than|through|into|for)|^) $", re.M)
STILL = "<p>Run this cell to move the controls.</p>"
NEEDS_NOTEBOOK = '<p class="needs-notebook">The controls need the notebook: <code>python3 course.py lab</code>.</p>'
QUESTIONS = "Your predictions (run this cell to type them in):"


class Site:
    """Where everything stands: pages, figures, equations, and the functions that compute equations."""

    def __init__(self, repository: str) -> None:
        self.repository = repository
        self.lessons = {place(one.path): one for one in read_assignments()}
        self.markdown = sorted({place(path) for glob in PAGES.split() for path in REPOSITORY.glob(glob)} - LEFT_OUT)
        self.figures: dict[str, str] = {}
        self.equations: dict[str, dict[str, str]] = {}  # page -> equation's number -> its key, such as "1.8"
        self.homes: dict[str, str] = {}
        for page, lesson in self.lessons.items():
            self._find(page, lesson)
        self.functions = functions_of_equations()

    def _find(self, page: str, lesson: Assignment) -> None:
        """Note the figures and equations of one lesson. An equation's home is the first lesson after 00 that shows it."""
        shown = self.equations[page] = {}
        for cell in lesson.stored.cells:
            for output in cell.get("outputs", []):
                for _, number, _ in FIGURE.findall(output.get("data", {}).get("text/html", "")):
                    self.figures[number] = page
            for numbers in EQUATION.findall(cell.source) if cell.cell_type == "markdown" else ():
                for number in numbers.split(", "):
                    shown[number] = key(number, page)
                    if lesson.name != "00":
                        self.homes.setdefault(shown[number], page)

    def resolve(self, page: str):
        """Return the function that says where a link from `page` leads on the site; None for plain words."""

        def where(target: str) -> str | None:
            meant = posixpath.normpath(posixpath.join(posixpath.dirname(page), unquoted(target)))
            meant = f"{meant}/README.md" if f"{meant}/README.md" in self.markdown else meant
            if meant in self.markdown or meant in self.lessons:
                return relative(name_on_site(meant), page)
            if self.repository and (REPOSITORY / meant).exists():
                return f"{self.repository}/{'tree' if (REPOSITORY / meant).is_dir() else 'blob'}/main/{meant}"
            return None

        return where

    def text(self, source: str, page: str) -> str:
        """Return Markdown with its links, and with links where it names figures and equations."""
        parts = PROTECTED.split(student_text(source, self.resolve(page)))
        for index in range(0, len(parts), 2):
            before = "".join(parts[max(0, index - 2) : index])
            parts[index] = self._linked(parts[index], page, before)
        return EQUATION.sub(lambda match: self._anchored(match, page), "".join(parts))

    def _linked(self, text: str, page: str, before: str) -> str:
        def figure(match: re.Match) -> str:
            word, number = match.groups()
            named = word or re.search(r"[Ff]igures (?:F?\d+\.\d+,? (?:and |to )?)+$", text[: match.start()])
            if not named or number not in self.figures:
                return match[0]
            return self._link(match[0], self.figures[number], f"figure-{slug(number)}", page)

        def equation(match: re.Match) -> str:
            number, left = match[1], (before + text)[: len(before) + match.start()][-80:]
            own = number in self.equations.get(page, {})
            if not (NAMED.search(left) or (own and JOINED.search(left))):
                return match[0]
            known = self.equations[page][number] if own else self._key(number, page, left)
            home = page if own else self.homes.get(known)
            return self._link(match[0], home, f"eq-{slug(known)}", page) if home else match[0]

        return A_FIGURE.sub(figure, AN_EQUATION.sub(equation, text))

    def _key(self, number: str, page: str, left: str) -> str:
        """Return the key of an equation that `page` names and does not show; eq. (1) is of the paper that it says."""
        if number == "1" and page not in self.lessons:
            return "2.1" if "paper 2" in left.lower() else "1.1" if "paper 1" in left.lower() else ""
        return key(number, page)

    def _link(self, words: str, to: str, part: str, page: str) -> str:
        address = "" if to == page else relative(str(PurePosixPath(name_on_site(to)).with_suffix(".html")), page)
        return f'<a class="to-number" href="{address}#{part}">{words}</a>'

    def _anchored(self, match: re.Match, page: str) -> str:
        """Return an equation with its anchor, and at its home with the function that computes it."""
        keys = [key(number, page) for number in match[1].split(", ")]
        anchor = "".join(f'<div class="equation" id="eq-{slug(one)}"></div>' for one in keys)
        said = ""
        found = [self.functions[one] for one in keys if one in self.functions and self.homes.get(one) == page]
        for module, name in dict.fromkeys(found):
            address = relative(f"api/{module}.html", page) + f"#course_lib.{module}.{name}"
            said += f' <a href="{address}"><code>{name}</code></a>'
        code = f'\n\n<p class="in-code">In code:{said}</p>\n' if said else ""
        return f"{anchor}\n\n{match[0]}{code}"


def write_source(folder: Path, repository: str = "") -> None:
    """Write all that Sphinx reads into an empty folder. repository: address for links to files that are no page."""
    site = Site(repository)
    shutil.copytree(SETTINGS, folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copytree(
        REPOSITORY / "notebooks" / "scenes", folder / "extra/notebooks/scenes", ignore=shutil.ignore_patterns("yours")
    )
    for page, lesson in site.lessons.items():
        notebook = lesson_page(site, page, lesson)
        write(folder / page, nbformat.writes(notebook) + "\n")
    for page in site.markdown:
        original = (REPOSITORY / page).read_text(encoding="utf-8")
        for picture in PICTURE.findall(original):
            where = posixpath.normpath(posixpath.join(posixpath.dirname(page), picture))
            (folder / where).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(REPOSITORY / where, folder / where)
        text = site.text(original, page)
        text += contents(site) if page == "README.md" else below(site, page)
        write(folder / name_on_site(page), text)
    for module, title in PUBLIC.items():
        write(folder / "api" / f"{module}.rst", api_page(module, title))
    write(folder / "api" / "index.rst", api_index())
    equations = {one: [str(PurePosixPath(home).with_suffix(".html")), f"eq-{slug(one)}"] for one, home in site.homes.items()}
    write(folder / "equations.json", json.dumps({"equations": equations, "repository": repository}))


def lesson_page(site: Site, page: str, lesson: Assignment) -> nbformat.NotebookNode:
    """Return a lesson as the site shows it: without solutions and last hints, its plumbing folded."""
    notebook = unsolved_notebook(lesson)
    cells = []
    for number, cell in enumerate(notebook.cells):
        if cell.cell_type == "markdown":
            text = NAVIGATION.sub("", cell.source).rstrip()
            if tag_of(cell) == "hint" or "<summary>The derivation</summary>" in text:
                text = LAST_STEP.sub("", text).rstrip()
            cell.source = site.text(text, page)
            if number == 0:
                cell.source += (
                    '\n\n<p class="needs-notebook">This page shows a stored run. To change it and run it: '
                    f"<code>python3 course.py lab</code>, then open {lesson.name}.</p>"
                )
            if not cell.source:
                continue
        else:
            shown_as(cell)
        cells.append(cell)
    notebook.cells = cells
    return notebook


def shown_as(cell: nbformat.NotebookNode) -> None:
    """Hide the input of a cell that teaches nothing, and write what it shows as a page needs it."""
    if tag_of(cell) == "check":
        cell.outputs = []
    tags = []
    if re.search(r"^predict\(", cell.source, re.M):
        tags = ["remove-input"]
    elif re.search(r"^recall\(", cell.source, re.M) or only_imports(cell.source):
        tags = ["hide-input"]
    cell.metadata["tags"] = cell.metadata.get("tags", []) + tags
    for output in cell.outputs:
        if "text/html" in output.get("data", {}):
            output.data["text/html"] = shown_html(output.data["text/html"])


def shown_html(text: str) -> str:
    """Return an output with its figure named, its scene loaded when it comes into view, and its still called so."""

    def figure(match: re.Match) -> str:
        image, number, caption = match.groups()
        frame = f'<div class="picture" tabindex="0" role="group" aria-label="Figure {number}">{image}</div>'
        named = f'<a href="#figure-{slug(number)}">Figure {number}.</a> {caption}'
        return f'<figure id="figure-{slug(number)}">{frame}<figcaption>{named}</figcaption></figure>'

    text = FIGURE.sub(figure, text)
    if not text.startswith("<figure"):
        label = "The panel's picture" if STILL in text else "The picture"
        frame = f'<div class="picture" tabindex="0" role="group" aria-label="{html.escape(label)}">'
        text = re.sub(r"<img alt=.*?>", lambda match: frame + match[0] + "</div>", text, flags=re.S)
    text = text.replace("<iframe ", '<iframe loading="lazy" ').replace(STILL, NEEDS_NOTEBOOK)
    return text.replace(QUESTIONS, "Write your predictions down before you read on:")


def only_imports(source: str) -> bool:
    """Return whether a cell only imports."""
    return all(isinstance(node, ast.Import | ast.ImportFrom) for node in ast.parse(source).body)


def contents(site: Site) -> str:
    """Return the table of contents, which the sidebar and the links to the next page are made from."""
    parts = []
    for caption, globs in CONTENTS.items():
        found = [place(path) for glob in globs.split() for path in sorted(REPOSITORY.glob(glob))]
        lines = [f"{short_title(page, site)} <{document(page)}>" for page in found]
        lines += ["API reference <api/index>"] if caption == "Reference" else []
        parts.append("\n".join(["```{toctree}", ":hidden:", f":caption: '{caption}'", "", *lines, "```"]))
    return "\n\n" + "\n\n".join(parts) + "\n"


def below(site: Site, page: str) -> str:
    """Return the table of contents of the pages below one."""
    found = [place(path) for path in sorted(REPOSITORY.glob(BELOW[page]))] if page in BELOW else []
    lines = [f"{short_title(one, site)} </{document(one)}>" for one in found if one != page]
    return "\n".join(["\n\n```{toctree}", ":hidden:", "", *lines, "```\n"]) if lines else ""


def short_title(page: str, site: Site) -> str:
    """Return a page's title up to its colon."""
    title = (
        site.lessons[page].title
        if page in site.lessons
        else (REPOSITORY / page).read_text(encoding="utf-8").splitlines()[0].removeprefix("# ")
    )
    return title.split(":")[0]


def public_names(module: str) -> dict[str, object]:
    """Return what `course_lib.MODULE` offers to its users, by name."""
    found = vars(import_module(f"course_lib.{module}"))
    return {
        name: one
        for name, one in found.items()
        if not name.startswith("_") and getattr(one, "__module__", "").startswith("course_lib.")
    }


def functions_of_equations() -> dict[str, tuple[str, str]]:
    """Return equation ("1.8") -> module of PUBLIC and name of the function whose docstring cites it as its source."""
    found: dict[str, tuple[str, str]] = {}
    for module in PUBLIC:
        for name, one in public_names(module).items():
            parts = inspect.getmembers(one, inspect.isfunction) if inspect.isclass(one) else [("", one)]
            for part, function in parts:
                for paper, numbers in re.findall(
                    r"Source:\s+paper (\d),\s+eqs?\.?\s+([(\d), ]+)", getattr(function, "__doc__", "") or ""
                ):
                    for number in re.findall(r"\d+", numbers):
                        found.setdefault(f"{paper}.{number}", (module, f"{name}.{part}" if part else name))
    return found


def api_page(module: str, title: str) -> str:
    """Return a page of all public names of a module, functions and classes first, then errors."""
    kinds: dict[str, list[str]] = {"Classes": [], "Functions": [], "Errors and warnings": []}
    for name, one in sorted(public_names(module).items()):
        if inspect.isclass(one) and issubclass(one, Exception):
            kinds["Errors and warnings"].append(f".. autoexception:: course_lib.{module}.{name}\n")
        elif inspect.isclass(one):
            kinds["Classes"].append(f".. autoclass:: course_lib.{module}.{name}\n   :members:\n")
        elif inspect.isroutine(one) or callable(one):
            kinds["Functions"].append(f".. autofunction:: course_lib.{module}.{name}\n")
    lines = [heading(title, "="), f".. automodule:: course_lib.{module}\n"]
    for kind, directives in kinds.items():
        lines += [heading(kind, "-"), *directives] if directives else []
    return "\n".join(lines)


def api_index() -> str:
    """Return the page that leads to those of the modules."""
    words = "The names that lessons and your own programs import. Units are metres and radians, and z is up.\n"
    pages = [f"   {title} <{module}>" for module, title in PUBLIC.items()]
    return "\n".join([heading("API reference", "="), words, ".. toctree::", "   :maxdepth: 3", "", *pages, ""])


def heading(title: str, line: str) -> str:
    return f"{title}\n{line * len(title)}\n"


def place(path: Path) -> str:
    """Return a file's path in the repository."""
    return path.relative_to(REPOSITORY).as_posix()


def name_on_site(page: str) -> str:
    """Return the path of a page's source on the site."""
    return re.sub(r"README\.md$", "index.md", page)


def document(page: str) -> str:
    return str(PurePosixPath(name_on_site(page)).with_suffix(""))


def relative(path: str, page: str) -> str:
    return posixpath.relpath(path, posixpath.dirname(page) or ".")


def unquoted(target: str) -> str:
    return target.replace("%20", " ")


def key(number: str, page: str) -> str:
    """Return an equation's name in the whole course: "1.8" for paper 1's (8); the course's own keep their number."""
    if "." in number:
        return f"own.{number}"
    return f"{2 if re.match(r'notebooks/1[1-8]_|notebooks/projects/P2', page) else 1}.{number}"


def slug(number: str) -> str:
    return number.lower().replace(".", "-")


def write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
