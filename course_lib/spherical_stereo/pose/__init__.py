"""Section 2.6: from pairs of objects and landmarks to a pose, and what a localization answers."""
