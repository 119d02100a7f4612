"""Lesson 03, GPU scene simulation: its small scenes and what it measures on them, figures and panel."""
