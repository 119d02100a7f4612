"""Lesson 18, similar sofas: poses of two matches, what speaks for each, how sure, and when to say nothing."""

from courseware.lessons.kit.room_data import room_map, room_scenes
from courseware.lessons.lesson_18.panel import PANELS, hypotheses_panel
