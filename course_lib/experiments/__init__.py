"""Both papers' experiments as plain functions of a seed and parameters: tables, scores, the papers' own numbers.

Imports the methods and what is simulated; no method imports it.
"""

from course_lib.experiments.sweeps import sweep

__all__ = ["sweep"]
