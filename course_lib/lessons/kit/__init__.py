"""What several lessons share: exercise checks, panels, live figures, progress bars, where the data is."""
