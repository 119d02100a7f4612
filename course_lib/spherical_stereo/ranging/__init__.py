"""Section 2.4: from two directions to a place, and how sure it is."""
