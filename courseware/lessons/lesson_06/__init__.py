"""Lesson 06, likelihood and weights: one depth image of the corridor, four likelihoods, and their panel."""
