"""Names in letters that a font lacks are drawn in another font, or as numbers that one warning tells."""

import warnings

import numpy as np
import pytest
from matplotlib import font_manager

from course_lib.plots import letters
from course_lib.plots.figures import new_figure
from course_lib.plots.letters import font_with


def figure_with(*words):
    figure, axes = new_figure(size=(3, 2))
    axes.set_title(f"σ of {words[0]}")
    for number, word in enumerate(words):
        axes.plot([0, 1], [number, number], label=word)
    axes.legend(prop={"family": "monospace"})
    return figure, axes


@pytest.fixture
def no_such_font(monkeypatch):
    monkeypatch.setattr(letters, "font_with", lambda letters: None)


def test_without_a_font_a_number_stands_for_each_word_and_one_warning_tells_them(no_such_font, tmp_path):
    figure, axes = figure_with("椅子", "机 2", "椅子")
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        figure.savefig(tmp_path / "a.png")
    (warning,) = told
    assert "[1] 机, [2] 椅子." in str(warning.message)
    assert axes.get_title(loc="left") + axes.get_title() == "σ of [2]"
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["[2]", "[1] 2", "[2]"]


def test_words_that_the_font_has_stay_and_nothing_is_told(no_such_font, tmp_path):
    figure, axes = figure_with("Stühle, σ ≤ 3°", "стол")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        figure.savefig(tmp_path / "a.png")
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["Stühle, σ ≤ 3°", "стол"]


def test_a_font_of_the_machine_that_has_the_letters_is_taken(monkeypatch, tmp_path):
    """DejaVu Sans stands for a Japanese font: it has the double-struck letters that its monospaced sister lacks."""
    figure, axes = figure_with("𝔸 𝔹")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        figure.savefig(tmp_path / "a.png")
    (text,) = axes.get_legend().get_texts()
    assert text.get_text() == "𝔸 𝔹"
    assert text.get_fontfamily() == ["monospace", font_with(frozenset("𝔸𝔹"))]


def test_a_font_with_a_box_for_every_letter_is_none(caplog):
    assert any("Last Resort" in one.name for one in font_manager.fontManager.ttflist)
    assert font_with(frozenset("\U000e0fff")) is None  # of no script
    assert "Last Resort" not in str(font_with(frozenset("椅子")))


def test_a_font_file_that_is_gone_is_passed_over(monkeypatch):
    entry = font_manager.FontEntry(fname="/nowhere/a.ttf", name="A gone font")
    monkeypatch.setattr(font_manager.fontManager, "ttflist", [entry, *font_manager.fontManager.ttflist])
    font_with.cache_clear()
    assert font_with(frozenset("é")) not in (None, "A gone font")


def test_a_scene_gets_labels_that_it_can_draw_and_one_warning_tells_the_others():
    from course_lib.plots.scenes import text

    with pytest.warns(UserWarning, match=r"\[1\] 机, \[2\] 椅子$") as told:
        plain = letters.plain_labels(["椅子", "chair", "café", "机", "椅子"])
    assert len(told) == 1
    assert plain == {"椅子": "[2]", "机": "[1]", "chair": "chair", "café": "cafe"}
    assert all(text(drawn, np.zeros(3)).n_points for drawn in plain.values())
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert letters.plain_labels(["chair"]) == {"chair": "chair"}


def test_figures_without_such_words_are_drawn_as_before(monkeypatch):
    def drawn():
        figure, _ = figure_with("é")
        figure.canvas.draw()
        return np.asarray(figure.canvas.buffer_rgba())

    ours = drawn()
    monkeypatch.setattr(letters, "make_readable", lambda figure: None)
    np.testing.assert_array_equal(ours, drawn())
