"""The flow charts of notebooks/README.md: they are those of its table, and their boxes lead to lessons."""

import re

import pytest

from tools.flow_charts import CHARTS, NOTEBOOKS, chart, steps


@pytest.mark.parametrize(("column", "name"), list(enumerate(CHARTS)))
def test_a_stored_chart_has_the_steps_of_the_table_and_its_boxes_lead_to_lessons(column, name):
    stored = (NOTEBOOKS / "pictures" / f"{name}.svg").read_text(encoding="utf-8")
    title, back_to = CHARTS[name]
    assert stored == chart(title, steps(column), back_to), "run python -m tools.flow_charts"
    links = re.findall(r'<a href="\.\./([^"]+)"', stored)
    assert len(links) == 6
    assert all((NOTEBOOKS / link).is_file() for link in links)
