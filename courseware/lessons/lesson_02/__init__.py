"""Lesson 02, a map from a laser scan: a small room's maps and what a camera sees of them, the corridor's map."""
