"""Lesson 16, pose from points: matched points of the room, noise on points, the figures and the panel of the fit."""
