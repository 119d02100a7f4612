"""Lesson 08, the corridor experiment: its figures, and a panel that runs the filter along the corridor at once."""
