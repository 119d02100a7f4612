"""The web site: what may not be in it, its links, and every page in a browser that reaches no other server."""

import functools
import http.server
import re
import threading

import nbformat
import pytest

from courseware.classroom.assignment_cells import read_assignments, tag_of
from courseware.classroom.leaks import find_leaks, plain, solutions, text_of
from courseware.cli import call
from tests.notebooks.driven_lab import require_chromium, serious_findings
from tools import bench, site, site_pages

MATHEMATICS_IS_SET = "() => typeof MathJax === 'undefined' || MathJax.startup?.promise?.then(() => true)"
OVERHANG = "() => document.documentElement.scrollWidth - document.documentElement.clientWidth"
# What scrolls sideways and cannot be reached by Tab.
NOT_REACHED = """() => [...document.querySelectorAll("main *")].filter(one => one.scrollWidth > one.clientWidth + 1
    && ["auto", "scroll"].includes(getComputedStyle(one).overflowX) && one.tabIndex < 0
    && !one.querySelector("a, button, input, [tabindex='0']")).map(one => one.outerHTML.slice(0, 200))"""
PHONE, DESK = {"width": 390, "height": 844}, {"width": 1400, "height": 1000}


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    """What Sphinx gets to read."""
    folder = tmp_path_factory.mktemp("source")
    site_pages.write_source(folder)
    return folder


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    """The whole site, built once."""
    if why := bench.install_beside(site.LOCK, site.PACKAGES):
        pytest.skip(f"the site's packages are not here and could not be installed: {why}")
    out = tmp_path_factory.mktemp("site") / "pages"
    assert call(lambda: site, "site", ["--out", str(out)]) == 0
    return out


@pytest.fixture(scope="module")
def address(pages):
    """The site on a server of this computer."""

    class Quiet(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *_):
            pass

    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=str(pages))) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}/"
        server.shutdown()


@pytest.fixture(scope="module")
def browser():
    playwright = pytest.importorskip("playwright.sync_api")
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=require_chromium(), args=["--no-sandbox"])
        yield browser
        browser.close()


def last_steps():
    """The last hint, or the derivation, of every exercise of the course, with its number."""
    for assignment in read_assignments():
        for exercise in assignment.exercises():
            step = re.findall(r"</summary>(.*?)</details>", exercise.hints, re.S)[-1]
            yield exercise.number, plain(step)


def test_no_solution_and_no_last_hint_is_in_the_sources_of_the_pages(source):
    assert find_leaks(source, solutions(read_assignments())) == []
    text = "\n".join(text_of(path) for path in sorted(source.glob("notebooks/**/*.ipynb")))
    assert [number for number, step in last_steps() if step in text] == []
    tags = [tag_of(cell) for path in source.glob("notebooks/**/*.ipynb") for cell in nbformat.read(path, 4).cells]
    assert "solution" not in tags
    assert tags.count("exercise") > 100


def test_figures_and_equations_that_a_page_names_are_links_to_where_they_stand(source):
    lesson = (source / "notebooks/06_likelihood_and_weights.ipynb").read_text(encoding="utf-8")
    assert lesson.count('id=\\"figure-6.1\\"') == 1
    assert '<a class=\\"to-number\\" href=\\"#figure-6.1\\">Figure 6.1</a>' in lesson
    assert 'By <a class=\\"to-number\\" href=\\"#eq-1.9\\">(9)</a>' in lesson or "eq-1.9" in lesson
    assert 'href=\\"05_particles_and_motion.html#eq-1.5\\">(5)</a>' in lesson
    assert 'href=\\"../api/depth_mcl.html#course_lib.depth_mcl.likelihood\\"' in lesson


def test_a_link_to_no_page_and_one_to_no_part_of_a_page_are_found(tmp_path):
    (tmp_path / "a.html").write_text('<p id="here"><a href="b.html#there">b</a> <a href="#here">here</a>')
    (tmp_path / "b.html").write_text('<a href="c.html">c</a> <a href="a.html#here">a</a> <a href="https://else">e</a>')
    assert site.check_links(tmp_path) == (4, ["a.html -> b.html#there", "b.html -> c.html"])


def test_a_folder_that_is_no_site_stays_and_an_address_that_is_none_is_named(tmp_path, run_tool, capsys):
    (tmp_path / "thesis.txt").write_text("mine")
    assert run_tool("site", "--out", tmp_path) == 2
    assert "not a site" in capsys.readouterr().err
    assert run_tool("site", "--out", tmp_path / "new", "--repository", "here") == 2
    assert "--repository must be" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.txt"]


@pytest.mark.release
@pytest.mark.slow
def test_every_page_opens_with_the_network_blocked_fits_a_phone_and_has_no_serious_finding(pages, address, browser):
    assert find_leaks(pages, solutions(read_assignments())) == []
    assert sum(path.stat().st_size for path in pages.rglob("*") if path.is_file()) < 60e6
    page, faults, elsewhere = browser.new_page(), [], []
    page.on("console", lambda message: faults.append(message.text) if message.type == "error" else None)
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.on("response", lambda answer: faults.append(answer.url) if answer.status >= 400 else None)
    page.route(lambda url: not url.startswith((address, "data:", "blob:")), lambda route: stopped(route, elsewhere))
    names = [path.relative_to(pages).as_posix() for path in sorted(pages.rglob("*.html"))]
    found = {}
    for name in names:
        if "scenes/" in name:  # opened as parts of their pages, and by tests/notebooks/test_scene_pages.py
            continue
        page.set_viewport_size(DESK)
        page.goto(address + name)
        page.wait_for_function(MATHEMATICS_IS_SET)
        if told := serious_findings(page, "body") or page.locator("mjx-merror").all_inner_texts():
            found[name] = told
        page.set_viewport_size(PHONE)
        page.goto(address + name)
        page.wait_for_function(MATHEMATICS_IS_SET)
        if page.evaluate(OVERHANG) > 0 or page.evaluate(NOT_REACHED):
            found[name, "phone"] = page.evaluate(OVERHANG), page.evaluate(NOT_REACHED)
    assert (found, faults, elsewhere) == ({}, [], [])


def stopped(route, elsewhere):
    elsewhere.append(route.request.url)
    route.abort()


@pytest.mark.release
@pytest.mark.slow
def test_the_search_finds_a_lesson_by_an_english_and_by_a_japanese_word(address, browser):
    for word in ("resampling", "尤度"):
        page = browser.new_page()
        page.goto(f"{address}search.html?q={word}")
        page.locator("#search-results li a").first.wait_for()
        assert page.locator("#search-results li a[href*='notebooks/']").count() > 0
        page.close()
