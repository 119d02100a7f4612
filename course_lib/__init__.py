"""Indoor localization by doing it: depth-camera Monte Carlo localization and spherical stereo.

geometry, files      rigid transforms and angles; reading and writing
rendering            camera, scene map, depth images
depth_mcl            paper 1 (Hatakeyama, Kanai, Date)
spherical_stereo     paper 2 (Onozeki, Iriyama, Ogasa, Pathak, Umeda)
beyond               what the papers left open
recordings           a localizer run over a whole recording
"""

__version__ = "2.0.0"
