"""A live figure shows what a figure drawn anew would show."""

from courseware.lessons.kit.live_figure import LiveFigure
from tests.lessons.kit.test_display import finished_figure


def test_a_live_figure_shows_new_data_like_a_fresh_one():
    def made(data):
        figure, axes = finished_figure()
        (line,) = axes.plot([0, 1], data)
        return LiveFigure(figure, [line]), line

    live, line = made([0.2, 0.4])
    before = live.png()
    line.set_ydata([0.9, 0.1])
    assert before != live.png() == made([0.9, 0.1])[0].png()
    line.set_ydata([0.2, 0.4])
    assert live.png() == before
