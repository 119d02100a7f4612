"""Lesson 15, semantic map matching: the room's objects from exact boxes, what the penalty makes of them, figures."""
