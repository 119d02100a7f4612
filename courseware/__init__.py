"""What surrounds the two methods: lessons, commands, experiments, and a teacher's tools.

cli, commands            `python -m courseware`, normally reached through `python3 course.py`
answers                  closed: solutions, inputs, known mistakes, the projects' hidden seeds and rivals
classroom                handing out and grading
lessons                  what only the notebooks use: a folder for each lesson, and kit/, which they share
plots                    figures that commands and lessons share
experiments              both papers' tables, as functions of a seed
simulation               the places that data/ was made from
run_folder               where a command keeps its results
working_copies           a student's own copies of the lessons
paths                    where the data and the lessons lie

A package imports only packages below it, and all of them may import `course_lib`, which never imports this one.
"""

from pathlib import Path

PACKED = "answers.pyz"
"""In a student's copy this zip archive holds `answers`, so that nobody meets a solution while opening files."""

__path__.append(str(Path(__file__).with_name(PACKED)))
