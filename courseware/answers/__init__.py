"""Closed: solutions, inputs and known mistakes of all exercises; the projects' hidden seeds and rivals.

A lesson is two files. `lesson_06.py` is its mathematics: the solutions, their inputs and special cases.
`lesson_06.hints` is plain text: below `[06.1]` the known mistakes, each a line `old => new` with its hint below.

`lessons` never imports this package: a check finds an exercise by its number at run time. It is not handed out as it
stands here, and a submission that is graded never finds it.
"""
