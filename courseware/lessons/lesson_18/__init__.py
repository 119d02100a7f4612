"""Lesson 18, similar sofas: poses of two matches, what speaks for each, how sure, and when to say nothing."""
