"""Project P2: from the boxes of two images to a pose."""
