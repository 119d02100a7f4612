"""Sphinx's settings of the course's site. tools/site_pages.py writes the pages beside this file."""

import json
import re
import shutil
from importlib.util import find_spec
from pathlib import Path

from docutils.nodes import Text, reference

HERE = Path(__file__).parent
SITE = json.loads((HERE / "site.json").read_text(encoding="utf-8"))

project = html_title = "Indoor localization by doing it"
author = copyright = ""
extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.mathjax"]
extensions += ["sphinx_codeautolink", "sphinx_copybutton"]
root_doc = "index"
exclude_patterns = [".doctrees", "extra", "contents.txt"]

highlight_language = "none"
nb_execution_mode = "off"
nb_code_prompt_show, nb_code_prompt_hide = "Show the code", "Hide the code"
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
myst_dmath_double_inline = True

autodoc_typehints = "signature"
autodoc_member_order = "bysource"
add_module_names = False
toc_object_entries_show_parents = "hide"
autodoc_preserve_defaults = True
napoleon_google_docstring = False
python_use_unqualified_type_names = True
nitpick_ignore_regex = [(r"py:.*", r".*")]  # types of other libraries, whose pages no link may need

html_theme = "sphinx_book_theme"
html_theme_options = {
    "use_download_button": False,
    "use_fullscreen_button": False,
    "show_toc_level": 2,
    "show_navbar_depth": 1,
    "navbar_persistent": [],  # the sidebar has the search
    "pygments_light_style": "a11y-high-contrast-light",
    "pygments_dark_style": "a11y-high-contrast-dark",
}
if SITE["repository"]:
    html_theme_options |= {"repository_url": SITE["repository"], "use_repository_button": True}
html_static_path = ["_static"]
html_css_files = ["course.css"]
html_js_files = ["course.js"]
html_favicon = "_static/favicon.svg"
html_extra_path = ["extra"]
html_context = {"default_mode": "auto"}
html_use_index = html_domain_indices = False
html_copy_source = False
html_show_copyright = html_show_sphinx = False

mathjax_path = "mathjax/tex-chtml-full.js"
mathjax3_config = {"chtml": {"scale": 0.95}, "options": {"enableMenu": False}}
for part in ("tex-chtml-full.js", "output/chtml/fonts/woff-v2"):
    package = Path(find_spec("sphinx-mathjax-offline").origin).parent / "static" / "mathjax" / part
    copied = HERE / "_static" / "mathjax" / part
    copied.parent.mkdir(parents=True, exist_ok=True)
    shutil.copytree(package, copied, dirs_exist_ok=True) if package.is_dir() else shutil.copyfile(package, copied)


codeautolink_concat_default = True


def as_rst(app, what, name, thing, options, lines):
    """Write a compact docstring as reStructuredText: indented equations, names in backticks, what it cites as links."""
    written, literal, in_sections, directive = [], False, False, None
    for line in lines:
        indentation = len(line) - len(line.lstrip())
        if directive is not None and line.strip() and indentation <= directive:
            directive = None
        if line.lstrip().startswith(".. "):
            directive = indentation
        if directive is not None:  # such as ".. math::"
            written.append(line)
            continue
        in_sections = in_sections or re.fullmatch(r"-{3,}", line) is not None
        in_table = re.match(r"[\w/*]+ {2,}\S", line) is not None
        indented = (line.startswith("    ") or in_table) and not in_sections
        if indented and not literal:
            written += ["", ".. code-block:: none", ""]
        elif literal and not indented and line.strip():
            written.append("")
        literal = indented or (literal and not line.strip())
        if re.match(r"(Source|Raises|Warns)\b", line) and not in_sections:
            written.append("")  # a paragraph of its own
        written.append("    " * in_table + line if literal else safe(line))
    lines[:] = written


def safe(line):
    """Return a line in which stars, bars and final underscores are themselves, with links to the equations it cites."""
    parts = re.split(r"(:\w+:`[^`]*`|``.*?``|`[^`]*`)", line)
    parts[::2] = [re.sub(r"\*(?![a-z ]+\*)(?<![a-z]\*)|\||(?<=\w)_(?!\w)", r"\\\g<0>", part) for part in parts[::2]]
    parts[1::2] = [part if part.startswith(":") else f"``{part.strip('`')}``" for part in parts[1::2]]
    line = "".join(parts)
    cited = re.search(r"Source:\s+paper (\d),\s+eqs?\.?\s", line)

    def link(found):
        page, part = SITE["equations"][f"{cited[1]}.{found[1]}"]
        return f"`({found[1]}) <../{page}#{part}>`__"

    return line[: cited.end()] + re.sub(r"\((\d+)\)", link, line[cited.end() :]) if cited else line


def only_ours(app, what, name, thing, skip, options):
    """Leave out what a module imports from other libraries, and fields that only have a number."""
    other = what == "module" and not getattr(thing, "__module__", "course_lib").startswith("course_lib")
    return skip or other or str(thing.__doc__).startswith("Alias for field number")


def shorten_titles(app, env):
    """In the sidebar, a title ends at its colon."""
    entries = [next(iter(contents.findall(reference)), None) for contents in env.tocs.values()]
    for title in [*env.titles.values(), *filter(None, entries)]:
        title.children = [Text(title.astext().split(":")[0])]


def setup(app):
    app.connect("autodoc-process-docstring", as_rst, priority=100)  # before napoleon reads the sections
    app.connect("autodoc-skip-member", only_ours)
    app.connect("env-updated", shorten_titles)
