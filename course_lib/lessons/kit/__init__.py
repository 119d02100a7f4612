"""What several lessons share: exercise checks, panels, live figures, progress bars, the recordings they look at."""
