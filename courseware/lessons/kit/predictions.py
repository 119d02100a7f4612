"""Ask for predictions at the start of a lesson, and print them beside the measured results at its end.

`predict("06", "How much more does it count?", ...)` shows a text box for each question. At the end of the lesson,
`recall("06", "2.0 times", ...)` prints each question, the student's prediction and the measured answer. Predictions are
kept in the student's record (`student_record`). Without a record, the boxes work, but nothing is kept.
"""

import html

import ipywidgets as widgets
from IPython.display import display

from courseware.lessons.kit.panel import VIEW
from courseware.lessons.kit.show_progress import update_page
from courseware.lessons.kit.student_record import RecordError, read_record, record_folder, record_prediction

_ASKED: dict[str, tuple[str, ...]] = {}  # lesson -> the questions that this kernel has shown; `recall` repeats them
FORGOTTEN = "Noted, but not kept: `python3 course.py lab` keeps predictions in the folder work/."


class Predictions:
    """One text box for each question. A prediction is kept when the student leaves its box.

    lesson: "06". questions: a few words each, in the order of the numbered list in the lesson's text. Raises
    `ValueError` for no question or an empty one.
    """

    def __init__(self, lesson: str, questions: tuple[str, ...]) -> None:
        if not questions or not all(question.strip() for question in questions):
            raise ValueError(f"predict({lesson!r}, ...) needs a question in words for each box; got {questions!r}")
        self.lesson, self.questions = lesson, questions
        kept, said = _kept(lesson)
        self.boxes = [self._box(number, question, kept) for number, question in enumerate(questions, start=1)]
        self._state = widgets.HTML()
        self._state.add_class("course-numbers")  # the lab's extension reads this class's text aloud
        self._say(said)
        self.view = widgets.VBox([*self.boxes, self._state])

    def _box(self, number: int, question: str, kept: dict[str, str]) -> widgets.Textarea:
        box = widgets.Textarea(
            value=kept.get(str(number), ""),
            description=f"{number}. {question}",
            placeholder="your prediction, and why",
            continuous_update=False,
            rows=2,
            tooltip=question,
            layout=widgets.Layout(width="98%", max_width="56em", flex_flow="column"),
            style={"description_width": "auto"},
        )
        box.observe(lambda change: self._keep(number, change["new"]), names="value")
        return box

    def _keep(self, number: int, text: str) -> None:
        """Keep the prediction for one question, and say so under the boxes."""
        try:
            said = FORGOTTEN
            if record_folder() is not None:
                said = f"{record_prediction(self.lesson, number, text)} Prediction {number} is kept.".strip()
        except OSError as error:
            said = f"Prediction {number} could not be kept: {error}"
        update_page()
        self._say(said)

    def _say(self, text: str) -> None:
        self._state.value = f'<p role="status">{html.escape(text)}</p>'

    def _repr_mimebundle_(self, include=None, exclude=None) -> dict:
        rows = "".join(f"<li>{html.escape(question)}</li>" for question in self.questions)
        still = f"<p>Your predictions (run this cell to type them in):</p><ol>{rows}</ol>"
        views = {kind: view for kind, view in self.view._repr_mimebundle_().items() if kind == VIEW}
        return {"text/plain": repr(self), "text/html": still, **views}

    def __repr__(self) -> str:
        return f"Predictions of lesson {self.lesson}: {len(self.questions)} questions"


def predict(lesson: str, *questions: str) -> None:
    """Display a text box for each question. It holds the student's earlier prediction, if there is one."""
    _ASKED[lesson] = questions
    display(Predictions(lesson, questions))


def recall(lesson: str, *measured: str) -> None:
    """Print each question of `predict`, the prediction (if a record is kept), and the `measured` answer.

    If the cell with `predict` did not run, only the questions' numbers are known. Raises `ValueError` if the number of
    answers differs from the number of questions.
    """
    questions = _ASKED.get(lesson, [f"Prediction {number}" for number, _ in enumerate(measured, start=1)])
    if len(questions) != len(measured):
        raise ValueError(
            f"recall({lesson!r}, ...) got {len(measured)} measured answers for {len(questions)} predictions: give one "
            "answer for each question of predict(...)"
        )
    kept, said = _kept(lesson)
    for number, (question, answer) in enumerate(zip(questions, measured, strict=True), start=1):
        print(f"{number}. {question}")
        if record_folder() is not None:
            typed = " ".join(kept.get(str(number), "").split())
            print(f"   you said: {typed or '(nothing yet: type it in under Predict)'}")
        print(f"   measured: {answer}")
    if said:
        print(said)


def _kept(lesson: str) -> tuple[dict[str, str], str]:
    """Return the kept predictions by number, and a sentence if they cannot be read."""
    try:
        return read_record(lesson)["predictions"], ""
    except (RecordError, OSError) as error:
        return {}, str(error)
