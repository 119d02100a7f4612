"""Paper 2: from two panoramas, one above the other, to a pose on a semantic map; one module per step."""
