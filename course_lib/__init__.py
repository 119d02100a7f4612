"""Indoor localization by doing it: depth-camera Monte Carlo localization and spherical stereo.

geometry, files, paths   rigid transforms and angles; reading and writing; where the data and the lessons lie
rendering                camera, scene map, depth images
depth_mcl                paper 1 (Hatakeyama, Kanai, Date)
spherical_stereo         paper 2 (Onozeki, Iriyama, Ogasa, Pathak, Umeda)
beyond                   what the papers left open
simulation               the places that data/ was made from
experiments              both papers' tables, as functions of a seed
plots, lessons           figures, and what only the notebooks use
classroom                handing out and grading
commands, cli            `python -m course_lib`, normally reached through `python3 course.py`
"""

__version__ = "1.0.0"
