"""Lesson 10, lost and found: a hotel with two rooms alike, kidnappings in it, filters that start anywhere."""
