"""Tools that several lessons share: exercise checks, panels, live figures, progress bars and the recordings."""
