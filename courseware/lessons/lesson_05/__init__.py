"""Lesson 05, particles and motion: clouds that walk, an oracle that keeps the nearest, their figures and panel."""
