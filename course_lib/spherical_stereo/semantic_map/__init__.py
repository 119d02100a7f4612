"""Section 2.5: the map of objects, eq. (1), and the greedy search that pairs observed objects with landmarks."""
