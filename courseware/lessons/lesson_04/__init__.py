"""Lesson 04, the depth camera: its scene, its faults one by one, figures and panel."""
