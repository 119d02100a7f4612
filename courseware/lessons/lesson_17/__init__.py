"""Lesson 17, the room experiment: its places, which poses fail, and a panel that hides objects from the camera."""
