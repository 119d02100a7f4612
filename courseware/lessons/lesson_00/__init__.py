"""Lesson 00, start here: the corridor's recording beside its map, the panel that looks for eq. (8)'s peak, a room."""
