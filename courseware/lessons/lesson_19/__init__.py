"""Lesson 19, both papers in one world: a robot put anywhere in a room, its two sensors, and who helps whom."""
