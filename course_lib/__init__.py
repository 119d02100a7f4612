"""Indoor localization by doing it: depth-camera Monte Carlo localization and spherical stereo.

geometry             the frames that both methods share
depth_mcl            paper 1 (Hatakeyama, Kanai, Date)
spherical_stereo     paper 2 (Onozeki, Iriyama, Ogasa, Pathak, Umeda)
experiments          both papers' tables, as functions of a seed
simulation           the places that data/ was made from
detector_training    the network that finds objects (needs PyTorch)
plots, lessons       figures, and what only the notebooks use
paths                where the data and the lessons lie
commands, cli        `python -m course_lib`, normally reached through `python3 course.py`
"""

__version__ = "0.1.0"
