"""Build the course's web site from the stored lessons: `python3 tools/site.py`.

The pages hold no solution and no last hint. They load nothing from another server. Any Python from 3.11 can start this
program: it makes the course's `.venv` if it is missing, and goes on there.
"""

import argparse
import html
import os
import re
import subprocess
import sys
import time
from pathlib import Path
from urllib.parse import unquote, urljoin

ROOT = Path(__file__).resolve().parents[1]

LOCK = ROOT / "environment-site.txt"
PACKAGES = ROOT / ".site"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `site`."""
    what = "where the pages go (default: results/site); an older site there is replaced"
    parser.add_argument("--out", type=Path, default=ROOT / "results" / "site", metavar="FOLDER", help=what)
    what = "address of the repository: links to its files lead there; without it they become plain words"
    parser.add_argument("--repository", default="", metavar="ADDRESS", help=what)


def run(arguments: argparse.Namespace) -> int:
    """Install the site's packages if they are missing, build the pages, and check every link."""
    from course_lib.files import staging_dir, temporary_folder
    from courseware.commands.arguments import require_output_folder
    from tools.bench import install_beside
    from tools.site_pages import write_source

    out, started = arguments.out, time.monotonic()
    require_output_folder(out)
    earlier = [path.name for path in out.iterdir()] if out.exists() else []
    if earlier and "searchindex.js" not in earlier:
        raise ValueError(f"--out {out} holds files that are not a site. Name an empty folder or an earlier site.")
    if arguments.repository and not re.match(r"https?://", arguments.repository):
        raise ValueError(f"--repository must be an address that starts with https://; got {arguments.repository!r}")
    if why := install_beside(LOCK, PACKAGES):
        raise RuntimeError(f"the site's packages could not be installed: {why}")
    with temporary_folder() as source, staging_dir(out, earlier) as pages:
        write_source(source, arguments.repository.rstrip("/"))
        build(source, pages)
        links, broken = check_links(pages)
        if broken:
            raise RuntimeError("these links lead nowhere: " + "; ".join(broken[:20]))
        n_pages = len(list(pages.rglob("*.html")))
        megabytes = sum(path.stat().st_size for path in pages.rglob("*") if path.is_file()) / 1e6
    seconds = time.monotonic() - started
    print(f"{n_pages} pages, {links} links, {megabytes:.0f} MB, {seconds:.0f} s. Open {out / 'index.html'}")
    return 0


def build(source: Path, pages: Path) -> None:
    """Let Sphinx make HTML in the folder `pages`. Raises `RuntimeError` with what it said for every warning."""
    command = [sys.executable, "-P", "-m", "sphinx", "-b", "html", "-q", "-n", "-W", "--keep-going", "-j", "auto"]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(ROOT), str(PACKAGES)]), "PYTHONWARNINGS": "ignore"}
    with_trees = [*command, "-d", str(source / ".doctrees"), str(source), str(pages)]
    done = subprocess.run(with_trees, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"Sphinx ended with code {done.returncode}:\n{done.stderr[-6000:]}")
    for template in pages.glob("_static/*macros.html"):  # the theme's own, not a page
        template.unlink()
    (pages / ".nojekyll").touch()  # else GitHub's pages would leave out folders such as _static


def check_links(pages: Path) -> tuple[int, list[str]]:
    """Return the number of links within a site, and each one that leads to no file or to no part of its page."""
    texts = {path.relative_to(pages).as_posix(): path.read_text("utf-8") for path in sorted(pages.rglob("*.html"))}
    texts = {page: re.sub(r"(?s)<script.*?</script>", "", text) for page, text in texts.items()}
    parts = {page: {"", *re.findall(r'\s(?:id|name)="([^"]+)"', text)} for page, text in texts.items()}
    links, broken = 0, []
    for page, text in texts.items():
        for target in re.findall(r'\s(?:href|src)="([^"]+)"', text):
            file, _, part = unquote(urljoin(f"http://site/{page}", html.unescape(target))).partition("#")
            if not file.startswith("http://site/"):  # another server's, or a picture in the page
                continue
            links, file = links + 1, file.removeprefix("http://site/").partition("?")[0]
            if not (pages / file).is_file() or part not in parts.get(file, {part}):
                broken.append(f"{page} -> {target}")
    return links, broken


def start() -> int:
    """Hand over to the environment's Python, which is made first if this is the system's Python."""
    sys.path[0] = str(ROOT)  # instead of tools/
    import course

    python = sys.executable
    try:
        if sys.prefix == sys.base_prefix:
            if course.why_not_ready():
                course.set_up()
            python = course.PYTHON
    except course.SetupError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    environment = course.clean_environment() | {"PYTHONPATH": str(ROOT)}
    return subprocess.call([python, "-P", "-m", "tools.site", *sys.argv[1:]], env=environment)


if __name__ == "__main__":
    if not __package__:
        sys.exit(start())
    from courseware.cli import tool

    sys.exit(tool("tools.site"))
