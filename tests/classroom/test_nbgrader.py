"""nbgrader's own generate, autograde and feedback: the judge gives the points, whatever a student's notebook says."""

import json
import sqlite3
import warnings

import pytest

from courseware.classroom.handout import canary_of
from courseware.classroom.leaks import find_leaks, solutions, teachers_words
from courseware.classroom.nbgrader_course import write_course
from courseware.classroom.student_copies import write
from tests.classroom.handed_in import assignment_of, handed_in, mistaken, solved

SEED = 31_415_926_535
FORGED = """import IPython, sys
{stub}
class Sixteen(float): pass
points = earned = lambda *given: 16
sys.displayhook = lambda value: print(16)
IPython.get_ipython().display_formatter.format = lambda *given: ({{"text/plain": "16"}}, {{}})
print(16)
"""


@pytest.fixture(scope="module")
def course(library, tmp_path_factory):
    folder = tmp_path_factory.mktemp("handout")
    write_course(folder / "nbgrader", [assignment_of("06")], canary_of(SEED))
    write(folder / "grading" / "seed.json", json.dumps({"seed": SEED}))
    return folder / "nbgrader"


def nbgrader_api(course):
    from nbgrader.apps.api import NbGraderAPI
    from nbgrader.coursedir import CourseDirectory
    from traitlets.config.loader import PyFileConfigLoader

    warnings.filterwarnings("ignore", module="nbgrader")  # its database's, about itself
    config = PyFileConfigLoader("nbgrader_config.py", path=str(course)).load_config()
    return NbGraderAPI(CourseDirectory(config=config), config=config)


@pytest.mark.slow
def test_five_students_through_nbgraders_own_steps(course):
    api, right = nbgrader_api(course), solved("06")
    made = api.generate_assignment("06")
    assert made["success"], made
    words = teachers_words(SEED, canary_of(SEED)) | solutions([assignment_of("06")])
    assert find_leaks(course / "release", words) == []
    odd = right | {"06.1": f"%%time\ntable = {{}}\ntable.update(one=1)\n{right['06.1']}"}
    students = {
        "solved": right, "untouched": {}, "odd": odd, "forger": dict.fromkeys(right, FORGED),
        "mistaken": right | {"06.2": mistaken("06.2")},
    }  # fmt: skip
    for student, answers in students.items():
        handed_in(
            course / "submitted" / student / "06" / "06.ipynb", "06", answers, course / "release" / "06" / "06.ipynb"
        )
        for step in (api.autograde, api.generate_feedback):
            done = step("06", student)
            assert done["success"], done
    with sqlite3.connect(course / "gradebook.db") as book:
        scores = dict(book.execute(
            "select student_id, sum(coalesce(manual_score, auto_score, 0)) from submitted_assignment s join "
            "submitted_notebook n on n.assignment_id = s.id join grade g on g.notebook_id = n.id group by student_id"
        ))  # fmt: skip
    assert scores == {"solved": 16, "untouched": 0, "odd": 16, "forger": 0, "mistaken": 12}
    feedback = (course / "feedback" / "mistaken" / "06" / "06.html").read_text(encoding="utf-8")
    assert "06.2: " in feedback
    assert find_leaks(course / "feedback", teachers_words(SEED, canary_of(SEED))) == []
