"""Lesson 12, detecting objects: a sofa that the seam cuts, thresholds, and the hue and saturation of a box."""
