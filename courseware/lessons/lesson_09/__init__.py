"""Lesson 09, six degrees of freedom: why 200 particles are lost, and the ideas that make it work."""
