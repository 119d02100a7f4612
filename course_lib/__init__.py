"""Indoor localization by doing it: depth-camera Monte Carlo localization and spherical stereo.

`course_lib.geometry` holds the frames both methods share, `course_lib.depth_mcl` paper 1 (Hatakeyama, Kanai, Date),
`course_lib.worlds` the simulated places that data/ was made from, `course_lib.lessons` what only the notebooks use.
The command line is `python -m course_lib`, normally reached through `python3 course.py`.
"""

__version__ = "0.1.0"
