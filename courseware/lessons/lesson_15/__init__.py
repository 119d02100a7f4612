"""Lesson 15, semantic map matching: the room's objects from exact boxes, what the penalty makes of them, figures."""

from courseware.lessons.kit.room_data import room_map, room_scenes
from courseware.lessons.lesson_15.figures import centroids_figure, sofas_figure, terms_figure
from courseware.lessons.lesson_15.panel import PANELS, weights_panel
from courseware.lessons.lesson_15.scores import PAIR, SOFAS, hidden_score, score, two_searches
