"""Lesson 18, similar sofas: poses of two matches, what speaks for each, how sure, and when to say nothing."""

from courseware.lessons.kit.room_observations import room_scenes
from courseware.lessons.kit.room_photographs import room_map
from courseware.lessons.lesson_18.panel import PANELS, hypotheses_panel
