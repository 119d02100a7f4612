"""Section 2.2: objects in each panorama, by a network."""
