"""Beyond paper 1, section 5: all six degrees of freedom. localizer.py says in which order the modules work."""
