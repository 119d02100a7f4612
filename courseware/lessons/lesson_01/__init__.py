"""Lesson 01, poses and frames: its figures, and a camera that six sliders drive through the corridor."""
