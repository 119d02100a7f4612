"""What axe-core finds that is serious inside the lessons' outputs.

axe-core (https://github.com/dequelabs/axe-core) comes as one script inside the package axe-playwright-python; it is put
into the page as text, so that nothing is loaded from anywhere.
"""

from __future__ import annotations

import pytest

OUTPUTS = ".jp-OutputArea-output"
RUN = """where => axe.run({include: [[where]]}, {resultTypes: ['violations']}).then(result => result.violations.flatMap(
    rule => rule.nodes.map(node => [rule.id, rule.impact, node.target.flat().join(' '), node.html.slice(0, 300)])))"""


def serious_findings(page) -> list[list[str]]:
    """Serious and critical findings inside the outputs: rule, impact, CSS selector of the element, its HTML."""
    base = pytest.importorskip("axe_playwright_python.base")
    page.evaluate(base.AXE_SCRIPT)
    assert page.locator(OUTPUTS).count() > 0
    return [found for found in page.evaluate(RUN, OUTPUTS) if found[1] in ("serious", "critical")]
