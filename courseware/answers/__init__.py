"""Closed: solutions, inputs and known mistakes of all exercises; the projects' hidden seeds and rivals.

`lessons` never imports this package: a check finds an exercise by its number at run time. It is not handed out as it
stands here, and a submission that is graded never finds it.
"""
