"""Simulated sensors: laser scanner, time-of-flight camera, panorama cameras and their rig."""
