"""What axe-core finds that is serious inside the lessons' outputs, but for what JupyterLab and ipywidgets do there.

axe-core (https://github.com/dequelabs/axe-core) comes as one script inside the package axe-playwright-python; it is put
into the page as text, so that nothing is loaded from anywhere.
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path

import pytest

OUTPUTS = ".jp-OutputArea-output"
SERIOUS = ("serious", "critical")
ALLOWED = Path(__file__).with_name("allowed_findings.toml")
RUN = """where => axe.run({include: [[where]]}, {resultTypes: ['violations']}).then(result => result.violations.flatMap(
    rule => rule.nodes.map(node => [rule.id, rule.impact, node.target.flat().join(' '), node.html.slice(0, 300)])))"""


@dataclass(frozen=True)
class Finding:
    """One element that breaks one of axe-core's rules: rule, impact, CSS selector of the element, its HTML."""

    rule: str
    impact: str
    target: str
    html: str


def findings(page) -> list[Finding]:
    """All that axe-core finds inside the outputs of the page."""
    base = pytest.importorskip("axe_playwright_python.base")
    page.evaluate(base.AXE_SCRIPT)
    assert page.locator(OUTPUTS).count() > 0
    return [Finding(*found) for found in page.evaluate(RUN, OUTPUTS)]


def allowed() -> list[dict]:
    """Entries of the committed list: a rule, a piece of the element's HTML, and the reason."""
    return tomllib.loads(ALLOWED.read_text(encoding="utf-8")).get("allowed", [])


def serious_findings(page) -> list[Finding]:
    """Serious and critical findings inside the outputs that the committed list does not excuse."""
    excused = [(entry["rule"], entry["html"]) for entry in allowed()]
    return [
        found
        for found in findings(page)
        if found.impact in SERIOUS and not any(found.rule == rule and piece in found.html for rule, piece in excused)
    ]
