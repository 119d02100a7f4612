"""Lesson 11, the spherical camera: a panorama and its sphere side by side, a view cut out of it, what seams do."""
