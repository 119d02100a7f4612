"""Lesson 13, matching two spheres: one object of the upper panorama, its band and its matches in the lower one."""
