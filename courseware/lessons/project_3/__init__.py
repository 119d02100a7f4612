"""Project P3: a matcher that survives the look-alike sofas."""
