"""Foundation F1, the Bayes filter: a corridor with three niches, the exact belief, and particles that carry weights."""
