"""The simulated corridor of paper 1: its true world, the laser survey's map, and the recorded runs."""
