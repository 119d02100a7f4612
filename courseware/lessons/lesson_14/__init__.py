"""Lesson 14, triangulation: how noise of two directions becomes an ellipse, and two distances of every object."""
