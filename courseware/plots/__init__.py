"""Figures that commands and lessons share, in one style."""
