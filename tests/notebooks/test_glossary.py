"""The glossary: its terms are in place, its lessons exist, and what links to it finds its term."""

from __future__ import annotations

import re

import pytest

from course_lib.paths import REPOSITORY, notebook_paths

TEXT = (REPOSITORY / "notebooks" / "GLOSSARY.md").read_text(encoding="utf-8")
ENTRIES = dict(re.findall(r"^### (.+)\n((?:.+\n?)+)", TEXT, re.M))
# GitHub and JupyterLab both make a heading's anchor of it: lower case already, spaces become dashes.
ANCHORS = {term.replace(" ", "-") for term in ENTRIES}


def test_terms_are_written_as_their_anchors():
    assert len(ENTRIES) >= 50
    assert [term for term in ENTRIES if not re.fullmatch(r"[a-z0-9 -]+", term)] == []


@pytest.mark.parametrize("term", ENTRIES)
def test_an_entry_is_short_and_names_a_lesson_that_exists(term):
    assert len(ENTRIES[term].split()) <= 60
    named = {number for group in re.findall(r"Lessons? ([\d and to,]+)\.", ENTRIES[term]) for number in group.split()}
    numbers = {word for word in named if word.isdigit()}
    assert numbers
    assert numbers <= {path.name[:2] for path in notebook_paths()}


def test_every_link_to_the_glossary_finds_its_term(lesson):
    assert set(re.findall(r"GLOSSARY\.md#([^)\s]+)\)", lesson.markdown)) <= ANCHORS
